// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_pages.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/e57/e57_crc.h"

namespace limen {
namespace {

static_assert(std::endian::native == std::endian::little, "E57 numbers are copied as they are in memory");

constexpr std::string_view kSignature = "ASTM-E57";
constexpr std::uint64_t kLeastPageBytes = 64;
constexpr std::uint64_t kLargestPageBytes = std::uint64_t{1} << 24U;

template <typename Value>
Value number_at(std::string_view bytes, std::size_t offset) {
  Value value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <typename Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

E57Head read_head(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kE57HeadBytes || bytes.substr(0, kSignature.size()) != kSignature) {
    throw Error("the file does not begin like an E57 file", name + ", byte 0", kE57CopyAgain);
  }
  E57Head head;
  head.major = number_at<std::uint32_t>(bytes, 8);
  head.minor = number_at<std::uint32_t>(bytes, 12);
  head.file_bytes = number_at<std::uint64_t>(bytes, 16);
  head.xml_offset = number_at<std::uint64_t>(bytes, 24);
  head.xml_bytes = number_at<std::uint64_t>(bytes, 32);
  head.page_bytes = number_at<std::uint64_t>(bytes, 40);
  return head;
}

void check_head(const E57Head& head, std::uint64_t size, const std::string& name) {
  if (head.major != 1) {
    throw Error(fmt::format("E57 version {}.{} is not known", head.major, head.minor), name + ", byte 8",
                "export the scan as E57 1.0");
  }
  if (head.page_bytes < kLeastPageBytes || head.page_bytes > kLargestPageBytes || head.page_bytes % 4 != 0) {
    throw Error(fmt::format("a page size of {} bytes is absurd", head.page_bytes), name + ", byte 40",
                kE57CopyAgain);
  }
  if (head.file_bytes > size) {
    throw Error(
        fmt::format("the file is cut off: it says it has {} bytes, there are {}", head.file_bytes, size),
        name, kE57CopyAgain);
  }
  if (head.file_bytes == 0 || head.file_bytes % head.page_bytes != 0) {
    throw Error(fmt::format("the file's length of {} bytes is not a multiple of its page size of {}",
                            head.file_bytes, head.page_bytes),
                name + ", byte 16", kE57CopyAgain);
  }
}

}  // namespace

std::string e57_head_bytes(const E57Head& head) {
  std::string bytes(kSignature);
  append(bytes, head.major);
  append(bytes, head.minor);
  append(bytes, head.file_bytes);
  append(bytes, head.xml_offset);
  append(bytes, head.xml_bytes);
  append(bytes, head.page_bytes);
  return bytes;
}

std::string e57_section_header(std::uint64_t section_bytes, std::uint64_t first_packet) {
  std::string bytes{1, 0, 0, 0, 0, 0, 0, 0};
  append(bytes, section_bytes);
  append(bytes, first_packet);
  append(bytes, std::uint64_t{0});
  return bytes;
}

std::string e57_check_sum(std::string_view payload) {
  const std::uint32_t sum = crc32c(payload);
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>((sum >> shift) & 255U);
  return bytes;
}

E57Pages::E57Pages(std::string_view bytes, std::string name)
    : name_(std::move(name)), head_(read_head(bytes, name_)) {
  check_head(head_, bytes.size(), name_);
  surplus_ = bytes.size() - head_.file_bytes;
  bytes_ = bytes.substr(0, head_.file_bytes);
}

std::string_view E57Pages::raw(std::uint64_t begin, std::uint64_t end) const {
  return bytes_.substr(begin * head_.page_bytes, (end - begin) * head_.page_bytes);
}

std::uint64_t E57Pages::logical_of(std::uint64_t physical, std::string_view what) const {
  const std::uint64_t within = physical % head_.page_bytes;
  if (physical >= bytes_.size() || within >= payload()) {
    throw Error(fmt::format("{} would begin at byte {}, which is {}", what, physical,
                            within >= payload() ? "a check sum" : "behind the end of the file"),
                name_, kE57CopyAgain);
  }
  return physical / head_.page_bytes * payload() + within;
}

std::uint64_t E57Pages::physical_of(std::uint64_t logical) const {
  return logical / payload() * head_.page_bytes + logical % payload();
}

void E57Pages::check(std::uint64_t begin, std::uint64_t end) const {
  constexpr std::size_t kGrain = 256;
  parallel_for(end - begin, kGrain, [&](std::size_t first, std::size_t last) {
    for (std::uint64_t page = begin + first; page < begin + last; ++page) {
      const std::string_view whole = raw(page, page + 1);
      std::uint32_t stored = number_at<std::uint32_t>(whole, payload());
      if (__builtin_bswap32(stored) == crc32c(whole.substr(0, payload()))) continue;
      throw Error(fmt::format("damaged: the checksum of page {} of {} is wrong", page, page_count()),
                  fmt::format("{}, byte {}", name_, page * head_.page_bytes),
                  "copy the file again from an intact source, or export it again");
    }
  });
}

void E57Pages::copy(std::uint64_t logical, std::size_t count, char* to) const {
  while (count > 0) {
    const std::uint64_t within = logical % payload();
    const std::size_t step = std::min<std::size_t>(count, payload() - within);
    std::memcpy(to, bytes_.data() + physical_of(logical), step);
    logical += step;
    to += step;
    count -= step;
  }
}

namespace {

constexpr std::size_t kPayload = 1024 - kE57CheckSumBytes;

}  // namespace

E57PageWriter::E57PageWriter(const std::filesystem::path& path) : file_(path) {
  kept_[0];
  append(std::string(kE57HeadBytes, '\0'));
}

std::uint64_t E57PageWriter::physical_of(std::uint64_t logical) {
  return logical + logical / kPayload * kE57CheckSumBytes;
}

void E57PageWriter::append(std::string_view bytes) {
  logical_ += bytes.size();
  while (!bytes.empty()) {
    const std::size_t step = std::min(bytes.size(), kPayload - page_.size());
    page_.append(bytes.substr(0, step));
    bytes.remove_prefix(step);
    if (page_.size() == kPayload) end_page();
  }
}

void E57PageWriter::fill_page() {
  if (!page_.empty()) append(std::string(kPayload - page_.size(), '\0'));
}

std::uint64_t E57PageWriter::keep_page() {
  kept_[pages_];
  return pages_;
}

void E57PageWriter::replace(std::uint64_t page, std::size_t at, std::string_view bytes) {
  (page == pages_ ? page_ : kept_.at(page)).replace(at, bytes.size(), bytes);
}

void E57PageWriter::finish(E57Head head) {
  fill_page();
  head.page_bytes = kPayload + kE57CheckSumBytes;
  head.file_bytes = pages_ * head.page_bytes;
  replace(0, 0, e57_head_bytes(head));
  for (const auto& [page, payload] : kept_)
    file_.overwrite(page * head.page_bytes, payload + e57_check_sum(payload));
  file_.commit();
}

void E57PageWriter::end_page() {
  file_.write(page_);
  file_.write(e57_check_sum(page_));
  const auto kept = kept_.find(pages_++);
  if (kept != kept_.end()) kept->second = page_;
  page_.clear();
}

}  // namespace limen
