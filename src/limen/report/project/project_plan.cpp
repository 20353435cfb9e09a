// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/project/page_parts.h"
#include "limen/report/project/project_axes.h"

namespace limen {
namespace {

constexpr double kWidth = 1000.0;  // of a drawing, its own units
constexpr double kTallest = 760.0;
constexpr double kMarginM = 1.0;
constexpr double kReachM = 25.0;
constexpr double kPassReachM = 8.0;
constexpr double kEnlarged = 100.0;  // ellipses are drawn so much larger than they are

/// Which of the report's axes lead to the right and upwards in a drawing.
struct Facing {
  Eigen::Index right;
  Eigen::Index upwards;
};
constexpr Facing kPlan = {0, 1};
constexpr Facing kFront = {0, 2};
constexpr Facing kSide = {1, 2};

/// From the report's axes to a drawing.
class PlanSheet {
 public:
  PlanSheet(const ProjectResult& result, const Matrix3d& axes, const std::vector<PlanSpot>& spots,
            Facing facing)
      : axes_(axes), facing_(facing), low_(flat(spots.front().at)), high_(low_) {
    for (const PlanSpot& spot : spots) {
      add(spot.at);
      // What is seen far away, and across the street, does not make the drawing small.
      const double reach = result.scans[spot.scan].mobile ? kPassReachM : kReachM;
      for (const PlanPatch& patch : result.scans[spot.scan].patches) {
        for (const Vector3d& corner : corners(patch)) {
          if ((corner - spot.at).norm() < reach) add(corner);
        }
      }
    }
    low_ -= Vector2d::Constant(kMarginM);
    high_ += Vector2d::Constant(kMarginM);
    const Vector2d size = (high_ - low_).cwiseMax(1.0);
    scale_ = std::min(kWidth / size.x(), kTallest / size.y());
    const double spare = std::max(0.0, kWidth / scale_ - size.x());
    low_.x() -= 0.5 * spare;
    high_.x() += 0.5 * spare;
  }

  /// Of a place in the report's axes.
  [[nodiscard]] double x(const Vector3d& p) const { return (flat(p).x() - low_.x()) * scale_; }
  [[nodiscard]] double y(const Vector3d& p) const { return (high_.y() - flat(p).y()) * scale_; }
  [[nodiscard]] double height() const { return (high_.y() - low_.y()) * scale_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] const Matrix3d& axes() const { return axes_; }
  [[nodiscard]] bool is_plan() const { return facing_.upwards == 1; }

  /// Of a rectangle of the project's frame, the report's axes.
  [[nodiscard]] std::array<Vector3d, 4> corners(const PlanPatch& patch) const {
    const Vector3d middle = axes_ * patch.middle;
    const Vector3d along = axes_ * patch.along;
    const Vector3d across = axes_ * patch.across;
    return {middle - along - across, middle + along - across, middle + along + across,
            middle - along + across};
  }
  /// Half sizes of the box around a deviation of the frame.
  [[nodiscard]] Vector2d spread(const Vector3d& sigma) const {
    return flat((axes_.cwiseAbs2() * sigma.cwiseAbs2()).cwiseSqrt());
  }

 private:
  [[nodiscard]] Vector2d flat(const Vector3d& p) const { return {p[facing_.right], p[facing_.upwards]}; }
  void add(const Vector3d& p) {
    low_ = low_.cwiseMin(flat(p));
    high_ = high_.cwiseMax(flat(p));
  }

