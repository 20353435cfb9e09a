// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/section_svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/geometry/spread_evenly.h"

namespace limen {
namespace {

constexpr double kSectionM = 0.3;                 // points within half of it of the cut are drawn
constexpr std::size_t kMostSectionPoints = 5000;  // per scan
constexpr double kSectionWidthPx = 720.0;
constexpr double kSectionHeightPx = 460.0;
constexpr double kBarPx = 34.0;  // below the picture: scale bar and key
constexpr double kTitlePx = 26.0;

/// Colours follow the page where the picture is in one; by themselves they suit paper.
constexpr const char* kSectionStyle =
    ".ls-paper{fill:var(--paper,#fff)}.ls-text{fill:var(--ink,#1d2a35);font:500 13px system-ui,sans-serif}"
    ".ls-soft{fill:var(--soft,#5c6b77);font:12px system-ui,sans-serif}"
    ".ls-t{stroke:var(--target,#1f6fb4)}.ls-s{stroke:var(--source,#d9730d)}"
    ".ls-p{fill:none;stroke-linecap:round;stroke-width:1.5;opacity:.55}"
    ".ls-w{fill:none;stroke-width:2;stroke-linecap:round}.ls-s.ls-w{stroke-dasharray:7 5}"
    ".ls-b{stroke:var(--ink,#1d2a35);stroke-width:1.5;fill:none}";

/// Horizontal and vertical axis of the picture and the direction looked along, as axes of the view.
struct Axes {
  Eigen::Index across;
  Eigen::Index up;
  Eigen::Index depth;
};

Axes axes_of(SectionSide side) {
  if (side == SectionSide::top) return {0, 1, 2};
  return side == SectionSide::front ? Axes{0, 2, 1} : Axes{1, 2, 0};
}

/// Paper coordinates of one section.
class Paper {
 public:
  Paper(const SceneView& view, SectionSide side) : axes_(axes_of(side)), low_(view.low), high_(view.high) {
    const double across = std::max(0.1, high_[axes_.across] - low_[axes_.across]);
    const double up = std::max(0.1, high_[axes_.up] - low_[axes_.up]);
    px_per_m_ = std::min(kSectionWidthPx / across, kSectionHeightPx / up);
    height_ = std::ceil(up * px_per_m_);
    left_ = 0.5 * (kSectionWidthPx - across * px_per_m_);
  }

  [[nodiscard]] Vector2d place(const Vector3d& x_in_view) const {
    return {left_ + (x_in_view[axes_.across] - low_[axes_.across]) * px_per_m_,
            kTitlePx + (high_[axes_.up] - x_in_view[axes_.up]) * px_per_m_};
  }
  [[nodiscard]] bool shows(const Vector2d& p) const {
    return p.x() >= 0 && p.x() <= kSectionWidthPx && p.y() >= kTitlePx && p.y() <= kTitlePx + height_;
  }
  [[nodiscard]] double px_per_m() const { return px_per_m_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] const Axes& axes() const { return axes_; }

