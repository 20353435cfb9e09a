// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/targets/found_target.h"
#include "limen/io/cloud/point_print.h"
#include "limen/model/result.h"
#include "limen/project/store/prepared_bytes.h"
#include "limen/project/store/scan_digest.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// What is kept of a file beside the features of its scans.
struct FileRecord {
  std::vector<std::size_t> points;      ///< of each scan in it
  std::vector<std::string> notes;       ///< without names of files (kept_notes.h)
  std::vector<PointPrint> prints = {};  ///< of each scan
};

/// A file by its bytes, and by what it is taken as: the same bytes are read otherwise as a model.
struct FileKey {
  std::string sha256;
  bool model = false;
  int scan = -1;  ///< the only one of its scans that is meant; -1: all
};

/// Results on disk, each in a file of its own that appears whole or not at all: what is there need not be
/// made again. Keys hold the hash of the input, the options and the version. An entry that is damaged, that
/// is the entry of another key, or that points to what is not there is removed, with a note, and counts as
/// missing.
class Store {
 public:
  /// Makes the folders. `options` is a text of everything that features and pairs depend on. `monitor`, which
  /// must live as long, takes the notes.
  Store(const std::filesystem::path& folder, const std::string& options, Monitor& monitor = silent_monitor());

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

  /// The targets that `sizes` describe, world coordinates.
  [[nodiscard]] std::optional<std::vector<FoundTarget>> load_targets(const std::string& key,
                                                                     const TargetOptions& sizes) const;
  void save_targets(const std::string& key, const TargetOptions& sizes,
                    const std::vector<FoundTarget>& targets) const;

  /// Whole, as has_features().
  [[nodiscard]] bool has_pair(const std::string& source, const std::string& target,
                              const PairCounts& counts) const;
  [[nodiscard]] std::optional<RegistrationResult> load_pair(const std::string& source,
                                                            const std::string& target,
                                                            const PairCounts& counts) const;
  void save_pair(const std::string& source, const std::string& target,
                 const RegistrationResult& result) const;

 private:
  /// The kinds of entries, each in a folder of its own.
  struct Room {
    const char* folder;
    const char* kind;
  };
  static constexpr Room kFiles{"files", "FILE"};
  static constexpr Room kFeatures{"features", "SCAN"};
  static constexpr Room kDigests{"digests", "DIGE"};
  static constexpr Room kPictures{"pictures", "PICT"};
  static constexpr Room kTargets{"targets", "TARG"};
  static constexpr Room kPairs{"pairs", "PAIR"};

  [[nodiscard]] std::string file_key(const FileKey& file) const;
  void save(const Room& room, const std::string& key, const std::string& bytes) const;
  /// What decode(bytes, where) makes of an entry; a bad one is removed, with a note.
  template <typename Decode>
  [[nodiscard]] auto loaded(const Room& room, const std::string& key, const Decode& decode) const
      -> std::optional<decltype(decode(std::string_view(), std::string()))>;

  std::filesystem::path folder_;
  std::string options_;  ///< 16 hexadecimal digits
  Monitor& monitor_;
};

}  // namespace limen
