# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""The stub of the compiled part and the annotations of the rest against what is there."""

import ast
import dataclasses
import importlib.util
import inspect
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import limen
from limen import _limen

PACKAGE = Path(limen.__file__).parent


def stub():
    return ast.parse((PACKAGE / "_limen.pyi").read_text()).body


class Stub(unittest.TestCase):
    def test_every_name_in_the_stub_is_there(self):
        for node in stub():
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                self.assertTrue(hasattr(_limen, node.name), node.name)

    def test_every_name_that_is_there_is_in_the_stub(self):
        stated = {node.name for node in stub() if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        there = {name for name in dir(_limen) if not name.startswith("_") and callable(getattr(_limen, name))}
        self.assertEqual(there - stated, set())

    def test_members_of_classes_agree(self):
        for node in stub():
            if not isinstance(node, ast.ClassDef) or node.name == "Error":
                continue
            stated = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
            stated |= {part.target.id for part in node.body if isinstance(part, ast.AnnAssign)}
            kind = getattr(_limen, node.name)
            for name in stated:
                self.assertTrue(hasattr(kind, name), f"{node.name}.{name}")
            there = {name for name in vars(kind) if not name.startswith("_")}
            self.assertEqual(there - stated, set(), node.name)

    def test_options_have_the_types_they_are_said_to_have(self):
        for node in stub():
            if not isinstance(node, ast.ClassDef) or not node.name.endswith("Options"):
                continue
            options = getattr(_limen, node.name)()
            fields = [part.target.id for part in node.body if isinstance(part, ast.AnnAssign)]
            self.assertEqual(list(options._fields), fields)
            for part in node.body:
                if isinstance(part, ast.AnnAssign) and isinstance(part.annotation, ast.Name):
                    value = getattr(options, part.target.id)
                    where = f"{node.name}.{part.target.id}"
                    self.assertEqual(type(value).__name__, part.annotation.id, where)

    def test_functions_take_what_the_stub_says(self):
        for node in stub():
            untyped = ("set_threads", "threads", "scene_names")
            if isinstance(node, ast.FunctionDef) and node.name not in untyped:
                first_line = getattr(_limen, node.name).__doc__.splitlines()[0]
                arguments = first_line[first_line.index("(") + 1 : first_line.rindex(")")]
                count = arguments.count(": ")
                self.assertEqual(count, len(node.args.args), f"{node.name}: {first_line}")


class Annotations(unittest.TestCase):
    def test_every_public_name_is_exported_once_and_documented(self):
        self.assertEqual(len(limen.__all__), len(set(limen.__all__)))
        for name in limen.__all__:
            value = getattr(limen, name)
            if callable(value) and not name.endswith("Options") and value.__module__.startswith("limen._"):
                if inspect.isfunction(value) or dataclasses.is_dataclass(value):
                    self.assertTrue(inspect.getdoc(value), name)

    def test_every_argument_of_a_public_function_has_a_type(self):
        for name in limen.__all__:
            value = getattr(limen, name)
            if inspect.isfunction(value):
                for parameter in inspect.signature(value).parameters.values():
                    self.assertIsNot(parameter.annotation, parameter.empty, f"{name}({parameter.name})")

    def test_defaults_are_those_of_cpp(self):
        defaults = limen.RegisterOptions()
        for parameter in inspect.signature(limen.register).parameters.values():
            if parameter.default not in (parameter.empty, None):
                self.assertEqual(parameter.default, getattr(defaults, parameter.name))
        self.assertEqual(inspect.signature(limen.read_scan).parameters["level"].default, _limen.LEVEL)

    @unittest.skipIf(importlib.util.find_spec("mypy") is None, "mypy is not installed")
    def test_mypy_agrees(self):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder) / "script.py"
            script.write_text(
                "import limen\nimport numpy as np\n\n"
                "def moved(path: str) -> float:\n"
                "    result = limen.register(limen.read_scan(path), path, method='polygons')\n"
                "    if result.target_from_source is None:\n        return 0.0\n"
                "    return float(result.apply(np.zeros((1, 3)))[0, 0])\n"
            )
            command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", folder, str(script)]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