 private:
  Axes axes_;
  Vector3d low_;
  Vector3d high_;
  double px_per_m_ = 1.0;
  double height_ = 0.0;
  double left_ = 0.0;
};

/// Dots as one path in tenths of a pixel: moves relative to the last, each with a line of no length.
std::string dots(const std::vector<Vector2d>& places, const char* colour) {
  if (places.empty()) return {};
  std::string path =
      fmt::format("<path class=\"ls-p {}\" transform=\"scale(.1)\" style=\"stroke-width:15\" d=\"", colour);
  long x = 0;
  long y = 0;
  for (const Vector2d& place : places) {
    const long to_x = std::lround(10.0 * place.x());
    const long to_y = std::lround(10.0 * place.y());
    path += fmt::format("m{} {}h0", to_x - x, to_y - y);
    x = to_x;
    y = to_y;
  }
  return path + "\"/>\n";
}

/// Places on paper of a side's points near the cut, evenly chosen where there are too many.
std::vector<Vector2d> near_cut(const SceneSide& side, const Rigid3& view_from_side, const Paper& paper,
                               double cut) {
  std::vector<Vector2d> places;
  for (const Vector3d& point : side.points) {
    const Vector3d x = view_from_side * point;
    if (std::abs(x[paper.axes().depth] - cut) > 0.5 * kSectionM) continue;
    const Vector2d place = paper.place(x);
    if (paper.shows(place)) places.push_back(place);
  }
  if (places.size() <= kMostSectionPoints) return places;
  std::vector<Vector3d> flat;
  for (const Vector2d& place : places) flat.push_back({0.01 * place.x(), 0.01 * place.y(), 0.0});
  std::vector<Vector2d> kept;
  for (const std::uint32_t i : spread_evenly(flat, kMostSectionPoints)) kept.push_back(places[i]);
  return kept;
}

std::string line(const Vector2d& a, const Vector2d& b) {
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x(), a.y(), b.x(), b.y());
}

/// Where the cut goes through the side's planes, or for lists of segments their projections.
std::string cut_lines(const SceneSide& side, const Rigid3& view_from_side, const Paper& paper, double cut,
                      const char* colour) {
  Vector3d normal = Vector3d::Zero();
  normal[paper.axes().depth] = 1.0;
  const Plane plane_in_side = transformed(inverse(view_from_side), Plane{normal, cut});
  std::vector<Segment> pieces;
  for (const PlanarPolygon& polygon : side.pictured.features.planes) {
    const std::vector<Segment> cuts = cut_polygon(polygon, plane_in_side);
    pieces.insert(pieces.end(), cuts.begin(), cuts.end());
  }
  if (side.points.empty() && side.faces.empty()) pieces = side.pictured.features.segments;
  std::string path;
  for (const Segment& piece : pieces) {
    if (piece.length() < 0.05) continue;
    const Vector2d a = paper.place(view_from_side * piece.a);
    const Vector2d b = paper.place(view_from_side * piece.b);
    const Vector2d middle = 0.5 * (a + b);
    if (paper.shows(a) || paper.shows(b) || paper.shows(middle)) path += line(a, b);
  }
  if (path.empty()) return {};
  return fmt::format("<path class=\"ls-w {}\" d=\"{}\"/>\n", colour, path);
}

/// 1, 2 or 5 times a power of ten metres, at most a quarter of the width.
double bar_metres(const Paper& paper) {
  const double most = 0.25 * kSectionWidthPx / paper.px_per_m();
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most) return factor * power;
  }
  return power;
}

std::string foot(const Paper& paper) {
  const double y = kTitlePx + paper.height() + 20.0;
  const double metres = bar_metres(paper);
  const double end = 12.0 + metres * paper.px_per_m();
  std::string text =
      fmt::format("<path class=\"ls-b\" d=\"M12 {0:.1f}v-6M12 {0:.1f}H{1:.1f}v-6\"/>\n", y, end);
  text +=
      fmt::format("<text class=\"ls-soft\" x=\"{:.1f}\" y=\"{:.1f}\">{:g} m</text>\n", end + 7.0, y, metres);
  const auto entry = [&](double x, const char* colour, const char* name) {
    text += fmt::format("<path class=\"ls-w {}\" d=\"M{:.1f} {:.1f}h28\"/>", colour, x, y - 4.0);
    text += fmt::format("<text class=\"ls-soft\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 34.0, y, name);
  };
  entry(kSectionWidthPx - 246.0, "ls-t", "target");
  entry(kSectionWidthPx - 122.0, "ls-s", "source");
  return text;
}

/// Which way the target's y axis points in the plan; on a national grid that is north.
std::string north_arrow(const ReportScene& scene, const SceneView& view) {
  constexpr double kGridM = 1e5;
  constexpr double kLongPx = 17.0;
  const Vector3d y_axis = view.view_from_target.col(1);
  const Vector2d along = Vector2d(y_axis.x(), -y_axis.y());
  if (along.norm() < 0.5) return {};  // the target's z axis does not point up
  const Vector2d d = along.normalized();
  const Vector2d across(-d.y(), d.x());
  const Vector2d middle(kSectionWidthPx - 34.0, kTitlePx + 34.0);
  const Vector2d tip = middle + kLongPx * d;
  const Vector2d left = tip - 9.0 * d + 4.5 * across;
  const Vector2d right = tip - 9.0 * d - 4.5 * across;
  const Vector2d name = middle + (kLongPx + 11.0) * d + Vector2d(-5.0, 5.0);
  const bool grid = scene.target.origin.cwiseAbs().maxCoeff() > kGridM;
  std::string text = fmt::format("<path class=\"ls-b\" d=\"{}{}{}\"/>\n", line(middle - kLongPx * d, tip),
                                 line(tip, left), line(tip, right));
  text += fmt::format("<text class=\"ls-soft\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", name.x(), name.y(),
                      grid ? "N" : "y");
  return text;
}

std::string title_of(SectionSide side, bool matched) {
  static constexpr const char* kTitles[] = {"Plan", "Section from the front", "Section from the side"};
  const std::string place = matched ? "" : ", side by side";
  return fmt::format("{}, {:.1f} m thick{}", kTitles[static_cast<int>(side)], kSectionM, place);
}

}  // namespace

