# SPDX-FileCopyrightText: The limen authors
# SPDX-License-Identifier: Apache-2.0
"""Registers two clouds with Open3D: open3d_pair.py ransac|fgr|icp SOURCE TARGET OUT [START] [--voxel-m 0.05]

Writes four rows of four numbers, target from source. icp wants START, a file of such rows. Status 3 where fewer
than three tenths of the source's points find a partner in the end.
"""
import argparse
import sys

import numpy as np
import open3d as o3d

registration = o3d.pipelines.registration


def read(path, voxel):
    cloud = o3d.io.read_point_cloud(path)
    middle = np.round(cloud.get_center())  # national grids: a millimetre must survive
    cloud.translate(-middle)
    thin = cloud.voxel_down_sample(voxel)
    thin.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2.0 * voxel, 30))
    return thin, middle


def features(cloud, voxel):
    return registration.compute_fpfh_feature(cloud, o3d.geometry.KDTreeSearchParamHybrid(5.0 * voxel, 100))


def by_ransac(source, target, voxel):
    reach = 1.5 * voxel
    return registration.registration_ransac_based_on_feature_matching(
        source, target, features(source, voxel), features(target, voxel), True, reach,
        registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(reach)],
        registration.RANSACConvergenceCriteria(4000000, 0.999)).transformation


def by_fgr(source, target, voxel):
    option = registration.FastGlobalRegistrationOption(maximum_correspondence_distance=0.5 * voxel)
    return registration.registration_fgr_based_on_feature_matching(
        source, target, features(source, voxel), features(target, voxel), option).transformation


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("method", choices=("ransac", "fgr", "icp"))
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("out")
    parser.add_argument("start", nargs="?")
    parser.add_argument("--voxel-m", type=float, default=0.05)
    options = parser.parse_args()
    source, from_middle = read(options.source, options.voxel_m)
    target, to_middle = read(options.target, options.voxel_m)
    to_local = np.eye(4)
    to_local[:3, 3] = -to_middle
    from_local = np.eye(4)
    from_local[:3, 3] = from_middle
    if options.method == "icp":
        if not options.start:
            sys.exit("open3d_pair: icp wants a start")
        start = to_local @ np.loadtxt(options.start) @ from_local
    else:
        start = (by_ransac if options.method == "ransac" else by_fgr)(source, target, options.voxel_m)
    reach = (10.0 if options.method == "icp" else 2.0) * options.voxel_m
    fine = start
    for distance in (reach, 2.0 * options.voxel_m, options.voxel_m):
        found = registration.registration_icp(source, target, distance, fine,
                                              registration.TransformationEstimationPointToPlane())
        fine = found.transformation
    np.savetxt(options.out, np.linalg.inv(to_local) @ fine @ np.linalg.inv(from_local), fmt="%.12g")
    return 0 if found.fitness >= 0.3 else 3


if __name__ == "__main__":
    sys.exit(main())
