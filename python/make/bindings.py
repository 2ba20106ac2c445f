# SPDX-License-Identifier: MIT
"""Writes the bindings of the public headers' plain structs and enumerations, and their text, as C++.

usage: bindings.py ROOT OUTPUT_FOLDER
"""
import pathlib
import re
import sys

import fields
import headers

FLOATS = {"double": "np.float64", "float": "np.float32"}
INTEGERS = {
    "int": "np.int32", "std::uint32_t": "np.int32", "std::int32_t": "np.int32", "unsigned": "np.int32",
    "Index": "np.int32", "std::size_t": "np.int64", "std::uint64_t": "np.int64", "std::int64_t": "np.int64",
    "std::uint8_t": "np.uint8", "unsigned char": "np.uint8", "std::byte": "np.uint8", "std::uint16_t": "np.uint16",
}  # fmt: skip
ROWS = {"Vec2": "np.float64", "Vec3": "np.float64", "Color": "np.float32"}
TEXT = {"std::string", "std::string_view", "const char*"}


class Types:
    """What C++ types are in Python."""

    def __init__(self, records, enums, aliases):
        self.records, self.enums, self.aliases = records, enums, aliases

    def resolved(self, name):
        name = name.removeprefix("const ").removesuffix(" const").strip()
        return self.resolved(self.aliases[name]) if name in self.aliases else name

    def scalar(self, name):
        """numpy's type of numbers, of which arrays are views; None for anything else."""
        name = self.resolved(name)
        if name in ROWS:
            return ROWS[name]
        array = re.fullmatch(r"std::array<(.*), (\w+)>", name) or re.fullmatch(r"(.*)\[(\w+)\]", name)
        if array and (inner := self.scalar(array.group(1))):
            return inner
        if name == "bool":
            return "np.bool_"
        return FLOATS.get(name) or INTEGERS.get(name)

    def is_structured(self, name):
        """Whether a vector of these structs is a structured array."""
        return name in fields.STRUCTURED

    def annotation(self, name):
        """The type in Python, or None when there is none."""
        name = self.resolved(name)
        if name == "bool":
            return "bool"
        if name in FLOATS:
            return "float"
        if name in INTEGERS and name != "std::byte":
            return "int"
        if name in TEXT:
            return "str"
        if name in ROWS:
            return f"NDArray[{ROWS[name]}]"
        if name == "std::filesystem::path":
            return "pathlib.Path | None"
        if name == "Deadline":
            return "float | None"
        if name in self.enums or name in self.records or name in fields.CLASSES:
            return name
        if corner := re.fullmatch(r"CornerAttribute<(Vec2|Vec3|Color)>", name):
            return "Corner" + corner.group(1)
        if sourced := re.fullmatch(r"Sourced<(double|std::string)>", name):
            return "SourcedNumber" if sourced.group(1) == "double" else "SourcedText"
        array = re.fullmatch(r"std::array<(.*), ([\w.:()]+)>", name) or re.fullmatch(r"(.*)\[(\w+)\]", name)
        if array:
            return self._many(array.group(1), "tuple[%s, ...]")
        name = re.sub(r"^Values<", "std::vector<", name)
        template = re.fullmatch(r"std::(optional|vector|set|pair|map|variant)<(.*)>", name)
        if not template:
            return None
        arguments = [self.annotation(part.strip()) for part in headers._split(template.group(2))]
        first = self.resolved(headers._split(template.group(2))[0].strip())
        if None in arguments and not (template.group(1) == "vector" and self.scalar(first)):
            return None
        match template.group(1):
            case "optional":
                return arguments[0] if arguments[0].endswith("| None") else arguments[0] + " | None"
            case "vector":
                return self._many(template.group(2), "tuple[%s, ...]")
            case "set":
                return f"frozenset[{arguments[0]}]" if first not in self.records else None
            case "pair":
                return f"tuple[{arguments[0]}, {arguments[1]}]"
            case "variant":
                return " | ".join(arguments)
            case "map":
                return f"Mapping[{arguments[0]}, {arguments[1]}]"
        return None

    def _many(self, element, form):
        if scalar := self.scalar(element):
            return f"NDArray[{scalar}]"
        if self.is_structured(self.resolved(element)):
            return "NDArray[np.void]"
        inner = self.annotation(element)
        if inner == "NDArray[np.void]":  # A vector of vectors comes as a copy.
            inner = f"tuple[{self.resolved(element)[12:-1]}, ...]"
        return form % inner if inner else None


def quoted(text):
    """A string of C++, in pieces that every compiler takes."""
    pieces = [text[i : i + 8000] for i in range(0, len(text), 8000)] or [""]
    return " ".join(f'R"doc({piece})doc"' for piece in pieces)


