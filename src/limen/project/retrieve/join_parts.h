// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "limen/project/retrieve/choose_pairs.h"
#include "limen/project/store/scan_digest.h"

namespace limen {

/// Scans whose poses to one another are known; a scan that is joined to nothing is a part of its own.
struct PlacedPart {
  std::vector<std::size_t> scans;
  std::vector<Rigid3> part_from_scan;  ///< of each; between the digests' origins, scans' axes
};

/// Chooses the pairs of scans most likely to join two parts. Poses between two parts are sought from above:
/// after each turn that brings main directions of their walls together, the correlation of their plans over
/// all shifts. Each is then scored in space by all planes of both parts: surface in common, less surface that
/// a scanner of the other part looked through. A wrong pose that lays two look-alike rooms on one another
/// puts walls where the other part is known to be clear. A pose leads to the scans that should see most of
/// one another.
class PartJoiner {
 public:
  explicit PartJoiner(const std::vector<ScanDigest>& digests) : digests_(digests) {}

  /// The most promising first. Left out are pairs that were `tried` (higher, lower number), and two parts
  /// that an earlier call matched as they are.
  PairList next_pairs(const std::vector<PlacedPart>& parts,
                      const std::function<bool(std::size_t, std::size_t)>& tried);

 private:
  using Scans = std::vector<std::size_t>;

  const std::vector<ScanDigest>& digests_;
  std::set<std::pair<Scans, Scans>> sought_;
};

}  // namespace limen
