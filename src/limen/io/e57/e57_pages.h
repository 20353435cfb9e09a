// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "limen/base/atomic_file.h"

namespace limen {

/// The 48 bytes at the front of an E57 file.
struct E57Head {
  std::uint32_t major = 1;
  std::uint32_t minor = 0;
  std::uint64_t file_bytes = 0;  ///< "physical": with the check sums
  std::uint64_t xml_offset = 0;  ///< physical
  std::uint64_t xml_bytes = 0;   ///< "logical": without check sums
  std::uint64_t page_bytes = 1024;
};
inline constexpr std::size_t kE57HeadBytes = 48;
inline constexpr std::size_t kE57CheckSumBytes = 4;
/// At the front of the section that holds a scan's points.
inline constexpr std::size_t kE57SectionHeaderBytes = 32;
/// What to do about a file that is cut off or damaged.
inline constexpr const char* kE57CopyAgain = "get the whole file, or export it again";

/// The head as its 48 bytes.
std::string e57_head_bytes(const E57Head& head);
/// The header of a section of packets: its length, and where the first packet lies (physical).
std::string e57_section_header(std::uint64_t section_bytes, std::uint64_t first_packet);
/// A page's check sum as it is stored (the high byte first).
std::string e57_check_sum(std::string_view payload);

/// An E57 file as pages of a payload and its check sum. Physical offsets count all bytes, logical ones only
/// payloads.
class E57Pages {
 public:
  /// Throws Error where the head is damaged or the file is shorter than it says. `bytes` must outlive this.
  E57Pages(std::string_view bytes, std::string name);

  [[nodiscard]] const E57Head& head() const { return head_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t page_count() const { return bytes_.size() / head_.page_bytes; }
  [[nodiscard]] std::uint64_t payload() const { return head_.page_bytes - kE57CheckSumBytes; }
  [[nodiscard]] std::uint64_t logical_size() const { return page_count() * payload(); }
  /// Bytes after the end that the head gives.
  [[nodiscard]] std::uint64_t surplus() const { return surplus_; }
  /// The bytes of pages [begin, end), check sums and all.
  [[nodiscard]] std::string_view raw(std::uint64_t begin, std::uint64_t end) const;

  /// Throws Error where it lies outside the file or in a check sum; `what` is for the message.
  [[nodiscard]] std::uint64_t logical_of(std::uint64_t physical, std::string_view what) const;
  [[nodiscard]] std::uint64_t physical_of(std::uint64_t logical) const;
  [[nodiscard]] std::uint64_t page_of(std::uint64_t logical) const { return logical / payload(); }

  /// Throws Error that names the first page of [begin, end) whose check sum is wrong.
  void check(std::uint64_t begin, std::uint64_t end) const;
  /// Copies `count` payload bytes from `logical` on, which must lie in the file; check sums are not looked
  /// at.
  void copy(std::uint64_t logical, std::size_t count, char* to) const;

 private:
  std::string_view bytes_;
  std::string name_;
  E57Head head_;
  std::uint64_t surplus_ = 0;
};

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