  Matrix3d axes_;
  Facing facing_;
  Vector2d low_;
  Vector2d high_;
  double scale_ = 1.0;
};

/// Walls from above; walls and slabs from aside.
std::string patches_of(const ProjectScan& scan, const PlanSheet& sheet) {
  std::string path;
  for (const PlanPatch& patch : scan.patches) {
    if (sheet.is_plan() && !patch.upright) continue;
    const std::array<Vector3d, 4> corners = sheet.corners(patch);
    if (sheet.is_plan()) {
      path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", sheet.x(corners[0]), sheet.y(corners[0]),
                          sheet.x(corners[1]), sheet.y(corners[1]));
      continue;
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
      path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", sheet.x(corners[k]), sheet.y(corners[k]));
    path += "Z";
  }
  return path.empty()
             ? ""
             : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", sheet.is_plan() ? "wall" : "slab", path);
}

std::string station_of(const ProjectScan& scan, const PlanSpot& spot, const PlanSheet& sheet) {
  const double x = sheet.x(spot.at);
  const double y = sheet.y(spot.at);
  const double enlarged = kEnlarged * sheet.scale();
  const Vector2d half = (enlarged * sheet.spread(scan.sigma.translation_m)).cwiseMin(60.0);
  std::string text = fmt::format("<g class=\"node {}\"><title>{}: {}, {}</title>", to_string(scan.state),
                                 escaped(shown_name(scan)), to_string(scan.state), escaped(scan.reason));
  text += fmt::format("<ellipse class=\"sigma\" cx=\"{:.1f}\" cy=\"{:.1f}\" rx=\"{:.1f}\" ry=\"{:.1f}\"/>", x,
                      y, half.x(), half.y());
  text += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>\n", x, y, x,
      y + 4.0, spot.scan);
  return text;
}

std::string links_of(const ProjectResult& result, const std::vector<PlanSpot>& floor,
                     const std::map<std::size_t, Vector3d>& places, const PlanSheet& sheet) {
  std::set<std::size_t> here;
  for (const PlanSpot& spot : floor) here.insert(spot.scan);
  std::string text;
  for (std::size_t k = 0; k < result.links.size(); ++k) {
    const ProjectLink& link = result.links[k];
    const auto from = places.find(static_cast<std::size_t>(link.source));
    const auto to = places.find(static_cast<std::size_t>(link.target));
    if (from == places.end() || to == places.end() || here.count(from->first) + here.count(to->first) == 0)
      continue;
    text += fmt::format(
        "<line class=\"link {0}\" x1=\"{1:.1f}\" y1=\"{2:.1f}\" x2=\"{3:.1f}\" y2=\"{4:.1f}\"><title>link "
        "{5}: {6} and {7}, {0}, {8:.1f} m2 agree</title></line>\n",
        to_string(link.solved.state), sheet.x(from->second), sheet.y(from->second), sheet.x(to->second),
        sheet.y(to->second), k, link.source, link.target, link.agreeing_m2);
  }
  return text;
}

/// Control and check points on a floor (from aside: on all), as triangles.
std::string points_of(const ProjectResult& result, const std::vector<PlanSpot>& floor,
                      const PlanSheet& sheet) {
  constexpr double kAsideM = 2.5;  // above and below the stations
  std::string text;
  for (const ProjectPoint& point : result.points) {
    if (!point.found || !point.given) continue;
    const Vector3d at = sheet.axes() * *point.found;
    if (sheet.is_plan() &&
        (at.z() < floor.front().at.z() - kAsideM || at.z() > floor.back().at.z() + kAsideM))
      continue;
    const char* state = point.state == PointState::used       ? "verified"
                        : point.state == PointState::left_out ? "rejected"
                                                              : "bridge";
    text += fmt::format(
        "<g class=\"node {}\"><title>{} point {}: {}, residual {:.1f} mm</title><path d=\"M{:.1f} {:.1f}l7 "
        "12h-14z\"/></g>\n",
        state, to_string(point.role), escaped(point.name), to_string(point.state),
        1e3 * point.test.residual.norm(), sheet.x(at), sheet.y(at) - 8.0);
  }
  return text;
}

/// A bar of a round length.
std::string bar_of(const PlanSheet& sheet) {
  double metres = 1.0;
  for (const double tried : {2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (tried * sheet.scale() < 0.3 * kWidth) metres = tried;
  }
  const double y = sheet.height() - 14.0;
  return fmt::format(
      "<path class=\"bar\" d=\"M14 {0:.1f}h{1:.1f}\"/><text class=\"scale\" x=\"14\" y=\"{2:.1f}\">{3:.0f} "
      "m</text>\n",
      y, metres * sheet.scale(), y - 6.0, metres);
}

/// Where the frame's y axis points, which is north on a map.
std::string north_of(const PlanSheet& sheet) {
  const Vector3d way = sheet.axes() * Vector3d::UnitY();
  const double turn = degrees(std::atan2(way.x(), way.y()));
  return fmt::format(
      "<g class=\"north\" transform=\"translate({:.0f} 34) rotate({:.1f})\"><path d=\"M0 18V-14M-5 -5L0 "
      "-14L5 -5\"/><text y=\"-18\">N</text></g>\n",
      kWidth - 34.0, turn);
}

/// One drawing of `spots`, all of which stand in `places`.
std::string drawing(const ProjectResult& result, const Matrix3d& axes, const std::vector<PlanSpot>& spots,
                    const std::map<std::size_t, Vector3d>& places, Facing facing, const std::string& name,
                    bool on_map) {
  const PlanSheet sheet(result, axes, spots, facing);
  std::string text = fmt::format(
      "<figure class=\"keep\"><figcaption>{0}</figcaption><svg class=\"plan\" viewBox=\"0 0 {1:.0f} "
      "{2:.0f}\" "
      "role=\"img\" aria-label=\"{0}\">\n",
      name, kWidth, sheet.height());
  for (const PlanSpot& spot : spots) text += patches_of(result.scans[spot.scan], sheet);
  text += links_of(result, spots, places, sheet);
  for (const PlanSpot& spot : spots) text += station_of(result.scans[spot.scan], spot, sheet);
  text += points_of(result, spots, sheet) + bar_of(sheet);
  if (on_map && sheet.is_plan()) text += north_of(sheet);
  return text + "</svg></figure>\n";
}

}  // namespace

std::string project_plan(const ProjectResult& result, bool on_map) {
  const Matrix3d axes = project_axes(result);
  const std::vector<std::vector<PlanSpot>> floors = project_floors(result, axes);
  std::vector<PlanSpot> all;
  std::map<std::size_t, Vector3d> places;
  for (const std::vector<PlanSpot>& floor : floors) {
    all.insert(all.end(), floor.begin(), floor.end());
    for (const PlanSpot& spot : floor) places[spot.scan] = spot.at;
  }
  std::string text;
  for (std::size_t k = 0; k < floors.size(); ++k) {
    const std::string name = floors.size() == 1 ? "Plan"
                                                : fmt::format("Plan of floor {}, stations at {:.1f} m", k + 1,
                                                              floors[k].front().at.z());
    text += drawing(result, axes, floors[k], places, kPlan, name, on_map);
  }
  if (all.empty()) return text;
  return text + drawing(result, axes, all, places, kFront, "Section from the front", on_map) +
         drawing(result, axes, all, places, kSide, "Section from the side", on_map);
}

}  // namespace limen
