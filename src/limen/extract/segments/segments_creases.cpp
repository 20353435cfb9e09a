// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_creases.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/extract/segments/segments_borders.h"

namespace limen {
namespace {

constexpr double kStep_m = 0.01;
constexpr double kCreaseMargin_m = 0.2;  // rows of points may end this far from an edge
constexpr double kAside_m = 0.006;       // slack of that
constexpr double kAmbiguous = 1.2;  // how near to a plane points may be its own, in units of the threshold
constexpr double kBeyondStrays_m = 0.015;
constexpr double kNear = 1.6;  // how far from a line points may begin, in units of their usual shortfall,
constexpr double kAlongRows = 0.6;  // and more where rows run along the line
constexpr double kFilled = 0.4;     // share of the bins along a line that must hold points
constexpr double kEndShare = 0.5;   // of a crease along which one of its planes must end

/// The box of a plane's image in space.
struct Box3 {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
};

Box3 box_in_space(const PlaneImage& image) {
  Box3 box;
  for (const double u : {image.box().low.x(), image.box().high.x()}) {
    for (const double v : {image.box().low.y(), image.box().high.y()}) {
      const Vector3d x = image.frame().to_space({u, v});
      box.low = box.low.cwiseMin(x);
      box.high = box.high.cwiseMax(x);
    }
  }
  box.low.array() -= kCreaseMargin_m;
  box.high.array() += kCreaseMargin_m;
  return box;
}

bool overlap(const Box3& a, const Box3& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// A line in space, bounded.
struct Line3 {
  Vector3d origin = Vector3d::Zero();
  Vector3d along = Vector3d::UnitX();
  double begin_m = -1e9;
  double end_m = 1e9;
};

/// Cuts a line down to the rectangle of an image.
void clip(const PlaneImage& image, Line3& line) {
  const Vector2d origin = image.frame().to_plane(line.origin);
  const Vector2d along(image.frame().u.dot(line.along), image.frame().v.dot(line.along));
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const double low = image.box().low[axis] - kCreaseMargin_m - origin[axis];
    const double high = image.box().high[axis] + kCreaseMargin_m - origin[axis];
    if (std::abs(along[axis]) < 1e-9) {
      if (low > 0.0 || high < 0.0) line.end_m = line.begin_m;
      continue;
    }
    const double a = low / along[axis];
    const double b = high / along[axis];
    line.begin_m = std::max(line.begin_m, std::min(a, b));
    line.end_m = std::min(line.end_m, std::max(a, b));
  }
}

std::optional<Line3> meeting_line(const Plane& a, const Plane& b, const Vector3d& near, double least_sine) {
  const Vector3d across = a.normal.cross(b.normal);
  const double sine = across.norm();
  if (sine < least_sine) return std::nullopt;
  Line3 line;
  line.along = across / sine;
  // The point of both planes nearest to `near`.
  const double da = a.signed_distance(near);
  const double db = b.signed_distance(near);
  const double cosine = a.normal.dot(b.normal);
  const double scale = 1.0 / (sine * sine);
  line.origin = near - scale * (da - db * cosine) * a.normal - scale * (db - da * cosine) * b.normal;
  return line;
}

/// How a plane lies about a place of a line in it.
struct CreaseSupport {
  bool near = false;  ///< it has points there
  bool ends = false;  ///< on one side only
};

struct CreaseInterval {
  double begin_m = 1e300;
  double end_m = -1e300;
  [[nodiscard]] bool empty() const { return end_m <= begin_m; }
};

/// How far from a line the points of a surface that reaches it may begin. Where rows of points run along the
/// line they all begin at one distance, anything up to the distance between two rows.
double farthest(const Approach& approach) {
  const double same = std::clamp(1.0 - approach.spread_m / std::max(1e-6, approach.shortfall_m), 0.0, 1.0);
  return (kNear + kAlongRows * same) * approach.shortfall_m + kAside_m;
}

/// Looks at a plane along a line in it.
class LineView {
 public:
  /// Points of the plane nearer to the line than `ambiguous_m` may be the other plane's.
  LineView(const PlaneImage& image, const Line3& line, double ambiguous_m)
      : image_(image),
        ambiguous_m_(ambiguous_m),
        origin_(image.frame().to_plane(line.origin)),
        along_(image.frame().u.dot(line.along), image.frame().v.dot(line.along)),
        across_(-along_.y(), along_.x()) {}

  [[nodiscard]] CreaseSupport at(double t) const {
    const Vector2d p = origin_ + t * along_;
    // A few strays of another surface on the line reach no further than their own discs; where rows of
    // points run along the line the next one may be further away than the points of a row are apart.
    const double reach = image_.reach_m(p);
    const double aside = reach + kBeyondStrays_m;
    const bool left = image_.covered(p + aside * across_);
    const bool right = image_.covered(p - aside * across_);
    CreaseSupport support;
    support.near = left || right || image_.covered(p + 2.0 * reach * across_) ||
                   image_.covered(p - 2.0 * reach * across_);
    support.ends = !left || !right;
    return support;
  }

