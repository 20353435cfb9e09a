// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/triangulate.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace limen {
namespace {

/// Twice the area below which three corners count as lying on a line, m^2.
constexpr long double kFlat = 1e-13L;

/// Twice the signed area of a triangle, in more digits than its corners have; 0 where they lie on a line.
long double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const long double ux = static_cast<long double>(b.x()) - static_cast<long double>(a.x());
  const long double uy = static_cast<long double>(b.y()) - static_cast<long double>(a.y());
  const long double vx = static_cast<long double>(c.x()) - static_cast<long double>(a.x());
  const long double vy = static_cast<long double>(c.y()) - static_cast<long double>(a.y());
  const long double cross = ux * vy - uy * vx;
  return cross > -kFlat && cross < kFlat ? 0.0L : cross;
}

/// Whether p lies on the segment from a to b, ends included.
bool on_segment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return turn(a, b, p) == 0.0L && (p - a).dot(p - b) <= 0.0;
}

/// Whether the segment from a to b meets the segment from c to d anywhere but in a or b.
bool blocked(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto free_end = [&](const Vector2d& p) { return p == a || p == b; };
  if (!free_end(c) && on_segment(a, b, c)) return true;
  if (!free_end(d) && on_segment(a, b, d)) return true;
  const long double sc = turn(a, b, c);
  const long double sd = turn(a, b, d);
  if ((sc > 0.0L) == (sd > 0.0L) || sc == 0.0L || sd == 0.0L) return false;
  const long double sa = turn(c, d, a);
  const long double sb = turn(c, d, b);
  return (sa > 0.0L) != (sb > 0.0L) && sa != 0.0L && sb != 0.0L;
}

Ring without_repetition(const Ring& ring) {
  Ring clean;
  for (const Vector2d& p : ring)
    if (clean.empty() || clean.back() != p) clean.push_back(p);
  while (clean.size() > 1 && clean.front() == clean.back()) clean.pop_back();
  return clean;
}

/// The ring without repeated corners, turned to the given side.
Ring cleaned(const Ring& ring, bool counter_clockwise) {
  Ring clean = without_repetition(ring);
  if (clean.size() < 3) return {};
  if ((signed_area(clean) > 0.0) != counter_clockwise) std::reverse(clean.begin(), clean.end());
  return clean;
}

std::size_t wrapped(std::size_t i, std::size_t size) {
  return i >= size ? i - size : i;
}

/// A corner of a ring with its neighbours; the polygon lies to the left of the way before - at - after.
struct Corner {
  const Vector2d& before;
  const Vector2d& at;
  const Vector2d& after;
};

Corner corner_of(const Ring& ring, std::size_t i) {
  const std::size_t size = ring.size();
  return {ring[wrapped(i + size - 1, size)], ring[i], ring[wrapped(i + 1, size)]};
}

/// Whether the way from the corner to `p` begins inside its angle.
bool in_corner(const Corner& c, const Vector2d& p) {
  if (turn(c.before, c.at, c.after) > 0.0L)
    return turn(c.before, c.at, p) > 0.0L && turn(c.at, c.after, p) > 0.0L;
  return turn(c.before, c.at, p) > 0.0L || turn(c.at, c.after, p) > 0.0L;
}

/// The same, or along one of its sides.
bool touches_corner(const Corner& c, const Vector2d& p) {
  const bool left_before = turn(c.before, c.at, p) >= 0.0L;
  const bool left_after = turn(c.at, c.after, p) >= 0.0L;
  return turn(c.before, c.at, c.after) > 0.0L ? left_before && left_after : left_before || left_after;
}

/// Whether two rings, or two parts of one, touch here such that each runs on into the other's corner: what
/// lies between them is then bounded by going over from one to the other. One may run along the other's side
/// where they have an edge in common.
bool must_swap(const Corner& a, const Corner& b) {
  return a.at == b.at && ((in_corner(a, b.after) && touches_corner(b, a.after)) ||
                          (touches_corner(a, b.after) && in_corner(b, a.after)));
}

