// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/share_belief.h"

#include <algorithm>
#include <cmath>

#include "limen/base/system.h"

namespace limen {
namespace {

double log_beta(double a, double b) {
  return log_gamma(a) + log_gamma(b) - log_gamma(a + b);
}

}  // namespace

double log_beta_binomial(double agreeing, double other, const ShareBelief& belief) {
  const double a = belief.mean * belief.strength;
  const double b = (1.0 - belief.mean) * belief.strength;
  return log_beta(a + agreeing, b + other) - log_beta(a, b);
}

double log_sum_exp(std::span<const double> logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double total = 0.0;
  for (const double one : logs) total += std::exp(one - most);
  return most + std::log(total);
}

double log_sum_exp(std::initializer_list<double> logs) {
  return log_sum_exp(std::span<const double>(logs.begin(), logs.size()));
}

}  // namespace limen
