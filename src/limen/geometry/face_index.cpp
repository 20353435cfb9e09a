// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/face_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limen {
namespace {

constexpr double kLeastCellM = 0.25;
constexpr double kMostCells = 6e6;
constexpr double kSamePlaneM = 0.005;
constexpr double kSameWay = 0.99;

/// Squared distance of a point to the nearest edge of a ring.
double ring_distance_squared(const Ring& ring, const Vector2d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vector2d edge = ring[i] - ring[j];
    const double squared = edge.squaredNorm();
    const double along = squared > 0.0 ? std::clamp(edge.dot(p - ring[j]) / squared, 0.0, 1.0) : 0.0;
    best = std::min(best, (p - ring[j] - along * edge).squaredNorm());
  }
  return best;
}

}  // namespace

FaceIndex::FaceIndex(std::vector<FlatFace> faces, double reach_m) : reach_m_(reach_m) {
  low_ = Vector3d::Constant(1e300);
  high_ = Vector3d::Constant(-1e300);
  for (FlatFace& face : faces) {
    Prepared ready;
    ready.low = Vector2d::Constant(1e300);
    ready.high = Vector2d::Constant(-1e300);
    for (const Vector2d& p : face.outline.outer) {
      ready.low = ready.low.cwiseMin(p);
      ready.high = ready.high.cwiseMax(p);
      const Vector3d x = face.frame.to_space(p);
      low_ = low_.cwiseMin(x);
      high_ = high_.cwiseMax(x);
    }
    const Vector2d size = ready.high - ready.low;
    ready.rectangle = face.outline.holes.empty() && !face.outline.outer.empty() &&
                      area(face.outline) > (1.0 - 1e-9) * size.x() * size.y();
    ready.face = std::move(face);
    faces_.push_back(std::move(ready));
  }
  if (high_.x() < low_.x()) return;
  layout();
  fill();
}

void FaceIndex::layout() {
  low_.array() -= reach_m_;
  high_.array() += reach_m_;
  cell_m_ = std::max(kLeastCellM, reach_m_);
  const Vector3d extent = high_ - low_;
  const auto count = [&](Eigen::Index k) { return std::floor(extent[k] / cell_m_) + 1.0; };
  while (count(0) * count(1) * count(2) > kMostCells) cell_m_ *= 1.25;
  for (Eigen::Index k = 0; k < 3; ++k) size_[k] = static_cast<std::int64_t>(count(k));
}

void FaceIndex::fill() {
  begin_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const Prepared& face : faces_) visit_cells(face, [&](std::size_t cell) { ++begin_[cell + 1]; });
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  members_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    visit_cells(faces_[i], [&](std::size_t cell) { members_[next[cell]++] = static_cast<std::uint32_t>(i); });
  }
}

FaceIndex::Place FaceIndex::place_of(const Vector3d& x) const {
  return ((x - low_) / cell_m_).array().floor().max(-1e15).min(1e15).cast<std::int64_t>();
}

bool FaceIndex::inside(const Place& place) const {
  return (place.array() >= 0).all() && (place.array() < size_.array()).all();
}

std::size_t FaceIndex::cell_at(const Place& place) const {
  return static_cast<std::size_t>((place.z() * size_.y() + place.y()) * size_.x() + place.x());
}

