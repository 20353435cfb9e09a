# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""What the other files of the package share: types of arguments, and poses."""

from __future__ import annotations

import os
from typing import Any, Callable, Union

import numpy as np
import numpy.typing as npt

Path = Union[str, "os.PathLike[str]"]
Array = npt.NDArray[Any]
#: Called as progress(stage, done, total) when a stage begins, and ten times a second at most while it lasts;
#: total is 0 where it is not known.
Progress = Callable[[str, float, float], object]


def as_pose(pose: npt.ArrayLike) -> Array:
    """A 4 x 4 matrix of a rigid motion, float64."""
    matrix = np.asarray(pose, dtype=np.float64)
    if matrix.shape != (4, 4):
        raise ValueError(f"a pose is a 4 x 4 matrix, not of shape {matrix.shape}")
    return matrix
