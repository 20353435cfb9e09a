// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/delaunay.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limen/base/random.h"

// Incremental: a point opens the faces whose circumscribed circle holds it, and a fan from it closes the gap
// (Bowyer 1981, Watson 1981). Points come in rounds, each about twice the one before, and along a curve
// within a round (Amenta, Choi, Rote 2003), so that each is a few steps from the one before.
//
// Three far corners hold all points. A face that they do not touch and whose circle stays away from them is
// one of the triangulation of the points alone.

namespace limen {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kFar = 4;         // of the extent: how far the outer corners lie
constexpr double kSureOfCircle = 1e-13;  // relative, beyond which rounding cannot turn the sign
constexpr std::int32_t kNone = DelaunayFace::kNone;

struct Whole {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// Positive where c lies left of the way from a to b. Exact.
std::int64_t side_of_line(const Whole& a, const Whole& b, const Whole& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d lies within the circle through a, b, c (counter-clockwise). Exact.
bool in_circle(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  const Whole p{a.x - d.x, a.y - d.y};
  const Whole q{b.x - d.x, b.y - d.y};
  const Whole r{c.x - d.x, c.y - d.y};
  const std::int64_t pq = p.x * q.y - p.y * q.x;
  const std::int64_t qr = q.x * r.y - q.y * r.x;
  const std::int64_t rp = r.x * p.y - r.y * p.x;
  const std::int64_t pp = p.x * p.x + p.y * p.y;
  const std::int64_t qq = q.x * q.x + q.y * q.y;
  const std::int64_t rr = r.x * r.x + r.y * r.y;
  const double first = static_cast<double>(pp) * static_cast<double>(qr);
  const double second = static_cast<double>(qq) * static_cast<double>(rp);
  const double third = static_cast<double>(rr) * static_cast<double>(pq);
  const double sum = first + second + third;
  if (std::abs(sum) > kSureOfCircle * (std::abs(first) + std::abs(second) + std::abs(third))) return sum > 0;
  return static_cast<Wide>(pp) * qr + static_cast<Wide>(qq) * rp + static_cast<Wide>(rr) * pq > 0;
}

std::uint64_t along_square_curve(const GridPoint& point) {
  const auto spread = [](std::int32_t coordinate) {
    std::uint64_t v = static_cast<std::uint32_t>(coordinate) + 0x80000000U;
    v = (v | (v << 16U)) & 0x0000ffff0000ffffULL;
    v = (v | (v << 8U)) & 0x00ff00ff00ff00ffULL;
    v = (v | (v << 4U)) & 0x0f0f0f0f0f0f0f0fULL;
    v = (v | (v << 2U)) & 0x3333333333333333ULL;
    return (v | (v << 1U)) & 0x5555555555555555ULL;
  };
  return spread(point.x) | (spread(point.y) << 1U);
}

/// The order in which points come.
std::vector<std::int32_t> insertion_order(const std::vector<GridPoint>& points) {
  struct Turn {
    int round = 0;
    std::uint64_t place = 0;
    std::int32_t point = 0;
  };
  constexpr int kRounds = 12;
  std::vector<Turn> turns(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    turns[i] = {-std::min(kRounds, std::countr_zero(mix64(i + 1))), along_square_curve(points[i]),
                static_cast<std::int32_t>(i)};
  std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
    return a.round != b.round ? a.round < b.round : a.place < b.place;
  });
  std::vector<std::int32_t> order(turns.size());
  for (std::size_t k = 0; k < turns.size(); ++k) order[k] = turns[k].point;
  return order;
}

class DelaunayBuilder {
 public:
  explicit DelaunayBuilder(const std::vector<GridPoint>& points, double most_radius)
      : inner_(static_cast<std::int32_t>(points.size())), fan_(points.size() + 3, kNone) {
    places_.reserve(points.size() + 3);
    std::int64_t reach = static_cast<std::int64_t>(std::ceil(most_radius)) + 1;
    for (const GridPoint& point : points) {
      places_.push_back({point.x, point.y});
      reach = std::max({reach, std::abs(std::int64_t{point.x}), std::abs(std::int64_t{point.y})});
    }
    const std::int64_t far = kFar * reach;
    places_.push_back({-far, -far});
    places_.push_back({far, -far});
    places_.push_back({0, far});
    faces_.reserve(2 * places_.size());
    faces_.push_back({{inner_, inner_ + 1, inner_ + 2}, {kNone, kNone, kNone}});
  }

  void insert(std::int32_t point) {
    open_cavity(face_around(point), point);
    close_cavity(point);
  }

  /// Those of the points alone that are not too large, numbered anew.
  [[nodiscard]] std::vector<DelaunayFace> small_faces(double most_radius) const {
    std::vector<std::int32_t> number(faces_.size(), kNone);
    std::vector<DelaunayFace> kept;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!is_small(faces_[f], most_radius)) continue;
      number[f] = static_cast<std::int32_t>(kept.size());
      kept.push_back(faces_[f]);
    }
    for (DelaunayFace& face : kept) {
      for (std::int32_t& across : face.across)
        across = across == kNone ? kNone : number[static_cast<std::size_t>(across)];
    }
    return kept;
  }

