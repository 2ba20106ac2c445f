# SPDX-License-Identifier: MIT
"""Puts single faults into a copy of the sources and looks whether the tests notice: docs/mutation.md.

usage: mutate.py ROOT [PATTERN] [--list] [--near] [--jobs N] [--json FILE]

ROOT is a git repository with
  tests/mutation/faults/*.jsonl   one fault a line: id, file, find (occurs once in the file), replace, why
  tests/mutation/project.json     how the copy is configured and built, and which programs test which folder
What is made lies in ROOT/build/mutation: the copy, the times of the programs, results.jsonl.
Exit codes: 0 done, survivors or not; 1 the list, the build or the tests without a fault are wrong; 2 usage; 130 interrupted.
"""
import argparse
import fnmatch
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

FIELDS = ("id", "file", "find", "replace", "why")
TIMES_UNMUTATED = 3  # A fault may make a loop endless.
LEAST_SHARE = 0.01  # Of a second's processor time: a process with less waits.
SECONDS_TO_END = 5
COMPILER_SAYS = re.compile(r"\berror:|undefined reference|multiple definition")
FAILED_CASE = re.compile(r"^\[  FAILED  \] (\S+?)[,. ]*(?:\(|$|,| where)", re.MULTILINE)


class Wrong(Exception):
    """The list, the build or the tests without a fault are wrong."""


def digest(data):
    return hashlib.sha256(data).hexdigest()


def words(file):
    """The words of a source's name; those of its test are the same: stem_test.cpp."""
    return set(Path(file).stem.removesuffix("_test").split("_"))


def nearest(sources, names, file):
    """Of the test sources those in `names`, else those whose names share most words with that of `file`."""
    if names:
        return {source for source in sources if any(fnmatch.fnmatch(Path(source).stem, name) for name in names)}
    wanted = words(file)
    shares = {source: len(wanted & words(source)) / len(wanted | words(source)) for source in sources}
    most = max(shares.values(), default=0)
    return {source for source, share in shares.items() if most > 0 and share == most}


def processor_seconds(group):
    """Of the processes in a group and of their children that ended."""
    ticks = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # It ended meanwhile.
        if int(fields[2]) == group:
            ticks += sum(int(ticks) for ticks in fields[11:15])
    return ticks / os.sysconf("SC_CLK_TCK")


class Project:
    """The list of faults and the table of tests."""

    def __init__(self, root):
        self.root = root
        folder = root / "tests" / "mutation"
        self.table = json.loads((folder / "project.json").read_text())
        self.faults, self.breaches = [], []
        for file in sorted((folder / "faults").glob("*.jsonl")):
            for number, line in enumerate(file.read_text().splitlines(), 1):
                self.take(line, f"{file.relative_to(root)}:{number}", file.stem)

    def take(self, line, place, folder):
        try:
            fault = json.loads(line)
        except json.JSONDecodeError as error:
            return self.breaches.append(f"{place}: {error}")
        if not isinstance(fault, dict) or set(fault) != set(FIELDS) or not all(isinstance(v, str) for v in fault.values()):
            return self.breaches.append(f"{place}: expected an object of the strings {', '.join(FIELDS)}")
        if any(not fault[key] for key in FIELDS if key != "replace"):
            return self.breaches.append(f"{place}: only 'replace' may be empty")
        fault.update(place=place, folder=folder, line=digest(line.encode()))
        self.faults.append(fault)

    def programs_of(self, file):
        """Names of the programs in the row with the longest path that `file` lies in."""
        rows = [row for row in self.table["tests_of"] if file == row or file.startswith(row + "/")]
        return self.table["tests_of"][max(rows, key=len)] if rows else []

    def nearest_sources(self, file):
        """Names of test sources, without their suffix, in the row of tests_first with the longest path; often none."""
        rows = [row for row in self.table["tests_first"] if file == row or file.startswith(row + "/")]
        return self.table["tests_first"][max(rows, key=len)] if rows else []

    def check(self, tree):
        """Every breach of the list against the sources in `tree`, one line each."""
        breaches, seen = list(self.breaches), {}
        for fault in self.faults:
            place, file = fault["place"], tree / fault["file"]
            if fault["id"] in seen:
                breaches.append(f"{place}: '{fault['id']}' is the id of {seen[fault['id']]}, too")
            seen.setdefault(fault["id"], place)
            if not self.programs_of(fault["file"]):
                breaches.append(f"{place}: no row of tests_of has {fault['file']}")
            if fault["find"] == fault["replace"]:
                breaches.append(f"{place}: {fault['id']} replaces a text by itself")
            if not file.is_file():
                breaches.append(f"{place}: {fault['file']} does not exist")
            elif (count := file.read_text().count(fault["find"])) != 1:
                breaches.append(f"{place}: the text of {fault['id']} occurs {count} times in {fault['file']}")
        for row, programs in self.table["tests_of"].items():
            breaches += [f"project.json: {row} is tested by {p}, which is no program" for p in programs
                         if p not in self.table["programs"]]
        for row, names in self.table["tests_first"].items():
            breaches += [f"project.json: no test {name} goes first for {row}" for name in names
                         if not any((tree / "tests").glob(f"**/{name}.cpp"))]
        return breaches

    def matching(self, pattern):
        try:
            wanted = re.compile(pattern)
        except re.error as error:
            raise SystemExit(f"mutate: '{pattern}' is no regular expression: {error}")
        return [f for f in self.faults if wanted.search(f["id"]) or wanted.search(f["file"])]


