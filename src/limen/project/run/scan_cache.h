// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "limen/project/store/store.h"

namespace limen {

/// Prepared scans from the store, as many as are needed at a time: a thousand never lie in memory at once.
class ScanCache {
 public:
  /// What a user calls the scan of a key.
  using NameOfKey = std::function<std::string(const std::string& key)>;

  ScanCache(const Store& store, std::size_t most, NameOfKey name)
      : store_(store), most_(most), name_(std::move(name)) {}

  /// Throws Error that names the scan where the store does not hold it, or not whole, any more.
  std::shared_ptr<const PreparedScan> get(const std::string& key);

 private:
  struct Entry {
    std::shared_ptr<const PreparedScan> scan;
    std::uint64_t used = 0;
  };

  const Store& store_;
  std::size_t most_;
  NameOfKey name_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  std::uint64_t clock_ = 0;
};

}  // namespace limen
