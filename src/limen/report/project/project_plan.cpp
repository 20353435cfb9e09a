// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"

namespace limen {
namespace {

constexpr double kFloorGapM = 1.8;  // stations further apart in height stand on different floors
constexpr double kWidth = 1000.0;   // of a drawing, its own units
constexpr double kMarginM = 2.0;
constexpr double kEnlarged = 100.0;  // ellipses are drawn so much larger than they are

/// A station in the plan.
struct Spot {
  std::size_t scan = 0;
  Vector3d at = Vector3d::Zero();
};

std::vector<Spot> spots_of(const ProjectResult& result) {
  std::vector<Spot> spots;
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const ProjectScan& scan = result.scans[k];
    if (scan.component != 0 || !scan.frame_from_scan || scan.model) continue;
    spots.push_back({k, scan.stations.empty() ? scan.sigma.centre : scan.stations.front()});
  }
  std::stable_sort(spots.begin(), spots.end(),
                   [](const Spot& a, const Spot& b) { return a.at.z() < b.at.z(); });
  return spots;
}

std::vector<std::vector<Spot>> by_floor(const std::vector<Spot>& spots) {
  std::vector<std::vector<Spot>> floors;
  for (const Spot& spot : spots) {
    if (floors.empty() || spot.at.z() - floors.back().back().at.z() > kFloorGapM) floors.emplace_back();
    floors.back().push_back(spot);
  }
  return floors;
}

/// From metres to the drawing.
class Sheet {
 public:
  Sheet(const ProjectResult& result, const std::vector<Spot>& spots) {
    Vector2d low = spots.front().at.head<2>();
    Vector2d high = low;
    const auto add = [&](const Vector3d& p) {
      low = low.cwiseMin(p.head<2>());
      high = high.cwiseMax(p.head<2>());
    };
    for (const Spot& spot : spots) {
      add(spot.at);
      // What a street pass sees far away does not make the plan small.
      constexpr double kReachM = 25.0;
      for (const PlanWall& wall : result.scans[spot.scan].walls) {
        if ((wall.from - spot.at).norm() < kReachM) add(wall.from);
        if ((wall.to - spot.at).norm() < kReachM) add(wall.to);
      }
    }
    low_ = low - Vector2d::Constant(kMarginM);
    high_ = high + Vector2d::Constant(kMarginM);
    scale_ = kWidth / std::max(1.0, high_.x() - low_.x());
  }
  [[nodiscard]] double x(const Vector3d& p) const { return (p.x() - low_.x()) * scale_; }
  [[nodiscard]] double y(const Vector3d& p) const { return (high_.y() - p.y()) * scale_; }
  [[nodiscard]] double height() const { return (high_.y() - low_.y()) * scale_; }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  Vector2d low_;
  Vector2d high_;
  double scale_ = 1.0;
};

std::string walls_of(const ProjectScan& scan, const Sheet& sheet) {
  std::string path;
  for (const PlanWall& wall : scan.walls)
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", sheet.x(wall.from), sheet.y(wall.from),
                        sheet.x(wall.to), sheet.y(wall.to));
  return path.empty() ? "" : fmt::format("<path class=\"wall\" d=\"{}\"/>\n", path);
}

std::string station_of(const ProjectScan& scan, const Spot& spot, const Sheet& sheet) {
  const double x = sheet.x(spot.at);
  const double y = sheet.y(spot.at);
  const double enlarged = kEnlarged * sheet.scale();
  const double a = std::min(60.0, enlarged * scan.sigma.translation_m.x());
  const double b = std::min(60.0, enlarged * scan.sigma.translation_m.y());
  std::string text = fmt::format("<g class=\"node {}\"><title>{}: {}, {}</title>", to_string(scan.state),
                                 escaped(scan.file), to_string(scan.state), escaped(scan.reason));
  text += fmt::format("<ellipse class=\"sigma\" cx=\"{:.1f}\" cy=\"{:.1f}\" rx=\"{:.1f}\" ry=\"{:.1f}\"/>", x,
                      y, a, b);
  text += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text></g>\n", x, y, x,
      y + 4.0, spot.scan);
  return text;
}

std::string links_of(const ProjectResult& result, const std::vector<Spot>& floor,
                     const std::vector<Spot>& all, const Sheet& sheet) {
  std::set<std::size_t> here;
  for (const Spot& spot : floor) here.insert(spot.scan);
  const auto place = [&](int scan) -> const Spot* {
    for (const Spot& spot : all) {
      if (spot.scan == static_cast<std::size_t>(scan)) return &spot;
    }
    return nullptr;
  };
  std::string text;
  for (std::size_t k = 0; k < result.links.size(); ++k) {
    const ProjectLink& link = result.links[k];
    const Spot* from = place(link.source);
    const Spot* to = place(link.target);
    if (from == nullptr || to == nullptr || (here.count(from->scan) == 0 && here.count(to->scan) == 0))
      continue;
    text += fmt::format(
        "<line class=\"link {0}\" x1=\"{1:.1f}\" y1=\"{2:.1f}\" x2=\"{3:.1f}\" y2=\"{4:.1f}\"><title>link "
        "{5}: "
        "{6} and {7}, {0}, {8:.1f} m2 agree</title></line>\n",
        to_string(link.solved.state), sheet.x(from->at), sheet.y(from->at), sheet.x(to->at), sheet.y(to->at),
        k, link.source, link.target, link.agreeing_m2);
  }
  return text;
}

/// Control and check points on a floor, as triangles.
std::string points_of(const ProjectResult& result, const std::vector<Spot>& floor, const Sheet& sheet) {
  constexpr double kReachM = 2.5;  // above and below the stations
  std::string text;
  for (const ProjectPoint& point : result.points) {
    if (!point.found || !point.given) continue;
    if (point.found->z() < floor.front().at.z() - kReachM || point.found->z() > floor.back().at.z() + kReachM)
      continue;
    const char* state = point.state == PointState::used       ? "verified"
                        : point.state == PointState::left_out ? "rejected"
                                                              : "bridge";
    text += fmt::format(
        "<g class=\"node {}\"><title>{} point {}: {}, misses by {:.1f} mm</title><path d=\"M{:.1f} {:.1f}l7 "
        "12h-14z\"/>"
        "</g>\n",
        state, to_string(point.role), escaped(point.name), to_string(point.state),
        1e3 * point.test.residual.norm(), sheet.x(*point.found), sheet.y(*point.found) - 8.0);
  }
  return text;
}

/// A bar of a round length.
std::string bar_of(const Sheet& sheet) {
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

}  // namespace

std::string project_plan(const ProjectResult& result) {
  const std::vector<Spot> spots = spots_of(result);
  const std::vector<std::vector<Spot>> floors = by_floor(spots);
  std::string text;
  for (std::size_t k = 0; k < floors.size(); ++k) {
    const Sheet sheet(result, floors[k]);
    if (floors.size() > 1)
      text += fmt::format("<h3>Floor {}, stations at {:.1f} m</h3>\n", k + 1, floors[k].front().at.z());
    text += fmt::format(
        "<svg class=\"plan\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"Plan of floor {}\">\n",
        kWidth, sheet.height(), k + 1);
    for (const Spot& spot : floors[k]) text += walls_of(result.scans[spot.scan], sheet);
    text += links_of(result, floors[k], spots, sheet);
    for (const Spot& spot : floors[k]) text += station_of(result.scans[spot.scan], spot, sheet);
    text += points_of(result, floors[k], sheet) + bar_of(sheet) + "</svg>\n";
  }
  return text;
}

}  // namespace limen
