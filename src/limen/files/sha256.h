// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>

namespace limen {

/// SHA-256 of bytes that come piece by piece, as the system's library computes it.
class Sha256 {
 public:
  static constexpr std::size_t kBytes = 32;

  /// Throws Error where it is not available.
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const char* bytes, std::size_t size);
  /// Call it once, last.
  std::array<unsigned char, kBytes> digest();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limen
