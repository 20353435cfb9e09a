// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "limen/base/atomic_file.h"
#include "limen/io/e57/e57_pages.h"

namespace limen {

/// Writes the payloads of a new E57 file; pages and check sums are its business. The file appears on
/// finish().
class E57PageWriter {
 public:
  explicit E57PageWriter(const std::filesystem::path& path);

  /// Payload bytes so far, the head's among them.
  [[nodiscard]] std::uint64_t logical() const { return logical_; }
  /// Where the next byte will lie in the file.
  [[nodiscard]] std::uint64_t physical() const;
  void append(std::string_view bytes);
  /// Replaces bytes of the first page, which must be there.
  void replace_early(std::size_t logical, std::string_view bytes);
  /// Fills the last page, completes the head and brings the file to its name. `head` needs the place and the
  /// length of the description.
  void finish(E57Head head);

 private:
  void end_page();

  AtomicFile file_;
  std::string page_;   ///< payload of the page that is not full
  std::string first_;  ///< payload of the first page once it is full
  std::uint64_t pages_ = 0;
  std::uint64_t logical_ = 0;
};

}  // namespace limen
