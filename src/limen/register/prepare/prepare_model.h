// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/model/bim_model.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// Name of the room that holds `at` (about the model's local origin), with its storey; empty: none does.
std::string room_at(const std::vector<BimSpace>& rooms, const Vector3d& at);

/// A model made ready for registration, as a scan is: its visible surface, openings and edges, its surfaces
/// as a view of space, and its rooms by name. `labels` stay empty.
PreparedScan prepare_model(const BimModel& model, Monitor& monitor = silent_monitor());

}  // namespace limen
