# SPDX-License-Identifier: MIT
"""mutate.py on a project of a few lines: mutate_test.py COMPILER. Exit code 77: git or the compiler is missing."""
import functools
import json
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from mutate import nearest

MUTATE = Path(__file__).resolve().parent / "mutate.py"
COMPILER = "c++"

SIZE = """int area(int width, int height) { return width * height; }
int perimeter(int width, int height) { return 2 * (width + height); }
"""
# A square would not notice that the perimeter takes its width twice.
TEST = """int area(int, int);
int perimeter(int, int);
int main() { return area(2, 3) == 6 && perimeter(2, 2) == 8 ? 0 : 1; }
"""
KILLED = {"id": "area", "file": "src/size.cpp", "find": "width * height", "replace": "width * width", "why": "oblong"}
SURVIVES = {"id": "perimeter", "file": "src/size.cpp", "find": "width + height", "replace": "width + width", "why": "oblong"}
UNCOMPILED = {"id": "syntax", "file": "src/size.cpp", "find": "width * height", "replace": "width *", "why": "none"}
ENDLESS = {"id": "endless", "file": "src/size.cpp", "find": "return width * height;",
           "replace": "for (volatile int i = 0; i == 0;) {} return width * height;", "why": "none"}
ASLEEP = {"id": "asleep", "file": "src/size.cpp", "find": "int area(int width, int height) {",
          "replace": "extern \"C\" int pause();\nint area(int width, int height) { pause();", "why": "none"}
# A program of two cases that understands the flags of GoogleTest and notes which of them are wanted.
GTEST = """#!PYTHON
import json, subprocess, sys
flags = dict(a[2:].split("=", 1) for a in sys.argv[1:] if "=" in a)
wanted = flags.get("gtest_filter", "*")
with open("FOLDER/filters.txt", "a") as log:
    log.write(wanted + chr(10))
suites = []
for suite, case, source in ("Size", "Area", "size_test.cpp"), ("Shape", "Corners", "shape_test.cpp"):
    asked, _, left_out = wanted.partition("-")
    if suite + "." + case not in left_out and (asked in ("", "*") or suite + "." + case in asked):
        suites.append({"name": suite, "testsuite": [{"name": case, "file": source, "time": "0.5s"}]})
json.dump({"testsuites": suites}, open(flags["gtest_output"].removeprefix("json:"), "w"))
if "--gtest_list_tests" in sys.argv:
    sys.exit()
if any(s["name"] == "Size" for s in suites) and subprocess.run(["FOLDER/mutation/tree/build/toy/size"]).returncode != 0:
    sys.exit("[  FAILED  ] Size.Area (0 ms)")
if UNSTEADY and any(s["name"] == "Shape" for s in suites) and wanted != "Shape.Corners":
    sys.exit("[  FAILED  ] Shape.Corners (0 ms)")
"""


