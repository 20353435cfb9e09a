// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <span>

namespace limen {

/// A share that is not known exactly, as the mean and the strength (in observations) of a beta distribution.
struct ShareBelief {
  double mean = 0.5;
  double strength = 2.0;
};

/// log of the mean of q^agreeing (1 - q)^other over the belief about the share q (beta-binomial; the counts
/// need not be whole).
double log_beta_binomial(double agreeing, double other, const ShareBelief& belief);

/// log of the sum of exp(x) over `logs`, of which there is one at least.
double log_sum_exp(std::span<const double> logs);
double log_sum_exp(std::initializer_list<double> logs);

}  // namespace limen
