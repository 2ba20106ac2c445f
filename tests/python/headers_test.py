# SPDX-License-Identifier: MIT
"""The module says what the headers say: names, defaults, text; and the stubs say what the module says."""
import ast
import inspect
import os
import pathlib
import re
import sys
import unittest

import numpy as np
import papilla
from papilla import _papilla

ROOT = pathlib.Path(os.environ["PAPILLA_ROOT"])
sys.path.insert(0, str(ROOT / "python" / "make"))
import bindings  # noqa: E402
import headers  # noqa: E402

SOURCE = bindings.Source(ROOT)


def header_value(text):
    """A default of a header as Python has it; NotImplemented for what is computed."""
    text = text.replace("'", "")
    known = {"true": True, "false": False, "": NotImplemented, "std::numeric_limits<double>::infinity()": float("inf")}
    if text in known:
        return known[text]
    if match := re.fullmatch(r"(\w+)::(\w+)", text):
        enum = SOURCE.enums.get(match.group(1))
        return match.group(2) if enum and match.group(2) in [v[0] for v in enum.values] else NotImplemented
    try:
        return ast.literal_eval(text.replace("{", "(").replace("}", ",)").replace("(,)", "()"))
    except (SyntaxError, ValueError):
        return NotImplemented


def same(value, expected):
    if expected == ():
        return value is None or not np.any(value) if isinstance(value, (np.ndarray, type(None))) else len(value) == 0
    if isinstance(value, np.ndarray):
        return np.array_equal(value.ravel(), np.asarray(expected, float).ravel())
    if isinstance(expected, tuple):
        return list(value) == list(expected)
    return value == expected and isinstance(value, bool) == isinstance(expected, bool)


class HeadersTest(unittest.TestCase):
    def test_defaults_are_those_of_the_headers(self):
        compared = 0
        for record in SOURCE.records.values():
            made = getattr(papilla, record.name)()
            for field, _ in SOURCE.kept(record):
                expected = header_value(field.default)
                if expected is NotImplemented or (expected == () and field.type in SOURCE.records):
                    continue
                with self.subTest(f"{record.name}.{field.name}"):
                    self.assertTrue(same(getattr(made, field.python_name), expected), f"{getattr(made, field.python_name)!r} {field.default}")
                    compared += 1
        self.assertGreater(compared, 700)

    def test_fields_that_are_left_out_are_of_c_plus_plus_alone(self):
        alone = r"ProgressCallback|[*&]|std::function|std::span|Source$|Histogram|ForceGuard::Fault|shared_ptr|" \
                r"::Level|SlopeLimitResult|Crease|HeightField|ChannelField|Assigned|MeshSheets"  # fmt: skip
        for line in bindings.left_out(SOURCE).splitlines():
            self.assertRegex(line, alone)

    def test_text_is_that_of_the_headers(self):
        compared = 0
        for name in _papilla._functions:
            function = SOURCE.functions.get(name)
            doc = inspect.getdoc(getattr(papilla, name))
            self.assertTrue(doc and len(doc) > 20, name)
            if function and doc.startswith(headers.python_text(function.doc)[:40]):
                self.assertEqual(doc, inspect.cleandoc(headers.python_text(function.doc)), name)
                compared += 1
        self.assertGreater(compared, 90)
        for record in SOURCE.records.values():
            text = headers.python_text(record.doc)
            if text:
                self.assertEqual(inspect.getdoc(getattr(papilla, record.name)), inspect.cleandoc(text))
            for field, _ in SOURCE.kept(record):
                self.assertEqual(
                    getattr(papilla, record.name).__dict__[field.python_name].__doc__ or "", headers.python_text(field.doc)
                )

    def test_signatures_can_be_inspected(self):
        for name, (parameters, options, has_progress, _, _) in _papilla._functions.items():
            signature = inspect.signature(getattr(papilla, name))
            names = [p[0] for p in parameters]
            if options:
                names += ["options"] + [f[0] for f in _papilla._records[options] if f[0] not in names]
            if has_progress:
                names.append("progress")
            self.assertEqual(list(signature.parameters), names, name)
        repair = inspect.signature(papilla.repair).parameters
        self.assertEqual(repair["max_passes"].default, papilla.RepairOptions().max_passes)
        self.assertEqual(inspect.signature(papilla.simplify).parameters["tolerance_mm"].default, float("inf"))


class StubsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        stub = pathlib.Path(papilla.__file__).with_suffix(".pyi")
        cls.tree = ast.parse(stub.read_text(encoding="utf-8"))
        cls.classes = {node.name: node for node in cls.tree.body if isinstance(node, ast.ClassDef)}
        cls.functions = {node.name: node for node in cls.tree.body if isinstance(node, ast.FunctionDef)}

    def test_every_public_name_has_a_stub(self):
        assigned = {t.id for node in self.tree.body if isinstance(node, ast.Assign) for t in node.targets}
        for name, value in vars(papilla).items():
            if name.startswith("_") or inspect.ismodule(value) or name == "choices":
                continue
            self.assertIn(name, self.classes if inspect.isclass(value) else self.functions)
        self.assertEqual(assigned, set(papilla.choices))

    def test_functions_agree(self):
        for name in _papilla._functions:
            stub = self.functions[name].args
            names = [a.arg for a in stub.args + stub.kwonlyargs]
            self.assertEqual(names, list(inspect.signature(getattr(papilla, name)).parameters), name)
            self.assertEqual(ast.get_docstring(self.functions[name]), inspect.getdoc(getattr(papilla, name)), name)

    def test_structs_agree(self):
        for name, fields in _papilla._records.items():
            stub = self.classes[name]
            own = [f[0] for f in fields if not f[3]]
            self.assertEqual([n.target.id for n in stub.body if isinstance(n, ast.AnnAssign)], own, name)
            init = next(n for n in stub.body if isinstance(n, ast.FunctionDef))
            self.assertEqual([a.arg for a in init.args.kwonlyargs], [f[0] for f in fields], name)

    def test_annotations_name_what_there_is(self):
        known = set(self.classes) | set(papilla.choices) | {"np", "os", "pathlib", "NDArray", "ArrayLike", "Any", "Literal", "Optional",
            "Union", "Callable", "Mapping", "Sequence", "frozenset", "str", "int", "float", "bool", "list", "dict", "tuple", "set", "object",
            "bytes", "Exception", "TypeError", "ValueError", "OSError", "ArithmeticError"}  # fmt: skip
        used = {node.id for node in ast.walk(self.tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
        self.assertEqual(used - known, set())


if __name__ == "__main__":
    unittest.main()
