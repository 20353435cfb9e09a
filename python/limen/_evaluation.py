# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""A pose against the true one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ._numbers import Array, ArrayLike, as_pose
from ._registration import Hypothesis, Registration


@dataclass(frozen=True, eq=False)
class Evaluation:
    """How far a pose is from the true one; the same numbers as those of `limen evaluate --json`."""

    rotation_error_deg: float
    translation_error_m: float  #: of the point `measured_at`
    measured_at: Array = field(repr=False)  #: the source's middle, metres, source world
    rotation_vector_rad: Array = field(repr=False)  #: the turn that is wrong, target frame
    shift_m: Array = field(repr=False)  #: the shift that is wrong, of `measured_at`, target frame
    largest_error_in_sigmas: Optional[float] = None  #: the worst of the six, where deviations are known


def _rotation_vector(rotation: Array) -> Array:
    """The axis times the angle, radians; exact near 0 and well-behaved to half a turn."""
    sine = 0.5 * np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    cosine = 0.5 * (np.trace(rotation) - 1.0)
    length = float(np.linalg.norm(sine))
    angle = float(np.arctan2(length, cosine))
    if length > 1e-9:
        return np.asarray(sine * (angle / length))
    if cosine > 0:
        return np.asarray(sine)
    # Half a turn: the axis is the column of R + I of the largest diagonal.
    doubled = rotation + np.eye(3)
    axis = doubled[:, int(np.argmax(np.diag(doubled)))]
    return np.asarray(axis / np.linalg.norm(axis) * np.pi)


def evaluate(
    result: Registration, truth: ArrayLike, *, pose: Optional[Hypothesis] = None
) -> Evaluation:
    """Compare the best pose of a result, or `pose` of its alternatives, with the true 4 x 4 matrix."""
    found = result.best if pose is None else pose
    if found is None:
        raise ValueError("no reliable overlap was found: there is no pose to compare")
    target_from_source, true_pose = found.target_from_source, as_pose(truth)
    middle = np.asarray(result.to_dict()["inputs"]["source"]["middle"])
    turn = _rotation_vector(target_from_source[:3, :3] @ true_pose[:3, :3].T)
    # Large coordinates meet in one subtraction.
    turned = (target_from_source[:3, :3] - true_pose[:3, :3]) @ middle
    shift = turned + (target_from_source[:3, 3] - true_pose[:3, 3])
    largest = None
    if found.sigma is not None and np.any(found.sigma.covariance):
        lever = target_from_source[:3, :3] @ middle + target_from_source[:3, 3] - found.sigma.centre
        skew = np.array([[0, lever[2], -lever[1]], [-lever[2], 0, lever[0]], [lever[1], -lever[0], 0]])
        moved = np.hstack([skew, np.eye(3)])
        variances = np.concatenate(
            [np.diag(found.sigma.covariance)[:3], np.diag(moved @ found.sigma.covariance @ moved.T)]
        )
        errors = np.concatenate([turn, shift])
        largest = float(np.max(np.abs(errors) / np.sqrt(np.maximum(variances, 1e-30))))
    return Evaluation(
        rotation_error_deg=float(np.degrees(np.linalg.norm(turn))),
        translation_error_m=float(np.linalg.norm(shift)),
        measured_at=middle,
        rotation_vector_rad=turn,
        shift_m=shift,
        largest_error_in_sigmas=largest,
    )
