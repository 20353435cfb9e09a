# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Registration of scans with scans and models."""

from __future__ import annotations

import copy
import json
import os
from dataclasses import dataclass, field, replace
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _html, _limen
from ._limen import Model, RegisterOptions, Scan
from ._numbers import Array, ArrayLike, Path, ProgressOption, as_count, as_pose, as_progress
from ._scans import read_model, read_scan

_DEFAULTS = RegisterOptions()

#: What can be registered: a scan, a model, a file of either, an array of points (n, 3), or scans with their
#: poses in one frame.
Side = Union[Scan, Model, Path, Array, Sequence[tuple[Union[Scan, Path], ArrayLike]]]


@dataclass(frozen=True, eq=False)
class Sigma:
    """One standard deviation of each degree of freedom, in the target frame, about `centre`."""

    rotation_rad: Array  #: about x, y, z
    translation_m: Array  #: along x, y, z, of the point `centre`
    centre: Array = field(repr=False)
    covariance: Array = field(repr=False)  #: 6 x 6, of (rotation, translation of `centre`)


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
    probability: Optional[float] = None  #: that the scans were taken so; not of segments
    tie: bool = False  #: of an alternative: it cannot be distinguished from the best
    matched_segments: int = 0
    sigma: Optional[Sigma] = field(default=None, repr=False)  #: how well it is known, were it the right one

    def apply(self, points: ArrayLike) -> Array:
        """Move world coordinates of the source, (n, 3), into the target's frame by this pose."""
        return _limen.transform_points(np.asarray(points, dtype=np.float64), self.target_from_source)


def _hypothesis(values: dict[str, Any]) -> Hypothesis:
    return Hypothesis(**{**values, "sigma": Sigma(*values["sigma"])})


@dataclass(frozen=True)
class PlaneMatch:
    """Planes that agree under the pose; indices count in either side's planes."""

    source: int
    target: int
    distance_m: float
    angle_rad: float
    overlap_m2: float

    @property
    def source_plane(self) -> int:
        """`source`, by its name in result.json."""
        return self.source

    @property
    def target_plane(self) -> int:
        """`target`, by its name in result.json."""
        return self.target


@dataclass(frozen=True)
class OpeningMatch:
    """Openings that agree under the pose."""

    source: int
    target: int
    shift_across_m: float
    shift_up_m: float

    @property
    def source_opening(self) -> int:
        """`source`, by its name in result.json."""
        return self.source

    @property
    def target_opening(self) -> int:
        """`target`, by its name in result.json."""
        return self.target


@dataclass(frozen=True)
class Thickness:
    """Of a wall that one scan saw from inside and the other from outside."""

    value_m: float
    sigma_m: float
    openings: int

    @property
    def thickness_m(self) -> float:
        """`value_m`, by its name in result.json."""
        return self.value_m


class _Kept:
    """What is left of a report that went through a pickle: its numbers, not its page."""

    def __init__(self, text: str) -> None:
        self._text = text

    def json(self) -> str:
        """The text of result.json."""
        return self._text

    def save(self, folder: str, with_report: bool) -> None:
        """Write result.json and transform.txt."""
        if with_report:
            raise ValueError("the report page is not kept in a pickle: use save(folder, report=False)")
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "result.json"), "w", encoding="utf-8") as file:
            file.write(self._text)
        pose = json.loads(self._text)["target_from_source"]
        if pose is not None:
            rows = "".join(" ".join(f"{number:.17g}" for number in row) + "\n" for row in pose)
            with open(os.path.join(folder, "transform.txt"), "w", encoding="utf-8") as file:
                file.write(rows)


