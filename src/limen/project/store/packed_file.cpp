// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/packed_file.h"

#include <fstream>
#include <iterator>

#include <zlib.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/project/store/byte_stream.h"

namespace limen {
namespace {

constexpr std::string_view kMagic = "limen\x1a";
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 33U;

std::string head_of(std::string_view kind, std::uint32_t version) {
  ByteWriter head;
  head.put(version);
  return std::string(kMagic) + std::string(kind) + head.bytes();
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

}  // namespace

void write_packed(const std::filesystem::path& path, std::string_view kind, std::uint32_t version,
                  std::string_view bytes) {
  ByteWriter size;
  size.put_count(bytes.size());
  AtomicFile file(path);
  file.write(head_of(kind, version));
  file.write(size.bytes());
  file.write(deflated(bytes));
  file.commit();
}

std::optional<std::string> read_packed(const std::filesystem::path& path, std::string_view kind,
                                       std::uint32_t version) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  const std::string whole{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string head = head_of(kind, version);
  if (whole.size() < head.size() + 8 || whole.compare(0, head.size(), head) != 0) return {};
  const auto size =
      ByteReader(std::string_view(whole).substr(head.size(), 8), path.string()).get<std::uint64_t>();
  // Deflate packs no tighter than a thousandth.
  if (size > kMostBytes || size / 1100 > whole.size()) return {};
  std::string bytes(size, '\0');
  auto unpacked = static_cast<uLongf>(size);
  const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &unpacked,
                                reinterpret_cast<const Bytef*>(whole.data() + head.size() + 8),
                                static_cast<uLong>(whole.size() - head.size() - 8));
  if (status != Z_OK || unpacked != size) return {};
  return bytes;
}

}  // namespace limen
