# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Registration of scans with scans and models."""

from __future__ import annotations

import copy
import json
import os
from dataclasses import dataclass, field
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _html, _limen
from ._limen import Model, RegisterOptions, Scan
from ._numbers import Array, Path, Progress, as_pose
from ._scans import read_model, read_scan

_DEFAULTS = RegisterOptions()

#: What can be registered: a scan, a model, a file of either, or scans with their poses in one frame.
Side = Union[Scan, Model, Path, Sequence[tuple[Union[Scan, Path], npt.ArrayLike]]]


@dataclass(frozen=True, eq=False)
class Sigma:
    """One standard deviation of each degree of freedom, in the target frame, about `centre`."""

    rotation_rad: Array  #: about x, y, z
    translation_m: Array  #: along x, y, z, of the point `centre`
    centre: Array = field(repr=False)


@dataclass(frozen=True, eq=False)
class Unobserved:
    """A direction that the data does not fix."""

    name: str
    rotation: bool  #: a turn about `direction`, else a shift along it
    direction: Array = field(repr=False)


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A pose and how well it explains both sides."""

    target_from_source: Array = field(repr=False)  #: 4 x 4, world to world
    score: float  #: higher is better
    agreeing_m2: float
    contradicted_m2: float
    rms_m: float
    matched_planes: int
    matched_openings: int
    explained_share: Optional[float] = None  #: against a model: of the walls that the scan saw
    room: str = ""  #: of a model with named rooms: where the first station stands


@dataclass(frozen=True)
class PlaneMatch:
    """Planes that agree under the pose; indices count in either side's planes."""

    source: int
    target: int
    distance_m: float
    angle_rad: float
    overlap_m2: float


@dataclass(frozen=True)
class OpeningMatch:
    """Openings that agree under the pose."""

    source: int
    target: int
    shift_across_m: float
    shift_up_m: float


@dataclass(frozen=True)
class Thickness:
    """Of a wall that one scan saw from inside and the other from outside."""

    value_m: float
    sigma_m: float
    openings: int


@dataclass(frozen=True, eq=False, repr=False)
class Registration:
    """What a registration found, and how far it can be trusted."""

    outcome: str  #: registered, ambiguous, under_constrained or no_match
    reason: str
    best: Optional[Hypothesis]  #: None for no_match
    sigma: Sigma
    unobserved: list[Unobserved]
    alternatives: list[Hypothesis]
    matches: list[PlaneMatch]
    openings: list[OpeningMatch]
    thickness: list[Thickness]
    stages: list[tuple[str, float]]  #: name and seconds
    _report: Any = None
    _views: tuple[Array, Array] = (np.empty((0, 3)), np.empty((0, 3)))

    @property
    def registered(self) -> bool:
        """One pose explains both sides clearly better than every different one."""
        return self.outcome == "registered"

    @property
    def target_from_source(self) -> Optional[Array]:
        """The 4 x 4 matrix between world coordinates; None where nothing in common was found."""
        return None if self.best is None else self.best.target_from_source

    def apply(self, points: npt.ArrayLike) -> Array:
        """Move world coordinates of the source, (n, 3), into the target's frame."""
        if self.best is None:
            raise ValueError("nothing in common was found: there is no pose to apply")
        return _limen.transform_points(np.asarray(points, dtype=np.float64), self.best.target_from_source)

    def save(self, folder: Path, *, report: bool = True) -> None:
        """Write result.json, transform.txt (unless nothing was found) and the page report.html with its
        sections, as `limen register` does."""
        self._report.save(os.fspath(folder), report)

    def to_dict(self) -> dict[str, Any]:
        """All that result.json holds."""
        told: dict[str, Any] = json.loads(self._report.json())
        return told

    def __repr__(self) -> str:
        return f"<limen.Registration: {self.outcome}: {self.reason}>"

    def _repr_html_(self) -> str:
        rows: list[tuple[str, str]] = []
        if self.best is not None:
            pose = self.best.target_from_source
            rows.append(("translation", "{:.4f} {:.4f} {:.4f} m".format(*pose[:3, 3])))
            if not self.unobserved:
                turn_deg = np.degrees(self.sigma.rotation_rad.max())
                shift_mm = 1e3 * self.sigma.translation_m.max()
                rows.append(("sigma", f"{turn_deg:.5f} deg, {shift_mm:.2f} mm"))
            rows += [("not fixed", freedom.name) for freedom in self.unobserved]
            surface = f"{self.best.agreeing_m2:.1f} m2, {self.best.contradicted_m2:.2f} m2 against"
            rows.append(("agreeing surface", surface))
            matched = f"{self.best.matched_planes} planes, {self.best.matched_openings} openings"
            rows.append(("matched", matched))
            if self.best.room:
                rows.append(("room", self.best.room))
        rows += [("wall", f"{wall.value_m:.3f} m thick") for wall in self.thickness[:3]]
        rows.append(("other poses", str(len(self.alternatives))))
        source, target = self._views
        if self.best is not None and len(source):
            view = _html.top_view([_html.occupied_cells(self.apply(source)), _html.occupied_cells(target)])
        else:
            view = ""
        legend = "<p>source blue, target orange, from above</p>" if view else ""
        return (
            f"<div><b>{_html.escape(self.outcome)}</b>: {_html.escape(self.reason)}"
            f"{_html.table(rows)}{view}{legend}</div>"
        )