def git(folder, *arguments):
    done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise Wrong(f"git {arguments[0]}: {done.stderr.strip()}")
    return done.stdout.strip()


def end_group(child):
    """Ends a child and its group. Ninja is asked first: its compilers have groups of their own, which it ends itself."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(child.pid, number)
            until = time.monotonic() + SECONDS_TO_END
            while time.monotonic() < until:
                child.poll()
                os.killpg(child.pid, 0)
                time.sleep(0.05)
        except ProcessLookupError:
            break
    child.wait()


class Copy:
    """A git worktree of HEAD in build/mutation, in which faults are applied and taken back."""

    def __init__(self, project, jobs):
        self.table = project.table
        self.folder = project.root / "build" / "mutation"
        self.tree = self.folder / "tree"
        self.build_folder = self.tree / self.table["build_folder"]
        self.told = self.folder / "tests.json"  # By the last run of a GoogleTest program.
        self.jobs = jobs
        self.commit = git(project.root, "rev-parse", "HEAD")
        self.tests = git(project.root, "rev-parse", "HEAD:tests")
        self.folder.mkdir(parents=True, exist_ok=True)
        if git(project.root, "status", "--porcelain", "--untracked-files=no"):
            print("mutate: what is not committed is not in the copy", file=sys.stderr)
        git(project.root, "worktree", "prune")
        if not (self.tree / ".git").exists():
            shutil.rmtree(self.tree, ignore_errors=True)
            git(project.root, "worktree", "add", "--quiet", "--detach", str(self.tree), self.commit)
        # Also what a run that was killed left behind.
        git(self.tree, "checkout", "--quiet", "--force", "--detach", self.commit)
        if not self.build_folder.exists():
            self.configure()
        self.times_file = self.folder / "times.json"
        known = json.loads(self.times_file.read_text()) if self.times_file.exists() else {}
        # Of each program what it was made of, its seconds and, of GoogleTest, the source and the seconds of each test.
        self.unmutated = known.get("programs", {})
        self.unsteady = known.get("unsteady", {}) if known.get("commit") == self.commit else {}

    def filled(self, words, work=None, targets=()):
        values = {"tree": self.tree, "build": self.build_folder, "work": work, "jobs": self.jobs}
        result = []
        for word in words:
            result += list(targets) if word == "{targets}" else [word.format(**values)]
        return result

    def environment(self):
        return {**os.environ, **{k: self.filled([v])[0] for k, v in self.table.get("environment", {}).items()}}

    def run(self, command, folder, limit=None):
        """The exit code, or why it was ended; what was printed, and the processor time in seconds."""
        log = self.folder / "output.txt"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(log, "w+", errors="replace") as output:
            child = subprocess.Popen(command, cwd=folder, env=self.environment(), stdin=subprocess.DEVNULL, stdout=output,
                                     stderr=subprocess.STDOUT, start_new_session=True)
            try:
                code = self.wait(child, limit)
            finally:
                if child.poll() is None:
                    end_group(child)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return code, log.read_text(errors="replace"), seconds

    def wait(self, child, limit):
        """The exit code, or why it has to be ended. Other processes, a low priority and a machine that is frozen do not count:
        a second is one that this process lived through, and what computes has a share of each."""
        computed, waited = 0, 0
        while True:
            try:
                return child.wait(1 if limit else None)
            except subprocess.TimeoutExpired:
                now = processor_seconds(child.pid)
                waited += now - computed < LEAST_SHARE
                computed = now
                if computed > limit:
                    return f"computes for longer than {limit:.0f} s"
                if waited > self.table["least_seconds"]["waiting"]:
                    return f"waits for longer than {waited:.0f} s"

    def configure(self):
        if not self.table["configure"]:
            return
        words = list(self.table["configure"])
        for program, more in self.table.get("configure_if", {}).items():
            words += more if shutil.which(program) else []
        code, output, _ = self.run(self.filled(words), self.tree)
        if code != 0:
            shutil.rmtree(self.build_folder, ignore_errors=True)
            raise Wrong(f"the copy can't be configured:\n{output[-4000:]}")

    def build(self, programs):
        """What the build printed when it failed, else nothing."""
        targets = sorted({target for name in programs for target in self.table["programs"][name]["targets"]})
        code, output, _ = self.run(self.filled(self.table["build"], targets=targets), self.tree)
        return output if code != 0 else None

    def command(self, name, asked, left_out, work):
        """What runs a program; of GoogleTest those tests alone, or all but those."""
        program = self.table["programs"][name]
        if "gtest" not in program:
            return self.filled(program["run"], work)
        left_out = [*left_out, *program.get("left_out", [])]
        words = [program["gtest"], "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_output=json:{self.told}"]
        if asked or left_out:
            words.append("--gtest_filter=" + ":".join(asked) + ("-" + ":".join(left_out) if left_out else ""))
        return self.filled(words, work)

    def test(self, name, limit=None, asked=(), left_out=()):
        """What kills the program's run, or None when it passes, and its processor seconds. A test of GoogleTest that fails
        is asked once more, alone: one that passes then depends on the hour, and is left out from now on."""
        work = self.folder / "work" / name
        while True:
            shutil.rmtree(work, ignore_errors=True)
            work.mkdir(parents=True)
            unsteady = self.unsteady.setdefault(name, [])
            code, output, seconds = self.run(self.command(name, asked, [*left_out, *unsteady], work), work, limit)
            if code == 0:
                return None, seconds
            if isinstance(code, str):
                return f"{name} ({code})", seconds
            case = FAILED_CASE.search(output)
            if not case:
                lines = output.strip().splitlines()
                return f"{name} (exit code {code}{': ' + lines[-1][:160] if lines else ''})", seconds
            if "gtest" not in self.table["programs"][name] or self.run(self.command(name, [case[1]], [], work), work, limit)[0] != 0:
                return f"{name}.{case[1]}", seconds
            print(f"  unsteady, and left out: {name}.{case[1]}", flush=True)
            unsteady.append(case[1])

    def made_of(self, name):
        """Digest of a program: the files that its command names, what its targets built, and what all programs read."""
        program = self.table["programs"][name]
        files = [Path(word) for word in self.filled(program.get("run") or [program["gtest"]])]
        files += [self.build_folder / "bin" / target for target in program["targets"]]
        for pattern in self.table.get("read_by_all", []):
            files += sorted(self.tree.glob(pattern))
        return digest("".join(f"{f.name} {digest(f.read_bytes())}\n" for f in files if f.is_file()).encode())

    def listed(self, name):
        """Source and seconds of each test of a GoogleTest program, of its last run or, with no time, of its list."""
        tests = {}
        if "gtest" in self.table["programs"][name]:
            for suite in json.loads(self.told.read_text())["testsuites"]:
                tests |= {f"{suite['name']}.{t['name']}": [t["file"], float(t.get("time", "0").rstrip("s"))]
                          for t in suite["testsuite"]}
        return tests

    def measure(self, programs):
        """Builds and runs the programs without a fault; the times of their tests are kept as long as they are the same."""
        if (output := self.build(programs)) is not None:
            raise Wrong(f"without a fault the build fails:\n{output[-4000:]}")
        for name in programs:
            made_of = self.made_of(name)
            if self.unmutated.get(name, {}).get("made_of") == made_of:
                continue
            print(f"  without a fault: {name}", flush=True)
            killer, seconds = self.test(name)
            if killer:
                raise Wrong(f"without a fault fails {killer}")
            self.unmutated[name] = {"made_of": made_of, "seconds": seconds, "tests": self.listed(name)}
            self.times_file.write_text(
                json.dumps({"commit": self.commit, "programs": self.unmutated, "unsteady": self.unsteady}))

    def measure_near(self, wanted):
        """The same of those tests alone that are near to one of the faults; `wanted`: programs, file and names of each."""
        programs = sorted({name for programs, _, _ in wanted for name in programs if "gtest" in self.table["programs"][name]})
        if (output := self.build(programs)) is not None:
            raise Wrong(f"without a fault the build fails:\n{output[-4000:]}")
        self.unmutated = {}
        for name in programs:
            self.run([*self.command(name, [], [], self.folder), "--gtest_list_tests"], self.folder)
            self.unmutated[name] = {"seconds": 0, "tests": self.listed(name)}
        near = [self.near(programs_of, file, names) for programs_of, file, names in wanted]
        for name in programs:
            asked = {t for of_fault in near for t in of_fault.get(name, [])}
            if asked:
                tests = self.unmutated[name]["tests"]
                print(f"  without a fault: {len(asked)} of {len(tests)} tests of {name}", flush=True)
                killer, seconds = self.test(name, asked=sorted(asked))
                if killer:
                    raise Wrong(f"without a fault fails {killer}")
                self.unmutated[name] = {"seconds": seconds, "tests": tests | self.listed(name)}

    def near(self, programs, file, names):
        """The tests near a file, of each program that was measured."""
        tests = {name: self.unmutated[name]["tests"] for name in programs if name in self.unmutated}
        sources = nearest({source for of_one in tests.values() for source, _ in of_one.values()}, names, file)
        return {name: [t for t, (source, _) in of_one.items() if source in sources] for name, of_one in tests.items()}

    def rounds(self, programs, file, names, near_alone):
        """What is run for a fault, one after the other: program, tests, those left out, and the seconds without a fault."""
        first, rest = [], []
        for name, near in self.near(programs, file, names).items():
            whole, tests = self.unmutated[name]["seconds"], self.unmutated[name]["tests"]
            if near and (near_alone or len(near) < len(tests)):
                share = sum(tests[t][1] for t in near) / max(1e-3, sum(t[1] for t in tests.values()))
                first.append((name, near, [], share * whole))
                rest.append((name, [], near, whole))
            else:
                rest.append((name, [], [], whole))
        return first if near_alone else first + rest

    def try_fault(self, fault, programs, names, near_alone):
        """One of killed, survived and does not compile, and by what; with `near_alone`, None in place of survived."""
        file = self.tree / fault["file"]
        source = file.read_bytes()
        try:
            file.write_text(source.decode().replace(fault["find"], fault["replace"]))
            built = set()
            for name, asked, left_out, seconds in self.rounds(programs, fault["file"], names, near_alone):
                if name not in built and (output := self.build([name])) is not None:
                    said = [line for line in output.splitlines() if COMPILER_SAYS.search(line)] or ["the build failed"]
                    return "does not compile", said[0].strip()
                built.add(name)
                limit = max(self.table["least_seconds"]["computing"], TIMES_UNMUTATED * seconds)
                if killer := self.test(name, limit, asked, left_out)[0]:
                    return "killed", killer
            return None if near_alone else "survived", ""
        finally:
            file.write_bytes(source)


class Results:
    """results.jsonl: the last line of an id counts."""

    def __init__(self, copy):
        self.copy = copy
        self.file = copy.folder / "results.jsonl"
        self.known = {}
        for line in self.file.read_text().splitlines() if self.file.exists() else []:
            try:
                self.known[json.loads(line)["id"]] = json.loads(line)
            except (json.JSONDecodeError, KeyError, TypeError):
                continue  # Of a run that was killed while it wrote.

    def key(self, fault):
        return digest((fault["line"] + digest((self.copy.tree / fault["file"]).read_bytes())).encode())

    def of(self, fault):
        """What is known of a fault; that it survived, only as long as the tests are the same."""
        found = self.known.get(fault["id"])
        if not found or found["key"] != self.key(fault) or found["result"] == "does not compile":
            return None
        return None if found["result"] == "survived" and found["tests"] != self.copy.tests else found

    def add(self, fault, result, by, seconds):
        self.known[fault["id"]] = {"id": fault["id"], "result": result, "by": by, "seconds": round(seconds, 1),
                                   "key": self.key(fault), "tests": self.copy.tests}
        with open(self.file, "a") as out:
            out.write(json.dumps(self.known[fault["id"]], ensure_ascii=False) + "\n")


def summary(faults, results):
    """Rows of folder, killed, survived, and the faults with their results."""
    rows, told = {}, []
    for fault in faults:
        found = results.of(fault)
        result = found["result"] if found else "not tried"
        row = rows.setdefault(fault["folder"], {"faults": 0, "killed": 0, "survived": 0})
        row["faults"] += 1
        if result in row:
            row[result] += 1
        told.append({"id": fault["id"], "file": fault["file"], "why": fault["why"], "result": result,
                     "by": found["by"] if found else ""})
    return rows, told


def share(row):
    tried = row["killed"] + row["survived"]
    return f"{100 * row['killed'] / tried:.1f} %" if tried else "-"


def print_summary(rows, told):
    print(f"\n{'folder':<12} {'faults':>6} {'killed':>6} {'survived':>8} {'score':>8}")
    total = {key: sum(row[key] for row in rows.values()) for key in ("faults", "killed", "survived")}
    for name, row in [*sorted(rows.items()), ("all", total)]:
        print(f"{name:<12} {row['faults']:>6} {row['killed']:>6} {row['survived']:>8} {share(row):>8}")
    survivors = [t for t in told if t["result"] == "survived"]
    if survivors:
        print("\nsurvivors:")
    for t in survivors:
        print(f"  {t['id']} ({t['file']}): {t['why']}")


def interrupt(*_):
    raise KeyboardInterrupt


def mutate(project, faults, arguments):
    copy = Copy(project, arguments.jobs)
    if breaches := project.check(copy.tree):
        raise Wrong("\n".join(breaches))
    results = Results(copy)
    left = [fault for fault in faults if not results.of(fault)]
    print(f"mutate: {len(faults)} faults, {len(faults) - len(left)} of them known", flush=True)
    uncompiled, interrupted = [], False
    try:
        wanted = [(project.programs_of(fault["file"]), fault["file"], project.nearest_sources(fault["file"])) for fault in left]
        if arguments.near:
            copy.measure_near(wanted)
        elif left:
            copy.measure(sorted({name for programs, _, _ in wanted for name in programs}))
        for number, (fault, (programs, _, names)) in enumerate(zip(left, wanted), 1):
            begin = time.monotonic()
            result, by = copy.try_fault(fault, programs, names, arguments.near)
            if result:
                results.add(fault, result, by, time.monotonic() - begin)
            said = f"killed by {by}" if result == "killed" else result or "not killed by the tests near it"
            print(f"[{number}/{len(left)}] {fault['id']}: {said}", flush=True)
            if result == "does not compile":
                uncompiled.append(f"{fault['place']}: {fault['id']} does not compile: {by}")
    except KeyboardInterrupt:
        interrupted = True
    rows, told = summary(faults, results)
    print_summary(rows, told)
    if arguments.json:
        for row in rows.values():
            row["score"] = row["killed"] / max(1, row["killed"] + row["survived"])
        Path(arguments.json).write_text(
            json.dumps({"commit": copy.commit, "folders": rows, "faults": told}, indent=2, ensure_ascii=False) + "\n")
    if uncompiled:
        raise Wrong("\n".join(uncompiled))
    return 130 if interrupted else 0


def main():
    parser = argparse.ArgumentParser(prog="mutate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=Path)
    parser.add_argument("pattern", nargs="?", default="", help="regular expression, searched in ids and files")
    parser.add_argument("--list", action="store_true", help="check the list against the sources, and end")
    parser.add_argument("--near", action="store_true", help="ask the tests near a fault alone; others stay not tried")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="compilers at a time")
    parser.add_argument("--json", metavar="FILE", help="write the results there, too")
    arguments = parser.parse_intermixed_args()  # As ./run gives them: options of its own before those of who calls it.
    project = Project(arguments.root.resolve())
    signal.signal(signal.SIGINT, interrupt)
    signal.signal(signal.SIGTERM, interrupt)
    try:
        if arguments.list:
            if breaches := project.check(project.root):
                raise Wrong("\n".join(breaches))
            return 0
        faults = project.matching(arguments.pattern)
        if not faults:
            print(f"mutate: no fault matches '{arguments.pattern}'", file=sys.stderr)
            return 2
        return mutate(project, faults, arguments)
    except KeyboardInterrupt:
        return 130
    except (Wrong, OSError, json.JSONDecodeError) as error:
        print(error, file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
