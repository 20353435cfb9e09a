// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/registration_report.h"

#include <algorithm>

#include "limen/base/drawn_steps.h"

namespace limen {
namespace {

/// Where most of the points are, about the local origin: a few echoes of the house across the street, seen
/// through a window, do not move it.
struct InnerBox {
  Vector3d middle = Vector3d::Zero();  ///< of the central 90 % along each axis
  Vector3d low = Vector3d::Zero();     ///< of the central 98 %
  Vector3d high = Vector3d::Zero();
};

InnerBox inner_box_of(const std::vector<Vector3d>& points) {
  InnerBox box;
  if (points.empty()) return box;
  constexpr std::size_t kEnough = 20000;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for_drawn_steps(points.size(), kEnough, [&](std::size_t i) { values.push_back(points[i][axis]); });
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    const std::size_t cut = values.size() / 20;
    const std::size_t few = values.size() / 100;
    box.middle[axis] = 0.5 * (values[cut] + values[last - cut]);
    box.low[axis] = values[few];
    box.high[axis] = values[last - few];
  }
  return box;
}

}  // namespace

InputSummary summarise(const std::string& path, const Scan& scan) {
  const Extent extent = extent_of(scan.points);
  InputSummary summary;
  summary.path = path;
  summary.points = scan.size();
  summary.low = scan.local_origin + extent.low;
  summary.high = scan.local_origin + extent.high;
  const InnerBox inner = inner_box_of(scan.points);
  summary.middle = scan.local_origin + inner.middle;
  summary.inner_low = scan.local_origin + inner.low;
  summary.inner_high = scan.local_origin + inner.high;
  summary.centre_known = scan.centre_known();
  if (scan.centre_known()) summary.place.source = scan.mobile() ? PlaceSource::per_point : scan.centre_source;
  if (scan.centres.size() == 1) summary.place.centre = scan.local_origin + scan.centres.front();
  summary.mobile = scan.mobile();
  return summary;
}

InputSummary summarise(const std::string& path, const BimModel& model) {
  std::vector<Vector3d> corners;
  for (const BimFace& face : model.faces) {
    for (const Vector2d& p : face.outline.outer) corners.push_back(face.frame.to_space(p));
  }
  const Extent extent = extent_of(corners);
  InputSummary summary;
  summary.path = path;
  summary.kind = "model";
  summary.elements = model.elements.size();
  summary.low = model.local_origin + extent.low;
  summary.high = model.local_origin + extent.high;
  summary.middle = 0.5 * (summary.low + summary.high);
  summary.inner_low = summary.low;
  summary.inner_high = summary.high;
  return summary;
}

Matrix4d file_matrix(const RegistrationReport& report, const Rigid3& target_from_source) {
  // Of a model whose file tells its unit the world is metres already.
  const double source_unit = report.source.metres_per_unit;
  const double target_unit = report.target.metres_per_unit;
  Matrix4d matrix = to_matrix(target_from_source);
  if (source_unit != target_unit) matrix.topLeftCorner<3, 3>() *= source_unit / target_unit;
  matrix.topRightCorner<3, 1>() /= target_unit;
  return matrix;
}

bool has_offset(const RegistrationReport& report) {
  return !report.source.offset_applied.isZero(0.0) || !report.target.offset_applied.isZero(0.0);
}

Matrix4d raw_matrix(const RegistrationReport& report, const Rigid3& target_from_source) {
  // With units u and offsets o of both files: u_t raw_t + o_t = R (u_s raw_s + o_s) + t. The large numbers
  // meet here, in one place: a double has them to 1e-9 m.
  Matrix4d matrix = file_matrix(report, target_from_source);
  matrix.topRightCorner<3, 1>() =
      (target_from_source * report.source.offset_applied - report.target.offset_applied) /
      report.target.metres_per_unit;
  return matrix;
}

}  // namespace limen
