// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/passes/bent_passes.h"
#include "limen/project/result/project_result.h"
#include "limen/project/store/scan_digest.h"

namespace limen {

/// Why a mobile pass stays rigid, as far as it tells itself.
std::string why_rigid(const ScanDigest& digest);

/// A bent pass in the result's frame: `stated_from_solved` leads there from that of the solution, and
/// `origin` is what its numbers are about.
PassCorrection stated_correction(const BentPass& pass, const PassWay& way, const Rigid3& stated_from_solved,
                                 const Vector3d& origin);

}  // namespace limen
