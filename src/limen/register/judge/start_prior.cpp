// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/start_prior.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr double kSearched_m3 = 40.0 * 40.0 * 10.0;
const double kRootTwoPi = std::sqrt(2.0 * std::numbers::pi);

/// Share of a normal spread in space within `radius` standard deviations.
double share_within(double radius) {
  return std::erf(radius / std::numbers::sqrt2) -
         2.0 / kRootTwoPi * radius * std::exp(-0.5 * radius * radius);
}

}  // namespace

void StartPrior::check() const {
  if (!(sigma_m > 0)) throw_bad_option("sigma_m", sigma_m, "more than 0");
  if (!(sigma_rad > 0)) throw_bad_option("sigma_rad", sigma_rad, "more than 0");
  if (!(trust > 0 && trust < 1)) throw_bad_option("trust", trust, "within (0, 1)");
}

StartAgreement miss_of_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at) {
  StartAgreement miss;
  miss.shift_m = (pose * at - start.target_from_source * at).norm();
  miss.turn_rad = rotation_angle(start.target_from_source.rotation.transpose() * pose.rotation);
  miss.sigmas = std::max(miss.shift_m / start.sigma_m, miss.turn_rad / start.sigma_rad);
  return miss;
}

double log_prior_of_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at, bool upright,
                          double most) {
  const StartAgreement miss = miss_of_start(start, pose, at);
  const double shifts = miss.shift_m / start.sigma_m;
  const double turns = miss.turn_rad / start.sigma_rad;
  // Over all headings 2 pi, over all turns 8 pi^2. A belief wider than the search says nothing.
  const double turn_density =
      upright ? 2.0 * std::numbers::pi / (kRootTwoPi * start.sigma_rad)
              : 8.0 * std::numbers::pi * std::numbers::pi / std::pow(kRootTwoPi * start.sigma_rad, 3);
  const double density = std::max(1.0, kSearched_m3 / std::pow(kRootTwoPi * start.sigma_m, 3)) *
                         std::max(1.0, turn_density) * std::exp(-0.5 * (shifts * shifts + turns * turns));
  return std::min(most, std::log(start.trust * density + (1.0 - start.trust)));
}

double log_prior_elsewhere(const StartPrior& start, const Rigid3& pose, const Vector3d& at, double apart_m) {
  // How much of the belief lies farther than that from the pose, were the pose in its middle; if it is not,
  // what is beyond by as much more.
  const double off = miss_of_start(start, pose, at).shift_m;
  const double near = share_within(std::max(0.0, apart_m - off) / start.sigma_m);
  return std::log(start.trust * (1.0 - near) + (1.0 - start.trust));
}

double odds_of_look_alike_beside_start(const StartPrior& start, const Rigid3& pose, const Vector3d& at,
                                       double log_prior) {
  constexpr double kRoomApartM = 2.5;
  return std::exp(std::max(log_prior_elsewhere(start, pose, at, kRoomApartM) - log_prior,
                           std::log((1.0 - start.trust) / start.trust)));
}

}  // namespace limen
