# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""What pip calls to build limen (PEP 517, PEP 660): CMake compiles, this makes the wheel. Needs nothing but
Python, so that `pip install .` works without a network.

Config settings (`pip install . --config-settings=cmake=-DLIMEN_BUILD_IFC=OFF`) go to CMake.
LIMEN_PYTHON_BUILD_DIR names a build folder that is configured already, with LIMEN_BUILD_PYTHON, to use as it
is.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: Of every file in a wheel: the same sources give the same bytes.
TIME = (2026, 1, 1, 0, 0, 0)
#: Beside the module: what `limen` starts, and what reads IFC.
PROGRAMS = ("limen_ifc", "limen_program")


def _version() -> str:
    found = re.search(r"project\(limen VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    if not found:
        raise SystemExit("limen_build: CMakeLists.txt does not tell the version")
    return found.group(1)


def _platform() -> str:
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")


def _tag() -> str:
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{version}-{version}-{_platform()}"


def _metadata() -> str:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return (
        f"Metadata-Version: 2.1\nName: limen\nVersion: {_version()}\n"
        "Summary: Registration of indoor scans, outdoor scans and building models\n"
        "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
        f"Description-Content-Type: text/markdown\n\n{readme}"
    )


def _wheel_file(tag: str) -> str:
    return f"Wheel-Version: 1.0\nGenerator: limen_build\nRoot-Is-Purelib: false\nTag: {tag}\n"


def _entry_points() -> str:
    return "[console_scripts]\nlimen = limen.__main__:main\n"


def _settings(config_settings: dict | None) -> list[str]:
    given = (config_settings or {}).get("cmake", [])
    return [word for text in ([given] if isinstance(given, str) else given) for word in shlex.split(text)]


def _build(config_settings: dict | None) -> Path:
    """Compiles; returns the folder of the gathered package."""
    configured = os.environ.get("LIMEN_PYTHON_BUILD_DIR")
    build = Path(configured or ROOT / "build" / "python")
    if not configured:
        configure = ["cmake", "-S", str(ROOT), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release"]
        configure += ["-DLIMEN_BUILD_PYTHON=ON", "-DLIMEN_BUILD_TESTS=OFF"]
        configure += [f"-DPython3_EXECUTABLE={sys.executable}"]
        if not (build / "CMakeCache.txt").exists():
            configure += ["-G", "Ninja"]
        subprocess.run(configure + _settings(config_settings), check=True)
    jobs = str(os.cpu_count() or 1)
    subprocess.run(
        ["cmake", "--build", str(build), "--target", "limen_python_package", "--parallel", jobs], check=True
    )
    return build / "python" / "limen"


def _package_files(package: Path, module: str) -> list[Path]:
    """The Python files, the module, the program, and the one that reads IFC."""
    names = {module, *PROGRAMS, "py.typed"}
    files = sorted(package.iterdir())
    wanted = [path for path in files if path.name in names or path.suffix in (".py", ".pyi")]
    if module not in (path.name for path in wanted):
        raise SystemExit(f"limen_build: {package} has no {module}")
    return wanted


class _Wheel:
    """A wheel that is being written; record() comes last."""

    def __init__(self, folder: Path, tag: str) -> None:
        self.name = f"limen-{_version()}-{tag}.whl"
        self._tag = tag
        self._zip = zipfile.ZipFile(folder / self.name, "w", zipfile.ZIP_DEFLATED)
        self._record: list[str] = []

    def add(self, name: str, content: bytes, executable: bool = False) -> None:
        info = zipfile.ZipInfo(name, TIME)
        info.compress_type = zipfile.ZIP_DEFLATED
        info.external_attr = (0o100755 if executable else 0o100644) << 16
        self._zip.writestr(info, content)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self._record.append(f"{name},sha256={digest},{len(content)}")

    def close(self) -> str:
        info = _info()
        self.add(f"{info}/METADATA", _metadata().encode())
        self.add(f"{info}/WHEEL", _wheel_file(self._tag).encode())
        self.add(f"{info}/entry_points.txt", _entry_points().encode())
        self.add(f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes())
        name = f"{info}/RECORD"
        content = "\n".join(self._record + [f"{name},,"]) + "\n"
        self._zip.writestr(zipfile.ZipInfo(name, TIME), content)
        self._zip.close()
        return self.name


def _info() -> str:
    return f"limen-{_version()}.dist-info"


def get_requires_for_build_wheel(config_settings=None):
    return []


get_requires_for_build_editable = get_requires_for_build_wheel
get_requires_for_build_sdist = get_requires_for_build_wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = Path(metadata_directory) / _info()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "METADATA").write_text(_metadata(), encoding="utf-8")
    (folder / "WHEEL").write_text(_wheel_file(_tag()), encoding="utf-8")
    (folder / "entry_points.txt").write_text(_entry_points(), encoding="utf-8")
    return _info()


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def pack(folder: Path, package: Path, module: str, tag: str, licences: Path | None = None) -> str:
    """Writes the wheel of a gathered package with one of its modules; returns its name."""
    wheel = _Wheel(folder, tag)
    for path in _package_files(package, module):
        wheel.add(f"limen/{path.name}", path.read_bytes(), executable=path.name in PROGRAMS)
    wheel.add("limen/share/limen/limen_dask.py", (ROOT / "src/dask/limen_dask.py").read_bytes())
    for path in sorted(licences.iterdir()) if licences else []:
        wheel.add(f"{_info()}/licenses/{path.name}", path.read_bytes())
    return wheel.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    module = "_limen" + sysconfig.get_config_var("EXT_SUFFIX")
    return pack(Path(wheel_directory), _build(config_settings), module, _tag())


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """A wheel that points to the build folder: Python files are taken from there after each build."""
    package = _build(config_settings)
    wheel = _Wheel(Path(wheel_directory), _tag())
    wheel.add("limen.pth", f"{package.parent}\n".encode())
    return wheel.close()


def _source_files() -> list[Path]:
    """What git tracks; without git, everything but build folders."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        return [Path(os.fsdecode(name)) for name in listed.stdout.split(b"\0") if name]
    left_out = {".git", "__pycache__"}
    files = [path.relative_to(ROOT) for path in sorted(ROOT.rglob("*")) if path.is_file()]
    files = [path for path in files if not left_out & set(path.parts)]
    return [path for path in files if not path.parts[0].startswith("build")]


def build_sdist(sdist_directory, config_settings=None):
    name = f"limen-{_version()}"
    info = Path(sdist_directory) / "PKG-INFO"
    with tarfile.open(Path(sdist_directory) / f"{name}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for path in _source_files():
            if (ROOT / path).is_file():
                archive.add(ROOT / path, f"{name}/{path}")
        info.write_text(_metadata(), encoding="utf-8")
        archive.add(info, f"{name}/PKG-INFO")
    info.unlink()
    return f"{name}.tar.gz"