def _loaded(side: Side) -> Union[Model, list[tuple[Scan, Array]]]:
    """Files are read; a scan alone stands in the origin of its group."""
    if isinstance(side, Model):
        return side
    if isinstance(side, Scan):
        return [(side, np.eye(4))]
    if isinstance(side, (str, os.PathLike)):
        return read_model(side) if _limen.is_model_file(os.fspath(side)) else [(read_scan(side), np.eye(4))]
    placed = []
    for scan, pose in side:
        placed.append((scan if isinstance(scan, Scan) else read_scan(scan), as_pose(pose)))
    return placed


def _view(side: Union[Model, list[tuple[Scan, Array]]]) -> Array:
    """Some points of a side, for a small picture."""
    if isinstance(side, Model) or not side:
        return np.empty((0, 3))
    scan = side[0][0]
    step = max(1, len(scan) // 20_000)
    return np.asarray(scan.points[::step] + scan.local_origin)


def register(
    source: Side,
    target: Side,
    *,
    method: str = _DEFAULTS.method,
    gravity: str = _DEFAULTS.gravity,
    wall_thickness_m: float = _DEFAULTS.wall_thickness_m,
    seed: int = _DEFAULTS.seed,
    options: Optional[RegisterOptions] = None,
    progress: Optional[Progress] = None,
) -> Registration:
    """Find the pose of `source` in `target`, from any start, and say whether to trust it.

    Either side is a Scan, a Model, a file of either, or a list of (scan, pose) known to one another.
    method: auto, polygons, openings, hybrid or segments. gravity: auto, up or unknown.
    `options` has all that the keywords have and more; keywords that are not at their defaults count first.
    """
    asked = copy.copy(_DEFAULTS if options is None else options)
    for name, value in (
        ("method", method),
        ("gravity", gravity),
        ("wall_thickness_m", wall_thickness_m),
        ("seed", seed),
    ):
        if value != getattr(_DEFAULTS, name):
            setattr(asked, name, value)
    from_side, to_side = _loaded(source), _loaded(target)
    report = _limen.register(from_side, to_side, asked, progress)
    told = report.values()
    return Registration(
        outcome=told["outcome"],
        reason=told["reason"],
        best=None if told["best"] is None else Hypothesis(**told["best"]),
        sigma=Sigma(*told["sigma"]),
        unobserved=[Unobserved(*it) for it in told["unobserved"]],
        alternatives=[Hypothesis(**it) for it in told["alternatives"]],
        matches=[PlaneMatch(*it) for it in told["matches"]],
        openings=[OpeningMatch(*it) for it in told["openings"]],
        thickness=[Thickness(*it) for it in told["thickness"]],
        stages=told["stages"],
        _report=report,
        _views=(_view(from_side), _view(to_side)),
    )
