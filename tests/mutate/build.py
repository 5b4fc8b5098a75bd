"""Makes a copy of the sources with faults in it, and builds it; faults that do not compile are dropped."""
import concurrent.futures
import hashlib
import json
import os
import pickle
import re
import shlex
import subprocess

import faults as finding

HERE = os.path.dirname(os.path.abspath(__file__))


class Copy:
    """The copy of the checkout `root` below `folder`. The checkout itself is never written to."""

    def __init__(self, root, folder):
        self.root, self.folder = root, folder
        self.sources = os.path.join(folder, "source")
        # Beside its sources as the presets have it, so that a compiler cache knows what has no faults.
        self.build = os.path.join(self.sources, "build", "release")

    def files(self):
        listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=self.root,
                                capture_output=True, text=True, check=True).stdout.split("\n")
        return [f for f in listed if f and os.path.isfile(os.path.join(self.root, f))]

    def write(self, name, data):
        """Only what differs, so that nothing else is compiled again."""
        path = os.path.join(self.sources, name)
        if os.path.exists(path) and open(path, "rb").read() == data:
            return
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as out:
            out.write(data)

    def mirror(self, but=()):
        """Copies every file as it is, except those named in `but`; removes what the checkout no longer has."""
        files = self.files()
        for name in files:
            if name in but:
                continue
            source = os.path.join(self.root, name)
            self.write(name, open(source, "rb").read())
            os.chmod(os.path.join(self.sources, name), os.stat(source).st_mode)
        known = set(files)
        for folder, folders, names in os.walk(self.sources):
            if folder == self.sources:
                folders[:] = [f for f in folders if f not in ("build", ".git")]
            for name in names:
                path = os.path.join(folder, name)
                if os.path.relpath(path, self.sources) not in known:
                    os.remove(path)

    def configure(self, targets):
        subprocess.run(["cmake", "--preset", "release", "-DBUILD_TESTING=ON", "-DTESSERA_WERROR=ON",
                        f"-DCMAKE_PROJECT_tessera_INCLUDE={HERE}/mutate.cmake",
                        f"-DTESSERA_MUTATE_TARGETS={';'.join(targets)}",
                        f"-DTESSERA_TEST_DATA={os.path.join(os.path.dirname(self.root), 'shared', 'data')}"],
                       cwd=self.sources, check=True, stdout=subprocess.DEVNULL)

    def has(self, target):
        """False for what is only built where VTK is installed, and it is not."""
        return f"\nbuild {target}: " in open(os.path.join(self.build, "build.ninja")).read()

    def flags(self):
        """What clang needs to read any of the files: every include folder and definition of the build."""
        flags = ["-x", "c++", "-std=c++20", "-DNDEBUG", f"-I{self.root}"]
        for entry in json.load(open(os.path.join(self.build, "compile_commands.json"))):
            words = shlex.split(entry["command"])
            for i, word in enumerate(words):
                more = [word] if word.startswith("-D") else [word, words[i + 1]] if word == "-isystem" else []
                if more and more[-1] not in flags:
                    flags += more
        return flags

    def make(self, targets, jobs):
        """Empty if all was built, else what the compiler said."""
        done = subprocess.run(["cmake", "--build", self.build, "-j", str(jobs), "--target", *targets, "--", "-k", "0"],
                              capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
        return "" if done.returncode == 0 else done.stdout + done.stderr

    def put(self, numbered):
        """Writes the files with these faults: {number: fault}. Every other file is as in the checkout."""
        by_file = {}
        for number, fault in numbered.items():
            by_file.setdefault(fault.file, []).append((number, fault))
        for name, its in by_file.items():
            data = open(os.path.join(self.root, name), "rb").read()
            self.write(name, with_faults(data, its))
        self.mirror(but=by_file)


def with_faults(data, numbered):
    """The text of a file in which each of the (number, fault) has its guard. Lines keep their numbers."""
    edits = []
    for number, fault in numbered:
        on = f"(tesseraMutantArmed[{number}] && tesseraMutantHit({number}))"
        edits += [(e.start, e.end, e.before.replace("@", on, 1) if "@" in e.before else e.before, e.after)
                  for e in fault.edits]
    # Outer edits first: what begins earlier, or ends later, holds the other.
    edits.sort(key=lambda e: (e[0], -e[1]))
    openings, closings = {}, {}
    for start, end, before, after in edits:
        openings.setdefault(start, []).append(before.encode())
        if after:
            closings.setdefault(end, []).append((start, after.encode()))
    out = [b"extern \"C\" { extern unsigned char tesseraMutantArmed[]; bool tesseraMutantHit(int); }\n#include <string>\n"
           b"#include <type_traits>\n#line 1\n"]
    for i in range(len(data) + 1):
        if i in closings:  # the innermost closes first
            out += [text for _, text in reversed(closings[i])]
        if i in openings:
            out += openings[i]
        out.append(data[i:i + 1])
    return b"".join(out)


def compatible(chosen, fault):
    """False where two faults would cut into each other's text or wrap the same text twice."""
    for other in chosen:
        for a in other.edits:
            for b in fault.edits:
                apart = a.end <= b.start or b.end <= a.start
                within = (a.start <= b.start and b.end <= a.end) or (b.start <= a.start and a.end <= b.end)
                if (a.start, a.end) == (b.start, b.end) or not (apart or within):
                    return False
    return True


def blamed(said, copy, numbered):
    """Numbers of the faults on the lines that the compiler complains about."""
    lines = {}
    start = rf"(?:{re.escape(copy.sources)}|\.\./\.\.)/"  # a compiler cache makes paths relative to the build folder
    blocks = re.split(r"\n(?=\S+:\d+:\d+: error:)|\n(?=In file included|FAILED:)", said)
    for block in blocks:
        if "error:" not in block:
            continue
        places = re.findall(start + r"(\S+?):(\d+):\d+: error:", block)
        places = places or re.findall(start + r"(\S+?):(\d+):\d+:", block)
        for name, line in places:
            lines.setdefault(name, set()).add(int(line))
    bad = set()
    for number, fault in numbered.items():
        wanted = lines.get(fault.file)
        if not wanted:
            continue
        data = open(os.path.join(copy.root, fault.file), "rb").read()
        for e in fault.edits:
            first, last = data.count(b"\n", 0, e.start) + 1, data.count(b"\n", 0, e.end) + 1
            if any(first <= line <= last for line in wanted):
                bad.add(number)
    return bad


def find_in(path, name, flags):
    return finding.faults_of(finding.load_clang(), path, name, flags)


def find_all(copy, names, flags):
    """Faults of the files, found again only where a file changed (kept in the folder of the copy)."""
    if finding.load_clang() is None:
        raise SystemExit("mutate: install python3-clang-16 (and run it with /usr/bin/python3)")
    rules = b"".join(open(os.path.join(HERE, f), "rb").read() for f in ("faults.py", "rules.py"))
    store = os.path.join(copy.folder, "found.pickle")
    known = pickle.load(open(store, "rb")) if os.path.exists(store) else {}
    keys = {}
    for name in names:
        data = open(os.path.join(copy.root, name), "rb").read()
        keys[name] = (name, hashlib.sha256(rules + data).hexdigest())
    with concurrent.futures.ProcessPoolExecutor() as pool:
        running = {pool.submit(find_in, os.path.join(copy.root, name), name, flags): key
                   for name, key in keys.items() if key not in known}
        for count, done in enumerate(concurrent.futures.as_completed(running), 1):
            known[running[done]] = done.result()
            if count % 20 == 0 or count == len(running):
                with open(store, "wb") as file:
                    pickle.dump(known, file)
    return [fault for name in names for fault in known[keys[name]]]


def choose(all_faults, count, seed):
    """In the order of the seed, one of each rule in turn, until there are `count`."""
    by_rule = {}
    for fault in sorted(all_faults, key=lambda f: f.rank(seed)):
        by_rule.setdefault(fault.rule, []).append(fault)
    chosen, by_file = [], {}
    while by_rule and len(chosen) < count:
        for rule in sorted(by_rule):
            while by_rule[rule]:
                fault = by_rule[rule].pop(0)
                if compatible(by_file.get(fault.file, []), fault):
                    by_file.setdefault(fault.file, []).append(fault)
                    chosen.append(fault)
                    break
            if not by_rule[rule]:
                del by_rule[rule]
    return chosen[:count]


def save_placed(folder, numbered):
    with open(os.path.join(folder, "placed.pickle"), "wb") as out:
        pickle.dump(numbered, out)


def load_placed(folder):
    """{number: fault} of the last build, in the order of the seed."""
    path = os.path.join(folder, "placed.pickle")
    return pickle.load(open(path, "rb")) if os.path.exists(path) else {}


def placed_files(folder):
    return {fault.file for fault in load_placed(folder).values()}
