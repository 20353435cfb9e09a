// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_records.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/las/laz/laz_chunk.h"
#include "limen/io/las/laz/laz_info.h"

namespace limen {
namespace {

class LazRecords : public LasRecords {
 public:
  LazRecords(std::string_view bytes, std::string name, const LasHeader& header)
      : bytes_(bytes),
        name_(std::move(name)),
        stride_(header.point_bytes),
        info_(parse_laz_info(bytes, name_, header)) {}

  LasPiece next(std::size_t most_rows) override {
    // What a damaged count promises may have no room in memory.
    most_rows = std::min(most_rows, kMostRows);
    if (!open_ && at_ == info_.chunks.size()) return {};
    const bool some = open_ != nullptr || info_.chunks[at_].points > most_rows;
    const std::size_t count = some ? decode_some(most_rows) : decode_whole(most_rows);
    return {records_.data(), count};
  }

 private:
  static constexpr std::size_t kMostRows = std::size_t{1} << 24U;

  [[noreturn]] void damaged(std::size_t chunk) const {
    throw Error(fmt::format("compressed chunk {} of {} is damaged (bytes {} to {})", chunk + 1,
                            info_.chunks.size(), info_.chunks[chunk].begin, info_.chunks[chunk].end),
                name_, "get the whole file, or export it again");
  }

  /// A chunk too large for one piece.
  std::size_t decode_some(std::size_t most_rows) {
    if (!open_) {
      open_ = open_laz_chunk(info_, info_.chunks[at_], bytes_);
      left_ = info_.chunks[at_].points;
    }
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, most_rows));
    records_.resize(count * stride_);
    if (!open_ || !open_->decode(records_.data(), count)) damaged(at_);
    left_ -= count;
    if (left_ > 0) return count;
    open_.reset();
    ++at_;
    return count;
  }

  /// As many chunks as fit into one piece.
  std::size_t decode_whole(std::size_t most_rows) {
    const std::size_t first = at_;
    std::vector<std::size_t> begins{0};
    while (at_ < info_.chunks.size() && begins.back() + info_.chunks[at_].points <= most_rows)
      begins.push_back(begins.back() + static_cast<std::size_t>(info_.chunks[at_++].points));
    records_.resize(begins.back() * stride_);
    parallel_for(at_ - first, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const LazChunkPlace& place = info_.chunks[first + k];
        const std::unique_ptr<LazChunk> chunk = open_laz_chunk(info_, place, bytes_);
        const auto count = static_cast<std::size_t>(place.points);
        if (!chunk || !chunk->decode(records_.data() + begins[k] * stride_, count)) damaged(first + k);
      }
    });
    return begins.back();
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t stride_;
  LazInfo info_;
  std::size_t at_ = 0;  ///< the next chunk
  std::unique_ptr<LazChunk> open_;
  std::uint64_t left_ = 0;  ///< points of the open chunk
  std::vector<char> records_;
};

}  // namespace

std::unique_ptr<LasRecords> open_laz_records(std::string_view bytes, const std::string& name,
                                             const LasHeader& header) {
  return std::make_unique<LazRecords>(bytes, name, header);
}

}  // namespace limen
