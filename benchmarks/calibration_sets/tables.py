# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of rows (verdicts.py): each is a title, the names of its columns and lines of a label and numbers."""
import math

OUTCOMES = ("registered", "probable", "ambiguous", "under_constrained", "no_match", "error")
STATES = ("registered", "probable", "ambiguous", "under_constrained", "floating")
BINS = ("< 1 m2", "1-4 m2", "4-16 m2", "> 16 m2")
EDGES = [(k / 10, (k + 1) / 10) for k in range(10)]
FINE_EDGES = [(0.9, 0.95), (0.95, 0.99), (0.99, 0.999), (0.999, 1.0)]


def shared_bin(m2):
    return sum(m2 >= bound for bound in (1.0, 4.0, 16.0))


def wilson(right, count):
    """95 % interval of a share (Wilson 1927)."""
    z = 1.959964
    share, scale = right / count, 1.0 + z * z / count
    middle = (share + z * z / (2 * count)) / scale
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / scale
    return max(0.0, middle - half), min(1.0, middle + half)


def pair_line(rows):
    def number(outcome, right=None):
        return sum(r["outcome"] == outcome and right in (None, r["right"]) for r in rows)
    return [len(rows), sum(r["listed"] for r in rows), sum(r["right"] for r in rows),
            number("registered", True), number("registered", False), number("probable", True), number("probable", False),
            *(number(outcome) for outcome in OUTCOMES[2:])]


def pair_table(rows):
    rows = [r for r in rows if r["set"] != "foreign"]
    lines = []
    for name in dict.fromkeys(r["set"] for r in rows):
        own = [r for r in rows if r["set"] == name]
        lines.append((name, pair_line(own)))
        bins = [[r for r in own if shared_bin(r["shared_m2"]) == k] for k in range(4)]
        lines += [("  " + BINS[k], pair_line(inside)) for k, inside in enumerate(bins) if inside and len(inside) < len(own)]
    lines.append(("all", pair_line(rows)))
    lines += [("  " + BINS[k], pair_line([r for r in rows if shared_bin(r["shared_m2"]) == k])) for k in range(4)]
    return ("Pairs whose true pose is known, by the surface that both scans saw",
            ["pairs", "listed", "best right", "registered", "WRONG", "probable", "WRONG", "ambiguous", "under_constr",
             "no_match", "error"], lines)


def foreign_table(rows):
    rows = [r for r in rows if r["set"] == "foreign"]
    stated = max((r["probability"] or 0.0 for r in rows if r["posed"]), default=0.0)
    return ("Pairs that share nothing: any pose is wrong", ["pairs", *OUTCOMES, "highest stated"],
            [("foreign", [len(rows), *(sum(r["outcome"] == outcome for r in rows) for outcome in OUTCOMES), stated])])


def reliability_line(rows):
    count, right = len(rows), sum(r["right_across"] for r in rows)
    if not count:
        return [0, None, None, None, None]
    return [count, sum(r["probability"] for r in rows) / count, right / count, *wilson(right, count)]


def reliability_table(rows):
    """Of all best poses with a stated probability, foreign pairs included. The error is over the ten even bins."""
    rows = [r for r in rows if r["posed"] and r["probability"] is not None]

    def between(low, high):
        return [r for r in rows if low <= r["probability"] < high or high == 1.0 == r["probability"]]
    lines = [(f"{low:g} - {high:g}", reliability_line(between(low, high))) for low, high in EDGES]
    error = sum(n * abs(stated - share) for _, (n, stated, share, _, _) in lines if n) / max(1, len(rows))
    lines += [(f"  {low:g} - {high:g}", reliability_line(between(low, high))) for low, high in FINE_EDGES]
    return (f"Stated probability of the best pose against the share that is right; expected calibration error {error:.4f}",
            ["poses", "stated", "right", "from", "to"], lines)


def project_line(project):
    rows = project["scans"]
    stated = [1.0 - r["doubt"] for r in rows if r["placed"] and r["doubt"] is not None]
    reachable = [r for r in rows if r.get("reachable")]
    return [len(rows), sum(r["placed"] for r in rows), sum(r["right"] for r in rows),
            sum(r["right"] and r["in_frame"] for r in rows), sum(stated) / len(stated) if stated else None,
            *(sum(r["state"] == state for r in rows) for state in STATES),
            *(sum(r["state"] == state and r["placed"] and not r["right"] for r in rows) for state in STATES),
            project["cpu_s"], project["wall_s"], len(reachable),
            *(sum(r["right"] and r["state"] in states for r in reachable) for states in (STATES[:2], STATES[:1]))]


