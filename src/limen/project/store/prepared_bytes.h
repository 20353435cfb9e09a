// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "limen/model/result.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// How many features a scan has that others point to by number.
struct FeatureCounts {
  std::size_t planes = 0;
  std::size_t openings = 0;
};
/// Those of the two scans of a pair.
struct PairCounts {
  FeatureCounts source;
  FeatureCounts target;
};

/// All of a prepared scan or model that registration uses (not the planes of its points), as bytes and back:
/// a registration with what comes back gives the same bits. Throws Error for a group of scans.
std::string bytes_of(const PreparedScan& prepared);
/// `where` is in messages. Throws Error where the bytes are damaged, or point to what is not there.
PreparedScan prepared_from(std::string_view bytes, const std::string& where);
/// Throws as well where prepared_from() would, but makes no view of space.
void require_prepared(std::string_view bytes, const std::string& where);

/// The same of a registration; its picture and its stages are left out.
std::string bytes_of(const RegistrationResult& result);
RegistrationResult result_from(std::string_view bytes, const std::string& where, const PairCounts& counts);

}  // namespace limen
