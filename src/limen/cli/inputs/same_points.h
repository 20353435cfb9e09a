// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "limen/io/cloud/point_sample.h"
#include "limen/register/register.h"

namespace limen {

/// Whether two names are of one file, or of files that are equal byte for byte.
bool same_bytes(const std::string& a, const std::string& b);

/// Notices where both sides of a registration are one scan, or one is a part or a thinned copy of the other.
/// Sides are shown to it as they are read; a model is no scan.
class SamePointsWatch {
 public:
  SamePointsWatch(std::string source, std::string target)
      : source_(std::move(source)), target_(std::move(target)) {}

  /// A sentence for the user, the first time that there is reason: with the source, before the long work,
  /// where the files are equal, else with the target.
  std::string note_on(const RegisterInput& side, bool is_source);
  /// The sentence again; empty: both are scans of their own.
  [[nodiscard]] const std::string& note() const { return note_; }

 private:
  std::string source_;
  std::string target_;
  PointSample sample_;                ///< of the source
  std::vector<std::uint64_t> marks_;  ///< of the source
  std::string note_;
};

}  // namespace limen
