# SPDX-License-Identifier: MIT
"""The wheel, installed alone, reads CAD files and pictures and finds its materials."""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import papilla

ROOT = pathlib.Path(os.environ["PAPILLA_ROOT"])
USE = """
import sys
import papilla
assert papilla.__file__.startswith(sys.argv[1]), papilla.__file__
scene = papilla.read_scene(sys.argv[2])  # A plug-in reads CAD, another one writes pictures.
print(papilla.part_statistics(scene)[0].triangles)
papilla.write_grey_image(sys.argv[1] + "/grain.png", papilla.synthesize_grain("sine", size_px=32).picture, 8)
print(len(papilla.MaterialLibrary().ids))
"""


@unittest.skipUnless(all(map(importlib.util.find_spec, ("pip", "setuptools", "wheel"))), "pip, setuptools or wheel is missing")
class WheelTest(unittest.TestCase):
    def test_an_installed_wheel_works_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            tree, target = pathlib.Path(folder) / "tree", pathlib.Path(folder) / "target"
            tree.mkdir()
            for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE", "CMakeLists.txt"):
                shutil.copy(ROOT / name, tree)
            shutil.copytree(ROOT / "LICENSES", tree / "LICENSES")
            shutil.copytree(ROOT / "python" / "papilla", tree / "python" / "papilla")
            pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--no-cache-dir"]
            self.run_quietly(*pip, "wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", folder, str(tree))
            wheels = list(pathlib.Path(folder).glob("papilla-*.whl"))
            self.assertEqual([wheel.name.split("-")[1] for wheel in wheels], [papilla.__version__])
            self.run_quietly(*pip, "install", "--no-deps", "--no-index", "--target", str(target), str(wheels[0]))
            names = {path.name for path in (target / "papilla").iterdir()}
            self.assertTrue({"__init__.pyi", "py.typed", "papilla_cad.so", "papilla_pictures.so", "materials", "LICENSE"} <= names)
            environment = {k: v for k, v in os.environ.items() if not k.startswith("PAPILLA_")} | {"PYTHONPATH": str(target)}
            step = ROOT / "data" / "exchange" / "handle.step"
            done = subprocess.run([sys.executable, "-c", USE, str(target), str(step)], env=environment, cwd=folder,
                                  capture_output=True, text=True)  # fmt: skip
            self.assertEqual(done.returncode, 0, done.stderr)
            triangles, materials = map(int, done.stdout.split())
            self.assertGreater(triangles, 100)
            self.assertGreater(materials, 10)

    def run_quietly(self, *command):
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
