# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Tables and small top views for notebooks."""

from __future__ import annotations

from html import escape as escape
from typing import Iterable, Sequence

import numpy as np

from ._numbers import Array

_WIDTH = 320.0
_HEIGHT = 240.0
_CELLS = 96
#: Distinct with every kind of colour vision.
COLOURS = ("#0072b2", "#d55e00", "#666666")
#: Source and target, as in the report.
SIDES = ("#c9660a", "#1f6fb4")


def table(rows: Iterable[Sequence[object]], head: Sequence[str] = ()) -> str:
    """An HTML table; every cell is escaped."""
    text = "<table>"
    if head:
        text += "<tr>" + "".join(f"<th>{escape(str(cell))}</th>" for cell in head) + "</tr>"
    for row in rows:
        text += "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>"
    return text + "</table>"


def occupied_cells(points: Array, most: int = 200_000) -> Array:
    """Middles of the cells of a grid seen from above that hold points: (n, 2), n <= 96 * 96."""
    if len(points) == 0:
        return np.empty((0, 2))
    flat = points[:: max(1, len(points) // most), :2]
    low, high = np.percentile(flat, 1, axis=0), np.percentile(flat, 99, axis=0)
    flat = flat[((flat >= low) & (flat <= high)).all(axis=1)]
    cell = max(float(np.max(high - low)), 1e-6) / _CELLS
    places = np.unique(np.floor((flat - low) / cell).astype(np.int64), axis=0)
    middles: Array = low + (places + 0.5) * cell
    return middles


def top_view(
    clouds: Sequence[Array] = (), lines: Sequence[Sequence[Array]] = (), colours: Sequence[str] = COLOURS
) -> str:
    """Points and polylines from above as SVG: each cloud and each list of lines in a colour of its own."""
    everything = [c[:, :2] for c in clouds if len(c)] + [line[:, :2] for group in lines for line in group]
    if not everything:
        return ""
    joined = np.concatenate(everything)
    low, high = joined.min(axis=0), joined.max(axis=0)
    scale = min(_WIDTH / max(high[0] - low[0], 1e-6), _HEIGHT / max(high[1] - low[1], 1e-6)) * 0.96

    def place(xy: Array) -> Array:
        shifted: Array = (xy - 0.5 * (low + high)) * scale * (1.0, -1.0) + (0.5 * _WIDTH, 0.5 * _HEIGHT)
        return np.round(shifted, 1)

    parts = []
    for cloud, colour in zip(clouds, colours):
        dots = "".join(f"M{x:g} {y:g}h.01" for x, y in place(cloud[:, :2]))
        parts.append(
            f'<path d="{dots}" stroke="{colour}" stroke-width="2" stroke-linecap="round" '
            'opacity=".6" fill="none"/>'
        )
    for group, colour in zip(lines, colours):
        strokes = "".join("M" + "L".join(f"{x:g} {y:g}" for x, y in place(line[:, :2])) for line in group)
        parts.append(f'<path d="{strokes}" stroke="{colour}" stroke-width="1.2" fill="none"/>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH:g}" height="{_HEIGHT:g}" role="img" '
        f'aria-label="seen from above">{"".join(parts)}</svg>'
    )
