// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/join_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "limen/base/angles.h"
#include "limen/extract/planes/merge_planes.h"

namespace limen {

std::vector<std::vector<std::uint32_t>> touching_parts(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       double gap_m) {
  using Place = std::pair<int, int>;
  const PlaneFrame frame = make_frame(fit.plane, fit.centroid);
  std::map<Place, std::vector<std::uint32_t>> squares;
  for (const std::uint32_t i : points) {
    const Vector2d p = frame.to_plane(scan.points[i]) / gap_m;
    squares[{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))}].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> parts;
  while (!squares.empty()) {
    std::vector<std::uint32_t>& part = parts.emplace_back();
    std::vector<Place> open = {squares.begin()->first};
    while (!open.empty()) {
      const Place at = open.back();
      open.pop_back();
      const auto found = squares.find(at);
      if (found == squares.end()) continue;
      part.insert(part.end(), found->second.begin(), found->second.end());
      squares.erase(found);
      for (int step = 0; step < 9; ++step)
        open.emplace_back(at.first + step % 3 - 1, at.second + step / 3 - 1);
    }
    std::sort(part.begin(), part.end());
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return parts;
}

namespace {

constexpr double kJoinReachM = 0.03;  // root mean square distance of a piece from a plane it may belong to
constexpr double kJoinedDeg = 3.0;    // between the normals of pieces wide enough to have one
constexpr double kChiSquared = 16.3;  // of three freedoms, exceeded once in a thousand
constexpr double kWideNoises = 8.0;   // times the noise: a piece so wide has a normal of its own

double squares_about_own(const PointMoments& moments, const PlaneFit& fit) {
  return moments.count * fit.rms_m * fit.rms_m;
}

/// How much worse the common plane is than two of their own, in units of what is allowed; more than 1: two
/// planes.
class PieceJoin {
 public:
  explicit PieceJoin(const JoinOptions& options) : o_(options) {}

  [[nodiscard]] double strain(const PlanePiece& piece, const PlaneFit& a_fit, const PlanePiece& other,
                              const PlaneFit& b_fit) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const PointMoments& a = piece.moments;
    const PointMoments& b = other.moments;
    if (rms_about(b, a_fit.plane) > kJoinReachM) return kNever;
    if (piece.sight.dot(a_fit.plane.normal) * other.sight.dot(a_fit.plane.normal) < 0.0) return kNever;
    if (wide(a_fit) && wide(b_fit) && std::abs(a_fit.plane.normal.dot(b_fit.plane.normal)) < cosine_)
      return kNever;
    PointMoments both = a;
    both += b;
    const double added =
        squares_about_own(both, fit_plane(both)) - squares_about_own(a, a_fit) - squares_about_own(b, b_fit);
    const double together = a.count * b.count / (a.count + b.count);
    const double allowed = kChiSquared * o_.noise_m * o_.noise_m + together * o_.drift_m * o_.drift_m;
    return added / allowed;
  }

 private:
  [[nodiscard]] bool wide(const PlaneFit& fit) const {
    return std::sqrt(12.0 * fit.variances[1]) > std::max(0.3, kWideNoises * o_.noise_m);
  }

  JoinOptions o_;
  double cosine_ = std::cos(radians(kJoinedDeg));
};

bool larger(const PlanePiece& a, const PlanePiece& b) {
  return a.points.size() > b.points.size();
}

}  // namespace

PlanePiece piece_of(const Scan& scan, std::vector<std::uint32_t> points, const Vector3d& anchor) {
  PlanePiece piece;
  for (const std::uint32_t i : points) {
    piece.moments.add(scan.points[i] - anchor);
    if (scan.centre_known()) piece.sight += scan.centre(i) - scan.points[i];
  }
  piece.points = std::move(points);
  return piece;
}

std::vector<std::int32_t> labels_with(std::vector<std::int32_t> labels, const std::vector<PlanePiece>& pieces,
                                      std::size_t first) {
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (const std::uint32_t i : pieces[p].points) labels[i] = static_cast<std::int32_t>(first + p);
  }
  return labels;
}

std::vector<PlanePiece> parts_of(const Scan& scan, const PlaneFit& fit,
                                 const std::vector<std::uint32_t>& points, double gap_m,
                                 const Vector3d& anchor) {
  std::array<std::vector<std::uint32_t>, 2> of_side;
  for (const std::uint32_t i : points) {
    const bool behind = scan.centre_known() && fit.plane.signed_distance(scan.centre(i)) < 0.0;
    of_side[behind ? 1 : 0].push_back(i);
  }
  std::vector<PlanePiece> parts;
  for (const std::vector<std::uint32_t>& side : of_side) {
    for (std::vector<std::uint32_t>& part : touching_parts(scan, fit, side, gap_m))
      parts.push_back(piece_of(scan, std::move(part), anchor));
  }
  std::stable_sort(parts.begin(), parts.end(), larger);
  return parts;
}

std::vector<PlanePiece> joined_pieces(std::vector<PlanePiece> pieces, const JoinOptions& options) {
  std::stable_sort(pieces.begin(), pieces.end(), larger);
  const PieceJoin join(options);
  std::vector<PlanePiece> planes;
  std::vector<PlaneFit> fits;
  for (PlanePiece& piece : pieces) {
    if (piece.points.size() < 3) continue;
    const PlaneFit own = fit_plane(piece.moments);
    std::size_t best = planes.size();
    double least = 1.0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double strain = join.strain(planes[k], fits[k], piece, own);
      if (strain > least) continue;
      least = strain;
      best = k;
    }
    if (best == planes.size()) {
      planes.push_back(std::move(piece));
      fits.push_back(own);
      continue;
    }
    planes[best].moments += piece.moments;
    planes[best].sight += piece.sight;
    planes[best].points.insert(planes[best].points.end(), piece.points.begin(), piece.points.end());
    fits[best] = fit_plane(planes[best].moments);
  }
  std::stable_sort(planes.begin(), planes.end(), larger);
  return planes;
}

}  // namespace limen
