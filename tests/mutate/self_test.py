#!/usr/bin/python3
"""Puts every fault that the rules find into sample.cpp, builds it once and looks whether each fault shows in what the
program prints. Run by ctest; ends with 77 (skipped) where libclang or a compiler is missing."""
import os
import shutil
import subprocess
import sys
import tempfile

import build
import faults

HERE = os.path.dirname(os.path.abspath(__file__))
WANTED = {
    ("span", "swap-operands", "(range.lo) - (range.hi)"), ("span", "plus-minus", "range.hi + (range.lo)"),
    ("span", "swap-member", "range.lo"), ("span", "return-empty", "return {}"), ("digits", "bound", "value > 10"),
    ("digits", "off-by-one", "11"), ("digits", "condition", "false"), ("digits", "zero-one", "0"),
    ("digits", "plus-minus", "count -= 1"), ("text", "and-or", "(!found) && (name.empty())"),
    ("text", "drop-not", "static_cast<bool>(found)"), ("text", "condition", "true"), ("text", "swap-operands", "std::string(\"!\") + (name)"),
    ("sorted", "drop-call", ""), ("sorted", "return-early", "return;"),
}
failures = []


def check(good, what):
    if not good:
        failures.append(what)
        print("FAILED:", what)


def main():
    cindex = faults.load_clang()
    compiler = shutil.which("c++")
    if cindex is None or compiler is None:
        print("skipped: needs python3-clang-16 and a C++ compiler")
        return 77
    path = os.path.join(HERE, "sample.cpp")
    found = [f for f in faults.faults_of(cindex, path, "sample.cpp", ["-x", "c++", "-std=c++20"]) if f.function != "main"]
    have = {(f.function, f.rule, f.becomes) for f in found}
    check(WANTED <= have, f"these faults are not found: {WANTED - have}")
    check(not any(f.function == "doubled" for f in found), "a fault in a constexpr function")
    again = build.choose(found, 5, 1)
    check([f.name() for f in again] == [f.name() for f in build.choose(found[::-1], 5, 1)], "a seed chooses differently")

    chosen = build.choose(found, len(found), 1)
    numbered = dict(enumerate(chosen, 1))
    with tempfile.TemporaryDirectory() as work:
        source, program = os.path.join(work, "sample.cpp"), os.path.join(work, "sample")
        data = open(path, "rb").read()
        with open(source, "wb") as out:
            out.write(build.with_faults(data, list(numbered.items())))
        subprocess.run([compiler, "-std=c++20", "-w", source, os.path.join(HERE, "switch.cpp"), "-o", program], check=True)

        def run(**settings):
            done = subprocess.run([program], capture_output=True, text=True, timeout=60, env={**os.environ, **settings})
            return done.returncode, done.stdout

        right = run()
        check(right == (0, "3 4 1 3\na! absent absent\n1 2 3 "), f"without a fault it prints {right}")
        for number, fault in numbered.items():
            same = run(TESSERA_MUTANT=str(number)) == right
            check(not same, f"switched on, this fault does not show: {fault.name()}")
        cover = os.path.join(work, "cover")
        run(TESSERA_MUTANT_COVER=cover)
        reached = {int(l) for l in open(cover)}
        check(reached == set(numbered), f"not noted as reached: {set(numbered) - reached}")
    print(f"{len(found)} faults found, {len(numbered)} tried")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