/// Cells that may hold a point within reach of the face: those of its box that its plane comes near and that
/// lie by the box of its outline.
template <typename Visit>
void FaceIndex::visit_cells(const Prepared& face, const Visit& visit) const {
  if (face.face.outline.outer.size() < 3) return;
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  for (const Vector2d& p : face.face.outline.outer) {
    const Vector3d x = face.face.frame.to_space(p);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Place from = place_of((low.array() - reach_m_).matrix()).cwiseMax(Place::Zero());
  const Place to = place_of((high.array() + reach_m_).matrix()).cwiseMin(size_ - Place::Ones());
  const double half = 0.5 * cell_m_;
  const double thickness = half * face.face.plane.normal.cwiseAbs().sum() + reach_m_;
  const double wide = half * face.face.frame.u.cwiseAbs().sum() + reach_m_;
  const double tall = half * face.face.frame.v.cwiseAbs().sum() + reach_m_;
  for (std::int64_t z = from.z(); z <= to.z(); ++z) {
    for (std::int64_t y = from.y(); y <= to.y(); ++y) {
      for (std::int64_t x = from.x(); x <= to.x(); ++x) {
        const Place place(x, y, z);
        const Vector3d middle = low_ + cell_m_ * (place.cast<double>().array() + 0.5).matrix();
        if (std::abs(face.face.plane.signed_distance(middle)) > thickness) continue;
        const Vector2d p = face.face.frame.to_plane(middle);
        if (p.x() < face.low.x() - wide || p.x() > face.high.x() + wide) continue;
        if (p.y() < face.low.y() - tall || p.y() > face.high.y() + tall) continue;
        visit(cell_at(place));
      }
    }
  }
}

/// Distance in the plane from a point to the outline; 0 inside; any number above `most` where it is farther.
double FaceIndex::outside_distance(const Prepared& face, const Vector2d& p, double most) {
  const Vector2d past = (face.low - p).cwiseMax(p - face.high).cwiseMax(Vector2d::Zero());
  if (past.squaredNorm() > most * most) return 2.0 * most;
  if (face.rectangle) return past.norm();
  if (contains(face.face.outline, p)) return 0.0;
  double squared = ring_distance_squared(face.face.outline.outer, p);
  for (const Ring& hole : face.face.outline.holes)
    squared = std::min(squared, ring_distance_squared(hole, p));
  return std::sqrt(squared);
}

FaceHit FaceIndex::nearest(const FaceQuery& query) const {
  FaceHit hit;
  const Place place = place_of(query.x);
  if (begin_.empty() || !inside(place)) return hit;
  const std::size_t cell = cell_at(place);
  double best = reach_m_;
  for (std::size_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
    const Prepared& face = faces_[members_[k]];
    const Plane& plane = face.face.plane;
    const double signed_m = plane.signed_distance(query.x);
    if (std::abs(signed_m) >= best) continue;
    if (query.normal != nullptr) {
      const double cosine = plane.normal.dot(*query.normal);
      if ((query.oriented ? cosine : std::abs(cosine)) < query.min_cosine) continue;
    }
    if (query.seen_from != nullptr && plane.signed_distance(*query.seen_from) <= 0.0) continue;
    if (query.but_not != nullptr && plane.normal.dot(query.but_not->normal) > kSameWay &&
        std::abs(query.but_not->signed_distance(query.x) - signed_m) < kSamePlaneM)
      continue;
    const double most = std::sqrt(best * best - signed_m * signed_m);
    const double off = outside_distance(face, face.face.frame.to_plane(query.x), most);
    if (off >= most) continue;
    best = std::hypot(off, signed_m);
    hit = {static_cast<int>(members_[k]), best, signed_m};
  }
  return hit;
}

/// Faces of a cell that the line crosses within the cell.
void FaceIndex::cross(std::size_t cell, const Vector3d& from, const Vector3d& to,
                      std::vector<FaceCrossing>& found) const {
  for (std::size_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
    const Prepared& face = faces_[members_[k]];
    const double a = face.face.plane.signed_distance(from);
    const double b = face.face.plane.signed_distance(to);
    if ((a > 0.0) == (b > 0.0)) continue;
    const Vector3d at = from + a / (a - b) * (to - from);
    const Place place = place_of(at);
    if (!inside(place) || cell_at(place) != cell) continue;
    const Vector2d p = face.face.frame.to_plane(at);
    if (p.x() < face.low.x() || p.x() > face.high.x() || p.y() < face.low.y() || p.y() > face.high.y())
      continue;
    if (face.rectangle || contains(face.face.outline, p))
      found.push_back({static_cast<int>(members_[k]), at});
  }
}

std::vector<FaceCrossing> FaceIndex::crossings(const Vector3d& from, const Vector3d& to) const {
  std::vector<FaceCrossing> found;
  if (begin_.empty()) return found;
  // The part of the line within the grid.
  const Vector3d way = to - from;
  double enter = 0.0;
  double leave = 1.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (std::abs(way[k]) < 1e-12) {
      if (from[k] < low_[k] || from[k] > high_[k]) return found;
      continue;
    }
    const double a = (low_[k] - from[k]) / way[k];
    const double b = (high_[k] - from[k]) / way[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return found;
  Place place = place_of(from + enter * way).cwiseMax(Place::Zero()).cwiseMin(size_ - Place::Ones());
  Vector3d next;
  Vector3d step;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double border = low_[k] + cell_m_ * static_cast<double>(place[k] + (way[k] > 0.0 ? 1 : 0));
    const bool moves = std::abs(way[k]) >= 1e-12;
    next[k] = moves ? (border - from[k]) / way[k] : std::numeric_limits<double>::infinity();
    step[k] = moves ? cell_m_ / std::abs(way[k]) : std::numeric_limits<double>::infinity();
  }
  while (inside(place)) {
    cross(cell_at(place), from, to, found);
    Eigen::Index k = 0;
    const double t = next.minCoeff(&k);
    if (t > leave) break;
    next[k] += step[k];
    place[k] += way[k] > 0.0 ? 1 : -1;
  }
  return found;
}

}  // namespace limen
