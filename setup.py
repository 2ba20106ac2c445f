# SPDX-License-Identifier: MIT
"""Builds the wheel: CMake makes the module and its plug-ins, setuptools packs them.

PAPILLA_BUILD names a folder that CMake has built in; without it a fresh one is configured and built.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def version():
    return re.search(r"project\(papilla VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


class CMakeBuild(build_ext):
    """The whole package papilla: the extension, its stubs, the plug-ins beside it, the material library."""

    def build_extension(self, ext):
        build = pathlib.Path(os.environ.get("PAPILLA_BUILD") or pathlib.Path(self.build_temp).resolve() / "cmake")
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            f"-DPython_EXECUTABLE={sys.executable}", "-DPAPILLA_BUILD_TESTS=OFF",
                            "-DPAPILLA_BUILD_BENCHMARKS=OFF"], check=True)  # fmt: skip
        subprocess.run(["cmake", "--build", str(build), "--target", "papilla_python_package"], check=True)
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        package.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cmake", "--install", str(build), "--component", "python_wheel", "--prefix", str(package), "--strip"],
                       check=True)  # fmt: skip
        for name in ("LICENSE", "LICENSES"):
            source, target = ROOT / name, package / name
            shutil.copytree(source, target, dirs_exist_ok=True) if source.is_dir() else shutil.copy(source, target)


setup(
    version=version(),
    packages=["papilla"],
    package_dir={"papilla": "python/papilla"},
    package_data={"papilla": ["py.typed"]},
    ext_modules=[Extension("papilla._papilla", [])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
