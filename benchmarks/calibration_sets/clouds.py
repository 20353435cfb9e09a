# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""The points of the files that labelled sets hold, and the surface that two scans share under a pose. Needs numpy."""
import numpy

from . import poses

VOXEL_M = 0.2
FINE_M = 0.1  # tells the two faces of a wall from one another
PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
             "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
             "double": "f8", "float64": "f8"}


def header(file, last):
    lines = []
    while not lines or not lines[-1].startswith(last):
        line = file.readline()
        if not line:
            raise ValueError(f"{file.name}: the header does not end")
        lines.append(line.decode("ascii", "replace").strip())
    return lines


def ply_points(path):
    """Points of a binary PLY whose first element is its vertices, with the offset of a line 'comment pivot x y z'."""
    with open(path, "rb") as file:
        lines = header(file, "end_header")
        if "format ascii 1.0" in lines:
            raise ValueError(f"{path}: an ascii PLY is not read here")
        order = ">" if "format binary_big_endian 1.0" in lines else "<"
        first = next(i for i, line in enumerate(lines) if line.startswith("element"))
        columns = []
        for line in lines[first + 1:]:
            if not line.startswith("property"):
                break
            columns.append((line.split()[2], order + PLY_TYPES[line.split()[1]]))
        count = int(lines[first].split()[2])
        data = numpy.frombuffer(file.read(count * numpy.dtype(columns).itemsize), dtype=columns)
    pivot = next((line.split()[2:5] for line in lines if line.startswith("comment pivot")), (0, 0, 0))
    return xyz(data) + numpy.array([float(x) for x in pivot])


def pcd_points(path):
    with open(path, "rb") as file:
        lines = {line.split()[0]: line.split()[1:] for line in header(file, "DATA") if line}
        if lines["DATA"] != ["binary"]:
            raise ValueError(f"{path}: only a plain binary PCD is read here")
        kinds = {"F": "f", "I": "i", "U": "u"}
        columns = [(name, kinds[kind] + size, (int(count),)) if int(count) > 1 else (name, kinds[kind] + size)
                   for name, kind, size, count in zip(lines["FIELDS"], lines["TYPE"], lines["SIZE"], lines["COUNT"])]
        count = int(lines["POINTS"][0])
        data = numpy.frombuffer(file.read(count * numpy.dtype(columns).itemsize), dtype=columns)
    return xyz(data)


def xyz(data):
    points = numpy.stack([data[name].astype(float) for name in "xyz"], axis=1)
    return points[numpy.isfinite(points).all(axis=1)]


def points_of(path):
    return pcd_points(path) if str(path).endswith(".pcd") else ply_points(path)


def write_ply(path, points):
    part = path.with_suffix(".part")
    with open(part, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\n".encode("ascii"))
        file.write(numpy.ascontiguousarray(points, dtype="<f4").tobytes())
    part.replace(path)


def voxels(points, reference_from_scan, size_m):
    """Numbers of the occupied cubes, sorted."""
    pose = numpy.array(reference_from_scan)
    cells = numpy.floor((points @ pose[:3, :3].T + pose[:3, 3]) / size_m).astype(numpy.int64) + (1 << 20)
    return numpy.unique((cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2])


def measure(scans):
    """Gives each scan of a set its middle and its cubes of both sizes in the frame of the first scan."""
    for scan in scans:
        points = points_of(scan.path)
        scan.middle = [float(x) for x in numpy.median(points, axis=0)]
        pose = poses.relative(scans[0].world_from_scan, scan.world_from_scan)
        scan.voxels = {size_m: voxels(points, pose, size_m) for size_m in (VOXEL_M, FINE_M)}


def shared_m2(a, b, size_m=VOXEL_M):
    return len(numpy.intersect1d(a.voxels[size_m], b.voxels[size_m], assume_unique=True)) * size_m ** 2
