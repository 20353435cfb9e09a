// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace limen {

/// What things say of whether two scans show one place or two that look alike: odds beforehand, and by how
/// much one place explains better what was seen (natural logarithms). They are separate, for what several
/// pairs say of one place multiplies, and what is believed of the place does not.
struct TwinEvidence {
  double otherwise = 1.0;       ///< odds beforehand of a look-alike place furnished otherwise ...
  double alike = 0.0;           ///< ... and of one furnished alike as well
  double otherwise_nats = 0.0;  ///< against the first
  double alike_nats = 0.0;      ///< against the second
  /// What surfaces of the building say against either, by how they were built (as_built.h).
  double built_nats = 0.0;

  /// Odds of a twin of either kind.
  [[nodiscard]] double odds() const {
    return std::exp(-built_nats) * (otherwise * std::exp(-otherwise_nats) + alike * std::exp(-alike_nats));
  }
  [[nodiscard]] double probability() const {
    const double against = odds();
    return std::isfinite(against) ? against / (1.0 + against) : 1.0;
  }
};

/// Evidence that leaves a probability of `probability`, of whichever kind of twin.
inline TwinEvidence twin_evidence_of(double probability) {
  constexpr double kMostNats = 50.0;
  TwinEvidence evidence;
  const double nats =
      probability > 0.0 ? std::log(evidence.odds() * (1.0 - probability) / probability) : kMostNats;
  evidence.otherwise_nats = evidence.alike_nats = std::min(nats, kMostNats);
  return evidence;
}

}  // namespace limen
