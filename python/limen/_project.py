# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Projects: all scans of a building in one frame."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any, Optional, Sequence

import numpy as np

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
    document = json.loads((place / "project.json" if place.is_dir() else place).read_text(encoding="utf-8"))
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
    scans: Sequence[Path],
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
    of known points, of where the scans see them, and of points to compare with. arguments: further ones of the command line. Raises RuntimeError with the program's own words where it refuses.
    """
    words = [sys.executable, "-m", "limen", "project", *(os.fspath(scan) for scan in scans)]
    words += ["-o", os.fspath(output), "--quiet", *arguments]
    for name, file in (("model", model), ("control", control), ("targets", targets), ("check", check)):
        if file is not None:
            words += [f"--{name}", os.fspath(file)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3, 4):
        raise RuntimeError(done.stderr.strip() or f"limen project ended with status {done.returncode}")
    return read_project(output)
