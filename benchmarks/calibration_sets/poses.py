# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Rigid transforms as four rows of four, in plain Python: numbers of kilometres keep their digits."""
import math

IDENTITY = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(a):
    turned = [[a[j][i] for j in range(3)] for i in range(3)]
    shift = [-sum(turned[i][k] * a[k][3] for k in range(3)) for i in range(3)]
    return [turned[i] + [shift[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def moved(a, x):
    return [sum(a[i][k] * x[k] for k in range(3)) + a[i][3] for i in range(3)]


def relative(world_from_target, world_from_source):
    """target_from_source, of two poses in one world."""
    return product(inverse(world_from_target), world_from_source)


def of_quaternion(shift, w, x, y, z):
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / norm, x / norm, y / norm, z / norm
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [turn[i] + [shift[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def turn_between(a, b):
    """Rotation vector that leads from b's directions to those of a, in the target's frame, radians."""
    turn = [[sum(a[i][k] * b[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
    axis = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]]
    sine = 0.5 * math.sqrt(sum(x * x for x in axis))
    cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0)
    angle = math.atan2(sine, cosine)
    if sine < 1e-9:  # no turn, or half a turn about whichever axis
        return [angle if cosine < 0 else 0.0, 0.0, 0.0]
    return [0.5 * x / sine * angle for x in axis]


def across(vector, directions):
    """What of a vector lies across unit directions that are square to one another."""
    for d in directions:
        along = sum(x * y for x, y in zip(vector, d))
        vector = [x - along * y for x, y in zip(vector, d)]
    return vector


def length(vector):
    return math.sqrt(sum(x * x for x in vector))


def errors(pose, truth, middle, unobserved=()):
    """Metres at the source's middle and degrees, across the freedoms that the answer calls unobserved."""
    shift = [x - y for x, y in zip(moved(pose, middle), moved(truth, middle))]
    open_of = {kind: [f["direction"] for f in unobserved if f["kind"] == kind] for kind in ("translation", "rotation")}
    turn = across(turn_between(pose, truth), open_of["rotation"])
    return length(across(shift, open_of["translation"])), math.degrees(length(turn))
