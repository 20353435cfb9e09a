// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "limen/base/error.h"
#include "limen/project/inputs/project_files.h"
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

/// The two kinds of work on a project's store, for any engine: what the store holds is not done again.

/// The store cannot be written: no fault of the scan that was worked on.
class StoreFault : public Error {
 public:
  using Error::Error;
};

/// Everything that features and pairs depend on beside the files.
std::string store_options(const ProjectOptions& options);

/// The record of a file of which all is kept, and whole: features, and pictures of scans. Its notes tell the
/// names of this run.
std::optional<FileRecord> kept_record(const Store& store, const ProjectFile& file,
                                      const ProjectOptions& options);

/// Features of all scans in the file, or of the model; what the store holds whole is not made again. Throws
/// StoreFault, and Error where the file is no good.
FileRecord make_features(const ProjectFile& file, const ProjectOptions& options, const Store& store,
                         Monitor& monitor);

/// A pair by the keys of its features. Two scans that stand upright may be searched as such.
struct PairKey {
  std::string source;
  std::string target;
  bool level = false;
  std::optional<StartPrior> start = {};  ///< where a user showed points of both
  PairCounts counts = {};                ///< no part of the key: what its result may point to

  /// The second half of the name that the result is kept by.
  [[nodiscard]] std::string target_name() const;
};

/// What came of the pair, as it is kept. `options`: as for every pair of the project. Throws StoreFault.
RegistrationResult make_pair_result(const PairKey& pair, const RegisterOptions& options, const Store& store,
                                    ScanCache& cache);

}  // namespace limen
