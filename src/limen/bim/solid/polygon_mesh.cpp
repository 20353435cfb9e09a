// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/solid/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr double kFarthest_m = 1e9;
constexpr double kSnapM = 1e-5;

/// Corners by the cell of a grid; a corner near a cell's border is looked for in the neighbour too.
class CornerTable {
 public:
  std::uint32_t index_of(const Vector3d& x) {
    const std::array<std::int64_t, 3> base = cell(x);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = first_.find(key({base[0] + dx, base[1] + dy, base[2] + dz}));
          if (found != first_.end() && (points_[found->second] - x).squaredNorm() <= kSnapM * kSnapM)
            return found->second;
        }
      }
    }
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(x);
    first_.emplace(key(base), index);
    return index;
  }
  [[nodiscard]] std::vector<Vector3d> take_points() { return std::move(points_); }

 private:
  static std::array<std::int64_t, 3> cell(const Vector3d& x) {
    std::array<std::int64_t, 3> result{};
    for (int k = 0; k < 3; ++k)
      result[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(x[k] / kSnapM));
    return result;
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) hash = mix64(hash ^ static_cast<std::uint64_t>(k));
    return hash;
  }

  std::vector<Vector3d> points_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_;
};

/// Without corners that repeat their predecessor; spikes (a b a) are left to the area.
std::vector<std::uint32_t> without_repeats(std::vector<std::uint32_t> ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

/// The ring from its least corner on: equal for equal polygons of the same sense.
std::vector<std::uint32_t> canonical(std::vector<std::uint32_t> ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

/// The same mesh without polygons that occur twice; the first stays.
PolygonMesh without_doubles(const PolygonMesh& mesh) {
  std::vector<std::vector<std::uint32_t>> rings(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i)
    rings[i] = canonical({mesh.corners.begin() + mesh.begin_of(i), mesh.corners.begin() + mesh.ends[i]});
  std::vector<std::size_t> order(mesh.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rings[a] < rings[b]; });
  std::vector<char> keep(mesh.size(), 1);
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (rings[order[k]] == rings[order[k - 1]]) keep[order[k]] = 0;
  }
  PolygonMesh result;
  result.points = mesh.points;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (keep[i] != 0)
      result.add({mesh.corners.begin() + mesh.begin_of(i), mesh.corners.begin() + mesh.ends[i]});
  }
  return result;
}

/// One side of a polygon.
struct Side {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t polygon;
  bool upwards;  ///< walked from low to high
};

std::vector<Side> sides_of(const PolygonMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::uint32_t begin = mesh.begin_of(i);
    for (std::uint32_t k = begin; k < mesh.ends[i]; ++k) {
      const std::uint32_t a = mesh.corners[k];
      const std::uint32_t b = mesh.corners[k + 1 == mesh.ends[i] ? begin : k + 1];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(i), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.polygon, a.upwards) < std::tie(b.low, b.high, b.polygon, b.upwards);
  });
  return sides;
}

/// Calls work(begin, end) for each run of sides over the same edge.
template <typename Work>
void for_each_edge(const std::vector<Side>& sides, const Work& work) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high)
      ++end;
    work(begin, end);
    begin = end;
  }
}

struct Neighbour {
  std::uint32_t polygon;
  bool agrees;      ///< walks the edge the other way
  bool only_other;  ///< no third polygon has the edge
};
using Neighbours = std::vector<std::vector<Neighbour>>;

Neighbours neighbours_of(const PolygonMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  Neighbours result(mesh.size());
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    const bool pair = end - begin == 2;
    for (std::size_t k = begin + 1; k < end; ++k) {
      const Side& a = sides[k - 1];
      const Side& b = sides[k];
      if (a.polygon == b.polygon) continue;
      const bool agrees = a.upwards != b.upwards;
      result[a.polygon].push_back({b.polygon, agrees, pair});
      result[b.polygon].push_back({a.polygon, agrees, pair});
    }
  });
  return result;
}

void turn(PolygonMesh& mesh, std::size_t polygon) {
  std::reverse(mesh.corners.begin() + mesh.begin_of(polygon), mesh.corners.begin() + mesh.ends[polygon]);
}

/// Makes the polygons that are connected by edges of two agree; the greater area of a part decides.
void make_agree(PolygonMesh& mesh, const Neighbours& neighbours) {
  std::vector<std::int8_t> sense(mesh.size(), 0);
  for (std::size_t seed = 0; seed < mesh.size(); ++seed) {
    if (sense[seed] != 0) continue;
    std::vector<std::size_t> part{seed};
    sense[seed] = 1;
    double balance = 0.0;
    for (std::size_t at = 0; at < part.size(); ++at) {
      const std::size_t i = part[at];
      balance += sense[i] * area_vector(mesh, i).norm();
      for (const Neighbour& next : neighbours[i]) {
        if (!next.only_other || sense[next.polygon] != 0) continue;
        sense[next.polygon] = next.agrees ? sense[i] : static_cast<std::int8_t>(-sense[i]);
        part.push_back(next.polygon);
      }
    }
    const std::int8_t wrong = balance < 0.0 ? 1 : -1;
    for (const std::size_t i : part) {
      if (sense[i] == wrong) turn(mesh, i);
    }
  }
}

