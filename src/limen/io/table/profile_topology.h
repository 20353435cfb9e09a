// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// Recovers profiles and pulses of a line scanner from the mirror angle of each echo: within a profile the
/// angle grows (or falls) steadily, between profiles it jumps back.
///
/// `theta`: one angle per point, any unit. `times`: seconds per point, or empty: then the points must be in
/// the order of measurement. With times, profiles without any echo are counted too.
///
/// Pulses are numbered by angle, so that equal numbers in neighbouring profiles look in nearly the same
/// direction; several echoes of one pulse share its number. Empty where the angles show no such order: both
/// ways equally often, fewer than two profiles, or profiles too short to be ones.
ScanTopology recover_profiles(const std::vector<double>& theta, const std::vector<double>& times);

}  // namespace limen