def project_table(projects):
    lines = [(p["set"], project_line(p)) for p in projects]
    if len(lines) > 1:
        scans = [scan for p in projects for scan in p["scans"]]
        lines.append(("all", project_line({"scans": scans, "cpu_s": sum(p["cpu_s"] for p in projects),
                                           "wall_s": sum(p["wall_s"] for p in projects)})))
    names = ["registered", "probable", "ambiguous", "under_constr", "floating"]
    return ("Buildings: scans, by what is stated of their places",
            ["scans", "placed", "right", "in frame", "stated", *names, *("WRONG " + name[:5] for name in names),
             "CPU s", "wall s", "reachable", "r. placed", "r. registered"], lines)


def all_tables(run):
    pairs, projects = run["pairs"], run["projects"]
    return [table for table, wanted in (
        (pair_table(pairs), any(r["set"] != "foreign" for r in pairs)),
        (foreign_table(pairs), any(r["set"] == "foreign" for r in pairs)),
        (reliability_table(pairs), pairs), (project_table(projects), projects)) if wanted]


def shown(value, signed=False):
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:+.4f}" if signed else f"{value:.4f}" if abs(value) <= 1 else f"{value:.1f}"
    return f"{value:+d}" if signed and value else "." if signed else str(value)


def text_of(table, signed=False):
    title, names, lines = table
    cells = [["", *names]] + [[label, *(shown(value, signed) for value in values)] for label, values in lines]
    widths = [max(len(row[k]) for row in cells) for k in range(len(names) + 1)]
    rows = [row[0].ljust(widths[0]) + "".join("  " + cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))
            for row in cells]
    return "\n".join([title, *(row.rstrip() for row in rows), ""])


def in_common(run, baseline):
    """What both runs have, in the order of the first."""
    old_pairs = {r["name"]: r for r in baseline["pairs"]}
    old_projects = {p["set"]: p for p in baseline["projects"]}
    pairs = [r for r in run["pairs"] if r["name"] in old_pairs]
    projects = [p for p in run["projects"] if p["set"] in old_projects and
                [s["name"] for s in p["scans"]] == [s["name"] for s in old_projects[p["set"]]["scans"]]]
    return ({"pairs": pairs, "projects": projects},
            {"pairs": [{**old_pairs[r["name"]], "shared_m2": r["shared_m2"]} for r in pairs],
             "projects": [old_projects[p["set"]] for p in projects]})


def word(row):
    outcome = row.get("outcome") or row.get("state")
    posed = row.get("posed", row.get("placed"))
    return outcome + (" right" if row["right"] else " WRONG" if posed else "")


def changes(run, baseline):
    """A line for each pair and scan that came out otherwise, the newly wrong ones first."""
    before = {r["name"]: word(r) for r in baseline["pairs"]}
    before.update((s["name"], word(s)) for p in baseline["projects"] for s in p["scans"])
    rows = [*run["pairs"], *(s for p in run["projects"] for s in p["scans"])]
    changed = [(r["name"], before[r["name"]], word(r)) for r in rows if before.get(r["name"], word(r)) != word(r)]
    order = ["registered WRONG", "probable WRONG"]
    changed.sort(key=lambda c: order.index(c[2]) if c[2] in order else len(order))
    return [f"{name}: {old} -> {new}" for name, old, new in changed]


def minus(a, b):
    return None if a is None or b is None else a - b


def difference(run, baseline):
    """The same tables of what both runs have, as differences."""
    run, baseline = in_common(run, baseline)
    text = [f"Against the baseline, of {len(run['pairs'])} pairs and {len(run['projects'])} buildings that both runs have\n"]
    for (title, names, lines), (_, _, olds) in zip(all_tables(run), all_tables(baseline)):
        differences = [(label, [minus(a, b) for a, b in zip(values, old)]) for (label, values), (_, old) in zip(lines, olds)]
        text.append(text_of((title, names, differences), signed=True))
    return "\n".join(text + ["What came out otherwise"] + (changes(run, baseline) or ["nothing"])) + "\n"
