// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <openssl/evp.h>

#include "limen/base/error.h"
#include "limen/files/file_hash.h"

namespace limen {

struct Sha256::State {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  if (!state_->context || EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) != 1)
    throw Error("SHA-256 is not available", "libcrypto", "check its configuration", Fault::internal);
}

Sha256::~Sha256() = default;

void Sha256::add(const char* bytes, std::size_t size) {
  EVP_DigestUpdate(state_->context.get(), bytes, size);
}

std::array<unsigned char, Sha256::kBytes> Sha256::digest() {
  std::array<unsigned char, kBytes> digest{};
  EVP_DigestFinal_ex(state_->context.get(), digest.data(), nullptr);
  return digest;
}

}  // namespace limen
