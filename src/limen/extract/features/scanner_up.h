// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/base/progress.h"
#include "limen/model/scan.h"

namespace limen {

/// The direction against gravity that a scan shows by itself, unit vector in its own frame; empty where it
/// does not tell.
///
/// A tripod scanner measures nothing straight below itself: of the main directions of the planes, up is the
/// one whose opposite lies in the widest round cone without a point. A vehicle drives on the ground: up is
/// the one along which a plane lies a constant 1 to 5 m under its path. Costs a look at part of the points.
std::optional<Vector3d> find_scanner_up(const Scan& scan, Monitor& monitor = silent_monitor());

}  // namespace limen
