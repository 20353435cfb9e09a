// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "limen/extract/model/model_surface.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// A piece of the section's outline; the solid lies on its left.
struct Piece {
  Vector2d from;
  Vector2d to;
};

/// Where a face meets the plane: along the line of both planes, between crossings of the face's rings.
class FaceCutter {
 public:
  explicit FaceCutter(const PlaneFrame& frame) : frame_(frame), normal_(frame.u.cross(frame.v)) {}

  void cut(const BimFace& face, std::vector<Piece>& pieces) const {
    const Vector3d line = normal_.cross(face.plane.normal);
    if (line.norm() < 1e-6) return;
    const Vector3d along = line.normalized();
    std::vector<std::pair<double, Vector3d>> crossings;
    add_crossings(face, face.outline.outer, along, crossings);
    for (const Ring& hole : face.outline.holes) add_crossings(face, hole, along, crossings);
    std::sort(crossings.begin(), crossings.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    // With `along` = normal x outward the solid is on the left of the piece when it runs along.
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
      pieces.push_back({frame_.to_plane(crossings[k].second), frame_.to_plane(crossings[k + 1].second)});
  }

 private:
  void add_crossings(const BimFace& face, const Ring& ring, const Vector3d& along,
                     std::vector<std::pair<double, Vector3d>>& crossings) const {
    if (ring.empty()) return;
    const auto height = [&](const Vector3d& x) { return normal_.dot(x - frame_.origin); };
    Vector3d a = face.frame.to_space(ring.back());
    double at_a = height(a);
    for (const Vector2d& corner : ring) {
      const Vector3d b = face.frame.to_space(corner);
      const double at_b = height(b);
      // A corner in the plane counts as above it, in every face alike.
      if ((at_a < 0) != (at_b < 0)) {
        const Vector3d x = a + (b - a) * (at_a / (at_a - at_b));
        crossings.emplace_back(along.dot(x), x);
      }
      a = b;
      at_a = at_b;
    }
  }

  PlaneFrame frame_;
  Vector3d normal_;
};

/// Joins pieces end to end into closed rings.
class RingMaker {
 public:
  RingMaker(std::vector<Piece> pieces, double tolerance_m)
      : pieces_(std::move(pieces)), tolerance_m_(tolerance_m), used_(pieces_.size(), false) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) starts_[cell_of(pieces_[i].from)].push_back(i);
  }

  std::vector<Ring> run() {
    std::vector<Ring> rings;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (used_[i]) continue;
      Ring ring;
      std::size_t at = i;
      bool open = false;
      while (!used_[at]) {
        used_[at] = true;
        ring.push_back(pieces_[at].from);
        if ((pieces_[at].to - pieces_[i].from).norm() <= tolerance_m_) break;
        const std::size_t next = next_of(pieces_[at].to);
        open = next == pieces_.size();
        if (open) break;
        at = next;
      }
      if (!open && ring.size() >= 3) rings.push_back(std::move(ring));
    }
    return rings;
  }

 private:
  [[nodiscard]] std::int64_t cell_of(const Vector2d& p, int dx = 0, int dy = 0) const {
    const auto part = [&](double x, int d) {
      return static_cast<std::int64_t>(std::floor(x / cell_m())) + d;
    };
    return part(p.x(), dx) * 4294967291LL + part(p.y(), dy);
  }
  [[nodiscard]] double cell_m() const { return 2.0 * tolerance_m_; }

  [[nodiscard]] std::size_t next_of(const Vector2d& end) const {
    std::size_t best = pieces_.size();
    double least = tolerance_m_;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto found = starts_.find(cell_of(end, dx, dy));
        if (found == starts_.end()) continue;
        for (const std::size_t i : found->second) {
          const double off = (pieces_[i].from - end).norm();
          if (used_[i] || off > least || (off == least && i > best)) continue;
          least = off;
          best = i;
        }
      }
    }
    return best;
  }

  std::vector<Piece> pieces_;
  double tolerance_m_;
  std::vector<bool> used_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> starts_;
};

}  // namespace

std::vector<Polygon> cross_section(const std::vector<const BimFace*>& faces, const PlaneFrame& frame,
                                   double tolerance_m) {
  const FaceCutter cutter(frame);
  std::vector<Piece> pieces;
  for (const BimFace* face : faces) cutter.cut(*face, pieces);
  std::vector<Polygon> outers;
  std::vector<Polygon> holes;
  for (Ring& ring : RingMaker(std::move(pieces), tolerance_m).run()) {
    const bool outer = signed_area(ring) > 0;
    if (!outer) std::reverse(ring.begin(), ring.end());
    (outer ? outers : holes).push_back({std::move(ring), {}});
  }
  return holes.empty() ? outers : difference(outers, holes);
}

}  // namespace limen
