# SPDX-License-Identifier: GPL-3.0-or-later
"""The program papilla, by files in a temporary folder."""
import csv
import functools
import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import tempfile
import threading

import numpy as np

from .. import unwrap_options
from .base import Baked, Cancelled, Distortion, Engine, EngineError, LibraryEntry, Unwrapped, summary_of
from .mesh_files import read_obj_uv, write_obj

_poll_seconds = 0.1


def find_program(path):
    """@return (path, reason): one of them empty."""
    found = shutil.which(os.path.expanduser(path) if path else "papilla")
    if found:
        return found, ""
    return "", f"there is no program {path!r}" if path else "there is no program 'papilla' on PATH"


class ProgramEngine(Engine):
    def __init__(self, path, material_library=""):
        self._path = path
        self._library = material_library
        self.label = f"program {self._run(['--version']).strip()} ({path})"

    def methods(self):
        return self._choices("method")

    def environment_maps(self):
        return self._choices("environment-map")

    def efforts(self):
        return self._choices("effort")

    def normalizations(self):
        return self._choices("normalize", "measure")

    def materials(self):
        return [_library_entry(told) for told in json.loads(self._run(["materials", "list", "--json", "-"]))["materials"]]

    def unwrap(self, meshes, settings, progress=None):
        with tempfile.TemporaryDirectory(prefix="papilla-") as name:
            folder = pathlib.Path(name)
            write_obj(folder / "in.obj", meshes)
            words = ["unwrap", folder / "in.obj", "-o", folder / "out.obj", "--unit", "mm", "--up", "z", "--keep-sides",
                     "--method", settings.method, "--effort", settings.effort, "--json", folder / "out.json"]
            if settings.gutter_mm is not None:
                words += ["--gutter", repr(settings.gutter_mm)]
            self._run(words + unwrap_options.command_line(settings.options), progress)
            told = json.loads((folder / "out.json").read_text(encoding="utf-8"))
            uv = read_obj_uv(folder / "out.obj", [len(mesh.triangles) for mesh in meshes])
        parts = told["parts"]
        return Unwrapped(uv, [part["failure"] or "" for part in parts], told["charts"], [part["method"] for part in parts],
                         summary_of(told["distortion"]))

    def measure(self, meshes, normalize, progress=None):
        with tempfile.TemporaryDirectory(prefix="papilla-") as name:
            folder = pathlib.Path(name)
            write_obj(folder / "in.obj", meshes)
            self._run(["measure", folder / "in.obj", "--unit", "mm", "--up", "z", "--normalize", normalize,
                       "--csv", folder / "out.csv", "--json", folder / "out.json"], progress)
            told = json.loads((folder / "out.json").read_text(encoding="utf-8"))
            with open(folder / "out.csv", encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
        column = {key: np.array([row[key] for row in rows], float) for key in
                  ("area_mm2", "symmetric_dirichlet", "stretch_l2", "flipped", "degenerate_3d", "degenerate_uv")}
        return Distortion(column["area_mm2"], column["symmetric_dirichlet"], column["stretch_l2"], column["flipped"] > 0,
                          (column["degenerate_3d"] == 0) & (column["degenerate_uv"] == 0), summary_of(told))

    def bake(self, scene, rules, output, progress=None):
        told = json.loads(self._run(["bake", scene, "-m", rules, "-o", output, "--json", "-"], progress))
        problems = [rule["problem"] for rule in told["rules"] if rule["problem"]]
        return Baked(len(told["parts"]), told["losses"] + problems + told["warnings"])

    @functools.lru_cache(maxsize=None)
    def _help(self, verb):
        return self._run([verb, "--help"])

    def _choices(self, option, verb="unwrap"):
        found = re.search(rf"--{option} \w+:{{([^}}]*)}}", self._help(verb))
        if not found:
            raise EngineError(f"{self._path}: papilla {verb} has no option --{option}")
        return found[1].split(",")

    def _run(self, words, progress=None):
        """Runs the program. @return what it writes to stdout."""
        command = [self._path, *map(str, words)] + (["--progress", "json"] if progress else [])
        environment = dict(os.environ)
        if self._library:
            environment["PAPILLA_MATERIAL_LIBRARY"] = self._library
        try:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       encoding="utf-8", errors="replace", env=environment)
        except OSError as error:
            raise EngineError(f"{self._path}: {error.strerror}") from error
        with process:
            said, text = _follow(process, progress)
        if process.returncode != 0:
            raise EngineError(_error_of(said) or f"{self._path} ended with {process.returncode}")
        return text


def _follow(process, progress):
    """Reads both streams until the program ends. @return (lines on stderr, stdout)."""
    lines, output, said = queue.Queue(), [], []

    def read_errors():
        for line in process.stderr:
            lines.put(line)
        lines.put(None)

    readers = [threading.Thread(target=lambda: output.append(process.stdout.read())), threading.Thread(target=read_errors)]
    for reader in readers:
        reader.start()
    stage, fraction, line = "", 0.0, ""
    while line is not None:
        try:
            line = lines.get(timeout=_poll_seconds)
        except queue.Empty:
            line = ""
        if line and line.startswith('{"stage"'):
            event = json.loads(line)
            stage, fraction = event["stage"], event["fraction"]
        elif line:
            said.append(line.rstrip())
        if progress and progress(stage, fraction) is False:
            _stop(process)
            for reader in readers:
                reader.join()
            raise Cancelled
    readers[0].join()
    return said, output[0]


def _stop(process):
    """As Ctrl-C, so that the program takes its unfinished files away."""
    if os.name == "posix":
        process.send_signal(signal.SIGINT)
    else:
        process.terminate()
    try:
        process.wait(5)
    except subprocess.TimeoutExpired:
        process.kill()


def _error_of(said):
    """The program's error, without its own name and that of the temporary file before it."""
    lines = [line for line in said if line and not line.startswith("Run with --help")]
    return re.sub(r"^(papilla: )?(error: )?(\S*/papilla-\w+/in\.obj: )?", "", lines[-1]) if lines else ""


def _library_entry(told):
    backing, relief, look = told["backing"], told["height"], told["appearance"]
    return LibraryEntry(
        told["name"], told["names"]["en"], tuple(told["uses"]["en"]), told["stiffness"], told["damping"],
        told["static_friction"], told["dynamic_friction"], told["stribeck_velocity"],
        (backing["stiffness"], backing["depth_mm"]) if backing else None,
        tuple(relief["size_mm"]) if relief else None, relief["depth_mm"] if relief else None,
        look["color"], look["roughness"], look["metallic"])
