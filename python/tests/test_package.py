# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""pip install without a network, what is in the wheel, and the examples of docs/python.md.

LIMEN_PYTHON_BUILD_DIR names the build whose module is packed, so that nothing is compiled again.
"""

import base64
import csv
import hashlib
import io
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))

import limen_build  # noqa: E402

BUILT = os.environ.get("LIMEN_PYTHON_BUILD_DIR")


@unittest.skipUnless(BUILT, "LIMEN_PYTHON_BUILD_DIR is not set")
class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name) / limen_build.build_wheel(cls.folder.name)
        cls.wheel = zipfile.ZipFile(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.wheel.close()
        cls.folder.cleanup()

    def test_its_name_tells_python_and_machine(self):
        version = f"cp{sys.version_info.major}{sys.version_info.minor}"
        platform = sysconfig.get_platform().replace("-", "_")
        self.assertRegex(self.path.name, rf"^limen-[0-9.]+-{version}-{version}-{re.escape(platform)}\.whl$")

    def test_record_has_every_file_with_its_hash(self):
        record = next(name for name in self.wheel.namelist() if name.endswith("/RECORD"))
        rows = list(csv.reader(io.StringIO(self.wheel.read(record).decode())))
        self.assertEqual(sorted(row[0] for row in rows), sorted(self.wheel.namelist()))
        for name, digest, size in rows:
            if name == record:
                continue
            content = self.wheel.read(name)
            expected = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            self.assertEqual((digest, size), (f"sha256={expected}", str(len(content))))

    def test_it_holds_module_types_and_programs(self):
        names = set(self.wheel.namelist())
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        for name in ("__init__.py", "py.typed", "_limen.pyi", f"_limen{suffix}", "limen_ifc", "limen_program"):
            self.assertIn(f"limen/{name}", names)
        for name in ("limen_ifc", "limen_program"):
            self.assertEqual(self.wheel.getinfo(f"limen/{name}").external_attr >> 16 & 0o111, 0o111)

    def test_the_same_build_gives_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            again = Path(folder) / limen_build.build_wheel(folder)
            self.assertEqual(again.read_bytes(), self.path.read_bytes())


@unittest.skipUnless(BUILT, "LIMEN_PYTHON_BUILD_DIR is not set")
class Installed(unittest.TestCase):
    """In an environment of its own, with nothing but the system's NumPy."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.python = Path(cls.folder.name) / "venv" / "bin" / "python"
        cls.environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        make = [sys.executable, "-m", "venv", "--system-site-packages", str(cls.python.parent.parent)]
        subprocess.run(make, check=True, env=cls.environment)
        install = [str(cls.python), "-m", "pip", "install", "--no-index", "--quiet", str(ROOT)]
        done = subprocess.run(install, capture_output=True, text=True, check=False, env=cls.environment)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_python(self, script):
        command = [str(self.python), "-c", script]
        return subprocess.run(
            command, capture_output=True, text=True, check=False, env=self.environment, cwd=self.folder.name
        )

    def test_it_runs(self):
        done = self.run_python("import limen; print(limen.__file__); print(limen.scene_names()[0])")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith(str(self.python.parent.parent)), done.stdout)

    def test_the_command_comes_with_it(self):
        for command in ([str(self.python.parent / "limen")], [str(self.python), "-m", "limen"]):
            done = subprocess.run(
                [*command, "--version"], capture_output=True, text=True, check=False, env=self.environment
            )
            self.assertEqual((done.returncode, done.stdout.split()[0]), (0, "limen"), done.stderr)

    def test_a_model_is_read_by_the_program_in_the_wheel(self):
        script = "import limen, os; print(os.path.join(os.path.dirname(limen.__file__), 'limen_ifc'))"
        here = self.run_python(script)
        self.assertTrue(os.access(here.stdout.strip(), os.X_OK), here.stdout)

    def test_the_examples_of_the_manual_run(self):
        text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
        examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(examples), 2)
        done = self.run_python("\n".join(examples))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("registered", done.stdout)


class Source(unittest.TestCase):
    def test_the_archive_holds_what_a_build_needs(self):
        with tempfile.TemporaryDirectory() as folder:
            name = limen_build.build_sdist(folder)
            with tarfile.open(Path(folder) / name) as archive:
                names = set(archive.getnames())
            top = name[: -len(".tar.gz")]
            wanted = ("pyproject.toml", "python/limen_build.py", "CMakeLists.txt", "src/limen_main.cpp", "PKG-INFO")
            for path in wanted:
                self.assertIn(f"{top}/{path}", names)
            self.assertFalse([it for it in names if "/build" in it and it.startswith(f"{top}/build")])

    def test_the_metadata_is_told_before_the_build(self):
        with tempfile.TemporaryDirectory() as folder:
            info = limen_build.prepare_metadata_for_build_wheel(folder)
            text = (Path(folder) / info / "METADATA").read_text(encoding="utf-8")
            self.assertIn("Name: limen\n", text)
            self.assertIn("Requires-Dist: numpy\n", text)


if __name__ == "__main__":
    unittest.main()
