// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

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

/// SHA-256 of a file's bytes, 64 hexadecimal digits, read piece by piece; empty where `path` is not a regular
/// file (a pipe can be read once only). Throws Error where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

/// The same of bytes that are there.
std::string sha256_of(std::string_view bytes);

}  // namespace limen
