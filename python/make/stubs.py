# SPDX-License-Identifier: MIT
"""Writes papilla/__init__.pyi from the module as it is loaded: types, defaults and the headers' text.

usage: stubs.py PACKAGE_PARENT OUTPUT.pyi
"""
import importlib
import inspect
import pathlib
import re
import sys

HEAD = """# SPDX-License-Identifier: MIT
# Written by python/make/stubs.py from the module; do not edit.
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
choices: dict[str, tuple[str, ...]]
"Enumerations by name: what their values may be."
"""

PROGRESS = "Callable[[str, float], bool | None] | None"


def text_block(text, indent):
    """A docstring."""
    text = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    pad = " " * indent
    lines = text.split("\n")
    closing = '"""' if len(lines) == 1 and not text.endswith('"') else f'\n{pad}"""'
    return pad + '"""' + ("\n" + pad).join(lines) + closing


def settable(annotation):
    """The type that a keyword takes, which is wider than the one that an attribute has."""
    annotation = re.sub(r"NDArray\[[\w.]+\]", "ArrayLike", annotation)
    annotation = annotation.replace("pathlib.Path", "str | os.PathLike[str]")
    annotation = re.sub(r"tuple\[([A-Z]\w+), \.\.\.\]", r"Sequence[\1 | dict[str, Any]]", annotation)
    return re.sub(r"tuple\[(.*), \.\.\.\]", r"Sequence[\1]", annotation).replace("frozenset", "set")


def keywords(fields):
    return ", ".join(f"{name}: {settable(annotation)} = ..." for name, annotation, *_ in fields)


def record(name, cls, fields):
    base = next((b.__name__ for b in cls.__bases__ if b.__module__ == "papilla"), "")
    lines = [f"class {name}({base}):" if base else f"class {name}:"]
    if doc := inspect.cleandoc(cls.__doc__ or ""):
        lines.append(text_block(doc, 4))
    for field, annotation, doc, inherited in fields:
        if inherited:
            continue
        lines.append(f"    {field}: {annotation}")
        if doc:
            lines.append(text_block(doc, 4))
    lines.append(f"    def __init__(self, *, {keywords(fields)}) -> None: ...")
    return lines


def shown_types(text):
    """pybind11's types as they are called here."""
    text = text.replace("papilla.", "").replace("_papilla.", "").replace("numpy.ndarray", "NDArray[Any]")
    text = text.replace("List[", "list[").replace("Tuple[", "tuple[").replace("Dict[", "dict[")
    return re.sub(r"= <[^>]*>", "= ...", text.replace("::", "."))


def bound_class(name, cls):
    """One that is bound by hand: its members say their types themselves."""
    lines = [f"class {name}:"]
    if doc := inspect.cleandoc(cls.__doc__ or ""):
        lines.append(text_block(doc, 4))
    for member, value in vars(cls).items():
        if isinstance(value, property):
            match = re.match(r"\(.*?\) -> (.*)", value.fget.__doc__ or "")
            lines += [f"    {member}: {shown_types(match.group(1)) if match else 'Any'}"]
            if value.__doc__ and not value.__doc__.startswith("("):
                lines.append(text_block(value.__doc__.strip(), 4))
        elif callable(value) and (not member.startswith("_") or member == "__init__"):
            first, _, doc = (value.__doc__ or "").strip().partition("\n")
            match = re.match(r"\w+\((.*)\) -> (.*)", first)
            if not match:  # Nothing makes one but functions.
                continue
            arguments = re.sub(r"^self: [^,]*", "self", match.group(1))
            lines.append(f"    def {member}({shown_types(arguments)}) -> {shown_types(match.group(2))}:")
            lines.append(text_block(doc.strip(), 8) if doc.strip() else "        ...")
    return lines


def function(name, entry, records):
    parameters, options, has_progress, result, doc = entry
    names = {parameter[0] for parameter in parameters}
    parts = [f"{n}: {annotation}" + (f" = {default}" if default else "") for n, annotation, default in parameters]
    if options or has_progress:
        parts.append("*")
    if options:
        parts.append(f"options: {options} | dict[str, Any] | None = None")
        fields = [field for field in records[options] if field[0] not in names]
        parts.append(keywords(fields))
    if has_progress:
        parts.append(f"progress: {PROGRESS} = None")
    lines = [f"def {name}({', '.join(part for part in parts if part)}) -> {result}:"]
    return lines + [text_block(doc.strip(), 4)]


def write(parent, output):
    sys.path.insert(0, str(parent))
    module = importlib.import_module("papilla._papilla")
    lines = [HEAD]
    for name, values in module.choices.items():
        lines.append(f"{name} = Literal[{', '.join(repr(v) for v in values)}]")
        if doc := module._choice_docs[name]:
            lines.append(text_block(doc.strip(), 0))
    for name, value in vars(module).items():
        if name.startswith("_") or not inspect.isclass(value):
            continue
        lines.append("")
        if issubclass(value, Exception):
            bases = ", ".join(b.__name__ for b in value.__bases__)
            lines += [f"class {name}({bases}):", text_block(value.__doc__, 4), "    exit_code: int"]
        elif name in module._records:
            lines += record(name, value, module._records[name])
        else:
            lines += bound_class(name, value)
    for name, value in vars(module).items():
        if name in module._functions:
            lines += ["", *function(name, module._functions[name], module._records)]
        elif inspect.isbuiltin(value) and not name.startswith("_"):
            first, _, doc = value.__doc__.partition("\n")
            lines += ["", f"def {first}:", text_block(doc.strip(), 4)]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]))
