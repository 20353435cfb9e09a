# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""What an answer of the program is worth, held against the truth. Plain Python, so that it can be tested anywhere."""
from . import poses


def within(error, one):
    return error[0] <= one.within_m and error[1] <= one.within_deg


def pair_row(pair, result):
    """What the tables need of a pair. right: the best pose is the true one; listed: it or an alternative is;
    right_across: as right, but what the answer calls unobserved is not asked for."""
    row = {"name": pair.name, "set": pair.of.name if pair.truth else "foreign", "shared_m2": round(pair.shared_m2, 2),
           "outcome": result.get("outcome", "error"), "probability": result.get("probability"),
           "right": False, "right_across": False, "listed": False, "error_m": None, "error_deg": None}
    best = result.get("target_from_source")
    row["posed"] = best is not None
    if best is None or pair.truth is None:
        return row
    error = poses.errors(best, pair.truth, pair.middle)
    row["error_m"], row["error_deg"] = error
    row["right"] = within(error, pair.of)
    across = poses.errors(best, pair.truth, pair.middle, result.get("unobserved", ()))
    row["right_across"] = row["right"] or within(across, pair.of)
    row["listed"] = row["right"] or any(
        within(poses.errors(other["target_from_source"], pair.truth, pair.middle), pair.of)
        for other in result.get("alternatives", ()))
    return row


def agreeing(anchor, placed, one):
    """The scans of a component that stand right as seen from one of them, and how far off they are together."""
    off = [(scan, poses.errors(poses.relative(anchor["pose"], scan["pose"]),
                               poses.relative(anchor["scan"].world_from_scan, scan["scan"].world_from_scan),
                               scan["scan"].middle)) for scan in placed]
    good = [(scan, error) for scan, error in off if within(error, one)]
    return [scan for scan, _ in good], sum(error[0] for _, error in good)


def right_ones(placed, one):
    """The scans of a component that are right as seen from one of those that are registered or probable: the one that
    most of these agree with, then most of all. Where none is, all count."""
    sure = [scan for scan in placed if scan["row"]["state"] in ("registered", "probable")] or placed

    def agreement(anchor):
        group, error = agreeing(anchor, placed, one)
        return -sum(scan in sure for scan in group), -len(group), error
    return agreeing(min(sure, key=agreement), placed, one)[0]


def largest_group(count, pairs):
    """Of scans 0 to count - 1 the largest set that the pairs join, the first of equal ones."""
    group = list(range(count))
    for a, b in pairs:
        old, new = max(group[a], group[b]), min(group[a], group[b])
        group = [new if one == old else one for one in group]
    best = max(range(count), key=lambda one: (group.count(one), -one), default=None)
    return {k for k in range(count) if group[k] == best}


def project_rows(one, document, reachable=frozenset()):
    """A row for each scan of a set. placed: it is in a frame with others; right: where those have it that the component
    is sure of (right_ones); in_frame: that frame is the project's; reachable: its number is among those that could be
    joined."""
    by_name = {scan["file"].replace("\\", "/").rsplit("/", 1)[-1]: scan for scan in document.get("scans", ())}
    rows, components = [], {}
    for number, scan in enumerate(one.scans):
        of = by_name.get(scan.path.name, {})
        pose = of.get("frame_from_scan") or of.get("component_from_scan")
        row = {"name": f"{one.name}: {scan.name}", "state": of.get("state", "error"), "doubt": of.get("doubt"),
               "in_frame": of.get("frame_from_scan") is not None, "placed": False, "right": False,
               "reachable": number in reachable}
        rows.append(row)
        if pose:
            components.setdefault(of.get("component"), []).append({"row": row, "scan": scan, "pose": pose})
    for placed in components.values():
        if len(placed) > 1:
            for scan in placed:
                scan["row"]["placed"] = True
            for scan in right_ones(placed, one):
                scan["row"]["right"] = True
    return rows
