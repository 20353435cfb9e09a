// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/same_points.h"

#include <filesystem>

#include <fmt/format.h>

#include "limen/files/file_hash.h"
#include "limen/files/scan_in_file.h"

namespace limen {

bool same_bytes(const std::string& a, const std::string& b) {
  const ScanInFile first = scan_in_file(a);
  const ScanInFile second = scan_in_file(b);
  std::error_code ignored;
  if (first.index != second.index || !std::filesystem::is_regular_file(first.file, ignored) ||
      !std::filesystem::is_regular_file(second.file, ignored))
    return false;
  if (std::filesystem::equivalent(first.file, second.file, ignored)) return true;
  return std::filesystem::file_size(first.file, ignored) ==
             std::filesystem::file_size(second.file, ignored) &&
         sha256_of_file(first.file) == sha256_of_file(second.file);
}

std::string SamePointsWatch::note_on(const RegisterInput& side, bool is_source) {
  if (side.scans.empty()) return {};
  const Scan& scan = side.scans.front().scan;
  const bool same = is_source ? same_bytes(source_, target_) : sample_.is_of(scan);
  std::vector<std::uint64_t> marks = point_marks(scan);
  const bool fewer = !same && !is_source && is_part_of(marks, marks_);
  const bool more = !same && !is_source && is_part_of(marks_, marks);
  if (is_source) {
    sample_ = PointSample(scan);
    marks_ = std::move(marks);
  }
  if (!note_.empty()) return {};
  constexpr const char* kNoTest = "a scan is registered to itself, which is no test for other scans";
  if (same) note_ = fmt::format("SOURCE and TARGET hold the same {} points: {}", scan.size(), kNoTest);
  if (fewer || more)
    note_ = fmt::format("{} holds only points of {}, of which it seems a thinned copy or a part: {}",
                        fewer ? "TARGET" : "SOURCE", fewer ? "SOURCE" : "TARGET", kNoTest);
  return note_;
}

}  // namespace limen
