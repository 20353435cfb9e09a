// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/store.h"

#include <string_view>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/base/version.h"
#include "limen/project/store/byte_stream.h"
#include "limen/project/store/packed_file.h"
#include "limen/project/store/prepared_bytes.h"
#include "limen/project/store/scan_picture.h"

namespace limen {

void transfer(auto& bytes, Is<PointPrint> auto& print) {
  bytes(print.points, print.spread_m, print.step_m, print.marks);
}

void transfer(auto& bytes, Is<FileRecord> auto& record) {
  bytes(record.points, record.notes, record.prints);
}

void transfer(auto& bytes, Is<FoundTarget> auto& target) {
  bytes(target.kind, target.centre, target.sigma_m, target.points);
  bytes.require(is_value(target.kind, TargetKind::board));
}

namespace {

/// Of the files' contents; raise it where what is made, or how it is written, changes.
constexpr std::uint32_t kFormat = 55;

std::string digits_of(const std::string& text) {
  std::uint64_t hash = 0x6c696d656e;
  for (const char c : text) hash = mix64(hash ^ static_cast<unsigned char>(c));
  return fmt::format("{:016x}", hash);
}

std::string key_of_targets(const std::string& key, const TargetOptions& sizes) {
  return fmt::format("{}-spheres{}-boards{}", key, sizes.sphere_radius_m, sizes.board_side_m);
}

}  // namespace

Store::Store(const std::filesystem::path& folder, const std::string& options, Monitor& monitor)
    : folder_(folder), options_(digits_of(options + kVersion)), monitor_(monitor) {
  std::error_code error;
  for (const Room& room : {kFiles, kFeatures, kDigests, kPictures, kTargets, kPairs})
    std::filesystem::create_directories(folder_ / room.folder, error);
  if (error) throw Error("cannot make the folder: " + error.message(), folder.string(), "give another place");
}

void Store::save(const Room& room, const std::string& key, const std::string& bytes) const {
  write_packed(folder_ / room.folder / key, {room.kind, kFormat, key}, bytes);
}

template <typename Decode>
auto Store::loaded(const Room& room, const std::string& key, const Decode& decode) const
    -> std::optional<decltype(decode(std::string_view(), std::string()))> {
  const std::filesystem::path path = folder_ / room.folder / key;
  try {
    const std::optional<std::string> bytes = read_packed(path, {room.kind, kFormat, key});
    if (!bytes) return {};
    return decode(*bytes, path.string());
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    monitor_.note(
        fmt::format("{}: a bad entry of the store, made again: {}", path.string(), error.problem()));
  }
  return {};
}

std::string Store::feature_key(const FileKey& file, int index) const {
  const int scan = file.scan < 0 ? index : file.scan;
  return fmt::format("{}-{}-{}", file.sha256.substr(0, 32), file.model ? "model" : std::to_string(scan),
                     options_);
}

std::string Store::file_key(const FileKey& file) const {
  return fmt::format("{}-{}{}{}", file.sha256.substr(0, 32), file.model ? "model-" : "",
                     file.scan < 0 ? "" : fmt::format("scan{}-", file.scan), options_);
}

std::optional<FileRecord> Store::load_file(const FileKey& file) const {
  return loaded(kFiles, file_key(file), [](std::string_view bytes, const std::string& where) {
    auto record = value_from<FileRecord>(bytes, where);
    record.prints.resize(record.points.size());
    return record;
  });
}

void Store::save_file(const FileKey& file, const FileRecord& record) const {
  save(kFiles, file_key(file), bytes_of_all(record));
}

bool Store::has_features(const std::string& key) const {
  const auto whole = [](std::string_view bytes, const std::string& where) {
    require_prepared(bytes, where);
    return true;
  };
  return load_digest(key) && loaded(kFeatures, key, whole);
}

std::optional<PreparedScan> Store::load_features(const std::string& key) const {
  return loaded(kFeatures, key, prepared_from);
}

void Store::save_features(const std::string& key, const PreparedScan& prepared) const {
  save(kDigests, key, bytes_of(digest_of(prepared)));
  // Last: where it is, both are.
  save(kFeatures, key, bytes_of(prepared));
}

std::optional<ScanDigest> Store::load_digest(const std::string& key) const {
  return loaded(kDigests, key, digest_from);
}

void Store::save_picture(const std::string& key, const Scan& picture) const {
  save(kPictures, key, picture_bytes(picture));
}

bool Store::has_picture(const std::string& key) const {
  return load_picture(key, 0).has_value();
}

std::optional<Scan> Store::load_picture(const std::string& key, std::size_t most) const {
  return loaded(kPictures, key, [most](std::string_view bytes, const std::string& where) {
    return picture_from(bytes, where, most);
  });
}

std::optional<std::vector<FoundTarget>> Store::load_targets(const std::string& key,
                                                            const TargetOptions& sizes) const {
  return loaded(kTargets, key_of_targets(key, sizes), value_from<std::vector<FoundTarget>>);
}

void Store::save_targets(const std::string& key, const TargetOptions& sizes,
                         const std::vector<FoundTarget>& targets) const {
  save(kTargets, key_of_targets(key, sizes), bytes_of_all(targets));
}

bool Store::has_pair(const std::string& source, const std::string& target, const PairCounts& counts) const {
  return load_pair(source, target, counts).has_value();
}

std::optional<RegistrationResult> Store::load_pair(const std::string& source, const std::string& target,
                                                   const PairCounts& counts) const {
  return loaded(kPairs, source + "_" + target, [&](std::string_view bytes, const std::string& where) {
    return result_from(bytes, where, counts);
  });
}

void Store::save_pair(const std::string& source, const std::string& target,
                      const RegistrationResult& result) const {
  save(kPairs, source + "_" + target, bytes_of(result));
}

}  // namespace limen
