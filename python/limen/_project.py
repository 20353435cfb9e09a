# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Projects: all scans of a building in one frame."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _limen
from .__main__ import PROGRAM
from ._numbers import Array, Path


@dataclass(frozen=True, eq=False)
class ProjectScan:
    """One station or pass of a project."""

    file: str
    state: str  #: registered, probable, ambiguous, under_constrained or floating
    frame_from_scan: Optional[Array] = field(repr=False)  #: 4 x 4, world to world; None where it does not stand there
    reason: str = field(repr=False, default="")
    index: int = 0  #: within the file


@dataclass(frozen=True, eq=False)
class Project:
    """What `limen project` found; `document` is all of project.json."""

    outcome: str
    reason: str
    scans: list[ProjectScan]
    questions: list[str]
    document: dict[str, Any] = field(repr=False)

    def pose_of(self, file: Path, index: int = 0) -> Array:
        """The pose of a scan in the frame, by the name of its file. Raises KeyError where it has none."""
        name = FilePath(file).name
        for scan in self.scans:
            if FilePath(scan.file).name == name and scan.index == index and scan.frame_from_scan is not None:
                return scan.frame_from_scan
        raise KeyError(f"{name} has no pose in the project's frame")


def read_project(path: Path) -> Project:
    """Read a project.json, or that of a project's folder."""
    place = FilePath(path)
    place = place / "project.json" if place.is_dir() else place
    try:
        document = json.loads(place.read_text(encoding="utf-8"))
    except OSError as error:
        raise _limen.Error(f"{place}: {error.strerror} (give the folder of a project)") from error
    except ValueError:
        document = None
    if not isinstance(document, dict) or "scans" not in document:
        raise _limen.Error(f"{place}: is not the result of a project (give its folder, or its project.json)")
    scans = [
        ProjectScan(
            file=it["file"],
            state=it["state"],
            frame_from_scan=None if it["frame_from_scan"] is None else np.array(it["frame_from_scan"]),
            reason=it["reason"],
            index=it.get("index", 0),
        )
        for it in document["scans"]
    ]
    return Project(
        outcome=document["outcome"],
        reason=document["reason"],
        scans=scans,
        questions=[it["text"] for it in document["questions"]],
        document=document,
    )


def project(
    scans: Union[Path, Sequence[Path]],
    output: Path,
    *,
    model: Optional[Path] = None,
    control: Optional[Path] = None,
    targets: Optional[Path] = None,
    check: Optional[Path] = None,
    arguments: Sequence[str] = (),
) -> Project:
    """Put scans of a building into one frame, as `limen project` does, in a process of its own.

    output: the folder of the project; what lies there of an earlier run is used again. control, targets, check: files
    of known points, of where the scans see them, and of points to compare with. arguments: further ones of the command
    line. Raises limen.Error with the program's own words where it refuses.
    """
    if isinstance(scans, (str, os.PathLike)):
        scans = [scans]
    files = [os.fspath(scan) for scan in scans]
    # A name that begins with a dash is no option.
    files = [os.path.join(os.curdir, file) if file.startswith("-") else file for file in files]
    words = [os.fspath(PROGRAM), "project", *files]
    words += ["-o", os.fspath(output), "--quiet", *arguments]
    for name, file in (("model", model), ("control", control), ("targets", targets), ("check", check)):
        if file is not None:
            words += [f"--{name}", os.fspath(file)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3, 4):
        said = done.stderr.strip().split("limen: error: ")[-1]
        raise _limen.Error(said or f"limen project ended with status {done.returncode}")
    return read_project(output)
