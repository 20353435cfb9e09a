// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/register/prepare/scan_view.h"

namespace limen {

/// Samples of one side that the other is asked about, in their order (plane by plane, clutter last).
struct AskedSamples {
  std::vector<std::uint32_t> indices;
  double factor = 1.0;  ///< surface that each represents, as a multiple of its own
};

/// Every n-th sample of `scan`, so that about `most` are left (0: all). Of a model only those within the
/// reach of the judge: a scan of one room says nothing about the rest of a building.
AskedSamples asked_samples(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
                           std::size_t most);

}  // namespace limen
