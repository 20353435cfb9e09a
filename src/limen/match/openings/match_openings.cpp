// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/match_openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "limen/geometry/linear.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/match/openings/outline_fit.h"

namespace limen {
namespace {

constexpr double kMaxSizeDifferenceM = 0.35;
constexpr double kMinGapM = 0.04;  // of the two faces of a wall
constexpr double kMaxGapM = 1.3;
constexpr double kMaxSameFaceM = 0.08;  // of rectangles seen from the same side
constexpr double kMaxWallAngleRad = 0.1;
constexpr double kUnseenSigmaM = 0.9;   // an edge with this deviation or more was not seen
constexpr double kFloorSigmaM = 0.003;  // real edges are not straighter than this
constexpr double kSillSigmaM = 0.008;   // sills slope
constexpr double kSplaySigmaM = 0.05;   // how much wider an opening may be on one side of the wall, each way
constexpr double kNothing = 1e3;        // deviation of what is not known
constexpr double kOtherShapeM = 0.045;  // outlines that differ by more on average are not of one opening

using Rectangle = OpeningFrame;

Rectangle rectangle_of(const Opening& opening) {
  Rectangle r;
  r.origin = opening.corners[0];
  const Vector3d side = opening.corners[1] - r.origin;
  const Vector3d rise = opening.corners[3] - r.origin;
  r.width = side.norm();
  r.height = rise.norm();
  r.across = side / std::max(1e-9, r.width);
  r.up = rise / std::max(1e-9, r.height);
  return r;
}

std::vector<Rectangle> rectangles_of(const std::vector<Opening>& openings) {
  std::vector<Rectangle> rectangles;
  rectangles.reserve(openings.size());
  for (const Opening& opening : openings) rectangles.push_back(rectangle_of(opening));
  return rectangles;
}

Rectangle moved(const Rectangle& r, const Rigid3& pose) {
  return {pose * r.origin, pose.rotation * r.across, pose.rotation * r.up, r.width, r.height};
}

/// Place of an edge along an axis, and its deviation.
struct Edge {
  double at = 0.0;
  double sigma = kNothing;
};

/// Edges as seen from the target's side: bottom, right, top, left.
using Edges = std::array<Edge, 4>;

Edges edges_of(const Opening& opening, const Rectangle& own, const Rectangle& axes) {
  const bool mirrored = own.across.dot(axes.across) < 0.0;
  const Vector3d middle = own.origin + 0.5 * (own.width * own.across + own.height * own.up) - axes.origin;
  const double u = axes.across.dot(middle);
  const double v = axes.up.dot(middle);
  Edges edges;
  edges[0] = {v - 0.5 * own.height, opening.edge_sigma_m[0]};
  edges[1] = {u + 0.5 * own.width, opening.edge_sigma_m[mirrored ? 3 : 1]};
  edges[2] = {v + 0.5 * own.height, opening.edge_sigma_m[2]};
  edges[3] = {u - 0.5 * own.width, opening.edge_sigma_m[mirrored ? 1 : 3]};
  return edges;
}

/// What two opposed edges say of the shift, each off by the shift plus or minus its part of the splay.
struct EdgeShift {
  double value = 0.0;
  double sigma = kNothing;
};

EdgeShift shift_of(const Edge& low, const Edge& high, double low_splay, double high_splay) {
  // Least squares over (shift, splay), the splay near zero a priori: with both edges it cancels.
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  const auto add = [&](const Vector3d& row, double value, double sigma) {
    const double weight = 1.0 / (sigma * sigma);
    normal += weight * row * row.transpose();
    right += weight * value * row;
  };
  add({1.0, 1.0, 0.0}, low.at, low.sigma);
  add({1.0, 0.0, -1.0}, high.at, high.sigma);
  add({0.0, 1.0, 0.0}, 0.0, low_splay);
  add({0.0, 0.0, 1.0}, 0.0, high_splay);
  // Both sides of an opening splay alike, nearly.
  add({0.0, 1.0, -1.0}, 0.0, std::abs(low_splay - high_splay) < 1e-9 ? 0.004 : kNothing);
  add({1.0, 0.0, 0.0}, 0.0, kNothing);
  const Matrix3d covariance = inverse_of(normal);
  const Vector3d solution = covariance * right;
  return {solution.x(), std::sqrt(covariance(0, 0))};
}

double trust_of(const Opening& opening) {
  switch (opening.view) {
    case OpeningView::through:
      return 1.0;
    case OpeningView::recess:
      return 0.7;
    case OpeningView::hole:
      return 0.3;
  }
  return 0.3;
}

Edge difference(const Edge& target, const Edge& source) {
  if (target.sigma >= kUnseenSigmaM || source.sigma >= kUnseenSigmaM) return {};
  return {target.at - source.at, Vector3d(target.sigma, source.sigma, kFloorSigmaM).norm()};
}

/// The outline in the axes of the target's rectangle, counter-clockwise there.
Ring outline_of(const Opening& opening, const Rigid3& pose, const Rectangle& axes) {
  Ring ring;
  for (const Vector3d& x : opening.outline) {
    const Vector3d from_corner = pose * x - axes.origin;
    ring.emplace_back(axes.across.dot(from_corner), axes.up.dot(from_corner));
  }
  if (signed_area(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// A lower corner of the box that the outline does not reach: bent all round, not only at the head.
bool bent_all_round(const Ring& ring) {
  constexpr double kOfWidth = 0.1;
  const Box2 box = box_of(ring);
  const double nearest =
      std::accumulate(ring.begin(), ring.end(), 1e300,
                      [&](double least, const Vector2d& p) { return std::min(least, (p - box.low).norm()); });
  return nearest > kOfWidth * (box.high - box.low).minCoeff();
}

/// The better known one: edges and outline come from the same samples, so that they do not add up.
EdgeShift surer(const EdgeShift& a, const EdgeShift& b) {
  return a.sigma <= b.sigma ? a : b;
}

/// Both outlines of an opening that is no rectangle.
struct Outlines {
  Ring source;
  Ring target;
  std::optional<OutlineFit> fit;

  [[nodiscard]] bool both() const { return fit.has_value(); }
};

Outlines outlines_of(const Opening& source, const Rigid3& pose, const Opening& target, const Rectangle& axes,
                     bool opposite) {
  Outlines outlines;
  if (source.outline.empty() || target.outline.empty()) return outlines;
  outlines.source = outline_of(source, pose, axes);
  outlines.target = outline_of(target, {}, axes);
  outlines.fit = fit_outlines(outlines.source, outlines.target, opposite ? kSplaySigmaM : kFloorSigmaM);
  return outlines;
}

/// Whether the two walls can be one: from its two sides, or from the same.
bool walls_agree(OpeningMatch& match, const Rectangle& a, const Rectangle& b) {
  const Vector3d source_normal = a.across.cross(a.up);  // towards the source's scanner
  const Vector3d target_normal = b.across.cross(b.up);
  const double cosine = source_normal.dot(target_normal);
  if (std::abs(cosine) < std::cos(kMaxWallAngleRad)) return false;
  if (a.up.dot(b.up) < std::cos(kMaxWallAngleRad)) return false;
  const Vector3d middle = a.origin + 0.5 * (a.width * a.across + a.height * a.up);
  match.gap_m = -target_normal.dot(middle - b.origin);
  match.opposite = cosine < 0.0;
  if (!match.opposite) return std::abs(match.gap_m) <= kMaxSameFaceM;
  return match.gap_m >= kMinGapM && match.gap_m <= kMaxGapM;
}

std::optional<OpeningMatch> match_of(const Opening& source, const Rectangle& a, const Rigid3& pose,
                                     const Opening& target, const Rectangle& b) {
  OpeningMatch match;
  if (!walls_agree(match, a, b)) return std::nullopt;
  const Edges from = edges_of(source, a, b);
  const Edges to = edges_of(target, b, b);
  std::array<Edge, 4> off;
  for (std::size_t k = 0; k < 4; ++k) off[k] = difference(to[k], from[k]);
  const auto both = [&](std::size_t low, std::size_t high) {
    return off[low].sigma < kUnseenSigmaM && off[high].sigma < kUnseenSigmaM;
  };
  const auto alike = [&](double own, double other, std::size_t low, std::size_t high) {
    return !both(low, high) ||
           std::abs(own - other) <= kMaxSizeDifferenceM + off[low].sigma + off[high].sigma;
  };
  if (!alike(a.height, b.height, 0, 2) || !alike(a.width, b.width, 3, 1)) return std::nullopt;
  const Outlines outlines = outlines_of(source, pose, target, b, match.opposite);
  if (outlines.both()) {
    if (outlines.fit->rms_m > kOtherShapeM) return std::nullopt;
    // A bent side has no place; the outline has.
    off[2] = {};
    if (bent_all_round(outlines.target)) off = {};
  }
  const double splay = match.opposite ? kSplaySigmaM : kFloorSigmaM;
  EdgeShift across = shift_of(off[3], off[1], splay, splay);
  // The splay of the sides is a hint at that of the head.
  const double widening = both(3, 1) ? 0.5 * std::abs(a.width - b.width) : splay;
  EdgeShift up = shift_of(off[0], off[2], kSillSigmaM, kSillSigmaM + std::min(splay, widening));
  if (outlines.both()) {
    across = surer(across, {outlines.fit->shift_m.x(), outlines.fit->sigma_m.x()});
    up = surer(up, {outlines.fit->shift_m.y(), outlines.fit->sigma_m.y()});
  }
  if (across.sigma > kUnseenSigmaM && up.sigma > kUnseenSigmaM) return std::nullopt;
  match.shift_across_m = across.sigma > kUnseenSigmaM ? 0.0 : across.value;
  match.shift_up_m = up.sigma > kUnseenSigmaM ? 0.0 : up.value;
  match.sigma_across_m = across.sigma;
  match.sigma_up_m = up.sigma;
  // Rectangles that nowhere overlap are not one opening, whatever a single edge says.
  const Vector3d gap = (a.origin + 0.5 * (a.width * a.across + a.height * a.up)) -
                       (b.origin + 0.5 * (b.width * b.across + b.height * b.up));
  if (std::abs(gap.dot(b.across)) > 0.5 * (a.width + b.width)) return std::nullopt;
  if (std::abs(gap.dot(b.up)) > 0.5 * (a.height + b.height)) return std::nullopt;
  match.at = b.origin + 0.5 * (b.width * b.across + b.height * b.up);
  match.across = b.across;
  match.up = b.up;
  match.tilt_rad = std::asin(std::clamp(a.up.cross(b.up).dot(b.across.cross(b.up)), -1.0, 1.0));
  match.area_m2 = std::min(a.width * a.height, b.width * b.height);
  match.trust = std::min(trust_of(source), trust_of(target));
  match.by_outline = outlines.both();
  return match;
}

}  // namespace

OpeningMatching::OpeningMatching(const Features& source, const Features& target)
    : sources_(source.openings),
      targets_(target.openings),
      source_rectangles_(rectangles_of(source.openings)),
      target_rectangles_(rectangles_of(target.openings)) {}

std::vector<OpeningMatch> OpeningMatching::under(const Rigid3& target_from_source, double gate_m) const {
  std::vector<OpeningMatch> all;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Rectangle& own = source_rectangles_[i];
    const Vector3d corner = target_from_source * own.origin;
    const double reach = kMaxGapM + own.width + own.height + gate_m;
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const Rectangle& b = target_rectangles_[k];
      if ((b.origin - corner).squaredNorm() > (reach + b.width) * (reach + b.width)) continue;
      auto match = match_of(sources_[i], moved(own, target_from_source), target_from_source, targets_[k], b);
      if (!match || std::hypot(match->shift_across_m, match->shift_up_m) > gate_m) continue;
      match->source = static_cast<int>(i);
      match->target = static_cast<int>(k);
      all.push_back(*match);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const OpeningMatch& a, const OpeningMatch& b) {
    return std::hypot(a.shift_across_m, a.shift_up_m) < std::hypot(b.shift_across_m, b.shift_up_m);
  });
  std::vector<OpeningMatch> matches;
  for (const OpeningMatch& match : all) {
    const bool taken = std::any_of(matches.begin(), matches.end(), [&](const OpeningMatch& other) {
      return other.source == match.source || other.target == match.target;
    });
    if (!taken) matches.push_back(match);
  }
  return matches;
}

}  // namespace limen
