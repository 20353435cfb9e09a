// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The scans of building models on which registration with a model is measured: which there are, how each is
// made, and when an answer is right.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/bim/read_bim.h"
#include "limen/model/result.h"
#include "limen/register/register.h"
#include "limen/simulate/model/bim_recipe.h"
#include "limen/simulate/model/bim_scene.h"

namespace limen::bim_cases {

inline constexpr double kMostHidden = 0.7;  // of the walls' length, in furnished rooms

/// One case to be made.
struct CasePlan {
  std::size_t model = 0;  ///< index into the models on the command line
  std::size_t stations = 1;
  bool as_built = false;
  bool any_rotation = false;
  std::uint64_t seed = 1;
  bool furnished = false;  ///< as built, and a share of the walls hidden by furniture, 0 to 70 %, by the seed

  /// "3 stations, as built, any rotation, seed 2".
  [[nodiscard]] std::string label() const {
    return fmt::format("{} station{}, {}, {}, seed {}", stations, stations == 1 ? "" : "s",
                       furnished  ? "furnished"
                       : as_built ? "as built"
                                  : "as planned",
                       any_rotation ? "any rotation" : "level", seed);
  }
};

/// Which cases to make.
struct Selection {
  std::size_t at_least = 60;  ///< cases in all: as many seeds as that takes
  std::uint64_t first_seed = 1;
  std::size_t points = 0;  ///< of each station; 0: the simulator's own
  bool furnished = false;  ///< instead of the usual cases furnished ones, as built
  bool as_built = false;   ///< only cases as built
};

/// All combinations of 1 or 3 stations, as planned or as built, level or any rotation, for every model, with
/// so many seeds that there are as many cases as asked.
inline std::vector<CasePlan> plan_cases(std::size_t models, const Selection& selection) {
  constexpr std::size_t kCombinations = 8;
  const std::size_t per_seed = kCombinations * std::max<std::size_t>(1, models);
  const std::size_t seeds = (selection.at_least + per_seed - 1) / per_seed;
  std::vector<CasePlan> plans;
  for (std::size_t model = 0; model < models; ++model)
    for (std::size_t seed = 0; seed < seeds; ++seed)
      for (std::size_t k = 0; k < kCombinations; ++k)
        plans.push_back({.model = model,
                         .stations = (k & 1U) != 0 ? std::size_t{3} : std::size_t{1},
                         .as_built = selection.furnished || selection.as_built || (k & 2U) != 0,
                         .any_rotation = (k & 4U) != 0,
                         // Another room for each case, not eight times the same.
                         .seed = selection.first_seed + seed * kCombinations + k,
                         .furnished = selection.furnished});
  return plans;
}

/// Reads a model file; "office" is the built-in one.
inline BimModel read_model(const std::string& name) {
  BimModel model = name == "office" ? model_of(office_recipe()) : read_bim(name);
  model.name = std::filesystem::path(name).filename().string();
  return model;
}

/// Scans the model. A room may have no place for three stations: then another seed's, a thousand on.
inline SimulatedCase make_case(const BimModel& model, CasePlan plan, const Selection& selection) {
  BimSceneOptions options;
  options.stations = plan.stations;
  options.any_rotation = plan.any_rotation;
  options.as_built.on = plan.as_built;
  if (plan.furnished)
    options.as_built.hidden_wall_share = RandomStream(plan.seed, 611).uniform(0.0, kMostHidden);
  if (selection.points > 0) options.points = selection.points;
  for (int attempt = 0;; ++attempt, plan.seed += 1000) {
    options.seed = plan.seed;
    try {
      return simulate_bim(model, options);
    } catch (const Error&) {
      if (attempt == 10) throw;
    }
  }
}

/// The scans as one side of a registration: their poses among one another are known.
inline RegisterInput input_of(const SimulatedCase& made) {
  RegisterInput input;
  for (std::size_t i = 0; i < made.scans.size(); ++i)
    input.scans.push_back({made.scans[i], true_target_from_source(made.truth, i, 0)});
  return input;
}

/// Whether the model has other rooms like each of those the stations stand in: then nobody can be sure.
inline bool is_repeated(const Truth& truth) {
  return truth.model && std::all_of(truth.model->rooms.begin(), truth.model->rooms.end(),
                                    [](const ModelRoom& room) { return !room.like.empty(); });
}

/// How an answer compares with the truth.
struct Judgement {
  double rotation_deg = 0.0;
  double translation_m = 0.0;  ///< of the first station's centre
  bool near = false;           ///< the best pose is within 2 cm and 0.2 degrees
  bool listed = false;         ///< the best pose or an alternative is
  bool repeated = false;       ///< the model repeats the room
  Outcome outcome = Outcome::no_match;

  /// Registered rightly, or rightly undecided with the truth among the candidates.
  [[nodiscard]] bool right() const {
    return outcome == Outcome::registered ? near : outcome == Outcome::ambiguous && listed && repeated;
  }
  [[nodiscard]] bool wrong() const { return outcome == Outcome::registered && !near; }
};

inline Judgement judge(const RegistrationResult& result, const Truth& truth) {
  constexpr double kBarM = 0.02;
  constexpr double kBarDeg = 0.2;
  const Rigid3 expected = world_from_scan(truth, 0);
  const auto miss = [&](const Rigid3& pose) {
    const double turn = degrees(rotation_angle(expected.rotation.transpose() * pose.rotation));
    return std::pair<double, double>(turn, (pose.translation - expected.translation).norm());
  };
  const auto within = [&](const Rigid3& pose) {
    const auto [turn, shift] = miss(pose);
    return turn <= kBarDeg && shift <= kBarM;
  };
  Judgement judgement;
  judgement.outcome = result.outcome;
  judgement.repeated = is_repeated(truth);
  if (result.outcome == Outcome::no_match) return judgement;
  std::tie(judgement.rotation_deg, judgement.translation_m) = miss(result.best.target_from_source);
  judgement.near = within(result.best.target_from_source);
  judgement.listed =
      judgement.near || std::any_of(result.alternatives.begin(), result.alternatives.end(),
                                    [&](const Hypothesis& h) { return within(h.target_from_source); });
  return judgement;
}

}  // namespace limen::bim_cases
