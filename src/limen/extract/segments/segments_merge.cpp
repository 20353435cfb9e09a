// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_merge.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "limen/base/angles.h"
#include "limen/geometry/cell_key.h"

namespace limen {
namespace {

using MergedInterval = std::pair<double, double>;

constexpr double kBesideCreaseM = 0.015;  // a border this near to a crease is the crease
constexpr double kOneEdgeM = 0.012;       // edges of one kind this near to one another are one
constexpr double kOneEdgeDeg = 4.0;       // between two edges that are one
constexpr double kCornerM = 0.08;         // an end this near to a corner with another edge is drawn up to it
constexpr double kUnsure = 2.5;  // a border may be this many of its standard deviations off its own crease

/// Edges found by the cubes they pass.
class EdgeIndex {
 public:
  void add(const Segment& segment, std::size_t id) {
    for_cubes(segment, [&](std::int64_t key) {
      std::vector<std::size_t>& ids = cubes_[key];
      if (ids.empty() || ids.back() != id) ids.push_back(id);
    });
  }
  /// Ascending, each once.
  [[nodiscard]] std::vector<std::size_t> near(const Segment& segment) const {
    std::vector<std::size_t> ids;
    for_cubes(segment, [&](std::int64_t key) {
      const auto found = cubes_.find(key);
      if (found != cubes_.end()) ids.insert(ids.end(), found->second.begin(), found->second.end());
    });
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }

 private:
  static constexpr double kCube_m = 0.25;
  /// The cubes along the segment and those around them, so that a neighbour is never missed.
  template <typename Visit>
  static void for_cubes(const Segment& segment, const Visit& visit) {
    const int steps = static_cast<int>(segment.length() / (0.5 * kCube_m)) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Vector3d x = segment.a + (static_cast<double>(k) / steps) * (segment.b - segment.a);
      for (int corner = 0; corner < 8; ++corner) {
        constexpr double kReach_m = 0.1;
        visit(cell_key(cell_of(x + kReach_m * Vector3d((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                                       (corner & 4) != 0 ? 1 : -1),
                               kCube_m)));
      }
    }
  }
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cubes_;
};

/// Part of `edge` that `other` covers, as lengths from edge.a; empty where they are not one line.
MergedInterval covered_part(const Segment& edge, const Segment& other, double reach_m, double cosine) {
  const Vector3d along = edge.direction();
  if (std::abs(along.dot(other.direction())) < cosine) return {0.0, 0.0};
  double t0 = along.dot(other.a - edge.a);
  double t1 = along.dot(other.b - edge.a);
  if (t0 > t1) std::swap(t0, t1);
  const MergedInterval common = {std::max(0.0, t0), std::min(edge.length(), t1)};
  if (common.second <= common.first) return {0.0, 0.0};
  // Both lines at the middle of what they share.
  const Vector3d x = edge.a + 0.5 * (common.first + common.second) * along;
  const Vector3d off = x - other.a;
  const Vector3d direction = other.direction();
  if ((off - off.dot(direction) * direction).norm() > reach_m) return {0.0, 0.0};
  return common;
}

/// What is left of [0, length] without the intervals.
std::vector<MergedInterval> rest_of(double length, std::vector<MergedInterval> taken) {
  std::sort(taken.begin(), taken.end());
  std::vector<MergedInterval> rest;
  double from = 0.0;
  for (const MergedInterval& interval : taken) {
    if (interval.first > from) rest.emplace_back(from, interval.first);
    from = std::max(from, interval.second);
  }
  if (length > from) rest.emplace_back(from, length);
  return rest;
}

bool better(const DetectedEdge& a, const DetectedEdge& b) {
  if (a.kind != b.kind) return a.kind == EdgeKind::crease;
  return a.segment.length() > b.segment.length();
}

bool longer(const DetectedEdge& a, const DetectedEdge& b) {
  return a.segment.length() > b.segment.length();
}

/// Each edge without what better ones cover.
std::vector<DetectedEdge> without_doubles(std::vector<DetectedEdge> edges, double min_length_m) {
  std::stable_sort(edges.begin(), edges.end(), better);
  const double cosine = std::cos(radians(kOneEdgeDeg));
  std::vector<DetectedEdge> kept;
  EdgeIndex index;
  for (const DetectedEdge& edge : edges) {
    std::vector<MergedInterval> taken;
    for (const std::size_t k : index.near(edge.segment)) {
      const bool beside = edge.kind == EdgeKind::border && kept[k].kind == EdgeKind::crease;
      const bool of_it = kept[k].planes[0] == edge.planes[0] || kept[k].planes[1] == edge.planes[0];
      const double unsure = of_it ? kUnsure * edge.sigma_m : 0.0;
      const double reach = beside ? kBesideCreaseM + unsure : kOneEdgeM;
      const MergedInterval part = covered_part(edge.segment, kept[k].segment, reach, cosine);
      if (part.second > part.first) taken.push_back(part);
    }
    const Vector3d along = edge.segment.direction();
    for (const MergedInterval& part : rest_of(edge.segment.length(), std::move(taken))) {
      if (part.second - part.first < min_length_m) continue;
      DetectedEdge piece = edge;
      piece.segment = {edge.segment.a + part.first * along, edge.segment.a + part.second * along};
      index.add(piece.segment, kept.size());
      kept.push_back(piece);
    }
  }
  return kept;
}

/// The two as one, on the line of the longer one; whether they are pieces of one line.
bool join(DetectedEdge& edge, const DetectedEdge& other, double gap_m) {
  constexpr double kMaxAngleDeg = 1.0;
  constexpr double kMaxOff_m = 0.006;
  if (edge.kind != other.kind) return false;
  const Vector3d along = edge.segment.direction();
  if (std::abs(along.dot(other.segment.direction())) < std::cos(radians(kMaxAngleDeg))) return false;
  const Vector3d to_a = other.segment.a - edge.segment.a;
  const Vector3d to_b = other.segment.b - edge.segment.a;
  double t0 = along.dot(to_a);
  double t1 = along.dot(to_b);
  if ((to_a - t0 * along).norm() > kMaxOff_m || (to_b - t1 * along).norm() > 2.0 * kMaxOff_m) return false;
  if (t0 > t1) std::swap(t0, t1);
  const double length = edge.segment.length();
  if (t0 > length + gap_m || t1 < -gap_m) return false;
  const Vector3d a = edge.segment.a;
  edge.segment = {a + std::min(0.0, t0) * along, a + std::max(length, t1) * along};
  return true;
}

/// Pieces of one line become one.
std::vector<DetectedEdge> joined(std::vector<DetectedEdge> edges, double gap_m) {
  std::stable_sort(edges.begin(), edges.end(), longer);
  EdgeIndex index;
  for (std::size_t k = 0; k < edges.size(); ++k) index.add(edges[k].segment, k);
  std::vector<char> used(edges.size(), 0);
  std::vector<DetectedEdge> kept;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (used[k] != 0) continue;
    DetectedEdge edge = edges[k];
    for (bool grew = true; grew;) {
      grew = false;
      const Vector3d reach = gap_m * edge.segment.direction();
      for (const std::size_t other : index.near({edge.segment.a - reach, edge.segment.b + reach})) {
        if (other <= k || used[other] != 0 || !join(edge, edges[other], gap_m)) continue;
        used[other] = 1;
        grew = true;
      }
    }
    kept.push_back(edge);
  }
  std::stable_sort(kept.begin(), kept.end(), longer);
  return kept;
}

/// Where the line of `edge` passes the line of `other`, as a length from edge.a; a length far away where they
/// do not come near one another.
double passing_place(const Segment& edge, const Segment& other) {
  constexpr double kNowhere = 1e9;
  const Vector3d u = edge.direction();
  const Vector3d v = other.direction();
  const double cosine = u.dot(v);
  const double sine2 = 1.0 - cosine * cosine;
  if (sine2 < 0.1) return kNowhere;
  const Vector3d off = other.a - edge.a;
  const double t = (off.dot(u) - cosine * off.dot(v)) / sine2;
  const double s = (cosine * off.dot(u) - off.dot(v)) / sine2;
  if ((edge.a + t * u - other.a - s * v).norm() > kOneEdgeM) return kNowhere;
  // The other one need not reach the corner either.
  constexpr double kShort_m = 0.1;
  return s < -kShort_m || s > other.length() + kShort_m ? kNowhere : t;
}

/// Ends that stop short of a corner, where another edge passes, are drawn up to it.
void draw_to_corners(std::vector<DetectedEdge>& edges) {
  EdgeIndex index;
  for (std::size_t k = 0; k < edges.size(); ++k) index.add(edges[k].segment, k);
  const std::vector<DetectedEdge> before = edges;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Segment& edge = before[k].segment;
    double begin = kCornerM;
    double end = kCornerM;
    for (const std::size_t other : index.near(edge)) {
      if (other == k) continue;
      const double t = passing_place(edge, before[other].segment);
      if (t <= 0.0) begin = std::min(begin, -t);
      if (t >= edge.length()) end = std::min(end, t - edge.length());
    }
    const Vector3d along = edge.direction();
    if (begin < kCornerM) edges[k].segment.a = edge.a - begin * along;
    if (end < kCornerM) edges[k].segment.b = edge.b + end * along;
  }
}

}  // namespace

std::vector<DetectedEdge> merged_edges(std::vector<DetectedEdge> edges, double join_gap_m,
                                       double min_length_m) {
  // Short pieces may still become part of a line: they are dropped last.
  std::vector<DetectedEdge> merged =
      joined(without_doubles(std::move(edges), 0.25 * min_length_m), join_gap_m);
  std::erase_if(merged, [&](const DetectedEdge& edge) { return edge.segment.length() < min_length_m; });
  draw_to_corners(merged);
  std::stable_sort(merged.begin(), merged.end(), longer);
  return merged;
}

}  // namespace limen