class MutateTest(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp(prefix="papilla-mutate-"))
        self.addCleanup(shutil.rmtree, self.root, ignore_errors=True)
        (self.root / "src").mkdir()
        (self.root / "tests" / "mutation" / "faults").mkdir(parents=True)
        (self.root / "src" / "size.cpp").write_text(SIZE)
        (self.root / "tests" / "size_test.cpp").write_text(TEST)
        (self.root / ".gitignore").write_text("build/\n")
        table = {"build_folder": "build/toy", "configure": ["mkdir", "-p", "{build}"],
                 "build": [COMPILER, "src/size.cpp", "tests/size_test.cpp", "-o", "{build}/size"], "environment": {},
                 "least_seconds": {"computing": 1, "waiting": 2}, "tests_first": {},
                 "programs": {"size": {"targets": ["size"], "run": ["{build}/size"]}}, "tests_of": {"src": ["size"]}}
        self.table = table
        self.write("tests/mutation/project.json", json.dumps(table))
        self.git("init", "--quiet")

    def git(self, *arguments):
        subprocess.run(["git", "-c", "user.name=test", "-c", "user.email=test@example.org", *arguments], cwd=self.root,
                       check=True, capture_output=True)

    def write(self, file, text):
        (self.root / file).write_text(text)

    def commit(self, *faults):
        self.write("tests/mutation/faults/toy.jsonl", "".join(json.dumps(fault) + "\n" for fault in faults))
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "-m", "toy")

    def mutate(self, *arguments):
        done = subprocess.run([sys.executable, MUTATE, self.root, *arguments], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def source_of_copy(self):
        return (self.root / "build" / "mutation" / "tree" / "src" / "size.cpp").read_text()

    def test_kills_one_and_lets_one_survive(self):
        self.commit(KILLED, SURVIVES)
        code, out, _ = self.mutate("--json", str(self.root / "result.json"))
        self.assertEqual(code, 0)
        self.assertIn("area: killed by size", out)
        self.assertIn("perimeter: survived", out)
        self.assertRegex(out, r"toy +2 +1 +1 +50\.0 %")
        result = json.loads((self.root / "result.json").read_text())
        self.assertEqual([f["result"] for f in result["faults"]], ["killed", "survived"])
        self.assertEqual(result["folders"]["toy"]["score"], 0.5)
        self.assertEqual(self.source_of_copy(), SIZE)
        self.assertEqual((self.root / "src" / "size.cpp").read_text(), SIZE)

    def test_resumes(self):
        self.commit(KILLED, SURVIVES)
        self.mutate()
        code, out, _ = self.mutate()
        self.assertEqual(code, 0)
        self.assertIn("2 faults, 2 of them known", out)
        self.assertRegex(out, r"toy +2 +1 +1 +50\.0 %")
        # A better test is asked about what survived, not about what was killed.
        self.write("tests/size_test.cpp", TEST.replace("perimeter(2, 2) == 8", "perimeter(2, 3) == 10"))
        self.commit(KILLED, SURVIVES)
        _, out, _ = self.mutate()
        self.assertIn("2 faults, 1 of them known", out)
        self.assertIn("perimeter: killed by size", out)
        # Another source makes all of its faults new.
        self.write("src/size.cpp", "// Of a rectangle.\n" + SIZE)
        self.commit(KILLED, SURVIVES)
        _, out, _ = self.mutate()
        self.assertIn("2 faults, 0 of them known", out)

    def test_what_does_not_compile_is_an_error_of_the_list(self):
        self.commit(UNCOMPILED, KILLED)
        code, out, err = self.mutate()
        self.assertEqual(code, 1)
        self.assertIn("toy.jsonl:1: syntax does not compile", err)
        self.assertIn("area: killed", out)
        self.assertEqual(self.source_of_copy(), SIZE)

    def test_configures_with_what_is_there(self):
        self.table["configure_if"] = {"sh": ["{build}/with_sh"], "no-such-program": ["{build}/without"]}
        self.write("tests/mutation/project.json", json.dumps(self.table))
        self.commit(KILLED)
        self.mutate()
        made = self.root / "build" / "mutation" / "tree" / "build" / "toy"
        self.assertTrue((made / "with_sh").is_dir())
        self.assertFalse((made / "without").exists())

    def test_pattern_chooses_by_id_and_file(self):
        self.commit(KILLED, SURVIVES)
        self.assertIn("1 faults", self.mutate("--jobs", "1", "^area")[1])
        self.assertIn("2 faults", self.mutate("size.cpp")[1])
        self.assertEqual(self.mutate("nothing")[0], 2)

    def test_tests_that_fail_without_a_fault_are_an_error(self):
        self.write("tests/size_test.cpp", TEST.replace("== 6", "== 7"))
        self.commit(KILLED)
        code, _, err = self.mutate()
        self.assertEqual(code, 1)
        self.assertIn("without a fault fails size", err)

    def test_an_interrupted_run_leaves_no_fault(self):
        self.table["least_seconds"]["computing"] = 120  # Longer than this test waits.
        self.write("tests/mutation/project.json", json.dumps(self.table))
        self.commit(KILLED, ENDLESS)
        run = subprocess.Popen([sys.executable, MUTATE, self.root], stdout=subprocess.PIPE, text=True)
        end = time.monotonic() + 60
        while time.monotonic() < end:  # Until the second fault is in the copy: the first one was told.
            if "area: killed" in run.stdout.readline():
                break
        while time.monotonic() < end and "volatile" not in self.source_of_copy():
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        out = run.communicate(timeout=60)[0]
        self.assertEqual(run.returncode, 130)
        self.assertRegex(out, r"toy +2 +1 +0 +100\.0 %")
        self.assertEqual(self.source_of_copy(), SIZE)
        results = (self.root / "build" / "mutation" / "results.jsonl").read_text().splitlines()
        self.assertEqual([json.loads(line)["id"] for line in results], ["area"])

    def test_what_never_ends_is_killed(self):
        self.commit(ENDLESS)
        self.assertIn("endless: killed by size (computes for longer than 1 s)", self.mutate()[1])

    def test_what_waits_for_ever_is_killed(self):
        self.commit(ASLEEP)
        self.assertIn("asleep: killed by size (waits for longer than 3 s)", self.mutate()[1])

    def asked(self, *faults, unsteady=False, left_out=(), arguments=()):
        """The filters of a GoogleTest program, run by run, and what was printed."""
        folder = self.root / "build"
        values = {"PYTHON": sys.executable, "FOLDER": str(folder), "UNSTEADY": str(unsteady)}
        self.write("tests/size_gtest", functools.reduce(lambda text, name: text.replace(name, values[name]), values, GTEST))
        (self.root / "tests" / "size_gtest").chmod(0o755)
        self.table["programs"]["size"] = {"targets": ["size"], "gtest": "{tree}/tests/size_gtest", "left_out": list(left_out)}
        self.write("tests/mutation/project.json", json.dumps(self.table))
        self.commit(*faults)
        folder.mkdir()
        _, out, _ = self.mutate(*arguments)
        return (folder / "filters.txt").read_text().split(), out

    def test_the_tests_named_after_a_file_are_asked_first(self):
        filters, out = self.asked(KILLED, SURVIVES)
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertIn("perimeter: survived", out)
        self.assertEqual(filters, ["*", "Size.Area", "Size.Area", "Size.Area", "-Size.Area"])

    def test_a_program_that_is_the_same_is_run_once_without_a_fault(self):
        before = len(self.asked(SURVIVES)[0])
        log = self.root / "build" / "filters.txt"
        self.write("tests/note.txt", "Of another test.")  # What survived is asked again.
        self.commit(SURVIVES)
        _, out, _ = self.mutate()
        self.assertNotIn("without a fault", out)
        self.assertEqual(log.read_text().split()[before:], ["Size.Area", "-Size.Area"])
        self.write("tests/size_gtest", (self.root / "tests" / "size_gtest").read_text() + "# Another program.\n")
        self.commit(SURVIVES)
        self.assertIn("without a fault: size", self.mutate()[1])

    def test_a_test_that_passes_the_second_time_is_left_out(self):
        filters, out = self.asked(KILLED, unsteady=True)
        self.assertIn("unsteady, and left out: size.Shape.Corners", out)
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertEqual(filters, ["*", "Shape.Corners", "-Shape.Corners", "-Shape.Corners", "Size.Area"])

    def test_tests_that_keep_pace_with_a_clock_are_never_asked(self):
        filters, out = self.asked(KILLED, unsteady=True, left_out=["Shape.Corners"])
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertEqual(filters, ["-Shape.Corners", "-Shape.Corners", "Size.Area-Shape.Corners"])

    def test_near_are_the_nearest_of_all_programs(self):
        sources = {"a/size_test.cpp", "b/size_of_shape_test.cpp", "c/shape_test.cpp"}
        self.assertEqual(nearest(sources, [], "src/size.cpp"), {"a/size_test.cpp"})
        self.assertEqual(nearest(sources, [], "src/other_size.cpp"), {"a/size_test.cpp"})
        self.assertEqual(nearest(sources, [], "src/other.cpp"), set())
        self.assertEqual(nearest(sources, ["*shape_test"], "src/size.cpp"), {"b/size_of_shape_test.cpp", "c/shape_test.cpp"})

    def test_near_ones_alone_leave_the_others_to_be_tried(self):
        filters, out = self.asked(KILLED, SURVIVES, arguments=["--near"])
        self.assertIn("without a fault: 1 of 2 tests of size", out)
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertIn("perimeter: not killed by the tests near it", out)
        self.assertRegex(out, r"toy +2 +1 +0 +100\.0 %")
        self.assertEqual(filters, ["*", "Size.Area", "Size.Area", "Size.Area", "Size.Area"])
        self.assertIn("2 faults, 1 of them known", self.mutate()[1])

    def test_all_tests_may_be_near(self):
        self.write("tests/shape_test.cpp", "")
        self.table["tests_first"] = {"src/size.cpp": ["size_test", "shape_test"]}
        filters, out = self.asked(KILLED, arguments=["--near"])
        self.assertIn("without a fault: 2 of 2 tests of size", out)
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertEqual(filters[1:3], ["Shape.Corners:Size.Area", "Size.Area:Shape.Corners"])

    def test_a_row_says_which_tests_are_asked_first(self):
        self.write("tests/shape_test.cpp", "")
        self.table["tests_first"] = {"src/size.cpp": ["shape_test"]}
        filters, out = self.asked(KILLED)
        self.assertIn("area: killed by size.Size.Area", out)
        self.assertEqual(filters, ["*", "Shape.Corners", "-Shape.Corners", "Size.Area"])  # What fails is asked again.

    def test_list_finds_breaches(self):
        self.commit(KILLED)
        self.assertEqual(self.mutate("--list"), (0, "", ""))
        breaches = {
            "twice": {**KILLED, "find": "width"},
            "none": {**KILLED, "find": "depth"},
            "itself": {**KILLED, "replace": KILLED["find"]},
            "elsewhere": {**KILLED, "file": "src/none.cpp"},
            "untested": {**KILLED, "file": "tests/size_test.cpp", "find": "== 6"},
            "incomplete": {"id": "x", "file": "src/size.cpp"},
        }
        said = {"twice": "occurs 4 times", "none": "occurs 0 times", "itself": "by itself", "elsewhere": "does not exist",
                "untested": "no row of tests_of", "incomplete": "expected an object"}
        for name, fault in breaches.items():
            self.commit(fault)
            code, _, err = self.mutate("--list")
            self.assertEqual(code, 1, name)
            self.assertIn(said[name], err)
        self.commit(KILLED, KILLED)
        self.assertIn("is the id of", self.mutate("--list")[2])
        self.table["tests_first"] = {"src/size.cpp": ["shape_test"]}
        self.write("tests/mutation/project.json", json.dumps(self.table))
        self.assertIn("no test shape_test goes first for src/size.cpp", self.mutate("--list")[2])
        self.assertFalse((self.root / "build").exists())


if __name__ == "__main__":
    if len(sys.argv) > 1:
        COMPILER = sys.argv.pop(1)
    if shutil.which("git") is None or shutil.which(COMPILER) is None:
        sys.exit(77)
    unittest.main(verbosity=2)
