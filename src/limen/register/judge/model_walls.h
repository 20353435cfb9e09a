// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/register/prepare/scan_view.h"

namespace limen {

/// How the walls that a scan saw agree with a model under one pose. In observations: of one plane
/// neighbouring pieces say the same, so that its surface saturates, and neither more points nor more pieces
/// say more.
struct WallBalance {
  double asked = 0.0;      ///< of walls that should be the model's
  double explained = 0.0;  ///< of these on a surface of the model

  [[nodiscard]] double share() const { return asked > 0 ? explained / asked : 1.0; }
};

/// Asks a model about the walls of a scan, pose by pose.
///
/// A model's world ends at its walls: what the scanner, standing where a pose puts it, sees through an
/// opening of the model is not asked for. Which surface that is the pose and the model say, not the way the
/// scan was cut into planes. Nor is a piece of furniture a wall: planes that do not reach up to a ceiling
/// count little.
class ModelWalls {
 public:
  /// Both must outlive this.
  ModelWalls(const ScanView& scan, const ScanView& model);

  [[nodiscard]] WallBalance under(const Rigid3& model_from_scan) const;

 private:
  struct Piece {
    Vector3d at = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    double area_m2 = 0.0;
    bool oriented = false;
    bool interior = false;
    std::size_t plane = 0;
  };
  struct Rectangle {
    Vector3d corner = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    Vector3d across = Vector3d::Zero();  ///< edge over its squared length
    Vector3d up = Vector3d::Zero();
    [[nodiscard]] bool is_crossed(const Vector3d& from, const Vector3d& to) const;
  };

  static constexpr std::size_t kWaysUp = 6;
  using Reaching = std::vector<double>;  ///< of each plane: the share of its length that reaches a ceiling

  [[nodiscard]] Reaching reaching_ceiling(const Vector3d& up) const;
  [[nodiscard]] const Reaching* reaching_under(const Matrix3d& rotation) const;
  void choose_pieces();
  [[nodiscard]] std::vector<Vector3d> stations_under(const Rigid3& model_from_scan) const;
  [[nodiscard]] bool is_asked(const Piece& piece, const Vector3d& at,
                              const std::vector<Vector3d>& stations) const;

  const ScanView& scan_;
  const ScanView& model_;
  std::vector<Piece> pieces_;
  std::array<Reaching, kWaysUp> reaching_;  ///< were +x, -x, +y, -y, +z or -z of the scan's frame up
  std::vector<Rectangle> openings_;
};

}  // namespace limen
