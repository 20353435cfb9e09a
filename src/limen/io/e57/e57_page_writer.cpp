// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_page_writer.h"

#include <algorithm>

namespace limen {
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
