// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/zip.h"

#include <fmt/format.h>
#include <zlib.h>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr std::string_view kEndOfDirectory("PK\x05\x06", 4);
constexpr std::string_view kDirectoryEntry("PK\x01\x02", 4);
constexpr std::string_view kLocalHeader("PK\x03\x04", 4);
constexpr std::size_t kEndBytes = 22;
constexpr std::size_t kEntryBytes = 46;
constexpr std::size_t kLocalBytes = 30;

/// A little-endian number; the caller has seen to it that the bytes are there.
std::size_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < size; ++k)
    value |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return value;
}

/// Where the end record is: among the last bytes, before a comment of at most 65535.
std::optional<std::size_t> end_record(std::string_view bytes) {
  if (bytes.size() < kEndBytes) return {};
  const std::size_t at = bytes.rfind(kEndOfDirectory, bytes.size() - kEndBytes);
  if (at == std::string_view::npos || bytes.size() - at > kEndBytes + 65535) return {};
  return at;
}

[[noreturn]] void damaged(const std::string& what, const ZipMember& member, const std::string& name) {
  throw Error(what, fmt::format("{}, member {}", name, member.name),
              "unpack the archive and give the file in it");
}

/// The packed bytes of a member.
std::string_view packed_bytes(std::string_view bytes, const ZipMember& member, const std::string& name) {
  if (member.at > bytes.size() || bytes.size() - member.at < kLocalBytes ||
      bytes.substr(member.at, 4) != kLocalHeader)
    damaged("the archive's directory is damaged", member, name);
  const std::size_t begin =
      member.at + kLocalBytes + number_at(bytes, member.at + 26, 2) + number_at(bytes, member.at + 28, 2);
  if (begin > bytes.size() || bytes.size() - begin < member.packed)
    damaged("the archive is cut off", member, name);
  return bytes.substr(begin, member.packed);
}

/// Inflates piece by piece, so that a bomb is seen before it goes off.
std::string inflated(std::string_view packed, const ZipMember& member, const std::string& name) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) damaged("the archive cannot be unpacked", member, name);
  std::string result;
  std::string piece(std::size_t{1} << 18U, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  int status = Z_OK;
  while (status == Z_OK && result.size() <= member.size) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    status = inflate(&stream, Z_NO_FLUSH);
    result.append(piece, 0, piece.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END || result.size() != member.size) damaged("the member is damaged", member, name);
  return result;
}

}  // namespace

std::vector<ZipMember> zip_members(std::string_view bytes) {
  const std::optional<std::size_t> end = end_record(bytes);
  if (!end) return {};
  const std::size_t count = number_at(bytes, *end + 10, 2);
  std::size_t at = number_at(bytes, *end + 16, 4);
  std::vector<ZipMember> members;
  for (std::size_t i = 0; i < count; ++i) {
    if (at > bytes.size() || bytes.size() - at < kEntryBytes || bytes.substr(at, 4) != kDirectoryEntry) break;
    const std::size_t name_bytes = number_at(bytes, at + 28, 2);
    if (bytes.size() - at - kEntryBytes < name_bytes) break;
    ZipMember member;
    member.method = static_cast<unsigned>(number_at(bytes, at + 10, 2));
    member.crc = static_cast<unsigned>(number_at(bytes, at + 16, 4));
    member.packed = number_at(bytes, at + 20, 4);
    member.size = number_at(bytes, at + 24, 4);
    member.at = number_at(bytes, at + 42, 4);
    member.name = std::string(bytes.substr(at + kEntryBytes, name_bytes));
    members.push_back(std::move(member));
    at += kEntryBytes + name_bytes + number_at(bytes, at + 30, 2) + number_at(bytes, at + 32, 2);
  }
  return members;
}

