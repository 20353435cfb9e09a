# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""A registered scan against its model."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Optional, Union

import numpy as np

from . import _html, _limen
from ._limen import DeviationOptions, Model, Scan
from ._numbers import Array, ArrayLike, Path, ProgressOption, as_pose, as_progress
from ._registration import Registration
from ._scans import read_model, read_scan


@dataclass(frozen=True, eq=False)
class ElementDeviation:
    """One element of the model against the scan; distances are positive where matter stands out."""

    name: str
    kind: str
    guid: str = field(repr=False)
    presence: str  #: found, not_found or not_judged
    points: int
    median_m: float
    sigma_m: float
    p95_m: float
    loa: int  #: USIBD class, 10 to 50; 0: none
    covered_share: float
    shift_m: Array  #: as built less as modelled; 0 along directions that its faces do not hold
    shift_sigma_m: Array = field(repr=False)


@dataclass(frozen=True, eq=False)
class Unmodelled:
    """A piece of matter that no face of the model explains; its extent in world coordinates."""

    points: int
    low: Array
    high: Array


@dataclass(frozen=True, eq=False, repr=False)
class Deviation:
    """What was built otherwise than drawn."""

    elements: list[ElementDeviation]  #: one per element of the model, in its order
    unmodelled: list[Unmodelled]
    common_shift: dict[str, Any]  #: of all found elements together: what the pose may be off by
    matched: int  #: points on faces
    far: int  #: points with no face near
    distance_m: Array  #: per point, float32; NaN: on no face
    element: Array  #: per point its index into `elements`, or -1
    _measured: Any = None

    def save(self, folder: Path, *, colour_limit_m: float = 0.05) -> None:
        """Write deviation.json, .csv, .xlsx and .ply, as `limen deviation` does."""
        if self._measured is None:
            raise ValueError("what the files need is not kept in a pickle: save before")
        self._measured.save(os.fspath(folder), colour_limit_m)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_measured": None}

    def _count(self, presence: str) -> int:
        return sum(element.presence == presence for element in self.elements)

    def __repr__(self) -> str:
        return (
            f"<limen.Deviation: {self._count('found')} elements found, {self._count('not_found')} not found, "
            f"{self._count('not_judged')} not judged>"
        )

    def _repr_html_(self) -> str:
        judged = [element for element in self.elements if element.presence != "not_judged"]
        judged.sort(key=lambda it: (it.presence != "not_found", -float(np.linalg.norm(it.shift_m))))
        rows = [
            (it.name or it.kind, it.presence, f"{1e3 * it.median_m:.1f}", f"{1e3 * it.p95_m:.1f}",
             f"{1e3 * float(np.linalg.norm(it.shift_m)):.1f}")
            for it in judged[:15]
        ]
        head = ("element", "", "median mm", "95 % mm", "shift mm")
        return f"<div><b>{_html.escape(repr(self)[1:-1])}</b>{_html.table(rows, head)}</div>"


def deviation(
    scan: Union[Scan, Path],
    model: Union[Model, Path],
    pose: Optional[Union[ArrayLike, Registration]] = None,
    *,
    options: Optional[DeviationOptions] = None,
    progress: ProgressOption = None,
) -> Deviation:
    """Measure a scan against its model. pose: 4 x 4, or the Registration of the scan (source) in the model
    (target); None: both are in one frame already."""
    if isinstance(pose, Registration):
        pose = pose.target_from_source
        if pose is None:
            raise ValueError("no reliable overlap was found: there is no pose to measure at")
    matrix = np.eye(4) if pose is None else as_pose(pose)
    measured = _limen.deviation(
        scan if isinstance(scan, Scan) else read_scan(scan),
        model if isinstance(model, Model) else read_model(model),
        matrix,
        options if options is not None else DeviationOptions(),
        as_progress(progress),
    )
    values = measured.values()
    return Deviation(
        elements=[ElementDeviation(**it) for it in values["elements"]],
        unmodelled=[Unmodelled(*it) for it in values["unmodelled"]],
        common_shift=values["common_shift"],
        matched=values["matched"],
        far=values["far"],
        distance_m=measured.distance_m,
        element=measured.element,
        _measured=measured,
    )
