// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/features.h"

namespace limen {

/// What was seen of one side of a registration, in that side's own frame, about `features.local_origin`.
struct PicturedSide {
  Features features;                ///< `samples` are left out
  Vector3d up = Vector3d::UnitZ();  ///< unit
  bool upright = false;             ///< `up` is known; else it is the z axis
};

/// What a report draws of a registration: indices of matches count in these features.
struct RegistrationPicture {
  PicturedSide source;
  PicturedSide target;
};

}  // namespace limen
