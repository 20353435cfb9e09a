# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
# Types of the compiled part. The options are those of C++: their defaults stand there.
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from ._numbers import Array, Progress
from ._scans import Element

__version__: str
LEVEL: bool

class Error(ValueError):
    what: str
    where: str
    remedy: str
    fault: str

def set_threads(count: int) -> None: ...
def threads() -> int: ...

class Scan:
    name: str
    level: bool
    def __init__(
        self,
        points: npt.ArrayLike,
        *,
        centres: Optional[npt.ArrayLike] = None,
        times: Optional[npt.ArrayLike] = None,
        intensities: Optional[npt.ArrayLike] = None,
        colours: Optional[npt.ArrayLike] = None,
        lines: Optional[npt.ArrayLike] = None,
        indices: Optional[npt.ArrayLike] = None,
        name: str = "",
        level: bool = ...,
        local_origin: Optional[npt.ArrayLike] = None,
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def points(self) -> npt.NDArray[np.float64]: ...
    @property
    def world_points(self) -> npt.NDArray[np.float64]: ...
    @property
    def local_origin(self) -> npt.NDArray[np.float64]: ...
    @property
    def centres(self) -> Optional[npt.NDArray[np.float64]]: ...
    @property
    def times(self) -> Optional[npt.NDArray[np.float64]]: ...
    @property
    def intensities(self) -> Optional[npt.NDArray[np.float32]]: ...
    @property
    def colours(self) -> Optional[npt.NDArray[np.uint8]]: ...
    @property
    def lines(self) -> Optional[npt.NDArray[np.int32]]: ...
    @property
    def indices(self) -> Optional[npt.NDArray[np.int32]]: ...
    @property
    def mobile(self) -> bool: ...
    def save(self, path: str) -> None: ...
    _centre_source: int
    def _repr_html_(self) -> str: ...

class Model:
    @property
    def name(self) -> str: ...
    @property
    def schema(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def georeferenced(self) -> bool: ...
    @property
    def local_origin(self) -> npt.NDArray[np.float64]: ...
    @property
    def faces(self) -> int: ...
    @property
    def openings(self) -> int: ...
    @property
    def spaces(self) -> list[str]: ...
    @property
    def elements(self) -> list[Element]: ...
    def _elements(self) -> list[tuple[str, str, str, str, str]]: ...

class DetectOptions:
    detector: str
    threshold: str
    seed: int
    relief: bool
    def __init__(
        self, *, detector: str = ..., threshold: str = ..., seed: int = ..., relief: bool = ...
    ) -> None: ...

class GrowOptions:
    inlier_threshold_m: float
    min_inliers: int
    finest_cell_m: float
    coarsest_cell_m: float
    max_angle_deg: float
    def __init__(
        self,
        *,
        inlier_threshold_m: float = ...,
        min_inliers: int = ...,
        finest_cell_m: float = ...,
        coarsest_cell_m: float = ...,
        max_angle_deg: float = ...,
    ) -> None: ...
    def check(self) -> None: ...

class PolygonOptions:
    alpha_m: float
    min_part_m2: float
    min_hole_m2: float
    simplify_m: float
    def __init__(
        self,
        *,
        alpha_m: float = ...,
        min_part_m2: float = ...,
        min_hole_m2: float = ...,
        simplify_m: float = ...,
    ) -> None: ...
    def check(self) -> None: ...

class ExtractOptions:
    detect: DetectOptions
    grow: GrowOptions
    polygons: PolygonOptions
    def __init__(
        self, *, detect: DetectOptions = ..., grow: GrowOptions = ..., polygons: PolygonOptions = ...
    ) -> None: ...
    def check(self) -> None: ...

class OpeningOptions:
    min_wall_m: float
    min_depth_m: float
    through_m: float
    min_width_m: float
    min_height_m: float
    max_width_m: float
    max_height_m: float
    centre: Optional[npt.ArrayLike]
    def __init__(
        self,
        *,
        min_wall_m: float = ...,
        min_depth_m: float = ...,
        through_m: float = ...,
        min_width_m: float = ...,
        min_height_m: float = ...,
        max_width_m: float = ...,
        max_height_m: float = ...,
        centre: Optional[npt.ArrayLike] = ...,
    ) -> None: ...
    def check(self) -> None: ...

class SegmentOptions:
    min_length_m: float
    min_angle_deg: float
    join_gap_m: float
    creases: bool
    borders: bool
    max_border_sigma_m: float
    def __init__(
        self,
        *,
        min_length_m: float = ...,
        min_angle_deg: float = ...,
        join_gap_m: float = ...,
        creases: bool = ...,
        borders: bool = ...,
        max_border_sigma_m: float = ...,
    ) -> None: ...
    def check(self) -> None: ...

class RegisterOptions:
    method: str
    gravity: str
    wall_thickness_m: float
    nothing_repeats: bool
    seed: int
    extract: ExtractOptions
    refined_poses: int
    alternatives: int
    def __init__(
        self,
        *,
        method: str = ...,
        gravity: str = ...,
        wall_thickness_m: float = ...,
        nothing_repeats: bool = ...,
        seed: int = ...,
        extract: ExtractOptions = ...,
        refined_poses: int = ...,
        alternatives: int = ...,
    ) -> None: ...
    def check(self) -> None: ...

class DeviationOptions:
    max_distance_m: float
    max_angle_deg: float
    tile_m: float
    rays: int
    min_points: int
    cluster_m: float
    min_cluster_points: int
    def __init__(
        self,
        *,
        max_distance_m: float = ...,
        max_angle_deg: float = ...,
        tile_m: float = ...,
        rays: int = ...,
        min_points: int = ...,
        cluster_m: float = ...,
        min_cluster_points: int = ...,
    ) -> None: ...
    def check(self) -> None: ...

class RegistrationReport:
    def values(self) -> dict[str, Any]: ...
    def json(self) -> str: ...
    def save(self, folder: str, with_report: bool) -> None: ...

class MeasuredDeviation:
    def values(self) -> dict[str, Any]: ...
    @property
    def distance_m(self) -> npt.NDArray[np.float32]: ...
    @property
    def element(self) -> npt.NDArray[np.int32]: ...
    def save(self, folder: str, colour_limit_m: float) -> None: ...

def read_scan(
    path: str, origin: Optional[Array], level: bool, units: str, progress: Optional[Progress]
) -> Scan: ...
def read_model(path: str, units: str, progress: Optional[Progress]) -> Model: ...
def is_model_file(path: str) -> bool: ...
def transform_file(path: str, pose: Array, output: str, progress: Optional[Progress]) -> dict[str, Any]: ...
def thin_file(
    path: str, output: str, points: int, spacing_m: float, progress: Optional[Progress]
) -> dict[str, Any]: ...
def require_pose(pose: Array) -> None: ...
def transform_scan(scan: Scan, pose: Array) -> Scan: ...
def transform_points(points: Array, pose: Array) -> Array: ...
def extract_features(
    scan: Scan,
    options: ExtractOptions,
    openings: Optional[OpeningOptions],
    segments: Optional[SegmentOptions],
    progress: Optional[Progress],
) -> dict[str, Any]: ...
def model_features(model: Model, progress: Optional[Progress]) -> dict[str, Any]: ...
def register(
    source: Union[Model, Sequence[tuple[Scan, Array]]],
    target: Union[Model, Sequence[tuple[Scan, Array]]],
    options: RegisterOptions,
    progress: Optional[Progress],
) -> RegistrationReport: ...
def deviation(
    scan: Scan, model: Model, pose: Array, options: DeviationOptions, progress: Optional[Progress]
) -> MeasuredDeviation: ...
def scene_names() -> list[str]: ...
def simulate(
    name: str, given: dict[str, Any], progress: Optional[Progress]
) -> tuple[list[Scan], list[Array], str]: ...
