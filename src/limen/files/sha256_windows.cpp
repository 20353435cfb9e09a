// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// The second needs the first.
// clang-format off
#include <windows.h>
#include <bcrypt.h>
// clang-format on

#include "limen/base/error.h"
#include "limen/files/file_hash.h"

namespace limen {

struct Sha256::State {
  BCRYPT_HASH_HANDLE hash = nullptr;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  static BCRYPT_ALG_HANDLE algorithm = [] {
    BCRYPT_ALG_HANDLE opened = nullptr;
    BCryptOpenAlgorithmProvider(&opened, BCRYPT_SHA256_ALGORITHM, nullptr, 0);
    return opened;
  }();
  if (BCryptCreateHash(algorithm, &state_->hash, nullptr, 0, nullptr, 0, 0) < 0)
    throw Error("SHA-256 is not available", "bcrypt.dll", "check the system", Fault::internal);
}

Sha256::~Sha256() {
  BCryptDestroyHash(state_->hash);
}

void Sha256::add(const char* bytes, std::size_t size) {
  constexpr std::size_t kMost = std::size_t{1} << 30U;
  while (size > 0) {
    const std::size_t piece = size < kMost ? size : kMost;
    auto* begin = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes));
    BCryptHashData(state_->hash, begin, static_cast<ULONG>(piece), 0);
    bytes += piece;
    size -= piece;
  }
}

std::array<unsigned char, Sha256::kBytes> Sha256::digest() {
  std::array<unsigned char, kBytes> digest{};
  BCryptFinishHash(state_->hash, digest.data(), kBytes, 0);
  return digest;
}

}  // namespace limen