 private:
  /// An edge of the gap, the gap on its left, and what lies beyond.
  struct Border {
    std::int32_t from = 0;
    std::int32_t to = 0;
    std::int32_t beyond = kNone;
  };

  [[nodiscard]] const Whole& at(std::int32_t point) const { return places_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] DelaunayFace& face(std::int32_t f) { return faces_[static_cast<std::size_t>(f)]; }

  [[nodiscard]] bool holds(const DelaunayFace& face, std::int32_t point) const {
    return in_circle(at(face.corners[0]), at(face.corners[1]), at(face.corners[2]), at(point));
  }

  /// The face that a point lies in or on, by a walk towards it.
  [[nodiscard]] std::int32_t face_around(std::int32_t point) {
    std::int32_t here = last_;
    std::int32_t from = kNone;
    for (bool there = false; !there;) {
      there = true;
      const DelaunayFace& face = faces_[static_cast<std::size_t>(here)];
      for (std::size_t k = 0; k < 3 && there; ++k) {
        if (face.across[k] == from && from != kNone) continue;
        if (side_of_line(at(face.corners[(k + 1) % 3]), at(face.corners[(k + 2) % 3]), at(point)) >= 0)
          continue;
        from = here;
        here = face.across[k];
        there = false;
      }
    }
    return here;
  }

  /// Takes out the faces whose circle holds the point; what bounds the gap is left in border_.
  void open_cavity(std::int32_t start, std::int32_t point) {
    border_.clear();
    gap_.assign(1, start);
    in_gap_.resize(faces_.size(), 0);
    in_gap_[static_cast<std::size_t>(start)] = 1;
    for (std::size_t head = 0; head < gap_.size(); ++head) {
      const DelaunayFace open = face(gap_[head]);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t next = open.across[k];
        if (next != kNone && in_gap_[static_cast<std::size_t>(next)] != 0) continue;
        if (next != kNone && holds(face(next), point)) {
          in_gap_[static_cast<std::size_t>(next)] = 1;
          gap_.push_back(next);
        } else {
          border_.push_back({open.corners[(k + 1) % 3], open.corners[(k + 2) % 3], next});
        }
      }
    }
    for (const std::int32_t f : gap_) in_gap_[static_cast<std::size_t>(f)] = 0;
  }

  /// Fills the gap with a fan around the point.
  void close_cavity(std::int32_t point) {
    // A gap of n faces has n + 2 edges.
    while (gap_.size() < border_.size()) {
      gap_.push_back(static_cast<std::int32_t>(faces_.size()));
      faces_.emplace_back();
    }
    for (std::size_t k = 0; k < border_.size(); ++k) {
      const Border& edge = border_[k];
      face(gap_[k]) = {{edge.from, edge.to, point}, {kNone, kNone, edge.beyond}};
      fan_[static_cast<std::size_t>(edge.from)] = gap_[k];
      if (edge.beyond == kNone) continue;
      DelaunayFace& beyond = face(edge.beyond);
      for (std::size_t c = 0; c < 3; ++c) {
        if (beyond.corners[(c + 1) % 3] == edge.to && beyond.corners[(c + 2) % 3] == edge.from)
          beyond.across[c] = gap_[k];
      }
    }
    for (std::size_t k = 0; k < border_.size(); ++k) {
      const std::int32_t next = fan_[static_cast<std::size_t>(border_[k].to)];
      face(gap_[k]).across[0] = next;
      face(next).across[1] = gap_[k];
    }
    last_ = gap_.front();
  }

  [[nodiscard]] bool is_small(const DelaunayFace& face, double most_radius) const {
    if (*std::max_element(face.corners.begin(), face.corners.end()) >= inner_) return false;
    const Whole& a = at(face.corners[0]);
    const Whole& b = at(face.corners[1]);
    const Whole& c = at(face.corners[2]);
    const auto squared = [](const Whole& p, const Whole& q) {
      const auto x = static_cast<double>(p.x - q.x);
      const auto y = static_cast<double>(p.y - q.y);
      return x * x + y * y;
    };
    const auto twice_area = static_cast<double>(side_of_line(a, b, c));
    return std::sqrt(squared(a, b) * squared(b, c) * squared(c, a)) <= 2.0 * twice_area * most_radius;
  }

  std::int32_t inner_;  ///< points before the three outer corners
  std::vector<Whole> places_;
  std::vector<DelaunayFace> faces_;
  std::vector<std::int32_t> fan_;  ///< by point: the face of the fan that begins there
  std::vector<std::int32_t> gap_;
  std::vector<Border> border_;
  std::vector<char> in_gap_;
  std::int32_t last_ = 0;
};

}  // namespace

std::vector<DelaunayFace> delaunay_faces(const std::vector<GridPoint>& points, double most_radius) {
  DelaunayBuilder builder(points, most_radius);
  for (const std::int32_t point : insertion_order(points)) builder.insert(point);
  return builder.small_faces(most_radius);
}

}  // namespace limen