/// The ring with those corners of `others` that lie on its edges, so that it touches them in corners only.
Ring with_touches(const Ring& ring, const std::vector<Ring>& others) {
  Ring dense;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[wrapped(i + 1, ring.size())];
    std::vector<Vector2d> between;
    for (const Ring& other : others)
      for (const Vector2d& p : other)
        if (p != a && p != b && on_segment(a, b, p)) between.push_back(p);
    std::sort(between.begin(), between.end(), [&](const Vector2d& p, const Vector2d& q) {
      return (p - a).squaredNorm() < (q - a).squaredNorm();
    });
    dense.push_back(a);
    for (const Vector2d& p : between)
      if (p != dense.back()) dense.push_back(p);
  }
  return dense;
}

/// Joins holes to the outer ring by bridges, so that one ring remains.
class HoleJoiner {
 public:
  explicit HoleJoiner(const Polygon& polygon) {
    std::vector<Ring> rings = {cleaned(polygon.outer, true)};
    if (rings[0].empty()) return;
    for (const Ring& hole : polygon.holes) {
      Ring clean = cleaned(hole, false);
      if (!clean.empty()) rings.push_back(std::move(clean));
    }
    ring_ = with_touches(rings[0], rings);
    for (std::size_t i = 1; i < rings.size(); ++i) {
      Ring hole = with_touches(rings[i], rings);
      const auto right = std::max_element(hole.begin(), hole.end(), by_x);
      std::rotate(hole.begin(), right, hole.end());
      holes_.push_back(std::move(hole));
    }
    // From the right: the first corner of each then sees one that is joined already.
    std::stable_sort(holes_.begin(), holes_.end(),
                     [](const Ring& a, const Ring& b) { return a.front().x() > b.front().x(); });
  }

  [[nodiscard]] Ring run() && {
    if (ring_.empty()) return {};
    for (done_ = 0; done_ < holes_.size(); ++done_) join(holes_[done_]);
    return std::move(ring_);
  }

 private:
  static bool by_x(const Vector2d& a, const Vector2d& b) { return a.x() < b.x(); }

  void join(const Ring& hole) {
    if (join_where_touching(hole)) return;
    for (std::size_t from = 0; from < hole.size(); ++from) {
      for (const std::size_t to : nearest_first(hole[from])) {
        if (!is_bridge(corner_of(hole, from), corner_of(ring_, to))) continue;
        splice(hole, from, to);
        return;
      }
    }
    splice(hole, 0, nearest_first(hole[0]).front());
  }

