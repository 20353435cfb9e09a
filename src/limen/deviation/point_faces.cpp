// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/point_faces.h"

#include <cmath>
#include <limits>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/extract/cells/point_normals.h"

namespace limen {
namespace {

constexpr double kFinestCubeM = 0.02;
constexpr double kMaxThicknessM = 0.015;  // root mean square, of the points of a small piece of surface
constexpr std::size_t kPointsPerPiece = 8192;

}  // namespace

ScanInModel::ScanInModel(const Scan& scan, const Rigid3& model_from_scan)
    : points(scan.size()), centres(scan.centres.size()) {
  parallel_for(points.size(), kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = model_from_scan * scan.points[i];
  });
  for (std::size_t i = 0; i < centres.size(); ++i) centres[i] = model_from_scan * scan.centres[i];
}

PointFaces lay_on_faces(const ScanInModel& scan, const FaceIndex& index, const DeviationOptions& options,
                        Monitor& monitor) {
  const std::size_t count = scan.points.size();
  PointFaces laid;
  laid.face.assign(count, -1);
  laid.distance_m.assign(count, std::numeric_limits<float>::quiet_NaN());
  laid.far.assign(count, 0);
  laid.gap_m.assign(count / PointFaces::kGapStride + 1, std::numeric_limits<float>::quiet_NaN());
  const MortonOrder sorted = morton_order(scan.points, kFinestCubeM);
  monitor.throw_if_cancelled();
  const PointNormals normals(sorted, kMaxThicknessM);
  monitor.throw_if_cancelled();
  const double min_cosine = std::cos(radians(options.max_angle_deg));
  const auto lay = [&](std::uint32_t k) {
    const std::size_t i = sorted.index(k);
    FaceQuery query;
    query.x = scan.points[i];
    FaceHit hit;
    Vector3d normal = Vector3d::Zero();  // lives as long as the query that points to it
    if (!normals.rough(k)) {
      query.min_cosine = min_cosine;
      query.oriented = scan.centre_known();
      if (query.oriented) query.seen_from = &scan.centre(i);
      if (const Vector3d* known = normals.at(k)) {
        const bool away = query.oriented && known->dot(scan.centre(i) - query.x) < 0.0;
        normal = away ? Vector3d(-*known) : *known;
        query.normal = &normal;
      }
      hit = index.nearest(query);
    }
    if (hit.face >= 0) {
      laid.face[i] = hit.face;
      laid.distance_m[i] = static_cast<float>(hit.signed_m);
      if (i % PointFaces::kGapStride != 0) return;
      query.but_not = &index.face(hit.face).plane;
      const FaceHit other = index.nearest(query);
      if (other.face >= 0)
        laid.gap_m[i / PointFaces::kGapStride] = static_cast<float>(std::abs(other.signed_m - hit.signed_m));
      return;
    }
    FaceQuery any;
    any.x = query.x;
    laid.far[i] = index.nearest(any).face < 0 ? 1 : 0;
  };
  parallel_for(count, kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) lay(static_cast<std::uint32_t>(k));
  });
  return laid;
}

}  // namespace limen
