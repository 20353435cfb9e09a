# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Planes, openings and segments."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np

from . import _html, _limen
from ._limen import ExtractOptions, Model, OpeningOptions, Scan, SegmentOptions
from ._numbers import Array, ProgressOption, as_progress


@dataclass(frozen=True, eq=False)
class Plane:
    """A bounded piece of a plane, world coordinates: normal . x = offset."""

    normal: Array  #: unit, towards the scanner where `oriented`
    offset: float  #: metres
    parts: list[list[Array]] = field(repr=False)  #: of each part the outer ring, then the holes: (k, 3) each
    centroid: Array = field(repr=False)
    inliers: int
    rms_m: float
    area_m2: float
    oriented: bool = field(repr=False)

    @property
    def outline(self) -> Array:
        """The outer ring of the largest part, (k, 3); the first point is not repeated."""
        return self.parts[0][0] if self.parts else np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Opening:
    """A window or door: lower left, lower right, upper right, upper left as seen from the scanner."""

    corners: Array  #: (4, 3), world
    plane: int  #: index into Features.planes
    evidence: int  #: rays that came back from behind the wall
    view: str  #: through, recess or hole
    edge_sigma_m: list[float]  #: of the bottom, right, top and left side; 1 or more: not seen
    reveal_depth_m: float
    reveal_sigma_m: float = field(repr=False)
    reveal_complete: bool = field(repr=False)
    outline: Array = field(repr=False)  #: where it is not a rectangle, else of shape (0, 3)

    @property
    def width_m(self) -> float:
        return float(np.linalg.norm(self.corners[1] - self.corners[0]))

    @property
    def height_m(self) -> float:
        return float(np.linalg.norm(self.corners[3] - self.corners[0]))


@dataclass(frozen=True, eq=False, repr=False)
class Features:
    """All that was found in one scan or model, world coordinates, most inliers first."""

    planes: list[Plane]
    openings: list[Opening]
    segments: Array  #: (n, 2, 3): both ends of each
    labels: Array  #: of every point its index into `planes`, or -1: int32
    inlier_threshold_m: float
    noise_m: float

    def __repr__(self) -> str:
        return (
            f"<limen.Features: {len(self.planes)} planes, {len(self.openings)} openings, "
            f"{len(self.segments)} segments>"
        )

    def _repr_html_(self) -> str:
        rows = [
            (
                k,
                f"{p.inliers:,}",
                f"{p.area_m2:.2f}",
                f"{1e3 * p.rms_m:.1f}",
                "{:.3f} {:.3f} {:.3f}".format(*p.normal),
            )
            for k, p in enumerate(self.planes[:10])
        ]
        walls = [_closed(p.outline) for p in self.planes if abs(p.normal[2]) < 0.5 and len(p.outline)]
        windows = [_closed(o.corners) for o in self.openings]
        head = ("plane", "points", "area m2", "rms mm", "normal")
        more = f"<p>... {len(self.planes) - 10} more</p>" if len(self.planes) > 10 else ""
        return (
            f"<div><b>{_html.escape(repr(self)[1:-1])}</b>{_html.table(rows, head)}{more}"
            f"{_html.top_view(lines=[walls, windows])}</div>"
        )


def _closed(ring: Array) -> Array:
    return np.concatenate([ring, ring[:1]])


def extract_features(
    scan: Union[Scan, Model],
    options: Optional[ExtractOptions] = None,
    *,
    openings: Union[bool, OpeningOptions] = True,
    segments: Union[bool, SegmentOptions] = True,
    progress: ProgressOption = None,
) -> Features:
    """Find the planes of a scan, and its openings and line segments unless they are not wanted.

    Openings need a level scan whose scanner position is known or can be estimated; else there are none. Of a
    model: what a scanner could see of it, without noise.
    """
    if isinstance(scan, Model):
        found = _limen.model_features(scan, as_progress(progress))
        if not openings:
            found["openings"] = []
        if not segments:
            found["segments"] = np.empty((0, 2, 3))
    else:
        found = _limen.extract_features(
            scan,
            options if options is not None else ExtractOptions(),
            OpeningOptions() if openings is True else openings or None,
            SegmentOptions() if segments is True else segments or None,
            as_progress(progress),
        )
    found["planes"] = [Plane(**plane) for plane in found["planes"]]
    found["openings"] = [Opening(**opening) for opening in found["openings"]]
    return Features(**found)
