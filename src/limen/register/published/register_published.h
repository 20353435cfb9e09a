// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/progress.h"
#include "limen/model/method.h"
#include "limen/model/result.h"
#include "limen/register/prepare/prepared_pair.h"

// The papers' own methods, each in a source of this room, run from two scans to one pose.
//
// Departures that all of them share:
// - planes: 2021, section 2 (scan lines where they are known, else MSAC), the threshold by equations 3 to 6
//   as printed; outlines, façades, the points behind them and openings as limen has them everywhere;
// - scans that do not stand upright are turned so first, by what they show;
// - the start is what the coordinates of the two files say: x_target = x_source;
// - a method gives one pose and no verdict. The outcome is never `registered`, which says that every other
//   pose was looked at: it is `ambiguous`, or `under_constrained` where the method leaves a freedom open by
//   construction, and the reason tells what limen's own measure says of the pose. No deviation is given.

namespace limen {

struct PublishedOptions {
  PublishedMethod method = PublishedMethod::cluster_2021;
  double wall_thickness_m = 0.0;  ///< as the user knows it; 0: not known
  std::uint64_t seed = 1;         ///< of the random trials
};

/// How scans are prepared for a published method.
PrepareOptions published_preparation(PublishedMethod method, Gravity gravity, std::uint64_t seed);

/// Throws Error where one side is a model and the paper's method takes none.
void check_sides(PublishedMethod method, bool with_model);

/// Runs one method. Poses are between the scans' world coordinates. Throws Error as check_sides does.
RegistrationResult register_as_published(const PreparedPair& pair, const PublishedOptions& options,
                                         Monitor& monitor = silent_monitor());

}  // namespace limen