class Source:
    """All that the headers of the module declare."""

    def __init__(self, root):
        self.places = {}
        for path in sorted(root.glob("**/include/papilla/**/*.hpp")):
            if path.relative_to(root).parts[0] not in ("build", "tests", "python"):
                self.places[path.as_posix().split("/include/papilla/")[1].removesuffix(".hpp")] = path
        self.headers = {}
        for field in fields.FIELDS:
            for name in fields.header_files(field):
                self.headers[name] = headers.read_header(self.places[name], f"papilla/{name}.hpp")
        every = self.headers.values()
        aliases = {name: value for header in every for name, value in header.aliases.items()}
        self.enums = {enum.name: enum for header in every for enum in header.enums}
        hidden = set(fields.CLASSES) | set(fields.LEFT_OUT) | set(ROWS)
        self.records = {s.name: s for header in every for s in header.structs if s.name not in hidden and (s.fields or s.base)}
        self.functions = {}
        for path_name, path in self.places.items():
            for function in headers.read_header(path, path_name).functions:
                self.functions.setdefault(function.name, function)
        self.types = Types(self.records, self.enums, aliases)

    def kept(self, record):
        """Its fields that Python has: (field, annotation)."""
        pairs = [(field, self.types.annotation(field.type)) for field in record.fields]
        return [(field, annotation) for field, annotation in pairs if annotation]

    def inherited(self, record):
        base = self.records.get(record.base)
        return self.inherited(base) + self.kept(base) if base else []


def names_header(source):
    lines = ["// SPDX-License-Identifier: MIT", "#pragma once", "", '#include "names.hpp"', "", "namespace papilla {"]
    lines += [f"enum class {name};" for name in source.enums]
    lines += [f"struct {name};" for name in source.records]
    lines += ["}  // namespace papilla", "", "namespace papilla::python {"]
    for enum in source.enums.values():
        values = ", ".join(f'{{{number}, "{name}"}}' for name, number, _ in enum.values)
        lines += [
            "template <>",
            f"struct EnumNames<{enum.name}> {{",
            f'  static constexpr const char* k_type = "{enum.name}";',
            f"  static constexpr EnumName k_values[] = {{{values}}};",
            "};",
        ]
    for name in source.records:
        structured = "true" if source.types.is_structured(name) else "false"
        lines += ["template <>", f"struct RecordTraits<{name}> : IsRecord<{structured}> {{}};"]
    return "\n".join(lines + ["}  // namespace papilla::python", ""])


def docs_header(source):
    lines = ["// SPDX-License-Identifier: MIT", "#pragma once", "", "/// The text of the functions in the headers."]
    lines += ["namespace papilla::python::docs {"]
    for name, function in sorted(source.functions.items()):
        lines.append(f"inline constexpr char {name}[] = {quoted(headers.python_text(function.doc))};")
    return "\n".join(lines + ["}  // namespace papilla::python::docs", ""])


def records_source(source, field):
    names = fields.header_files(field)
    lines = ["// SPDX-License-Identifier: MIT"]
    lines += [f'#include "papilla/{name}.hpp"' for name in names]
    order = [s for name in names for s in source.headers[name].structs if s.name in source.records]
    # Every file that meets a class that is bound by hand has to see how.
    uses = {used for record in order for item in record.fields for used in re.findall(r"\w+", item.type)}
    lines += ["", '#include "pictures.hpp"' if uses & set(fields.CLASSES) else '#include "record.hpp"']
    lines += ['#include "sourced.hpp"'] if "SourcedNumber" in uses else []
    lines += ["", "namespace papilla::python {"]
    blocks = []
    for name in names:
        for enum in source.headers[name].enums:
            values = "\n".join(f"  {value}: {doc}" if doc else f"  {value}" for value, _, doc in enum.values)
            text = f"{headers.python_text(enum.doc)}\n\n{values}".strip()
            blocks.append(f"  add_choices<{enum.name}>(module, {quoted(text)});")
    for record in order:
        base = f", {record.base}" if record.base in source.records else ""
        blocks.append(f"  Record<{record.name}{base}>(module, \"{record.name}\", {quoted(headers.python_text(record.doc))})")
        for inherited, pairs in ((True, source.inherited(record)), (False, source.kept(record))):
            for item, annotation in pairs:
                call = "inherited" if inherited else "field"
                doc = headers.python_text(item.doc)
                blocks.append(
                    f'      .{call}<&{record.name}::{item.name}>("{item.python_name}", "{annotation}", {quoted(doc)})'
                )
        blocks[-1] += "\n      .done();"
    # Functions of moderate size: compilers take long for large ones.
    parts, current = [], []
    for block in blocks:
        current.append(block)
        if len(current) > 60 and block.endswith(";"):
            parts.append(current)
            current = []
    parts.append(current)
    for number, part in enumerate(parts):
        lines += [f"static void add_part_{number}(py::module_& module) {{", *part, "  static_cast<void>(module);", "}"]
    lines += [f"void add_{field}_records(py::module_& module) {{"]
    lines += [f"  add_part_{number}(module);" for number in range(len(parts))]
    return "\n".join(lines + ["}", "}  // namespace papilla::python", ""])


def left_out(source):
    """The fields that Python does not have, for people and a test."""
    lines = []
    for record in source.records.values():
        kept = {item.name for item, _ in source.kept(record)}
        lines += [f"{record.name}.{item.name}: {item.type}" for item in record.fields if item.name not in kept]
    return "\n".join(lines + [""])


def write(path, text):
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def main(root, output):
    source = Source(root)
    output.mkdir(parents=True, exist_ok=True)
    write(output / "record_names.hpp", names_header(source))
    write(output / "docs.hpp", docs_header(source))
    write(output / "left_out.txt", left_out(source))
    for field in fields.FIELDS:
        write(output / f"{field}_records.cpp", records_source(source, field))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
