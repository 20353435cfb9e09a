// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/store.h"

#include <string_view>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/base/version.h"
#include "limen/project/store/byte_stream.h"
#include "limen/project/store/packed_file.h"
#include "limen/project/store/prepared_bytes.h"
#include "limen/project/store/scan_picture.h"

namespace limen {
namespace {

/// Of the files' contents; raise it where what is made, or how it is written, changes.
constexpr std::uint32_t kFormat = 32;

std::string digits_of(const std::string& text) {
  std::uint64_t hash = 0x6c696d656e;
  for (const char c : text) hash = mix64(hash ^ static_cast<unsigned char>(c));
  return fmt::format("{:016x}", hash);
}

bool is_whole(const std::filesystem::path& path, std::string_view kind) {
  return read_packed(path, kind, kFormat).has_value();
}

}  // namespace

Store::Store(const std::filesystem::path& folder, const std::string& options)
    : folder_(folder), options_(digits_of(options + kVersion)) {
  std::error_code error;
  for (const char* room : {"files", "features", "digests", "pictures", "pairs"})
    std::filesystem::create_directories(folder_ / room, error);
  if (error) throw Error("cannot make the folder: " + error.message(), folder.string(), "give another place");
}

std::string Store::feature_key(const FileKey& file, int index) const {
  return fmt::format("{}-{}-{}", file.sha256.substr(0, 32), file.model ? "model" : std::to_string(index),
                     options_);
}

std::filesystem::path Store::file_path(const FileKey& file) const {
  return folder_ / "files" /
         fmt::format("{}-{}{}", file.sha256.substr(0, 32), file.model ? "model-" : "", options_);
}

std::optional<FileRecord> Store::load_file(const FileKey& file) const {
  const std::filesystem::path path = file_path(file);
  const std::optional<std::string> bytes = read_packed(path, "FILE", kFormat);
  if (!bytes) return {};
  ByteReader reader(*bytes, path.string());
  FileRecord record;
  for (const std::uint64_t points : reader.get_all<std::uint64_t>()) record.points.push_back(points);
  record.notes = reader.get_all<std::string>();
  return record;
}

void Store::save_file(const FileKey& file, const FileRecord& record) const {
  ByteWriter writer;
  writer.put_all(record.points);
  writer.put_all(record.notes);
  write_packed(file_path(file), "FILE", kFormat, writer.bytes());
}

bool Store::has_features(const std::string& key) const {
  return is_whole(folder_ / "digests" / key, "DIGE") && is_whole(folder_ / "features" / key, "SCAN");
}

std::optional<PreparedScan> Store::load_features(const std::string& key) const {
  const std::filesystem::path path = folder_ / "features" / key;
  const std::optional<std::string> bytes = read_packed(path, "SCAN", kFormat);
  if (!bytes) return {};
  return prepared_from(*bytes, path.string());
}

void Store::save_features(const std::string& key, const PreparedScan& prepared) const {
  write_packed(folder_ / "digests" / key, "DIGE", kFormat, bytes_of(digest_of(prepared)));
  // Last: where it is, both are.
  write_packed(folder_ / "features" / key, "SCAN", kFormat, bytes_of(prepared));
}

std::optional<ScanDigest> Store::load_digest(const std::string& key) const {
  const std::filesystem::path path = folder_ / "digests" / key;
  const std::optional<std::string> bytes = read_packed(path, "DIGE", kFormat);
  if (!bytes) return {};
  return digest_from(*bytes, path.string());
}

void Store::save_picture(const std::string& key, const Scan& picture) const {
  write_packed(folder_ / "pictures" / key, "PICT", kFormat, picture_bytes(picture));
}

bool Store::has_picture(const std::string& key) const {
  return is_whole(folder_ / "pictures" / key, "PICT");
}

std::optional<Scan> Store::load_picture(const std::string& key, std::size_t most) const {
  const std::filesystem::path path = folder_ / "pictures" / key;
  const std::optional<std::string> bytes = read_packed(path, "PICT", kFormat);
  if (!bytes) return {};
  return picture_from(*bytes, path.string(), most);
}

std::filesystem::path Store::pair_path(const std::string& source, const std::string& target) const {
  return folder_ / "pairs" / (source + "_" + target);
}

bool Store::has_pair(const std::string& source, const std::string& target) const {
  return is_whole(pair_path(source, target), "PAIR");
}

std::optional<RegistrationResult> Store::load_pair(const std::string& source,
                                                   const std::string& target) const {
  const std::filesystem::path path = pair_path(source, target);
  const std::optional<std::string> bytes = read_packed(path, "PAIR", kFormat);
  if (!bytes) return {};
  return result_from(*bytes, path.string());
}

void Store::save_pair(const std::string& source, const std::string& target,
                      const RegistrationResult& result) const {
  write_packed(pair_path(source, target), "PAIR", kFormat, bytes_of(result));
}

}  // namespace limen