@dataclass(frozen=True, eq=False, repr=False)
class Registration:
    """What a registration found, and how far it can be trusted."""

    outcome: str  #: registered, probable, ambiguous, under_constrained or no_match
    reason: str
    best: Optional[Hypothesis]  #: None for no_match
    sigma: Sigma
    unobserved: list[Unobserved]
    alternatives: list[Hypothesis]
    matches: list[PlaneMatch]
    moved_planes: list[PlaneMatch]  # not built where a model has them, or beside their counterparts
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
    def placed(self) -> bool:
        """registered, or probable: the same, but right with a probability of 0.95 or more only."""
        return self.outcome in ("registered", "probable")

    @property
    def target_from_source(self) -> Optional[Array]:
        """The 4 x 4 matrix between world coordinates; None where nothing in common was found."""
        return None if self.best is None else self.best.target_from_source

    def apply(self, points: ArrayLike) -> Array:
        """Move world coordinates of the source, (n, 3), into the target's frame."""
        if self.best is None:
            raise ValueError("no reliable overlap was found: there is no pose to apply")
        return _limen.transform_points(np.asarray(points, dtype=np.float64), self.best.target_from_source)

    def save(self, folder: Path, *, report: bool = True) -> None:
        """Write result.json, transform.txt (unless nothing was found) and the page report.html with its
        sections, as `limen register` does."""
        self._report.save(os.fspath(folder), report)

    @property
    def probability(self) -> Optional[float]:
        """Of the best pose."""
        return None if self.best is None else self.best.probability

    @property
    def matched_openings(self) -> list[OpeningMatch]:
        """`openings`, by their name in result.json."""
        return self.openings

    @property
    def wall_thickness(self) -> list[Thickness]:
        """`thickness`, by its name in result.json."""
        return self.thickness

    @property
    def motion(self) -> Optional[dict[str, Any]]:
        """The pose as a reader sees it: shift_m of the source's middle (`about`), and the turn about it (`axis`,
        turn_rad); as in result.json."""
        values: Optional[dict[str, Any]] = self.to_dict()["motion"]
        return values

    @property
    def precision(self) -> Optional[dict[str, Any]]:
        """Within what radius the source's middle and its far end are known (95 %), as in result.json."""
        values: Optional[dict[str, Any]] = self.to_dict()["precision"]
        return values

    @property
    def next_steps(self) -> list[str]:
        """What to do next, sentences."""
        return list(self.to_dict()["next_steps"])

    def __copy__(self) -> Registration:
        return replace(self)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_report": _Kept(self._report.json())}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    def to_dict(self) -> dict[str, Any]:
        """All that result.json holds."""
        values: dict[str, Any] = json.loads(self._report.json())
        return values

    def __repr__(self) -> str:
        return f"<limen.Registration: {self.outcome}: {self.reason}>"

    def _repr_html_(self) -> str:
        rows: list[tuple[str, str]] = []
        if self.best is not None:
            values = self.to_dict()
            if self.best.probability is not None:
                rows.append(("probability", f"{100 * self.best.probability:.2f} %"))
            motion, precision = values["motion"], values["precision"]
            shift = "{:.4f} {:.4f} {:.4f} m".format(*motion["shift_m"])
            rows.append(("shift of the centre", shift))
            axis = "{:.2f} {:.2f} {:.2f}".format(*motion["axis"])
            rows.append(("turn about it", f"{np.degrees(motion['turn_rad']):.4f} deg about {axis}"))
            if precision is not None:
                middle, far = precision["middle"], precision["far_end"]
                rows.append(
                    (
                        "accuracy (95 %)",
                        f"{1e3 * middle['radius_m']:.1f} mm at the centre, {1e3 * far['radius_m']:.1f} mm "
                        f"at the far end {far['distance_m']:.0f} m away",
                    )
                )
            rows.append(("residuals", f"{1e3 * self.best.rms_m:.1f} mm (root mean square)"))
            rows += [("not fixed", freedom.name) for freedom in self.unobserved]
            surface = f"{self.best.agreeing_m2:.1f} m2, {self.best.contradicted_m2:.2f} m2 contradict"
            rows.append(("agreeing surface", surface))
            matched = f"{self.best.matched_planes} planes, {self.best.matched_openings} openings"
            rows.append(("matched", matched))
            if self.best.room:
                rows.append(("room", self.best.room))
        rows += [("wall", f"{wall.value_m:.3f} m thick") for wall in self.thickness[:3]]
        rows.append(("other poses", str(len(self.alternatives))))
        source, target = self._views
        if self.best is not None and len(source):
            cells = [_html.occupied_cells(self.apply(source)), _html.occupied_cells(target)]
            view = _html.top_view(cells, colours=_html.SIDES)
        else:
            view = ""
        legend = "<p>source orange, target blue, from above</p>" if view else ""
        return (
            f"<div><b>{_html.escape(self.outcome)}</b>: {_html.escape(self.reason)}"
            f"{_html.table(rows)}{view}{legend}</div>"
        )


