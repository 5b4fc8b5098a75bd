"""A solver that writes its files slowly: copies FILE... into FOLDER, each in pieces with pauses, so that it is partial for
a while; of files that belong together (.json and .raw) any may come first."""
import os, random, sys, time

folder, seed, *files = sys.argv[1:]
random.seed(int(seed))
for path in files:
    with open(path, "rb") as source:
        content = source.read()
    with open(os.path.join(folder, os.path.basename(path)), "wb", buffering=0) as out:
        cuts = sorted(random.randrange(len(content)) for _ in range(random.choice([0, 1, 3])))
        for begin, end in zip([0] + cuts, cuts + [len(content)]):
            out.write(content[begin:end])
            time.sleep(random.choice([0, 0.05, 0.2]))
    time.sleep(random.choice([0, 0.1]))
