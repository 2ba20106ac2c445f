# SPDX-License-Identifier: GPL-3.0-or-later
"""What computes: the Python module papilla, or the program papilla. One interface, equal results."""
from .base import Cancelled, Distortion, Engine, EngineError, Mesh, Unwrapped, UnwrapSettings
from .module import ModuleEngine, find_module
from .program import ProgramEngine, find_program

__all__ = ["Cancelled", "Distortion", "Engine", "EngineError", "Mesh", "Unwrapped", "UnwrapSettings", "find_engine"]

AUTOMATIC, MODULE, PROGRAM = "AUTOMATIC", "MODULE", "PROGRAM"


def find_engine(choice=AUTOMATIC, program="", module_folder="", material_library=""):
    """The engine that is chosen, or the first one that is there: module, then program.

    program: path of the program; empty: the one on PATH. module_folder: where the module lies; empty: Python's own places.
    material_library: folder of the materials; empty: the program's own.
    @throws EngineError naming what was looked for.
    """
    reasons = []
    if choice in (AUTOMATIC, MODULE):
        module, reason = find_module(module_folder)
        if module:
            return ModuleEngine(module, material_library)
        reasons.append(reason)
    if choice in (AUTOMATIC, PROGRAM):
        path, reason = find_program(program)
        if path:
            return ProgramEngine(path, material_library)
        reasons.append(reason)
    raise EngineError("; ".join(reasons) + " (see the add-on's preferences)")