std::string unpacked(std::string_view bytes, const ZipMember& member, const std::string& name,
                     std::size_t most_bytes) {
  if (member.size > most_bytes) {
    damaged(fmt::format("the member would need {} MB unpacked, more than the {} MB that are allowed",
                        member.size / 1000000, most_bytes / 1000000),
            member, name);
  }
  const std::string_view packed = packed_bytes(bytes, member, name);
  if (member.method != 0 && member.method != 8)
    damaged(fmt::format("the member is packed by method {}, which is not known", member.method), member,
            name);
  if (member.method == 0 && packed.size() != member.size) damaged("the member is damaged", member, name);
  std::string result = member.method == 0 ? std::string(packed) : inflated(packed, member, name);
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(result.data()), static_cast<uInt>(result.size()));
  if (crc != member.crc) damaged("the member is damaged: its checksum is wrong", member, name);
  return result;
}

namespace {

constexpr std::size_t kMostFiles = 65535;
constexpr std::size_t kMostBytes = 0xFFFFFFFFU;
constexpr unsigned kVersionNeeded = 20;
constexpr unsigned kUtf8Names = 0x0800;
constexpr unsigned kDeflated = 8;
constexpr unsigned kFirstDay = 0x21;  // 1980-01-01, the first that the format knows

void put_number(std::string& bytes, std::size_t value, std::size_t size) {
  for (std::size_t k = 0; k < size; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xFFU);
}

[[noreturn]] void too_large(const std::string& name) {
  throw Error("is more than a zip archive holds", name, "write fewer files");
}

std::string deflated(const ZipFile& file) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("cannot be packed", file.name, "check zlib", Fault::internal);
  std::string packed(deflateBound(&stream, static_cast<uLong>(file.bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(file.bytes.data()));
  stream.avail_in = static_cast<uInt>(file.bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int status = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error("cannot be packed", file.name, "check zlib", Fault::internal);
  return packed;
}

/// What the local header and the directory say alike of a file.
std::string facts_of(const ZipFile& file, std::size_t packed) {
  const auto crc =
      crc32(0, reinterpret_cast<const Bytef*>(file.bytes.data()), static_cast<uInt>(file.bytes.size()));
  std::string facts;
  put_number(facts, kVersionNeeded, 2);
  put_number(facts, kUtf8Names, 2);
  put_number(facts, kDeflated, 2);
  put_number(facts, 0, 2);  // the time of day
  put_number(facts, kFirstDay, 2);
  put_number(facts, crc, 4);
  put_number(facts, packed, 4);
  put_number(facts, file.bytes.size(), 4);
  put_number(facts, file.name.size(), 2);
  put_number(facts, 0, 2);  // no extra field
  return facts;
}

}  // namespace

std::string zipped(const std::vector<ZipFile>& files) {
  if (files.size() > kMostFiles) too_large("the archive");
  std::string archive;
  std::string directory;
  for (const ZipFile& file : files) {
    if (file.bytes.size() > kMostBytes / 2 || file.name.size() > kMostFiles) too_large(file.name);
    const std::string packed = deflated(file);
    const std::string facts = facts_of(file, packed.size());
    directory.append("PK\x01\x02", 4);
    put_number(directory, kVersionNeeded, 2);
    directory += facts;
    put_number(directory, 0, 2);  // no comment
    put_number(directory, 0, 2);  // first volume
    put_number(directory, 0, 2);  // internal attributes
    put_number(directory, 0, 4);  // external attributes
    put_number(directory, archive.size(), 4);
    directory += file.name;
    archive.append("PK\x03\x04", 4);
    archive += facts;
    archive += file.name;
    archive += packed;
    if (archive.size() + directory.size() > kMostBytes) too_large(file.name);
  }
  const std::size_t begin = archive.size();
  archive += directory;
  archive.append("PK\x05\x06", 4);
  put_number(archive, 0, 4);  // one volume
  put_number(archive, files.size(), 2);
  put_number(archive, files.size(), 2);
  put_number(archive, directory.size(), 4);
  put_number(archive, begin, 4);
  put_number(archive, 0, 2);
  return archive;
}

}  // namespace limen
