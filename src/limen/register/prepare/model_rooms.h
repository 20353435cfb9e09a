// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/model/bim_model.h"

namespace limen {

/// Name of the room that holds `at` (about the model's local origin), with its storey; empty: none does.
std::string room_at(const std::vector<BimSpace>& rooms, const Vector3d& at);

}  // namespace limen