const char* to_string(SectionSide side) {
  if (side == SectionSide::top) return "top";
  return side == SectionSide::front ? "front" : "side";
}

std::vector<Segment> cut_polygon(const PlanarPolygon& polygon, const Plane& cut) {
  const Vector3d along = polygon.plane.normal.cross(cut.normal);
  std::vector<Segment> pieces;
  if (along.norm() < 0.05) return pieces;
  for (const Polygon& part : polygon.parts) {
    std::vector<Vector3d> crossings;
    const auto cross_ring = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vector3d a = polygon.frame.to_space(ring[i]);
        const Vector3d b = polygon.frame.to_space(ring[(i + 1) % ring.size()]);
        const double before = cut.signed_distance(a);
        const double after = cut.signed_distance(b);
        if ((before < 0) == (after < 0)) continue;
        crossings.push_back(a + before / (before - after) * (b - a));
      }
    };
    cross_ring(part.outer);
    for (const Ring& hole : part.holes) cross_ring(hole);
    std::sort(crossings.begin(), crossings.end(),
              [&along](const Vector3d& a, const Vector3d& b) { return along.dot(a) < along.dot(b); });
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      pieces.push_back({crossings[i], crossings[i + 1]});
  }
  return pieces;
}

std::string section_svg(const ReportScene& scene, const SceneView& view, SectionSide side) {
  const Paper paper(view, side);
  const double cut = view.cut[paper.axes().depth];
  const Rigid3 view_from_target{view.view_from_target, Vector3d::Zero()};
  const Rigid3 view_from_source = view_from_target * view.target_from_source;
  const double height = kTitlePx + paper.height() + kBarPx;
  const std::string title = title_of(side, view.matched);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\" "
      "aria-label=\"{2}\">\n<style>{3}</style>\n<rect class=\"ls-paper\" width=\"{0:g}\" height=\"{1:g}\"/>\n"
      "<text class=\"ls-text\" x=\"12\" y=\"18\">{2}</text>\n",
      kSectionWidthPx, height, title, kSectionStyle);
  const std::string clip = fmt::format("ls-{}", to_string(side));
  svg += fmt::format(
      "<clipPath id=\"{}\"><rect y=\"{}\" width=\"{:g}\" height=\"{:g}\"/></clipPath>\n<g "
      "clip-path=\"url(#{})\">\n",
      clip, kTitlePx, kSectionWidthPx, paper.height(), clip);
  svg += dots(near_cut(scene.target, view_from_target, paper, cut), "ls-t");
  svg += dots(near_cut(scene.source, view_from_source, paper, cut), "ls-s");
  svg += cut_lines(scene.target, view_from_target, paper, cut, "ls-t");
  svg += cut_lines(scene.source, view_from_source, paper, cut, "ls-s");
  svg += "</g>\n";
  if (side == SectionSide::top) svg += north_arrow(scene, view);
  return svg + foot(paper) + "</svg>\n";
}

}  // namespace limen
