# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""What the other files of the package share: types of arguments, and poses."""

from __future__ import annotations

import operator
import os
import sys
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

import numpy as np

from . import _limen

Path = Union[str, "os.PathLike[str]"]
if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[Any]
    ArrayLike = npt.ArrayLike
else:  # NumPy 1.19 has no numpy.typing
    Array = np.ndarray
    ArrayLike = Any
#: Called as progress(stage, done, total) when a stage begins, and ten times a second at most while it lasts;
#: total is 0 where it is not known.
Progress = Callable[[str, float, float], object]
#: True: a bar of tqdm where that is installed, else lines on stderr.
ProgressOption = Union[Progress, bool, None]


class _Bar:
    """One bar of tqdm for all stages."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None
        self._stage = ""

    def __call__(self, stage: str, done: float, total: float) -> None:
        if self._bar is None or stage != self._stage:
            self.close()
            self._stage = stage
            self._bar = self._tqdm(total=100, desc=stage, unit="%", leave=False)
        if total > 0:
            self._bar.n = round(100 * done / total)
            self._bar.refresh()

    def close(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def __del__(self) -> None:
        self.close()


class _Lines:
    """A line on stderr for each stage."""

    def __init__(self) -> None:
        self._stage = ""

    def __call__(self, stage: str, done: float, total: float) -> None:
        if stage != self._stage:
            self._stage = stage
            print(f"limen: {stage}", file=sys.stderr, flush=True)


def as_progress(progress: ProgressOption) -> Optional[Progress]:
    """What is called while work goes on: nothing, the caller's own function, or for True a bar."""
    if progress is None or progress is False:
        return None
    if progress is not True:
        return progress
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines()
    return _Bar(tqdm)


def as_pose(pose: ArrayLike) -> Array:
    """A 4 x 4 matrix of a rigid motion, float64."""
    matrix = np.asarray(pose, dtype=np.float64)
    if matrix.shape != (4, 4):
        raise ValueError(f"a pose is a 4 x 4 matrix, not of shape {matrix.shape}")
    _limen.require_pose(matrix)
    return matrix


def as_count(name: str, value: Any) -> int:
    """A number of something, as Python or NumPy has it."""
    try:
        count = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}: give a whole number") from None
    if count < 0:
        raise ValueError(f"{name} is {count}: give a number from 0")
    return count
