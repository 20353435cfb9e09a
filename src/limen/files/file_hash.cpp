// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/file_hash.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <vector>

#include <openssl/evp.h>

#include "limen/base/error.h"
#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr const char* kRemedy = "check the file and the disk";

std::string hexadecimal(const unsigned char* bytes, unsigned int count) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
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
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
    throw Error("SHA-256 is not available", "libcrypto", "check its configuration", Fault::internal);
  std::vector<char> piece(kPiece);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    EVP_DigestUpdate(context.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) throw Error("cannot be read", path.string(), kRemedy);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &size);
  return hexadecimal(digest.data(), size);
}

std::string sha256_of(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw Error("SHA-256 is not available", "libcrypto", "check its configuration", Fault::internal);
  return hexadecimal(digest.data(), size);
}

}  // namespace limen
