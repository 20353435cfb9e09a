// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace limen {

/// Files of a case that is complete only with its last one: without it none is left.
class CaseFiles {
 public:
  CaseFiles() = default;
  ~CaseFiles() {
    std::error_code ignored;
    for (const std::filesystem::path& path : written_) std::filesystem::remove(path, ignored);
  }
  CaseFiles(const CaseFiles&) = delete;
  CaseFiles& operator=(const CaseFiles&) = delete;

  /// Names a file that is about to be written; one that was there before stays.
  const std::filesystem::path& add(const std::filesystem::path& path) {
    return std::filesystem::exists(path) ? path : written_.emplace_back(path);
  }
  void keep() { written_.clear(); }

 private:
  std::vector<std::filesystem::path> written_;
};

}  // namespace limen
