// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/scan_style.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/random.h"

namespace limen {

ScanStyle random_scan_style(const ScanStyle& plain, std::uint64_t seed) {
  RandomStream random(seed, 30);
  ScanStyle style = plain;
  style.points = static_cast<std::size_t>(static_cast<double>(plain.points) * random.uniform(0.5, 1.5));
  style.scanner.noise_m = random.uniform(0.001, 0.008);
  style.scanner.mixed_pixel_share = random.uniform(0.05, 0.45);
  style.scanner.loss_share = random.uniform(0.0, 0.03);
  style.scanner.glass_return_share = random.uniform(0.0, 0.15);
  style.scanner.glass_loss_share = random.uniform(0.0, 0.5);
  style.scanner.glass_mirror_share = random.uniform() < 0.4 ? random.uniform(0.05, 0.3) : 0.0;
  style.view.low_deg = random.uniform(-65.0, -40.0);
  style.view.high_deg = random.uniform() < 0.3 ? random.uniform(45.0, 75.0) : 90.0;
  if (random.uniform() < 0.12) style.view.span_deg = random.uniform(190.0, 270.0);
  if (random.uniform() < 0.3) style.tilt_rad = radians(std::min(3.0, std::abs(random.normal())));
  if (random.uniform() < 0.3) {
    style.file_origin = {random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), random.uniform(-2.0, 2.0)};
    style.origin_stated = random.uniform() < 0.4;
  }
  if (random.uniform() < 0.3) style.people = 1 + static_cast<int>(random.below(3));
  return style;
}

FurnishingStyle random_furnishing_style(std::uint64_t seed) {
  RandomStream random(seed, 31);
  FurnishingStyle style;
  style.least_hidden = random.uniform(0.0, 0.3);
  style.most_hidden = random.uniform(style.least_hidden, 0.7);
  style.small_per_m2 = random.uniform(0.0, 0.25);
  style.shift_m = random.uniform(0.01, 0.05);
  style.turn_rad = random.uniform(0.005, 0.05);
  return style;
}

}  // namespace limen
