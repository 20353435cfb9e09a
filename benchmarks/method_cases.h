// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The indoor x outdoor pairs on which registration methods are compared, and what one run on one of them
// gave.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "limen/base/angles.h"
#include "limen/model/result.h"
#include "limen/simulate/scene.h"

namespace limen::methods {

/// A level of difficulty: how the scenes are made and how near a pose must come.
struct Level {
  std::string name;
  std::size_t facades = 0;  ///< street façades the room has open windows in; 0: not asked
  double curtain_share = -1.0;
  double drift_m = 0.0;
  bool any_rotation = false;
  bool alike = false;  ///< nothing tells shifts apart: `ambiguous` with the true pose listed is right
  double bar_m = 0.02;
  double bar_deg = 0.2;
};

inline std::vector<Level> all_levels() {
  return {
      {.name = "easy", .facades = 2, .curtain_share = 0.1},
      {.name = "medium", .facades = 1, .curtain_share = 0.3},
      {.name = "hard", .facades = 1, .curtain_share = 0.6, .drift_m = 0.01, .bar_m = 0.05, .bar_deg = 0.5},
      {.name = "any_rotation", .facades = 2, .curtain_share = 0.1, .any_rotation = true},
      {.name = "identical", .alike = true}};
}

/// About 1 000 points on a square metre of façade, as vehicles of the papers' kind give.
constexpr std::size_t kPointsOutdoor = 2500000;

/// Which pairs to run.
struct Selection {
  std::vector<std::string> levels;  ///< empty: all
  std::vector<std::string> kinds;   ///< empty: all
  std::uint64_t first_seed = 1;
  int pairs = 0;  ///< per kind and level; 0: the full number
  std::size_t points_indoor = 0;
  std::size_t points_outdoor = 0;
};

/// One pair to be made.
struct PairPlan {
  Level level;
  SceneOptions scene;
};

inline bool chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// How many pairs of one kind a level has: 7, 7 and 6 of the three kinds make twenty.
inline int full_count(const Level& level, std::size_t kind) {
  if (level.alike) return 10;
  return kind == 2 ? 6 : 7;
}

/// Plans of all pairs that were asked for, level by level. Half of the pairs with any rotation see one
/// façade.
inline std::vector<PairPlan> plan_pairs(const std::vector<std::string>& kinds, const Selection& selection) {
  std::vector<PairPlan> plans;
  for (const Level& level : all_levels()) {
    if (!chosen(selection.levels, level.name)) continue;
    const std::vector<std::string> scenes = level.alike ? std::vector<std::string>{"identical_bays"} : kinds;
    for (std::size_t kind = 0; kind < scenes.size(); ++kind) {
      if (!level.alike && !chosen(selection.kinds, scenes[kind])) continue;
      const int count = selection.pairs > 0 ? selection.pairs : full_count(level, kind);
      for (int i = 0; i < count; ++i) {
        PairPlan plan{.level = level, .scene = {}};
        plan.scene.name = scenes[kind];
        plan.scene.seed = selection.first_seed + static_cast<std::uint64_t>(i);
        plan.scene.stations = 1;
        plan.scene.facades = level.any_rotation && i % 2 == 1 ? 1 : level.facades;
        plan.scene.curtain_share = level.curtain_share;
        plan.scene.drift_m = level.drift_m;
        plan.scene.any_rotation = level.any_rotation;
        plan.scene.points_indoor = selection.points_indoor;
        plan.scene.points_outdoor = selection.points_outdoor > 0 ? selection.points_outdoor : kPointsOutdoor;
        plans.push_back(plan);
      }
    }
  }
  return plans;
}

/// Façades in which the station sees at least two fifths of one open window of its room, and the street scan
/// sees something through the same. Less is no view: nobody would set up a scanner there to look out.
inline std::size_t facades_seen(const Truth& truth) {
  constexpr int kCells = 26;  // of 64
  std::vector<Vector3d> normals;
  for (const TrueOpening& opening : truth.openings) {
    if (!opening.exterior || opening.curtained || opening.rooms[0] != truth.scans[0].room) continue;
    if (std::popcount(opening.sights[0].cells) < kCells || opening.sights.back().through == 0) continue;
    const bool known = std::any_of(normals.begin(), normals.end(),
                                   [&](const Vector3d& n) { return n.dot(opening.normal) > 0.999; });
    if (!known) normals.push_back(opening.normal);
  }
  return normals.size();
}

/// What one method gave on one pair.
struct Row {
  std::string level;
  std::string kind;
  std::uint64_t seed = 0;
  std::string method;
  std::size_t facades = 0;
  Outcome outcome = Outcome::no_match;
  double rotation_deg = 0.0;
  double translation_m = 0.0;      ///< at the station's centre
  bool near = false;               ///< the best pose is within the level's bar
  bool listed = false;             ///< the true pose is the best or among the alternatives
  std::array<double, 6> sigmas{};  ///< errors about and along x, y, z over their deviations
  double thickness_error_m = std::numeric_limits<double>::quiet_NaN();
  double thickness_sigma_m = std::numeric_limits<double>::quiet_NaN();
  double seconds = 0.0;
  bool alike = false;  ///< nobody can know the pose: it is right to say so and to list it

  [[nodiscard]] bool registered() const { return outcome == Outcome::registered; }
  [[nodiscard]] bool right() const {
    return alike ? outcome == Outcome::ambiguous && listed : registered() && near;
  }
  [[nodiscard]] bool wrong() const { return registered() && !right(); }
};

/// Rotation and translation by which a pose is off, the latter at a point of the source.
struct Miss {
  double rotation_deg = 0.0;
  double translation_m = 0.0;
  [[nodiscard]] bool within(const Level& level) const {
    return rotation_deg <= level.bar_deg && translation_m <= level.bar_m;
  }
};

inline Miss miss_of(const Rigid3& pose, const Rigid3& truth, const Vector3d& source_point) {
  const Rigid3 error = inverse(truth) * pose;
  return {degrees(rotation_angle(error.rotation)), (error * source_point - source_point).norm()};
}

/// The six errors in the target's frame about the centre that the deviations refer to, in deviations.
inline std::array<double, 6> errors_in_sigmas(const RegistrationResult& result, const Rigid3& truth) {
  const Rigid3 off = result.best.target_from_source * inverse(truth);
  const Vector3d turn = rotation_log(off.rotation);
  const Vector3d shift = off * result.sigma.centre - result.sigma.centre;
  std::array<double, 6> errors{};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    errors[i] = turn[k] / std::max(1e-12, result.sigma.rotation_rad[k]);
    errors[i + 3] = shift[k] / std::max(1e-12, result.sigma.translation_m[k]);
  }
  return errors;
}

}  // namespace limen::methods