def _loaded(side: Side, centre: Optional[ArrayLike]) -> Union[Model, list[tuple[Scan, Array]]]:
    """Files are read, arrays become scans; a scan alone stands in the origin of its group."""
    if isinstance(side, np.ndarray):
        return [(Scan(points=side, centres=centre), np.eye(4))]
    if isinstance(side, (str, os.PathLike)) and not _limen.is_model_file(os.fspath(side)):
        return [(read_scan(side, origin=centre), np.eye(4))]
    if centre is not None:
        raise ValueError("a centre is of an array or of the file of a scan: Scan(points=..., centres=...) has its own")
    if isinstance(side, Model):
        return side
    if isinstance(side, Scan):
        return [(side, np.eye(4))]
    if isinstance(side, (str, os.PathLike)):
        return read_model(side)
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
    nothing_repeats: bool = _DEFAULTS.nothing_repeats,
    seed: int = _DEFAULTS.seed,
    centre: Optional[ArrayLike] = None,
    source_centre: Optional[ArrayLike] = None,
    target_centre: Optional[ArrayLike] = None,
    options: Optional[RegisterOptions] = None,
    progress: ProgressOption = None,
) -> Registration:
    """Find the pose of `source` in `target`, from any start, and say whether to trust it.

    Either side is a Scan, a Model, a file of either, an array of points (n, 3) in metres, or a list of
    (scan, pose) known to one another. centre: from where arrays were seen, one place or one per point;
    source_centre and target_centre where the two differ, and of files, one place.
    method: auto, polygons, openings, hybrid or segments. gravity: auto, up or unknown. nothing_repeats: no
    room, flat or storey of the building was built like another, as you know it (docs/judge.md).
    `options` has all that the keywords have and more; keywords that are not at their defaults count first.
    """
    if options is not None and not isinstance(options, RegisterOptions):
        raise TypeError(f"options are {type(options).__name__}: give limen.RegisterOptions(...)")
    asked = copy.copy(_DEFAULTS if options is None else options)
    for name, value in (
        ("method", method),
        ("gravity", gravity),
        ("wall_thickness_m", wall_thickness_m),
        ("nothing_repeats", nothing_repeats),
        ("seed", as_count("seed", seed)),
    ):
        if value != getattr(_DEFAULTS, name):
            setattr(asked, name, value)
    arrays = [isinstance(side, np.ndarray) for side in (source, target)]
    if centre is not None and not any(arrays):
        raise ValueError("neither side is an array: give source_centre or target_centre for the file of a scan")
    from_side = _loaded(source, centre if source_centre is None and arrays[0] else source_centre)
    to_side = _loaded(target, centre if target_centre is None and arrays[1] else target_centre)
    report = _limen.register(from_side, to_side, asked, as_progress(progress))
    values = report.values()
    return Registration(
        outcome=values["outcome"],
        reason=values["reason"],
        best=None if values["best"] is None else _hypothesis(values["best"]),
        sigma=Sigma(*values["sigma"]),
        unobserved=[Unobserved(*it) for it in values["unobserved"]],
        alternatives=[_hypothesis(it) for it in values["alternatives"]],
        matches=[PlaneMatch(*it) for it in values["matches"]],
        moved_planes=[PlaneMatch(*it) for it in values["moved_planes"]],
        openings=[OpeningMatch(*it) for it in values["openings"]],
        thickness=[Thickness(*it) for it in values["thickness"]],
        stages=values["stages"],
        _report=report,
        _views=(_view(from_side), _view(to_side)),
    )
