// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/file_hash.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr const char* kRemedy = "check the file and the disk";

std::string hexadecimal(const std::array<unsigned char, Sha256::kBytes>& bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace

std::string sha256_of_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(errno == 0 ? "cannot be read" : reason_of(errno), path.string(), kRemedy);
  Sha256 hash;
  std::vector<char> piece(kPiece);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) throw Error("cannot be read", path.string(), kRemedy);
  return hexadecimal(hash.digest());
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hexadecimal(hash.digest());
}

}  // namespace limen
