// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_streams.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr std::size_t kPaddingBytes = 16;
/// Where one column's packets come this far before another's, memory would go to book-keeping.
constexpr std::size_t kMostStretches = std::size_t{1} << 22U;
constexpr std::uint64_t kMostConstantRows = std::uint64_t{1} << 20U;

template <typename Value>
Value number_at(const char* bytes) {
  Value value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Throws where so many points cannot be in so many bytes.
void check_promise(const E57Scan& scan, std::uint64_t room, const std::string& name) {
  std::uint64_t bits = 0;
  for (const E57Column& column : scan.columns) bits += column.bits;
  const bool fits = bits == 0 ? scan.points <= kMostConstantRows : scan.points <= room * 8 / bits;
  if (fits) return;
  throw Error(fmt::format("the file promises {} points of {} bits each; there is room for {} bytes",
                          scan.points, bits, room),
              name, kE57CopyAgain);
}

}  // namespace

E57Streams::E57Streams(const E57Pages& pages, const E57Scan& scan, std::string name)
    : pages_(&pages),
      scan_(&scan),
      name_(std::move(name)),
      streams_(scan.columns.size()),
      header_page_(pages.page_count()) {
  if (scan.points == 0) return;
  const std::uint64_t begin = pages.logical_of(scan.section, "the section of the points");
  if (pages.logical_size() - begin < kE57SectionHeaderBytes)
    fail("the section of the points is cut off", begin);
  std::array<char, kE57SectionHeaderBytes> header{};
  read(begin, header.size(), header.data());
  if (header[0] != 1) fail("there is no section of packed points where the points should be", begin);
  const auto length = number_at<std::uint64_t>(&header[8]);
  if (length < kE57SectionHeaderBytes || length > pages.logical_size() - begin) {
    fail(fmt::format("the section of the points would have {} bytes, which do not fit into the file", length),
         begin);
  }
  end_ = begin + length;
  at_ = pages.logical_of(number_at<std::uint64_t>(&header[16]), "the first packet of points");
  if (at_ < begin + kE57SectionHeaderBytes) fail("the first packet of points lies before its section", begin);
  checked_ = pages.page_of(at_);
  check_promise(scan, end_ - std::min(at_, end_), name_);
}

void E57Streams::fail(const std::string& what, std::uint64_t logical) const {
  throw Error(what, fmt::format("{}, byte {}", name_, pages_->physical_of(logical)), kE57CopyAgain);
}

void E57Streams::read(std::uint64_t logical, std::size_t count, char* to) {
  const std::uint64_t first = pages_->page_of(logical);
  const std::uint64_t last = pages_->page_of(logical + count - 1);
  if (first != last || first != header_page_) pages_->check(first, last + 1);
  header_page_ = last;
  pages_->copy(logical, count, to);
}

std::uint64_t E57Streams::rows_ready() const {
  std::uint64_t ready = scan_->points - row_;
  for (std::size_t k = 0; k < streams_.size(); ++k) {
    const std::uint64_t bits = scan_->columns[k].bits;
    if (bits != 0)
      ready =
          std::min(ready, streams_[k].received * 8 / bits - std::min(row_, streams_[k].received * 8 / bits));
  }
  return ready;
}

void E57Streams::drop_passed() {
  for (std::size_t k = 0; k < streams_.size(); ++k) {
    std::deque<Stretch>& stretches = streams_[k].stretches;
    const std::uint64_t first_byte = row_ * scan_->columns[k].bits / 8;
    while (!stretches.empty()) {
      const std::uint64_t next = stretches.size() > 1 ? stretches[1].start : streams_[k].received;
      if (next > first_byte) break;
      stretches.pop_front();
      --stretches_;
    }
  }
}

