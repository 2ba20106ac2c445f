# SPDX-License-Identifier: MIT
"""Every block of Python in the pages runs, those of a page one after the other in a folder of their own."""
import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["PAPILLA_ROOT"])
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)


def pages():
    return sorted(p for p in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")] if BLOCK.search(p.read_text(encoding="utf-8")))


def run_page(path, folder):
    text = path.read_text(encoding="utf-8")
    names = {"__name__": "__page__"}
    before = os.getcwd()
    os.chdir(folder)
    try:
        for block in BLOCK.finditer(text):
            line = text[: block.start()].count("\n") + 1
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile("\n" * line + block.group(1), str(path), "exec"), names)
    finally:
        os.chdir(before)


class PagesTest(unittest.TestCase):
    def test_every_block_runs(self):
        found = pages()
        self.assertIn(ROOT / "README.md", found)
        self.assertIn(ROOT / "docs" / "python.md", found)
        for path in found:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "data").symlink_to(ROOT / "data")
                (pathlib.Path(folder) / "examples").symlink_to(ROOT / "examples")
                run_page(path, folder)

    def test_the_first_example_has_ten_lines(self):
        block = BLOCK.search((ROOT / "README.md").read_text(encoding="utf-8")).group(1)
        self.assertLessEqual(len([line for line in block.splitlines() if line.strip()]), 10)


if __name__ == "__main__":
    unittest.main()
