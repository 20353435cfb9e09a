// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/zip_writer.h"

#include <cstdint>

#include <zlib.h>

#include "limen/base/error.h"

namespace limen {
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
