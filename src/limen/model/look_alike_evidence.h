// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace limen {

/// How many amounts of bends within a scan are distinguished (kBends in register/judge/as_built.cpp, metres);
/// by the last one a scan is bent so far that walls say nothing.
inline constexpr std::size_t kBendLevels = 7;

/// How many shares of things that are the building's after all (a step, a fitting) are distinguished
/// (look_alike_odds.cpp).
inline constexpr std::size_t kBuiltInLevels = 5;

/// Nats of things, for each of these shares.
using NatsOfThings = std::array<double, kBuiltInLevels>;

/// What was seen of how surfaces were built, for each of these amounts: logarithms of its density.
struct BuiltEvidence {
  std::array<double, kBendLevels> one{};         ///< if the scans show one place ...
  std::array<double, kBendLevels> look_alike{};  ///< ... and if they show two that were built alike
  std::array<double, kBendLevels> as_drawn{};    ///< either, of a building that is exactly as drawn
};

/// What two scans say of whether they show one place or two that look alike
/// (register/judge/look_alike_odds.h). The odds beforehand are of a place. All else is of the scans: over
/// several pairs it adds up.
struct LookAlikeEvidence {
  bool rooms = true;              ///< both scans are of rooms: else things and walls were not asked
  double otherwise = 1.0;         ///< odds beforehand of a look-alike place that is furnished otherwise ...
  double alike = 0.0;             ///< ... and of one that is furnished alike
  NatsOfThings otherwise_nats{};  ///< of things against the first (natural logarithm)
  NatsOfThings alike_nats{};      ///< against the second, if as many things match as stay in one room
  NatsOfThings share_nats{};      ///< against each share itself, if the scans show one place
  BuiltEvidence built{};          ///< of how surfaces were built against either
  double things = 0.0;            ///< how many were seen by both ...
  double agreeing = 0.0;          ///< ... and how many of them agree
};

/// Places that look alike are further from each other than one of these.
inline constexpr double kOtherPlaceM = 0.5;
inline constexpr double kOtherPlaceRad = 0.087;
/// What is nearer to one another than this is no other place: none repeats nearer than a wall is thick.
inline constexpr double kNoOtherPlaceM = 0.15;

}  // namespace limen
