// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/packed_file.h"

#include <fstream>
#include <iterator>

#include <zlib.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/files/file_hash.h"
#include "limen/project/store/byte_stream.h"

namespace limen {
namespace {

constexpr std::string_view kMagic = "limen\x1a";
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 33U;
constexpr std::size_t kHashDigits = 64;

/// All that is before the hash and the packed bytes.
std::string bytes_of(const EntryHead& head) {
  return std::string(kMagic) + std::string(head.kind) + bytes_of_all(head.version, std::string(head.key));
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), 3);
  if (status != Z_OK) throw Error("bytes cannot be packed", "store", "free some memory", Fault::internal);
  packed.resize(size);
  return packed;
}

[[noreturn]] void refuse(const std::string& what, const std::filesystem::path& path) {
  throw Error(what, path.string(), "remove it: it is made again by the next run");
}

/// The packed part again, `size` bytes long.
std::string inflated(std::string_view packed, std::uint64_t size, const std::filesystem::path& path) {
  // Deflate packs no tighter than a thousandth.
  if (size > kMostBytes || size / 1100 > packed.size()) refuse("the file is damaged", path);
  std::string bytes(size, '\0');
  auto unpacked = static_cast<uLongf>(size);
  const int status =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &unpacked,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || unpacked != size) refuse("the file is damaged", path);
  return bytes;
}

}  // namespace

void write_packed(const std::filesystem::path& path, const EntryHead& head, std::string_view bytes) {
  const std::string before = bytes_of(head);
  const std::string packed = bytes_of_all(bytes.size()) + deflated(bytes);
  AtomicFile file(path);
  file.write(before);
  file.write(sha256_of(before + packed));
  file.write(packed);
  file.commit();
}

std::optional<std::string> read_packed(const std::filesystem::path& path, const EntryHead& head) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  const std::string whole{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string before = bytes_of(head);
  const std::size_t named = kMagic.size() + head.kind.size();
  if (whole.compare(0, named, before, 0, named) != 0) refuse("the file is of another kind", path);
  if (whole.compare(named, sizeof head.version, before, named, sizeof head.version) != 0) return {};
  if (whole.size() < before.size() + kHashDigits + sizeof(std::uint64_t)) refuse("the file is damaged", path);
  if (whole.compare(0, before.size(), before) != 0) refuse("the file belongs to another key", path);
  const std::string_view packed = std::string_view(whole).substr(before.size() + kHashDigits);
  if (whole.compare(before.size(), kHashDigits, sha256_of(before + std::string(packed))) != 0)
    refuse("the file is damaged", path);
  const auto size = value_from<std::uint64_t>(packed, path.string());
  return inflated(packed.substr(sizeof(std::uint64_t)), size, path);
}

}  // namespace limen
