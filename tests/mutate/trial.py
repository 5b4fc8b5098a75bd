"""Runs tests in a build with faults: first to see which faults each test comes to, then once for each fault."""
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time

MEMORY, FILE_SIZE = 12 << 30, 4 << 30  # bytes: a fault may ask for any amount


class Test:
    """One test case of a test program, or a script."""

    def __init__(self, program, name, file, seconds, reaches):
        self.program, self.name, self.file, self.seconds, self.reaches = program, name, file, seconds, set(reaches)


def digest(path):
    return hashlib.sha256(open(path, "rb").read()).hexdigest()[:16] if os.path.exists(path) else ""


class Trials:
    """Tests of the programs `programs` in the folder `build`, run one at a time; what is known is kept in `folder`."""

    def __init__(self, folder, build, sources, programs, scripts, data):
        self.folder, self.build, self.sources = folder, build, sources
        self.programs, self.scripts, self.data = programs, scripts, data
        self.tests = []

    def environment(self, work):
        env = {k: v for k, v in os.environ.items() if not k.startswith(("TESSERA_MUTANT", "GTEST_"))}
        for name, sub in (("TMPDIR", "tmp"), ("XDG_CONFIG_HOME", "c"), ("XDG_STATE_HOME", "s"), ("XDG_CACHE_HOME", "k"),
                          ("XDG_DATA_HOME", "d")):
            env[name] = os.path.join(work, sub)
            os.makedirs(env[name], exist_ok=True)
        env["MESA_SHADER_CACHE_DIR"] = os.path.join(self.folder, "shaders")
        if self.data:
            env.setdefault("TESSERA_DATA", self.data)
            env["TESSERA_TEST_DATA"] = self.data
        return env

    def run(self, command, seconds, settings):
        """(status, output) of a command that may use the processor for `seconds`; None for one that ran too long."""
        with tempfile.TemporaryDirectory(dir=self.folder) as work:
            env = {**self.environment(work), **settings}
            processor = int(seconds) + 1

            def limits():
                os.nice(5)
                resource.setrlimit(resource.RLIMIT_CPU, (processor, processor + 5))
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
                resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_SIZE, FILE_SIZE))
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

            with open(os.path.join(work, "said"), "wb") as said:
                process = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, cwd=work,
                                           env=env, preexec_fn=limits, start_new_session=True)
                status = wait_while_busy(process, 60 + 3 * seconds, command[0] != "bash")
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
                process.wait()
            text = open(os.path.join(work, "said"), "rb").read().decode(errors="replace")
        return status, text

    # What tests reach

    def known_path(self):
        return os.path.join(self.folder, "reached.json")

    def learn(self, numbers, say):
        """Runs each test that is new, or whose source file changed, without a fault; the rest as noted before. Where
        `numbers` holds faults that were not there before, all run again."""
        known = json.load(open(self.known_path())) if os.path.exists(self.known_path()) else {}
        if not set(numbers) <= set(known.get("faults", [])):
            known = {"faults": sorted(numbers), "tests": {}}
        notes = known["tests"]
        for program in self.programs:
            binary = os.path.join(self.build, program)
            names = list_tests(binary, self.environment(self.folder))
            for gone in [k for k, v in notes.items() if v["program"] == program and v["name"] not in names]:
                del notes[gone]
            fresh = [n for n in names if f"{program}:{n}" not in notes
                     or notes[f"{program}:{n}"]["digest"] != digest(notes[f"{program}:{n}"]["file"])]
            say(f"{program}: {len(fresh)} of {len(names)} tests to learn")
            for part in range(0, len(fresh), 400):
                self.learn_from(program, binary, fresh[part:part + 400], notes)
            with open(self.known_path(), "w") as out:
                json.dump(known, out)
        for script in self.scripts:
            key = f"script:{script}"
            path = os.path.join(self.sources, "tests", "e2e", script + ".sh")
            if key not in notes or notes[key]["digest"] != digest(path):
                notes[key] = self.learn_script(script, path)
                say(f"{key}: {'passes' if notes[key]['passed'] else 'does not pass: left out'}")
                with open(self.known_path(), "w") as out:
                    json.dump(known, out)
        self.remember()
        left_out = [k for k, n in notes.items() if not n["passed"]]
        if left_out:
            say(f"left out, since they do not pass without a fault: {', '.join(left_out)}")

    def remember(self):
        """The tests as noted by the last run."""
        known = json.load(open(self.known_path())) if os.path.exists(self.known_path()) else {"tests": {}}
        self.tests = [Test(n["program"], n["name"], n["file"], n["seconds"], n["reaches"])
                      for n in known["tests"].values() if n["passed"]]

    def learn_from(self, program, binary, names, notes):
        folder = tempfile.mkdtemp(dir=self.folder)
        settings = {"TESSERA_MUTANT_COVER": "", "TESSERA_MUTANT_TESTS": folder}
        self.run([binary, "--gtest_filter=" + ":".join(names)], 3000, settings)
        for file in os.listdir(folder):
            if not file.isdigit():
                continue
            lines = open(os.path.join(folder, file)).read().split("\n")
            name, source, passed, seconds = lines[0].split("\t")
            source = os.path.normpath(os.path.join(self.build, source))  # a compiler cache makes it relative
            notes[f"{program}:{name}"] = {"program": program, "name": name, "file": source, "digest": digest(source),
                                          "passed": passed == "1", "seconds": float(seconds),
                                          "reaches": [int(l) for l in lines[1:] if l]}
        shutil.rmtree(folder)

    def learn_script(self, script, path):
        cover = os.path.join(self.folder, "script.reached")
        if os.path.exists(cover):
            os.remove(cover)
        began = time.time()
        status, _ = self.run(self.script_command(path), 1000, {"TESSERA_MUTANT_COVER": cover})
        reached = sorted({int(l) for l in open(cover).read().split()}) if os.path.exists(cover) else []
        return {"program": "script", "name": script, "file": path, "digest": digest(path), "passed": status == 0,
                "seconds": time.time() - began, "reaches": reached}

    def script_command(self, path):
        return ["bash", path, os.path.join(self.build, "tessera"), self.sources]

    # One fault

    def kill(self, number):
        """(verdict, test): "killed" by the first test that fails, "survived" (no test), or "unreached"."""
        tests = sorted((t for t in self.tests if number in t.reaches), key=lambda t: t.seconds)
        if not tests:
            return "unreached", ""
        for batch in batches(tests):
            rest = batch
            while rest:
                failed, hung = self.first_failure(number, rest)
                if failed is None:
                    break
                if hung or len(rest) == 1 or self.first_failure(number, [failed])[0]:
                    return "killed", f"{failed.program}:{failed.name}"
                # By itself it passes: the failure came of the company it was in, or of the load.
                rest = [t for t in rest if t is not failed]
        return "survived", ""

    def first_failure(self, number, tests):
        """(the first of the tests that fails with this fault or None, whether it did not come to an end)"""
        seconds = 20 + 5 * sum(t.seconds for t in tests)
        program = tests[0].program
        settings = {"TESSERA_MUTANT": str(number)}
        if program == "script":
            command = self.script_command(tests[0].file)
        else:
            command = [os.path.join(self.build, program), "--gtest_fail_fast", "--gtest_brief=0",
                       "--gtest_filter=" + ":".join(t.name for t in tests)]
        status, text = self.run(command, seconds, settings)
        if status == 0:
            return None, False
        found = re.search(r"\[  FAILED  \] ([^\s,]+)", text) or (re.findall(r"\[ RUN      \] (\S+)", text) or [None])[-1]
        name = found if isinstance(found, str) else found[1] if found else ""
        return next((t for t in tests if t.name == name), tests[-1]), status is None


