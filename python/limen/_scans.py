# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Scans and models: reading, moving, showing."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Optional, Union, overload

import numpy as np

from . import _html, _limen
from ._limen import Model, Scan
from ._numbers import Array, ArrayLike, Path, ProgressOption, as_pose, as_progress


@dataclass(frozen=True)
class Element:
    """One building element of a model, as the file names it."""

    kind: str
    type: str
    guid: str
    name: str
    storey: str


def read_scan(
    path: Path,
    *,
    origin: Optional[ArrayLike] = None,
    level: bool = _limen.LEVEL,
    units: str = "",
    progress: ProgressOption = None,
) -> Scan:
    """Read a scan of any format limen knows; the content decides, not the name.

    origin: from where the scan was taken, in the coordinates of its points, metres, where the file does not
    say. level: the z axis points up. units: of the numbers in the file (m, mm, cm, ft, us-ft, in, km), where it
    does not say; the scan is in metres. Raises limen.Error for what cannot be read.
    """
    place = None if origin is None else np.asarray(origin, dtype=np.float64)
    return _limen.read_scan(os.fspath(path), place, level, units, as_progress(progress))


def read_model(path: Path, *, units: str = "", progress: ProgressOption = None) -> Model:
    """Read a building model: IFC (also zipped), OBJ, or PLY with faces. units: of a mesh, which does not say."""
    return _limen.read_model(os.fspath(path), units, as_progress(progress))


@overload
def transform(cloud: Scan, target_from_source: ArrayLike) -> Scan: ...
@overload
def transform(cloud: Array, target_from_source: ArrayLike) -> Array: ...
def transform(cloud: Union[Scan, Array], target_from_source: ArrayLike) -> Union[Scan, Array]:
    """Move a scan, or an array of world coordinates of shape (n, 3), by a 4 x 4 matrix."""
    pose = as_pose(target_from_source)
    if isinstance(cloud, Scan):
        return _limen.transform_scan(cloud, pose)
    return _limen.transform_points(cloud, pose)


def transform_file(
    path: Path, target_from_source: ArrayLike, output: Path, *, progress: ProgressOption = None
) -> int:
    """Move a point file with all its values, as `limen transform` does; returns the number of points."""
    pose = as_pose(target_from_source)
    written = _limen.transform_file(os.fspath(path), pose, os.fspath(output), as_progress(progress))
    return int(written["points"])


def thin(
    path: Path, output: Path, *, points: int = 0, spacing_m: float = 0.0, progress: ProgressOption = None
) -> int:
    """Keep an even part of a cloud of any size, as `limen thin` does; returns the number of points kept.

    points: at most so many. spacing_m: one in each cube of that side.
    """
    if points <= 0 and spacing_m <= 0:
        raise ValueError("give how many points to keep: points or spacing_m")
    written = _limen.thin_file(os.fspath(path), os.fspath(output), points, spacing_m, as_progress(progress))
    return int(written["points_written"])


def _scan_facts(scan: Scan) -> list[tuple[str, str]]:
    centre = scan.centres
    if centre is None:
        place = "unknown"
    elif scan.mobile:
        place = "per point"
    else:
        place = "{:.3f} {:.3f} {:.3f}".format(*(centre[0] + scan.local_origin))
    points = scan.points
    size = points.max(axis=0) - points.min(axis=0)
    has = [name for name in ("times", "intensities", "colours", "lines") if getattr(scan, name) is not None]
    return [
        ("points", f"{len(scan):,}"),
        ("size", "{:.2f} x {:.2f} x {:.2f} m".format(*size)),
        ("scanner position", place),
        ("attributes", ", ".join(has) or "none"),
        ("local origin", "{:g} {:g} {:g}".format(*scan.local_origin)),
    ]


def _scan_repr(scan: Scan) -> str:
    return f"<limen.Scan {scan.name!r}: {len(scan):,} points>"


def _scan_html(scan: Scan) -> str:
    view = _html.top_view([_html.occupied_cells(scan.points)])
    return f"<div><b>{_html.escape(scan.name or 'scan')}</b>{_html.table(_scan_facts(scan))}{view}</div>"


def _model_repr(model: Model) -> str:
    held = f"{len(model.elements)} elements, {model.faces} faces"
    return f"<limen.Model {model.name!r}: {model.schema}, {held}>"


def _elements(model: Model) -> list[Element]:
    return [Element(*parts) for parts in model._elements()]


def _restored(parts: dict[str, Any], centre_source: int) -> Scan:
    scan = Scan(**parts)
    scan._centre_source = centre_source
    return scan


def _scan_reduce(scan: Scan) -> tuple[Any, ...]:
    parts = {name: getattr(scan, name) for name in _PARTS}
    return _restored, (parts, scan._centre_source)


#: What Scan(...) takes.
_PARTS = (
    "points",
    "centres",
    "times",
    "intensities",
    "colours",
    "lines",
    "indices",
    "name",
    "level",
    "local_origin",
)

setattr(Scan, "__reduce__", _scan_reduce)
setattr(Scan, "__repr__", _scan_repr)
setattr(Scan, "_repr_html_", _scan_html)
setattr(Model, "__repr__", _model_repr)
setattr(Model, "elements", property(_elements, doc="The building elements, in the order of the file."))
