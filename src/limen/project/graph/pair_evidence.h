// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "limen/project/graph/pose_graph.h"
#include "limen/register/judge/as_built.h"
#include "limen/register/judge/look_alike_odds.h"

namespace limen {

/// What one pair of nodes says of one relative pose, as logarithms of likelihood ratios (nats).
struct PairEvidence {
  double chance_nats = 0.0;  ///< against "the pair shares nothing"
  /// Against the same where other links already lay the pair so: wrong poses seldom agree by chance.
  double coincidence_nats = 0.0;
  LookAlikeEvidence look_alikes;  ///< against look-alike places
  /// `look_alikes` was measured; else a look-alike place is one of the pair's own poses.
  bool asks_look_alike = false;
  /// By a file, a survey or a user: it depends on no surface, which another pair may show too.
  bool stated = false;

  /// Whether things and walls of rooms were asked about.
  [[nodiscard]] bool asks_things() const { return asks_look_alike && look_alikes.rooms; }
  /// Against a look-alike room behind windows, by what is contradicted and what agrees; where `look_alikes`
  /// are not of rooms.
  [[nodiscard]] double behind_windows_nats() const;
  /// Odds of a look-alike place of either kind.
  [[nodiscard]] double odds_of_look_alike() const;
  /// Against every other explanation, where nothing else joins the two nodes.
  [[nodiscard]] double alone() const;
  /// The same where other links join them as well.
  [[nodiscard]] double in_loop() const;
};

/// No pair is surer than this. Of 115 answers with a probability above 0.999 all are right
/// (benchmarks/calibration): a single pair is trusted to one in ten thousand.
inline constexpr double kMostPairNats = 9.2;

/// What several pairs say together against look-alike places. How many of its things are its own is a
/// question for all of them at once.
class LookAlikeSum {
 public:
  explicit LookAlikeSum(const BuiltBelief& built = {}) : belief_(built) {}

  /// Shares of what the pair shows that count for it (SharedViews): of things, and of the building's surface.
  void add(const PairEvidence& evidence, double of_things = 1.0, double of_surface = 1.0);
  /// Things of a pair of rooms, alone.
  void add_things(const LookAlikeEvidence& look_alikes, double of_things);
  /// How walls were built, alone. For one place they say no more than their share of what a pair may; each
  /// pair that speaks against it would have to be bent for itself.
  void add_walls(const BuiltEvidence& walls, double of_surface);
  [[nodiscard]] double stayed_nats(const StayedBelief& stayed) const { return nats_of_stayed(sum_, stayed); }
  [[nodiscard]] double against_otherwise(double stayed_nats = 0.0) const {
    return limen::against_otherwise(sum_, belief_.as_drawn, stayed_nats) + built_nats_;
  }
  [[nodiscard]] double against_alike(double stayed_nats = 0.0) const {
    return limen::against_alike(sum_, belief_.as_drawn, stayed_nats) + built_nats_;
  }

 private:
  BuiltBelief belief_;
  LookAlikeEvidence sum_;  ///< of things
  double built_nats_ = 0.0;
};

/// Of a pose of a link.
PairEvidence evidence_of(const GraphLink& link, std::size_t pose);

}  // namespace limen
