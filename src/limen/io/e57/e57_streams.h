// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_pages.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// Some values of one column as they are stored: value i has the bits from shift + i * bits on, counted from
/// the lowest bit of the first byte. Sixteen more bytes follow the last.
struct E57Bits {
  std::vector<char> bytes;
  unsigned shift = 0;
};

/// The streams of the columns of one scan, taken together from its packets. Each column has a stream of its
/// own, which goes on from packet to packet; a packet need not hold as many rows of one as of another. Only
/// where the stretches of the current rows lie is kept, not their bytes.
class E57Streams {
 public:
  /// Throws Error where the scan's section is none. `pages` and `scan` must outlive this.
  E57Streams(const E57Pages& pages, const E57Scan& scan, std::string name);

  /// Goes on to the next rows, at most `most`, and tells how many: 0 at the end. Check sums of all pages that
  /// hold them are verified. Throws Error for damaged packets and where points are missing.
  std::size_t advance(std::size_t most);
  /// Values of a column in the current rows, counted from the first of them. May be called from many threads.
  [[nodiscard]] E57Bits bits_of(std::size_t column, RowRange rows) const;

 private:
  struct Stretch {
    std::uint64_t start = 0;    ///< byte of the stream
    std::uint64_t logical = 0;  ///< where it lies in the file
  };
  struct Stream {
    std::deque<Stretch> stretches;
    std::uint64_t received = 0;  ///< bytes
  };

  [[noreturn]] void fail(const std::string& what, std::uint64_t logical) const;
  void read(std::uint64_t logical, std::size_t count, char* to);
  void drop_passed();
  bool walk_packet();
  void take_data_packet(std::uint64_t length);
  [[nodiscard]] std::uint64_t rows_ready() const;

  const E57Pages* pages_;
  const E57Scan* scan_;
  std::string name_;
  std::vector<Stream> streams_;
  std::size_t stretches_ = 0;  ///< of all streams
  std::uint64_t row_ = 0;      ///< first of the current rows
  std::size_t rows_ = 0;       ///< current rows
  std::uint64_t at_ = 0;       ///< next packet, logical
  std::uint64_t end_ = 0;      ///< of the section, logical
  std::uint64_t checked_ = 0;  ///< pages before this one are verified
  std::uint64_t header_page_;  ///< the page verified last for a packet's header
};

}  // namespace limen
