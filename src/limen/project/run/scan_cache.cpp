// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/scan_cache.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "limen/base/error.h"

namespace limen {

std::shared_ptr<const PreparedScan> ScanCache::get(const std::string& key) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = entries_.find(key);
    if (found != entries_.end()) {
      found->second.used = ++clock_;
      return found->second.scan;
    }
  }
  std::optional<PreparedScan> loaded = store_.load_features(key);
  if (!loaded)
    throw Error("its features are gone from the store, or damaged", name_(key), "run the project again");
  auto scan = std::make_shared<const PreparedScan>(std::move(*loaded));
  const std::lock_guard<std::mutex> lock(mutex_);
  entries_[key] = {scan, ++clock_};
  while (entries_.size() > most_) {
    entries_.erase(std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    }));
  }
  return scan;
}

}  // namespace limen
