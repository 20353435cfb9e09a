// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// What two scans say of whether they show one place or two that look alike (register/judge/twin_odds.h). The
/// odds beforehand are of a place. All else is of the scans: over several pairs it adds up.
struct TwinEvidence {
  double otherwise = 1.0;       ///< odds beforehand of a look-alike place that is furnished otherwise ...
  double alike = 0.0;           ///< ... and of one that is furnished alike
  double otherwise_nats = 0.0;  ///< of things against the first (natural logarithm)
  double alike_nats = 0.0;      ///< of the faces of things against the second
  double built_nats = 0.0;      ///< of how surfaces were built against either, if no scan is bent
  double things = 0.0;          ///< observations of things ...
  double agreeing = 0.0;        ///< ... and how many of them agree
};

}  // namespace limen
