# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Labelled sets of scans: where they lie beneath the folder of data, and how the poses of their authors are read."""
import dataclasses
import hashlib
import itertools
import json
import pathlib
import random
import shlex
import shutil
import subprocess
import sys

import numpy

from . import clouds, poses, verdicts
from .tables import shared_bin

REACHABLE_M2 = 4.0  # two scans that share so much surface can be joined


@dataclasses.dataclass
class Scan:
    name: str
    path: pathlib.Path
    world_from_scan: list
    middle: list = None
    voxels: dict = None  # by the size of the cubes


@dataclasses.dataclass
class LabelledSet:
    name: str
    place: str  # scans of two places share nothing
    scans: list
    within_m: float = 0.05
    within_deg: float = 0.5
    real: bool = False
    project: bool = True


@dataclasses.dataclass
class Pair:
    of: LabelledSet
    source: Scan
    target: Scan
    truth: list = None  # target_from_source; None where the scans share nothing
    shared_m2: float = 0.0
    middle: list = None
    name: str = ""


def museum(folder, _):
    return [Scan(path.stem, path, poses.IDENTITY) for path in sorted(folder.glob("musee_*.ply"))]


def balm(folder, _):
    """Scan fullN: rows 4 N to 4 N + 3 of alidarPose.csv; the last of them carries a time."""
    file = next(p for p in (folder / "alidarPose.csv", folder.parent / "balm" / "alidarPose.csv") if p.is_file())
    rows = [[float(x) for x in line.split(",") if x.strip()] for line in file.read_text().splitlines() if line.strip()]
    paths = sorted(folder.glob("full*.pcd"), key=lambda path: int(path.stem[4:]))
    return [Scan(path.stem, path, rows[4 * n:4 * n + 3] + [poses.IDENTITY[3]])
            for path in paths for n in (int(path.stem[4:]),)]


def mlcc(folder, made):
    """Raw triples of 4-byte numbers; line i of pose.json is the pose of patch i: shift, then w x y z."""
    lines = [[float(x) for x in line.split()] for line in (folder / "pose.json").read_text().splitlines() if line.strip()]
    scans = []
    for path in sorted(folder.glob("patch*.dat"), key=lambda path: int(path.stem[5:])):
        ply = made / (path.stem + ".ply")
        if not ply.is_file():
            clouds.write_ply(ply, numpy.fromfile(path, dtype="<f4").reshape(-1, 3))
        line = lines[int(path.stem[5:])]
        scans.append(Scan(path.stem, ply, poses.of_quaternion(line[:3], *line[3:7])))
    return scans


def tdtk(folder, made):
    """Centimetres, left-handed with y up: x, y, z become z, -x, y in metres. The last line of .frames holds the pose
    column by column."""
    turn = numpy.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    scans = []
    for path in sorted(folder.glob("scan*.3d")):
        ply = made / (path.stem + ".ply")
        if not ply.is_file():
            points = numpy.loadtxt(path, usecols=(0, 1, 2))
            points = points[(points != 0).any(axis=1)]  # a ray without an echo
            clouds.write_ply(ply, points @ turn.T / 100.0)
        numbers = path.with_suffix(".frames").read_text().strip().splitlines()[-1].split()[:16]
        theirs = numpy.array([float(x) for x in numbers]).reshape(4, 4).T
        pose = numpy.eye(4)
        pose[:3, :3] = turn @ theirs[:3, :3] @ turn.T
        pose[:3, 3] = turn @ theirs[:3, 3] / 100.0
        scans.append(Scan(path.stem, ply, pose.tolist()))
    return scans


REAL = {"strasbourg_museum": ("museum", museum, {}),
        "balm": ("hall", balm, {"within_m": 0.3, "within_deg": 1.0}),
        "balm_hall": ("hall", balm, {"within_m": 0.3, "within_deg": 1.0}),
        "mlcc_scene1": ("court", mlcc, {}),
        "3dtk": ("corridor", tdtk, {})}


def other_simulator(folder):
    """A building with a pose per scan, or a pair with one transform. A case of one scan or a model is no set."""
    case = json.loads((folder / "case.json").read_text())
    of = case.get("transforms")
    if not of and "transform" in case and "target" in case:
        of = {pathlib.Path(case["source"]).stem: case["transform"], pathlib.Path(case["target"]).stem: poses.IDENTITY}
    scans = [Scan(name, folder / (name + ".ply"), pose) for name, pose in sorted((of or {}).items())]
    scans = [scan for scan in scans if scan.path.is_file()]
    return LabelledSet(folder.name, folder.name, scans, project=len(scans) > 2) if len(scans) > 1 else None


