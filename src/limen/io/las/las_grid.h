// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/geometry/rigid.h"
#include "limen/io/las/las_header.h"

namespace limen {

/// An axis-aligned box.
struct LasBox {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
};

/// The steps in which coordinates are stored: coordinate = offset + scale * integer.
struct LasGrid {
  Vector3d scale = Vector3d::Ones();
  Vector3d offset = Vector3d::Zero();
  bool unchanged = false;  ///< the integers stay, only the offset moves
};

/// The box round the eight corners of a moved box.
LasBox moved_box(const LasBox& box, const Rigid3& target_from_source);

/// The box that the header tells, where it can be one.
std::optional<LasBox> stated_box(const LasHeader& header);

/// A round number near a place: what stored coordinates are counted from.
Vector3d round_offset(const Vector3d& near);

/// A grid for points in `box`, target frame: steps as fine as the finest old ones and 0.1 mm, where the box
/// allows, else the next power of ten that it allows; the offset is a round number near its middle. A pose
/// without rotation keeps the old steps and shifts the offset.
LasGrid moved_grid(const LasHeader& header, const Rigid3& target_from_source, const LasBox& box);

}  // namespace limen
