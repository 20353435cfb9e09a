// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "limen/register/judge/verdict.h"

namespace limen {

/// A pose whose walls fit while things tell another place built alike.
struct TwinPlace {
  std::size_t pose = 0;
  TwinEvidence said;
};

/// What is left once such poses are set aside.
struct HeardPlaces {
  Verdict verdict;
  std::vector<TwinPlace> twins;  ///< those set aside, by how much surface agrees
};

using MatterFunction = std::function<IndividualMatter(const RefinedPose& pose)>;

/// Hears what things say of several poses. Walls of a place built alike fit by design, and more of them than
/// a door leaves of the right place: which of two poses far apart is right, things tell, and not how much
/// surface agrees. Each pose that is wrong must lay a place on its twin or meet by chance; with the odds of
/// that, o(k), pose k is o(j) / o(k) times as probable as pose j.
///
/// A pose is set aside where another one, which agrees beyond chance, is 20 times as probable and things tell
/// either clearly. None where nothing is to be set aside.
std::optional<HeardPlaces> hear_past_twins(const std::vector<JudgedPose>& poses, const Verdict& verdict,
                                           const ContrastFunction& contrast, const MatterFunction& matter,
                                           const VerdictOptions& options);

}  // namespace limen