  bool join_where_touching(const Ring& hole) {
    for (std::size_t from = 0; from < hole.size(); ++from) {
      for (std::size_t to = 0; to < ring_.size(); ++to) {
        if (!must_swap(corner_of(hole, from), corner_of(ring_, to))) continue;
        splice(hole, from, to);
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::vector<std::size_t> nearest_first(const Vector2d& p) const {
    std::vector<std::pair<double, std::size_t>> order;
    order.reserve(ring_.size());
    for (std::size_t i = 0; i < ring_.size(); ++i) order.emplace_back((ring_[i] - p).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> indices;
    indices.reserve(order.size());
    for (const auto& [distance, index] : order) indices.push_back(index);
    return indices;
  }

  [[nodiscard]] bool is_bridge(const Corner& from, const Corner& to) const {
    if (from.at == to.at || !in_corner(to, from.at) || !in_corner(from, to.at)) return false;
    if (crosses(ring_, from.at, to.at)) return false;
    return std::none_of(holes_.begin() + static_cast<std::ptrdiff_t>(done_), holes_.end(),
                        [&](const Ring& other) { return crosses(other, from.at, to.at); });
  }

  static bool crosses(const Ring& ring, const Vector2d& a, const Vector2d& b) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (blocked(a, b, ring[i], ring[wrapped(i + 1, ring.size())])) return true;
    return false;
  }

  void splice(const Ring& hole, std::size_t from, std::size_t to) {
    Ring joined(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(to) + 1);
    for (std::size_t i = 0; i <= hole.size(); ++i) joined.push_back(hole[(from + i) % hole.size()]);
    joined.insert(joined.end(), ring_.begin() + static_cast<std::ptrdiff_t>(to), ring_.end());
    ring_ = std::move(joined);
  }

  Ring ring_;
  std::vector<Ring> holes_;
  std::size_t done_ = 0;
};

/// Cuts a ring apart wherever it touches itself.
std::vector<Ring> split_at_touches(Ring whole) {
  std::vector<Ring> open = {std::move(whole)};
  std::vector<Ring> done;
  while (!open.empty()) {
    const Ring ring = without_repetition(open.back());
    open.pop_back();
    bool split = false;
    for (std::size_t i = 0; !split && i < ring.size(); ++i) {
      for (std::size_t k = i + 1; !split && k < ring.size(); ++k) {
        if (!must_swap(corner_of(ring, i), corner_of(ring, k))) continue;
        const auto from = ring.begin() + static_cast<std::ptrdiff_t>(i);
        const auto to = ring.begin() + static_cast<std::ptrdiff_t>(k);
        open.emplace_back(from, to);
        open.emplace_back(ring.begin(), from);
        open.back().insert(open.back().end(), to, ring.end());
        split = true;
      }
    }
    if (!split) done.push_back(ring);
  }
  return done;
}

/// Cuts ears off one ring that may touch itself.
class EarClipper {
 public:
  explicit EarClipper(Ring ring) : points_(std::move(ring)), next_(points_.size()), before_(points_.size()) {
    const std::size_t size = points_.size();
    for (std::size_t i = 0; i < size; ++i) {
      next_[i] = wrapped(i + 1, size);
      before_[i] = wrapped(i + size - 1, size);
    }
  }

  [[nodiscard]] std::vector<Triangle2> run() && {
    std::size_t left = points_.size();
    std::size_t at = 0;
    std::size_t looked = 0;
    while (left > 2) {
      const bool flat = corner(at) == 0.0L;
      const bool stuck = looked > left;
      if (stuck) at = sharpest(at, left);
      if (!flat && !stuck && !is_ear(at)) {
        at = next_[at];
        ++looked;
        continue;
      }
      at = cut(at);
      --left;
      looked = 0;
    }
    return std::move(triangles_);
  }

 private:
  [[nodiscard]] long double corner(std::size_t i) const {
    return turn(points_[before_[i]], points_[i], points_[next_[i]]);
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const Triangle2 ear = {points_[before_[i]], points_[i], points_[next_[i]]};
    if (turn(ear[0], ear[1], ear[2]) <= 0.0L) return false;
    for (std::size_t k = next_[next_[i]]; k != before_[i]; k = next_[k])
      if (disturbs(ear, k)) return false;
    return true;
  }

  /// Whether corner k lies inside the ear, or on its border with an edge that runs in from there.
  [[nodiscard]] bool disturbs(const Triangle2& ear, std::size_t k) const {
    std::array<bool, 3> border{};
    for (std::size_t side = 0; side < 3; ++side) {
      const long double where = turn(ear[side], ear[(side + 1) % 3], points_[k]);
      if (where < 0.0L) return false;
      border[side] = where == 0.0L;
    }
    const auto runs_in = [&](const Vector2d& q) {
      for (std::size_t side = 0; side < 3; ++side)
        if (border[side] && turn(ear[side], ear[(side + 1) % 3], q) <= 0.0L) return false;
      return true;
    };
    return runs_in(points_[next_[k]]) || runs_in(points_[before_[k]]);
  }

  /// Of a ring whose edges cross, the corner to cut that does least harm: convex, with the shortest diagonal.
  [[nodiscard]] std::size_t sharpest(std::size_t at, std::size_t left) const {
    std::size_t best = at;
    double least = 1e300;
    for (std::size_t k = 0; k < left; ++k, at = next_[at]) {
      const double diagonal = (points_[next_[at]] - points_[before_[at]]).norm();
      const double cost = corner(at) > 0.0L ? diagonal : diagonal + 1e150;
      if (cost < least) {
        least = cost;
        best = at;
      }
    }
    return best;
  }

  /// Takes corner i away and goes on two corners further, which keeps the triangles from fanning out.
  std::size_t cut(std::size_t i) {
    if (corner(i) > 0.0L) triangles_.push_back({points_[before_[i]], points_[i], points_[next_[i]]});
    next_[before_[i]] = next_[i];
    before_[next_[i]] = before_[i];
    return next_[next_[i]];
  }

  Ring points_;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> before_;
  std::vector<Triangle2> triangles_;
};

}  // namespace

std::vector<Triangle2> triangulate(const Polygon& polygon) {
  std::vector<Triangle2> all;
  for (Ring& ring : split_at_touches(HoleJoiner(polygon).run())) {
    const std::vector<Triangle2> triangles = EarClipper(std::move(ring)).run();
    all.insert(all.end(), triangles.begin(), triangles.end());
  }
  return all;
}

}  // namespace limen