/// What hangs together over any edge.
struct Part {
  std::vector<std::size_t> polygons;
  Vector3d low = Vector3d::Constant(kFarthest_m);
  Vector3d high = Vector3d::Constant(-kFarthest_m);
  double volume = 0.0;
  bool closed = false;
};

double tetrahedra(const PolygonMesh& mesh, std::size_t polygon, const Vector3d& apex) {
  const std::uint32_t begin = mesh.begin_of(polygon);
  const Vector3d a = mesh.points[mesh.corners[begin]] - apex;
  double sum = 0.0;
  for (std::uint32_t k = begin + 1; k + 1 < mesh.ends[polygon]; ++k) {
    const Vector3d b = mesh.points[mesh.corners[k]] - apex;
    sum += a.dot(b.cross(mesh.points[mesh.corners[k + 1]] - apex));
  }
  return sum / 6.0;
}

Part part_from(const PolygonMesh& mesh, const Neighbours& neighbours, std::size_t seed,
               std::vector<char>& seen) {
  Part part;
  part.polygons.push_back(seed);
  seen[seed] = 1;
  const Vector3d apex = mesh.points[mesh.corners[mesh.begin_of(seed)]];
  Vector3d area_sum = Vector3d::Zero();
  double area = 0.0;
  for (std::size_t at = 0; at < part.polygons.size(); ++at) {
    const std::size_t i = part.polygons[at];
    const Vector3d vector = area_vector(mesh, i);
    area_sum += vector;
    area += vector.norm();
    part.volume += tetrahedra(mesh, i, apex);
    for (std::uint32_t k = mesh.begin_of(i); k < mesh.ends[i]; ++k) {
      part.low = part.low.cwiseMin(mesh.points[mesh.corners[k]]);
      part.high = part.high.cwiseMax(mesh.points[mesh.corners[k]]);
    }
    for (const Neighbour& next : neighbours[i]) {
      if (seen[next.polygon] != 0) continue;
      seen[next.polygon] = 1;
      part.polygons.push_back(next.polygon);
    }
  }
  // The area vectors of a closed surface cancel, also where a T-junction hides that its edges match.
  part.closed = area_sum.norm() <= 1e-5 * area && std::abs(part.volume) > 1e-6 * std::pow(area, 1.5);
  return part;
}

bool encloses(const Part& outer, const Part& inner) {
  return outer.closed && outer.volume > std::abs(inner.volume) &&
         (outer.low.array() < inner.low.array()).all() && (outer.high.array() > inner.high.array()).all();
}

}  // namespace

Vector3d area_vector(const PolygonMesh& mesh, std::size_t polygon) {
  const std::uint32_t begin = mesh.begin_of(polygon);
  const Vector3d& first = mesh.points[mesh.corners[begin]];
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t k = begin + 1; k + 1 < mesh.ends[polygon]; ++k)
    sum += (mesh.points[mesh.corners[k]] - first).cross(mesh.points[mesh.corners[k + 1]] - first);
  return 0.5 * sum;
}

PolygonMesh welded(const PolygonMesh& mesh) {
  CornerTable table;
  constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> now(mesh.points.size(), kNone);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if ((mesh.points[i].array().abs() < kFarthest_m).all()) now[i] = table.index_of(mesh.points[i]);
  }
  PolygonMesh result;
  result.points = table.take_points();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = mesh.begin_of(i); k < mesh.ends[i]; ++k) ring.push_back(now[mesh.corners[k]]);
    if (std::find(ring.begin(), ring.end(), kNone) != ring.end()) continue;
    ring = without_repeats(std::move(ring));
    if (ring.size() < 3) continue;
    result.add(ring);
    if (area_vector(result, result.size() - 1).norm() > kSnapM * kSnapM) continue;
    result.corners.resize(result.corners.size() - ring.size());
    result.ends.pop_back();
  }
  return without_doubles(result);
}

PolygonMesh oriented(PolygonMesh mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  make_agree(mesh, neighbours);
  std::vector<char> seen(mesh.size(), 0);
  std::vector<Part> parts;
  for (std::size_t seed = 0; seed < mesh.size(); ++seed) {
    if (seen[seed] == 0) parts.push_back(part_from(mesh, neighbours, seed, seen));
  }
  for (const Part& part : parts) {
    if (!part.closed || part.volume >= 0.0) continue;
    if (std::any_of(parts.begin(), parts.end(), [&](const Part& other) { return encloses(other, part); }))
      continue;
    for (const std::size_t i : part.polygons) turn(mesh, i);
  }
  return mesh;
}

double signed_volume(const PolygonMesh& mesh) {
  if (mesh.size() == 0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) sum += tetrahedra(mesh, i, mesh.points[mesh.corners.front()]);
  return sum;
}

bool is_closed(const PolygonMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  bool closed = !sides.empty();
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    int balance = 0;
    for (std::size_t k = begin; k < end; ++k) balance += sides[k].upwards ? 1 : -1;
    closed = closed && balance == 0;
  });
  return closed;
}

}  // namespace limen
