// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

/// A flat face with an outline, seen from the side its normal points to.
struct FlatFace {
  Plane plane;
  PlaneFrame frame;  ///< 2-D coordinates of `outline`, right-handed with the normal
  Polygon outline;
};

/// A face near a point.
struct FaceHit {
  int face = -1;            ///< index; -1: none within reach
  double distance_m = 0.0;  ///< to the nearest point of the face, >= 0
  double signed_m = 0.0;    ///< to its plane, positive on the side of its normal
};

/// Which faces a point accepts.
struct FaceQuery {
  Vector3d x = Vector3d::Zero();
  const Vector3d* normal = nullptr;     ///< unit, of the surface at x; null: any direction
  double min_cosine = 0.0;              ///< of the face's normal with `normal`
  bool oriented = false;                ///< the sign of `normal` counts
  const Vector3d* seen_from = nullptr;  ///< only faces whose front that point sees; null: any
  const Plane* but_not = nullptr;       ///< no face within 5 mm of this plane that looks the same way
};

/// A place where a straight line goes through a face.
struct FaceCrossing {
  int face = -1;
  Vector3d at = Vector3d::Zero();
};

/// Many flat faces made ready to be asked which is nearest to a point, and which a ray crosses. Answers do
/// not depend on how the faces are kept, only on their order (the first of equally near ones).
class FaceIndex {
 public:
  /// Faces farther than `reach_m` > 0 from a point are not found.
  FaceIndex(std::vector<FlatFace> faces, double reach_m);

  [[nodiscard]] FaceHit nearest(const FaceQuery& query) const;
  /// Every face that the straight line from `from` to `to` goes through, in no order; each once.
  [[nodiscard]] std::vector<FaceCrossing> crossings(const Vector3d& from, const Vector3d& to) const;

  [[nodiscard]] const FlatFace& face(int index) const { return faces_[static_cast<std::size_t>(index)].face; }
  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  struct Prepared {
    FlatFace face;
    Vector2d low = Vector2d::Zero();  // box of the outline
    Vector2d high = Vector2d::Zero();
    bool rectangle = false;  // the outline fills its box
  };
  using Place = Eigen::Matrix<std::int64_t, 3, 1>;

  void layout();
  void fill();
  [[nodiscard]] Place place_of(const Vector3d& x) const;
  [[nodiscard]] std::size_t cell_at(const Place& place) const;
  [[nodiscard]] bool inside(const Place& place) const;
  template <typename Visit>
  void visit_cells(const Prepared& face, const Visit& visit) const;
  [[nodiscard]] static double outside_distance(const Prepared& face, const Vector2d& p, double most);
  void cross(std::size_t cell, const Vector3d& from, const Vector3d& to,
             std::vector<FaceCrossing>& found) const;

  std::vector<Prepared> faces_;
  double reach_m_ = 0.0;
  double cell_m_ = 0.25;
  Vector3d low_ = Vector3d::Zero();
  Vector3d high_ = Vector3d::Zero();
  Place size_ = Place::Zero();
  std::vector<std::uint32_t> begin_;  // of each cell in members_, and one more
  std::vector<std::uint32_t> members_;
};

}  // namespace limen