void E57Streams::take_data_packet(std::uint64_t length) {
  std::array<char, 2> count_bytes{};
  if (length < 6) fail("a packet of points is too short", at_);
  read(at_ + 4, 2, count_bytes.data());
  const std::size_t count = number_at<std::uint16_t>(count_bytes.data());
  if (count == 0) return;
  if (count != streams_.size()) {
    fail(fmt::format("a packet of points has {} streams, but the points have {} values", count,
                     streams_.size()),
         at_);
  }
  if (6 + 2 * count > length) fail("a packet of points is too short for its streams", at_);
  std::vector<char> lengths(2 * count);
  read(at_ + 6, lengths.size(), lengths.data());
  std::uint64_t from = at_ + 6 + lengths.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t bytes = number_at<std::uint16_t>(&lengths[2 * k]);
    if (bytes > at_ + length - from) fail("a packet of points is too short for its streams", at_);
    if (bytes != 0 && scan_->columns[k].bits != 0) {
      streams_[k].stretches.push_back({streams_[k].received, from});
      streams_[k].received += bytes;
      ++stretches_;
    }
    from += bytes;
  }
}

bool E57Streams::walk_packet() {
  if (at_ >= end_ || end_ - at_ < 4) return false;
  std::array<char, 4> header{};
  read(at_, header.size(), header.data());
  const std::uint64_t length = std::uint64_t{number_at<std::uint16_t>(&header[2])} + 1;
  if (length < 4 || length % 4 != 0 || length > end_ - at_) {
    fail(fmt::format("a packet would have {} bytes, which is impossible", length), at_);
  }
  constexpr char kIndex = 0;
  constexpr char kData = 1;
  constexpr char kEmpty = 2;
  if (header[0] == kData) {
    take_data_packet(length);
  } else if (header[0] != kIndex && header[0] != kEmpty) {
    fail(fmt::format("a packet is of the unknown kind {}", static_cast<unsigned char>(header[0])), at_);
  }
  at_ += length;
  return true;
}

std::size_t E57Streams::advance(std::size_t most) {
  row_ += rows_;
  drop_passed();
  const std::uint64_t wanted = std::min<std::uint64_t>(std::max<std::size_t>(most, 1), scan_->points - row_);
  bool more = true;
  while (more && rows_ready() < wanted && stretches_ < kMostStretches) more = walk_packet();
  const std::uint64_t ready = rows_ready();
  if (ready < wanted && !more) {
    fail(fmt::format("the points end after {} of {}", row_ + ready, scan_->points), std::min(at_, end_));
  }
  if (ready == 0 && wanted != 0) fail("the values of one point are stored absurdly far from each other", at_);
  rows_ = static_cast<std::size_t>(std::min(ready, wanted));
  const std::uint64_t end_page = at_ == 0 ? 0 : pages_->page_of(at_ - 1) + 1;
  if (end_page > checked_) {
    pages_->check(checked_, end_page);
    checked_ = end_page;
  }
  return rows_;
}

E57Bits E57Streams::bits_of(std::size_t column, RowRange rows) const {
  const std::uint64_t bits = scan_->columns[column].bits;
  const std::uint64_t first_bit = (row_ + rows.begin) * bits;
  const std::uint64_t last_bit = (row_ + rows.end) * bits;
  E57Bits result;
  result.shift = static_cast<unsigned>(first_bit % 8);
  std::uint64_t from = first_bit / 8;
  const std::uint64_t to = (last_bit + 7) / 8;
  result.bytes.resize(static_cast<std::size_t>(to - from) + kPaddingBytes);
  const Stream& stream = streams_[column];
  auto stretch = std::upper_bound(stream.stretches.begin(), stream.stretches.end(), from,
                                  [](std::uint64_t byte, const Stretch& one) { return byte < one.start; });
  char* out = result.bytes.data();
  for (--stretch; from < to;) {
    const auto next = stretch + 1;
    const std::uint64_t stop = std::min(to, next == stream.stretches.end() ? stream.received : next->start);
    pages_->copy(stretch->logical + (from - stretch->start), static_cast<std::size_t>(stop - from), out);
    out += stop - from;
    from = stop;
    stretch = next;
  }
  return result;
}

}  // namespace limen