def simulated(program, spec, more, work):
    """The buildings of KIND:SEED or KIND:FIRST-LAST. They are made once, whatever program asks for them next."""
    kind, _, seeds = spec.partition(":")
    first, _, last = (seeds or "1").partition("-")
    for seed in range(int(first), int(last or first) + 1):
        arguments = ["simulate", kind, "--project", *shlex.split(more), "--seed", str(seed)]
        key = hashlib.sha256(json.dumps(arguments).encode()).hexdigest()[:10]
        folder = work / "sim" / f"{kind}_{seed}_{key}"
        truth = folder / "truth" / "project.json"
        if not truth.is_file():
            part = folder.with_name(folder.name + ".part")
            shutil.rmtree(part, ignore_errors=True)
            part.parent.mkdir(exist_ok=True)
            if subprocess.run([program, *arguments, "-o", part, "--quiet"], check=False).returncode != 0:
                raise SystemExit(f"calibration: {kind}, seed {seed}, cannot be simulated")
            part.rename(folder)
        scans = [Scan(pathlib.Path(scan["file"]).stem, folder / scan["file"], scan["world_from_scan"])
                 for scan in json.loads(truth.read_text())["scans"]]
        yield LabelledSet(f"{kind}_{seed}", folder.name, scans)


def labelled_sets(program, data, work, simulate, simulate_args, names):
    """All sets, or those named; what is missing is named and left out."""
    found = []
    for name, (place, scans_of, tolerance) in REAL.items():
        if not names or name in names:
            made = work / "converted" / name
            made.mkdir(parents=True, exist_ok=True)
            folder = data / "real" / name
            scans = scans_of(folder, made) if folder.is_dir() else []
            found.append(LabelledSet(name, place, scans, real=True, **tolerance))
    for folder in sorted((data / "sim_other").glob("*")):
        if (folder / "case.json").is_file() and (not names or folder.name in names):
            found.append(other_simulator(folder) or LabelledSet(folder.name, folder.name, []))
    for spec in simulate:
        found.extend(simulated(program, spec, simulate_args, work))
    for one in found:
        if not one.scans:
            print(f"calibration: {one.name}: no two scans with known poses here, left out", file=sys.stderr)
    return [one for one in found if one.scans]


def in_turns(groups, count):
    """The first of each group, then the second of each, until there are count."""
    turns = itertools.chain.from_iterable(itertools.zip_longest(*groups))
    return list(itertools.islice((x for x in turns if x is not None), count))


def shuffled(items, seed):
    items = list(items)
    random.Random(seed).shuffle(items)
    return items


def pairs_of(one, count, seed):
    """All pairs of a set, or count of them, in turns from those that share much, less, little and next to nothing."""
    pairs = [Pair(one, a, b, poses.relative(b.world_from_scan, a.world_from_scan), clouds.shared_m2(a, b), a.middle,
                  f"{one.name}: {a.name} {b.name}") for a, b in itertools.combinations(one.scans, 2)]
    if count is None or count >= len(pairs):
        return pairs
    pairs = shuffled(pairs, f"{seed} {one.name}")
    return in_turns([[p for p in pairs if shared_bin(p.shared_m2) == k] for k in (3, 2, 1, 0)], count)


def foreign_pairs(sets, count, seed):
    """Pairs of real scans of two places, in turns from every two places."""
    groups = {}
    for one, other in itertools.combinations([s for s in sets if s.real], 2):
        if one.place != other.place:
            group = groups.setdefault((one.place, other.place), [])
            group.extend(Pair(one, a, b, name=f"foreign: {one.name}/{a.name} {other.name}/{b.name}")
                         for a in one.scans for b in other.scans)
    return in_turns([shuffled(group, f"{seed} {key}") for key, group in groups.items()], count)


def reachable(one):
    """The scans of a set that hang together by surface enough, by their numbers: the largest such group."""
    pairs = itertools.combinations(range(len(one.scans)), 2)
    return verdicts.largest_group(len(one.scans), [
        (a, b) for a, b in pairs if clouds.shared_m2(one.scans[a], one.scans[b], clouds.FINE_M) >= REACHABLE_M2])
