# SPDX-License-Identifier: MIT
"""The scripts of examples/python draw their pictures."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(os.environ["PAPILLA_ROOT"]) / "examples" / "python"


class ExamplesTest(unittest.TestCase):
    def test_every_script_draws(self):
        scripts = sorted(EXAMPLES.glob("*.py"))
        self.assertEqual(len(scripts), 4)
        for script in scripts:
            with self.subTest(script.name), tempfile.TemporaryDirectory() as folder:
                picture = os.path.join(folder, "picture.png")
                done = subprocess.run([sys.executable, str(script), picture, "--quick"], capture_output=True, text=True, cwd=folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertGreater(os.path.getsize(picture), 10_000)


if __name__ == "__main__":
    unittest.main()
