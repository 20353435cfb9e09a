// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/geometry/rigid.h"

namespace limen {

/// The shortest rotation that takes the direction of `from` to that of `to`, neither of them zero. Where they
/// are opposite, a half turn about some direction across them, the same one for the same vectors.
Matrix3d rotation_between(const Vector3d& from, const Vector3d& to);

}  // namespace limen