def wait_while_busy(process, longest, alone):
    """Exit status of a process; None where it took longer than `longest` seconds (others may be using the machine), or,
    if it does its work `alone`, did nothing at all for 40 seconds."""
    began = idle_since = time.monotonic()
    before = None
    while True:
        try:
            return process.wait(timeout=0.5)
        except subprocess.TimeoutExpired:
            now = time.monotonic()
        try:
            fields = open(f"/proc/{process.pid}/stat").read().rpartition(")")[2].split()
            used = (fields[11], fields[12], fields[13], fields[14])  # its own time and that of children that have ended
        except OSError:
            continue
        if used != before:
            before, idle_since = used, now
        if now - began > longest or (alone and now - idle_since > 40):
            return None


def list_tests(binary, env):
    out, suite = [], ""
    for line in subprocess.run([binary, "--gtest_list_tests"], capture_output=True, text=True, env=env).stdout.split("\n"):
        line = line.split("#")[0].rstrip()
        if line and not line.startswith(" ") and line.endswith("."):
            suite = line
        elif line.startswith("  ") and not line.strip().startswith("DISABLED_"):
            out.append(suite + line.strip())
    return out


def batches(tests):
    """Groups of one program each, quick ones first: a process for a few costs less than one for each."""
    out = []
    for limit in (1, 5, 20, 60, 1e9):
        part, tests = [t for t in tests if t.seconds < limit / 10], [t for t in tests if t.seconds >= limit / 10]
        for program in sorted({t.program for t in part}, key=lambda p: (p == "script", "gl" in p, p)):
            group, total = [], 0
            for test in (t for t in part if t.program == program):
                if group and (total + test.seconds > limit or program == "script"):
                    out.append(group)
                    group, total = [], 0
                group.append(test)
                total += test.seconds
            if group:
                out.append(group)
    return out
