# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""limen finds how laser scans of one building fit together, and where in a building model a scan was taken.

    import limen
    result = limen.register("room.ply", "street.ply")
    if result.registered:
        moved = result.apply(points)

Coordinates are metres; poses are 4 x 4 matrices `target_from_source` between world coordinates. A scan's
`points` are about its `local_origin`: world = points + local_origin.
"""

from . import _limen
from ._deviation import Deviation, ElementDeviation, Unmodelled, deviation
from ._evaluation import Evaluation, evaluate
from ._features import Features, Opening, Plane, extract_features
from ._limen import (
    DetectOptions,
    DeviationOptions,
    Error,
    ExtractOptions,
    GrowOptions,
    Model,
    OpeningOptions,
    PolygonOptions,
    RegisterOptions,
    Scan,
    SegmentOptions,
    __version__,
    set_threads,
    threads,
)
from ._project import Project, ProjectScan, project, read_project
from ._registration import (
    Hypothesis,
    OpeningMatch,
    PlaneMatch,
    Registration,
    Sigma,
    Thickness,
    Unobserved,
    register,
)
from ._scans import Element, read_model, read_scan, thin, transform, transform_file

__all__ = [
    "DetectOptions",
    "Deviation",
    "DeviationOptions",
    "Element",
    "ElementDeviation",
    "Error",
    "Evaluation",
    "ExtractOptions",
    "Features",
    "GrowOptions",
    "Hypothesis",
    "Model",
    "Opening",
    "OpeningMatch",
    "OpeningOptions",
    "Plane",
    "PlaneMatch",
    "PolygonOptions",
    "Project",
    "ProjectScan",
    "RegisterOptions",
    "Registration",
    "Scan",
    "SegmentOptions",
    "Sigma",
    "Thickness",
    "Unmodelled",
    "Unobserved",
    "__version__",
    "deviation",
    "evaluate",
    "extract_features",
    "project",
    "read_model",
    "read_project",
    "read_scan",
    "register",
    "set_threads",
    "thin",
    "threads",
    "transform",
    "transform_file",
]

# The simulator is not part of every build.
if hasattr(_limen, "simulate"):
    from ._simulation import Simulation, scene_names, simulate

    __all__ += ["Simulation", "scene_names", "simulate"]
