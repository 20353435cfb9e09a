// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_page_writer.h"

#include <algorithm>

namespace limen {
namespace {

constexpr std::size_t kPayload = 1024 - kE57CheckSumBytes;

}  // namespace

E57PageWriter::E57PageWriter(const std::filesystem::path& path) : file_(path) {
  append(std::string(kE57HeadBytes, '\0'));
}

std::uint64_t E57PageWriter::physical() const {
  return pages_ * (kPayload + kE57CheckSumBytes) + page_.size();
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

void E57PageWriter::replace_early(std::size_t logical, std::string_view bytes) {
  (pages_ == 0 ? page_ : first_).replace(logical, bytes.size(), bytes);
}

void E57PageWriter::finish(E57Head head) {
  if (!page_.empty()) {
    page_.resize(kPayload, '\0');
    end_page();
  }
  head.page_bytes = kPayload + kE57CheckSumBytes;
  head.file_bytes = pages_ * head.page_bytes;
  first_.replace(0, kE57HeadBytes, e57_head_bytes(head));
  file_.overwrite(0, first_ + e57_check_sum(first_));
  file_.commit();
}

void E57PageWriter::end_page() {
  file_.write(page_);
  file_.write(e57_check_sum(page_));
  if (pages_++ == 0) first_ = page_;
  page_.clear();
}

}  // namespace limen
