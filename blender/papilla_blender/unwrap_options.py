# SPDX-License-Identifier: GPL-3.0-or-later
"""What a method of unwrapping can be told: read from the JSON Schema of MATERIALS.json, whose names, limits and defaults
are those of `papilla unwrap`.
"""
import dataclasses
import json
import re

from .schemas import schema

ENVIRONMENT = "environment"  # moves with the eye: no material's method, so that the schema does not have its options


@dataclasses.dataclass(frozen=True)
class Option:
    name: str
    kind: str  # "number", "whole", "flag", "choice" or "text"
    description: str
    default: object = None
    low: float = None
    high: float = None
    choices: tuple = ()


def _methods_named(description, methods, before):
    """The methods that a description says an option is of; all where it says nothing."""
    if description.startswith("Of the same"):
        return before
    words = set(re.findall(r"[a-z][a-z-]*", description)) & set(methods)
    if description.startswith("Of "):
        return words
    if description.startswith("Not of "):
        return set(methods) - words
    return set(methods)


def _option(name, told, method):
    description = told.get("description", "")
    choices = tuple(told.get("enum", ()))
    of_method = re.search(rf"[Oo]f {method}: ([^;.]*)", description)
    if choices and of_method:
        choices = tuple(c for c in re.split(r",\s*", of_method[1]) if c in choices)
    kind = "choice" if choices else {"number": "number", "integer": "whole", "boolean": "flag"}.get(told.get("type"), "text")
    default = told.get("default", choices[0] if choices else None)
    if default not in choices and choices:
        default = choices[0]
    return Option(name, kind, description or name, default, told.get("minimum"), told.get("maximum"), choices)


def options_of(method, methods, environment_maps):
    """The options of a method. `methods`: all names; `environment_maps`: choices of the method environment."""
    if method == ENVIRONMENT:
        return [Option("eye", "text", "[x, y, z] in mm, from where it is looked at; not given: in front of each part"),
                Option("environment_map", "choice", "What mirrors the surroundings", environment_maps[0],
                       choices=tuple(environment_maps))]
    options, before = [], set()
    for name, told in schema("materials")["$defs"]["unwrap"]["properties"].items():
        if name in ("method", "grain_of"):
            continue
        before = _methods_named(told.get("description", ""), methods, before)
        if method in before:
            options.append(_option(name, told, method))
    return options


def from_text(text):
    """What a field of text stands for: JSON where it looks like it, else the word. @throws ValueError."""
    text = text.strip()
    return json.loads(text) if text[:1] in "[{" and text else text


def command_line(options):
    """The options, under their names in MATERIALS.json, as words for `papilla unwrap`."""
    words = []
    for name, value in options.items():
        flag = "--" + {"pins": "pin", "iso_lines": "iso_line"}.get(name, name).replace("_", "-")
        if isinstance(value, bool):
            words += [flag] if value else []
        elif name == "pins":
            for pin in value:
                words += [f"{flag}={_numbers(pin['at'])}={_numbers(pin['uv'])}{_at_part(pin)}"]
        elif name == "iso_lines":
            for line in value:
                held = f"={line['value']!r}" if "value" in line else ""
                words += [f"{flag}={line['of']}{held}:{';'.join(map(_numbers, line['through']))}{_at_part(line)}"]
        elif isinstance(value, dict):
            words += [f"{flag}=edge:{_numbers(value['edge'])}"]
        elif isinstance(value, (list, tuple)):
            words += [f"{flag}={_numbers(value)}"]
        else:
            words += [f"{flag}={value!r}" if isinstance(value, float) else f"{flag}={value}"]
    return words


def _numbers(values):
    return ",".join(repr(float(v)) for v in values)


def _at_part(held):
    return f"@{held['part']}" if held.get("part") else ""