  /// The part of a stretch of the line along which the plane's points come as near to it as they must where
  /// the surface does; empty where they do not.
  [[nodiscard]] CreaseInterval reached(double begin, double end) const {
    CreaseInterval reached;
    for (const double sign : {1.0, -1.0}) {
      Strip strip;
      strip.origin = origin_;
      strip.along = sign * along_;
      strip.begin_m = sign > 0.0 ? begin : -end;
      strip.end_m = sign > 0.0 ? end : -begin;
      strip.low_m = ambiguous_m_;
      const Approach approach = approach_of(image_, strip);
      if (approach.filled < kFilled || approach.nearest_m > farthest(approach)) continue;
      const double half = 0.5 * image_.spacing_m(strip.at(0.5 * (strip.begin_m + strip.end_m), 0.0));
      const double first = sign > 0.0 ? approach.first_m : -approach.last_m;
      const double last = sign > 0.0 ? approach.last_m : -approach.first_m;
      reached.begin_m = std::min(reached.begin_m, first - half);
      reached.end_m = std::max(reached.end_m, last + half);
    }
    return reached;
  }

  void add_ambiguous(double begin, double end, std::vector<std::uint32_t>& points) const {
    const Strip strip{origin_, along_, begin, end, -ambiguous_m_, ambiguous_m_};
    for (const FlatPoint& point : image_.points_in(strip)) points.push_back(point.point);
  }

 private:
  const PlaneImage& image_;
  double ambiguous_m_;
  Vector2d origin_;
  Vector2d along_;
  Vector2d across_;
};

/// What two planes have in common.
struct Meeting {
  std::vector<DetectedEdge> edges;
  std::vector<std::uint32_t> ambiguous;  ///< points
};

/// Finds the stretches of a line that both planes bear out.
class Meet {
 public:
  Meet(const LineView& a, const LineView& b, const Line3& line, const SegmentOptions& options)
      : a_(a), b_(b), line_(line), o_(options) {}

  void run(const DetectedEdge& like, Meeting& meeting) {
    for (double t = line_.begin_m; t <= line_.end_m; t += kStep_m) {
      const CreaseSupport of_a = a_.at(t);
      if (!of_a.near) continue;
      const CreaseSupport of_b = b_.at(t);
      if (!of_b.near) continue;
      if (steps_ > 0 && t - last_ > o_.join_gap_m) finish(like, meeting);
      if (steps_ == 0) begin_ = t;
      last_ = t;
      ++steps_;
      if (of_a.ends || of_b.ends) ++ends_;
    }
    finish(like, meeting);
  }

 private:
  void finish(const DetectedEdge& like, Meeting& meeting) {
    if (steps_ > 0 && last_ - begin_ >= o_.min_length_m && ends_ >= kEndShare * steps_) {
      const CreaseInterval of_a = a_.reached(begin_, last_);
      const CreaseInterval of_b = b_.reached(begin_, last_);
      // Where a plane does not reach the other, its points there are the other's.
      if (of_a.empty()) a_.add_ambiguous(begin_, last_, meeting.ambiguous);
      if (of_b.empty()) b_.add_ambiguous(begin_, last_, meeting.ambiguous);
      const double from = std::max({begin_, of_a.begin_m, of_b.begin_m});
      const double to = std::min({last_, of_a.end_m, of_b.end_m});
      if (to - from >= o_.min_length_m) {
        meeting.edges.push_back(like);
        meeting.edges.back().segment = {line_.origin + from * line_.along, line_.origin + to * line_.along};
      }
    }
    steps_ = 0;
    ends_ = 0;
  }

  const LineView& a_;
  const LineView& b_;
  const Line3& line_;
  const SegmentOptions& o_;
  double begin_ = 0.0;
  double last_ = -1e9;
  int steps_ = 0;
  int ends_ = 0;
};

/// How well the place of a plane is known, from its points.
double plane_sigma_m(const PlanarPolygon& plane) {
  return plane.rms_m / std::sqrt(std::max(1.0, static_cast<double>(plane.inliers)));
}

}  // namespace

Creases find_creases(const Features& features, const std::vector<std::unique_ptr<PlaneImage>>& images,
                     const SegmentOptions& options, std::size_t points) {
  const double least_sine = std::sin(radians(options.min_angle_deg));
  std::vector<Box3> boxes;
  for (const auto& image : images) boxes.push_back(box_in_space(*image));
  std::vector<Meeting> found(images.size());
  parallel_for(images.size(), 1, [&](std::size_t i, std::size_t /*end*/) {
    for (std::size_t j = i + 1; j < images.size(); ++j) {
      if (!overlap(boxes[i], boxes[j])) continue;
      const Vector3d near =
          0.5 * (boxes[i].low.cwiseMax(boxes[j].low) + boxes[i].high.cwiseMin(boxes[j].high));
      const PlanarPolygon& a = features.planes[i];
      const PlanarPolygon& b = features.planes[j];
      std::optional<Line3> line = meeting_line(a.plane, b.plane, near, least_sine);
      if (!line) continue;
      clip(*images[i], *line);
      clip(*images[j], *line);
      if (line->end_m - line->begin_m < options.min_length_m) continue;
      const double sine = a.plane.normal.cross(b.plane.normal).norm();
      DetectedEdge like;
      like.planes = {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)};
      like.sigma_m = std::hypot(plane_sigma_m(a), plane_sigma_m(b)) / sine;
      const double ambiguous_m = kAmbiguous * features.inlier_threshold_m / std::max(0.3, sine);
      const LineView view_a(*images[i], *line, ambiguous_m);
      const LineView view_b(*images[j], *line, ambiguous_m);
      Meet(view_a, view_b, *line, options).run(like, found[i]);
    }
  });
  Creases creases;
  creases.ambiguous.assign(points, 0);
  for (const Meeting& part : found) {
    creases.edges.insert(creases.edges.end(), part.edges.begin(), part.edges.end());
    for (const std::uint32_t point : part.ambiguous) creases.ambiguous[point] = 1;
  }
  return creases;
}

}  // namespace limen
