// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/result.h"
#include "limen/register/options/pair_options.h"

namespace limen {

/// How far a pose is from the one believed. `at`: a point of the source in the middle of what it saw.
StartAgreement miss_of_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at);

/// Logarithm of how much more probable a belief makes a pose: its density over the uniform density in the
/// space that is searched (40 x 40 x 10 m, all headings where `upright`, else all rotations). At least
/// log(1 - trust) and at most `most`: a belief may single out one of the poses that a search can distinguish,
/// but is no evidence that the scans overlap.
double log_prior_of_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at, bool upright,
                          double most);

/// The same of all poses whose place is more than `apart_m` from that of `pose`, as a look-alike place's:
/// other rooms that the belief bears as well.
double log_prior_elsewhere(const StartPrior& start, const Rigid3& pose, const Vector3d& at, double apart_m);

/// By how much a belief about the pose changes the odds of a look-alike place; `log_prior`: of `pose`. A
/// look-alike is another place, a room away at least. But who takes one room for another believes the wrong
/// place as sharply as the right one: what is not trusted counts as such mistakes, so that no belief, however
/// sharp, makes a look-alike less probable than by (1 - trust) / trust.
double odds_of_look_alike_beside_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at,
                                       double log_prior);

}  // namespace limen
