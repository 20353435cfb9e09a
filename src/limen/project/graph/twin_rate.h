// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/twin_evidence.h"

namespace limen {

/// What the things of two scans whose walls fit say of a twin.
struct TwinWitness {
  int source = -1;
  int target = -1;
  TwinEvidence evidence;
};

/// Of each kind of twin, by what to multiply the probability that is believed beforehand of one pair alone.
struct TwinFactors {
  double otherwise = 1.0;
  double alike = 1.0;
};

/// How many of the pairs whose walls fit are twins is a property of a building, and how many of these are
/// furnished alike is as well: a hotel has many of both, a terrace many of the first, a villa none. The
/// shares of the three, r of twins furnished otherwise, a of those furnished alike, 1 - r - a of one room,
/// are known as a Dirichlet distribution with the means that one pair alone is given and the strength of one
/// observation, and learned from all pairs whose things say something: of nats o and a',
///
///   likelihood of a pair  =  1 - r - a + r exp(-o) + a exp(-a').
///
/// What says nothing teaches nothing. Twins furnished alike are weighed against one room, by a / (1 - r):
/// what speaks for or against twins furnished otherwise alone says nothing of these. Of pairs that lie in a
/// loop only the most telling ones count, so that one room seen from many places is not many.
class TwinRate {
 public:
  TwinRate(int nodes, const std::vector<TwinWitness>& witnesses);

  /// For links from the nodes on one `side` to those on the other; what pairs say that lead across teaches
  /// them nothing. Never less than a fifteenth: no number of other rooms makes two bare ones the same.
  [[nodiscard]] TwinFactors factors(const std::vector<bool>& side) const;

 private:
  /// Shares of both kinds, and how probable they are.
  struct Shares {
    double otherwise = 0.0;
    double alike_of_rest = 0.0;  ///< of what is no twin furnished otherwise
    double log_believed = 0.0;
  };
  struct Lesson {
    int source = -1;
    int target = -1;
    double otherwise = 1.0;  ///< by how much more probable a twin makes what was seen than one room does
    double alike = 1.0;
    [[nodiscard]] double log_likelihood(const Shares& shares) const;
  };
  static Shares mean(const std::vector<Shares>& all);

  std::vector<Shares> shares_;
  Shares mean_before_;
  std::vector<Lesson> lessons_;
};

}  // namespace limen
