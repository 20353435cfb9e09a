// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "limen/project/graph/pose_graph.h"

namespace limen {

/// What one pair of nodes says of one relative pose, as logarithms of likelihood ratios (nats).
struct PairEvidence {
  double chance_nats = 0.0;  ///< against "the pair shares nothing"
  /// Against the same where other links already lay the pair so: wrong poses seldom agree by chance.
  double coincidence_nats = 0.0;
  TwinEvidence twins;  ///< against look-alike places
  bool looks_for_twins =
      false;  ///< `twins` was measured; else a look-alike place is one of the pair's own poses

  /// Against a look-alike place of one kind (`&TwinEvidence::otherwise_nats` or `alike_nats`).
  [[nodiscard]] double against_twin(double TwinEvidence::*nats) const;
  [[nodiscard]] double odds_of_twin() const { return looks_for_twins ? twins.odds() : 0.0; }
  /// Against every other explanation, where nothing else joins the two nodes.
  [[nodiscard]] double alone() const;
  /// The same where other links join them as well.
  [[nodiscard]] double in_loop() const;
};

/// No pair is surer than this. Of 115 answers with a probability above 0.999 all are right
/// (benchmarks/calibration): a single pair is trusted to one in ten thousand.
inline constexpr double kMostPairNats = 9.2;

/// What several pairs say together against one look-alike place. How alike its rooms are furnished is a
/// property of the place: what supports one furnished alike is believed once, by the pair that says most.
class LookAlikeNats {
 public:
  /// `nats`: of which kind, as PairEvidence::against_twin() has it.
  explicit LookAlikeNats(double TwinEvidence::*nats) : nats_(nats) {}
  void add(const PairEvidence& evidence, double share = 1.0) {
    const double against = share * evidence.against_twin(nats_);
    if (against < 0.0 && nats_ == &TwinEvidence::alike_nats)
      least_ = std::min(least_, against);
    else
      sum_ += against;
  }
  [[nodiscard]] double sum() const { return sum_ + least_; }

 private:
  double TwinEvidence::*nats_;
  double sum_ = 0.0;
  double least_ = 0.0;
};

/// Of a pose of a link.
PairEvidence evidence_of(const GraphLink& link, std::size_t pose);

}  // namespace limen
