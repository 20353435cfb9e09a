# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Scans of made-up buildings, with the exact truth."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from . import _limen
from ._limen import Scan
from ._numbers import Array, ProgressOption, as_count, as_progress


@dataclass(frozen=True, eq=False, repr=False)
class Simulation:
    """Scans as a scanner would give them, and the truth."""

    scans: list[Scan]
    truth: dict[str, Any] = field(repr=False)  #: all that truth.json holds
    world_from_scan: list[Array] = field(repr=False)

    def target_from_source(self, source: int, target: int) -> Array:
        """The true pose between two scans, 4 x 4."""
        return np.linalg.inv(self.world_from_scan[target]) @ self.world_from_scan[source]

    def __repr__(self) -> str:
        return f"<limen.Simulation: {', '.join(scan.name for scan in self.scans)}>"


def scene_names() -> list[str]:
    """The built-in scenes."""
    return list(_limen.scene_names())


def simulate(
    name: str,
    *,
    seed: Optional[int] = None,
    stations: Optional[int] = None,
    points_indoor: Optional[int] = None,
    points_outdoor: Optional[int] = None,
    facades: Optional[int] = None,
    any_rotation: Optional[bool] = None,
    as_built: bool = True,
    curtain_share: Optional[float] = None,
    noise_m: Optional[float] = None,
    drift_m: Optional[float] = None,
    progress: ProgressOption = None,
) -> Simulation:
    """Scan a built-in building, one of scene_names(). What is not given is as the scene has it.

    `as_built`: walls, slabs and openings are off by millimetres to a centimetre; else all is exactly as drawn, and
    look-alike rooms are equal to the millimetre."""
    counts = {
        "seed": seed,
        "stations": stations,
        "points_indoor": points_indoor,
        "points_outdoor": points_outdoor,
        "facades": facades,
    }
    given = {
        **{name: as_count(name, value) for name, value in counts.items() if value is not None},
        "any_rotation": any_rotation,
        "as_built": as_built,
        "curtain_share": curtain_share,
        "noise_m": noise_m,
        "drift_m": drift_m,
    }
    scans, poses, truth = _limen.simulate(name, given, as_progress(progress))
    return Simulation(scans=scans, truth=json.loads(truth), world_from_scan=poses)
