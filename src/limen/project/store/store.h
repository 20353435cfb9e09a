// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/project/store/scan_digest.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// What is kept of a file beside the features of its scans.
struct FileRecord {
  std::vector<std::size_t> points;  ///< of each scan in it
  std::vector<std::string> notes;   ///< without names of files (kept_notes.h)
};

/// A file by its bytes, and by what it is taken as: the same bytes are read otherwise as a model.
struct FileKey {
  std::string sha256;
  bool model = false;
  int scan = -1;  ///< the only one of its scans that is meant; -1: all
};

/// Results on disk, each in a file of its own that appears whole or not at all: what is there need not be
/// made again. Keys hold the hash of the input, the options and the version; what is damaged counts as
/// missing.
class Store {
 public:
  /// Makes the folders. `options` is a text of everything that features and pairs depend on.
  Store(const std::filesystem::path& folder, const std::string& options);

  /// Of the options and the version: the last part of all keys.
  [[nodiscard]] const std::string& options_key() const { return options_; }
  [[nodiscard]] std::string feature_key(const FileKey& file, int index) const;

  [[nodiscard]] std::optional<FileRecord> load_file(const FileKey& file) const;
  void save_file(const FileKey& file, const FileRecord& record) const;

  /// Whether features and digest are there and whole: all of them is read.
  [[nodiscard]] bool has_features(const std::string& key) const;
  [[nodiscard]] std::optional<PreparedScan> load_features(const std::string& key) const;
  /// The digest is kept with them, in a file of its own.
  void save_features(const std::string& key, const PreparedScan& prepared) const;
  [[nodiscard]] std::optional<ScanDigest> load_digest(const std::string& key) const;

  /// What reports draw (scan_picture.h); no result depends on it.
  void save_picture(const std::string& key, const Scan& picture) const;
  /// Whole, as has_features().
  [[nodiscard]] bool has_picture(const std::string& key) const;
  [[nodiscard]] std::optional<Scan> load_picture(const std::string& key, std::size_t most) const;

  /// Whole, as has_features().
  [[nodiscard]] bool has_pair(const std::string& source, const std::string& target) const;
  [[nodiscard]] std::optional<RegistrationResult> load_pair(const std::string& source,
                                                            const std::string& target) const;
  void save_pair(const std::string& source, const std::string& target,
                 const RegistrationResult& result) const;

 private:
  [[nodiscard]] std::filesystem::path file_path(const FileKey& file) const;
  [[nodiscard]] std::filesystem::path pair_path(const std::string& source, const std::string& target) const;

  std::filesystem::path folder_;
  std::string options_;  ///< 16 hexadecimal digits
};

}  // namespace limen
