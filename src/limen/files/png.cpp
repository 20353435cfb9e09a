// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/png.h"

#include <string_view>

#include <zlib.h>

#include "limen/base/error.h"

namespace limen {
namespace {

/// The highest byte first.
std::string four_bytes(std::size_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>((number >> shift) & 0xFFU);
  return bytes;
}

std::string png_chunk(std::string_view type, const std::string& content) {
  const std::string bytes = std::string(type) + content;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  return four_bytes(content.size()) + bytes + four_bytes(crc);
}

}  // namespace

std::string png_of_grey(const std::vector<std::uint8_t>& grey, std::size_t width) {
  const std::size_t height = grey.size() / width;
  std::string rows;
  for (std::size_t row = 0; row < height; ++row) {
    rows += '\0';  // no filter
    rows.append(reinterpret_cast<const char*>(grey.data()) + row * width, width);
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
               static_cast<uLong>(rows.size())) != Z_OK)
    throw Error("cannot be packed", "a picture", "check zlib", Fault::internal);
  packed.resize(size);
  const std::string head = four_bytes(width) + four_bytes(height) + std::string("\x08\0\0\0\0", 5);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", head) + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

}  // namespace limen
