#!/usr/bin/python3
"""Puts single faults into a room's code and tells which of them no test notices.

One copy of the sources is built with all faults in it, each behind a switch (TESSERA_MUTANT in the environment); every
test is run once to see which faults it comes to; then for each fault the tests that come to it are run, quick ones
first, until one fails. The checkout is never written to. Which faults are made is told by the seed alone: a fault keeps
its place while its own function does.

  mutate.py app                    makes, builds and tries 200 faults in app; goes on where it was stopped
  mutate.py app --again            tries survivors again, with tests that were added or changed since
  mutate.py app --as-built         goes on with the copy as it was built, whatever changed since
  mutate.py app --fresh            chooses again: after much new code, or with another --seed, --faults or --placed
  mutate.py app --report           prints the table and the survivors, runs nothing
  mutate.py app --only 17,23       tries these again and says by what they are killed
  mutate.py app --under app/session,app/history --tests app_tests --folder build/mutate_session
                                   a part of the room by some of its tests: a run of minutes, with a folder of its own

Needs python3-clang-16 and what ./setup.sh --tests installs.
"""
import argparse
import json
import os
import sys

import build
import report
import trial

# Of each room: folders that are left out, its libraries, and what tries its faults.
ROOMS = {
    "volume": dict(but=(), libraries=["volume"], tests=["volume_tests", "import_tests"], programs=[], scripts=[]),
    "codec": dict(but=(), libraries=["codec"], tests=["codec_tests"], programs=[], scripts=[]),
    "vis": dict(but=(), libraries=["vis_model", "vis_packet", "vis"],
                tests=["vis_tests", "packet_tests", "vis_gl_tests"], programs=[], scripts=[]),
    "app": dict(but=("app/importer/",), libraries=["app_core", "drawing", "app", "tessera"],
                tests=["app_tests", "app_gl_tests"], programs=["tessera"],
                scripts=["compare", "diff", "generate", "mesh", "plot", "render", "stats"]),
}


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("room", choices=sorted(ROOMS))
    parser.add_argument("--faults", type=int, default=200, help="how many to try (200)")
    parser.add_argument("--seed", type=int, default=1, help="other seeds choose other faults (1)")
    parser.add_argument("--placed", type=int, default=0,
                        help="how many to build, of which those that tests reach are tried (2.5 times --faults)")
    parser.add_argument("--under", default="", help="folders of the room to take faults from (all)")
    parser.add_argument("--tests", default="", help="test programs to try them by, without scripts (all)")
    parser.add_argument("--folder", default="build/mutate", help="where the copy is made (build/mutate)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="for the compiler (one a core)")
    parser.add_argument("--again", action="store_true", help="try survivors again")
    parser.add_argument("--only", default="", help="numbers of faults to try again")
    parser.add_argument("--report", action="store_true", help="only print what is known")
    parser.add_argument("--fresh", action="store_true", help="choose the faults again, as after a change of seed or rules")
    parser.add_argument("--as-built", action="store_true", help="go on with what is built, whatever changed since")
    parser.add_argument("--build-only", action="store_true", help="make and build the copy, run nothing")
    return parser.parse_args()


def say(text):
    print(f"mutate: {text}", file=sys.stderr, flush=True)


def load(path, empty):
    return json.load(open(path)) if os.path.exists(path) else empty


def save(path, value):
    with open(path + ".new", "w") as out:
        json.dump(value, out, indent=1)
    os.replace(path + ".new", path)


def sources_of(copy, room, under):
    """The room's source files in the folders `under`, but those of programs that its tests do not run."""
    folders = tuple(f.rstrip("/") + "/" for f in (under or room).split(","))
    return sorted(n for n in copy.files() if n.endswith(".cpp") and n.startswith(folders) and n.startswith(room + "/") and
                  not n.startswith(ROOMS[room]["but"]))


def place(copy, room, args):
    """{number: fault} of the copy, which is written and built. Faults that did not compile once are not tried again."""
    flags = copy.flags()
    every = build.find_all(copy, sources_of(copy, room, args.under), flags)
    refused_path = os.path.join(copy.folder, "refused.json")
    refused = set(load(refused_path, []))
    wanted = args.placed or args.faults * 5 // 2
    targets = ROOMS[room]["tests"] + ROOMS[room]["programs"]
    numbered_path = os.path.join(copy.folder, "numbers.json")
    numbers = load(numbered_path, {})  # names keep their numbers: what is known of them stays true
    placed = [] if args.fresh else list(build.load_placed(copy.folder).values())
    if placed:  # the same faults, wherever their lines are now
        found = {f.name(): f for f in every}
        chosen = [found[f.name()] for f in placed if f.name() in found]
    else:
        chosen = build.choose(every, wanted, args.seed)
    chosen = [f for f in chosen if f.name() not in refused]
    say(f"{room}: {len(every)} possible faults, {len(chosen)} placed")
    for fault in chosen:
        numbers.setdefault(fault.name(), len(numbers) + 1)
    save(numbered_path, numbers)
    numbered = {numbers[f.name()]: f for f in chosen}
    if max(numbered, default=0) >= 4096:  # as many as switch.cpp has room for
        raise SystemExit(f"mutate: too many faults were placed over time; remove {copy.folder}")
    while True:
        copy.put(numbered)
        said = copy.make(targets, args.jobs)
        if not said:
            break
        bad = build.blamed(said, copy, numbered)
        if not bad:
            raise SystemExit(f"mutate: the copy does not compile, and by none of the faults:\n{said[-3000:]}")
        say(f"{len(bad)} faults do not compile and are dropped")
        refused |= {numbered.pop(number).name() for number in bad}
        save(refused_path, sorted(refused))
    return numbered


def main():
    args = options()
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    room = ROOMS[args.room]
    if args.tests:
        room.update(tests=args.tests.split(","), programs=[], scripts=[])
    folder = os.path.join(root, args.folder, args.room)
    os.makedirs(folder, exist_ok=True)
    copy = build.Copy(root, folder)
    verdict_path = os.path.join(folder, "verdicts.json")
    verdicts, reasons = load(verdict_path, {}), report.equivalents()
    if args.report or args.as_built:
        numbered = build.load_placed(folder)
    else:
        copy.mirror(but=build.placed_files(folder))
        copy.configure(room["libraries"])
        room["tests"] = [t for t in room["tests"] if copy.has(t)]
        numbered = place(copy, args.room, args)
        build.save_placed(folder, numbered)
    if args.build_only:
        return
    data = os.path.join(os.path.dirname(root), "shared", "data")
    trials = trial.Trials(folder, copy.build, copy.sources, room["tests"], room["scripts"], data if os.path.isdir(data) else "")
    if args.report or args.as_built:
        trials.remember()
    else:
        trials.learn(numbered, say)
    reached = [n for n in numbered if any(n in t.reaches for t in trials.tests)]
    tried = reached[:args.faults]
    if not args.report:
        only = {int(n) for n in args.only.split(",") if n}
        for count, number in enumerate(tried):
            fault = numbered[number]
            before = verdicts.get(fault.name(), {}).get("verdict")
            retry = number in only or (args.again and before == "survived" and fault.name() not in reasons)
            if (only and number not in only) or (before and not retry):
                continue
            # Every test that comes to it would run, to tell what is known.
            verdict, by = ("survived", "") if fault.name() in reasons else trials.kill(number)
            verdicts[fault.name()] = {"verdict": verdict, "by": by, "number": number}
            save(verdict_path, verdicts)
            say(f"{count + 1}/{len(tried)} {number} {verdict} {by or fault.name()}")
    faults_tried = [numbered[n] for n in tried]
    print(report.by_rule(faults_tried, verdicts, reasons))
    print(report.survivors(faults_tried, verdicts, reasons))
    print(report.HEAD)
    print(report.row(args.room, len(numbered), len(reached), faults_tried, verdicts, reasons))


if __name__ == "__main__":
    main()
