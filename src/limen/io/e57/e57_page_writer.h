// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
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
  /// Where the next byte will lie in the file, or the payload byte `logical`.
  [[nodiscard]] std::uint64_t physical() const { return physical_of(logical_); }
  [[nodiscard]] static std::uint64_t physical_of(std::uint64_t logical);
  void append(std::string_view bytes);
  /// Fills the page that is not full with zeros, so that the next byte begins one.
  void fill_page();
  /// Fills up to four bytes, where the next section may begin.
  void fill_word() { append(std::string((4 - logical_ % 4) % 4, '\0')); }
  /// The page that the next byte lies in; its bytes may still be replaced when it is full.
  [[nodiscard]] std::uint64_t keep_page();
  /// Replaces bytes of a page that was kept, or of the first.
  void replace(std::uint64_t page, std::size_t at, std::string_view bytes);
  /// Fills the last page, completes the head and brings the file to its name. `head` needs the place and the
  /// length of the description.
  void finish(E57Head head);

 private:
  void end_page();

  AtomicFile file_;
  std::string page_;                           ///< payload of the page that is not full
  std::map<std::uint64_t, std::string> kept_;  ///< payloads of pages that may change; empty: not yet full
  std::uint64_t pages_ = 0;
  std::uint64_t logical_ = 0;
};

}  // namespace limen
