// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_records.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/las/laz/laz_info.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen {
namespace {

/// Decodes the points of one chunk, some at a time.
class LazChunk {
 public:
  LazChunk() = default;
  LazChunk(const LazChunk&) = delete;
  LazChunk& operator=(const LazChunk&) = delete;
  virtual ~LazChunk() = default;

  /// Writes the next `count` records, one behind the other, to `records`. False where the bytes are damaged:
  /// the records are worth nothing then.
  virtual bool decode(char* records, std::size_t count) = 0;
};

using laz::ItemPlan;
using laz::ItemType;

std::size_t record_bytes(const LazInfo& info) {
  std::size_t bytes = 0;
  for (const ItemPlan& item : info.items) bytes += item.bytes;
  return bytes;
}

std::unique_ptr<laz::PointItem> make_point_item(const ItemPlan& plan) {
  switch (plan.type) {
    case ItemType::point10:
      return laz::make_point10(plan.version);
    case ItemType::gps_time11:
      return laz::make_gps_time11(plan.version);
    case ItemType::rgb12:
      return laz::make_rgb12(plan.version);
    case ItemType::wave_packet13:
      return laz::make_wave_packet13(plan.version);
    default:
      return laz::make_bytes(plan.version, plan.bytes);
  }
}

std::unique_ptr<laz::LayerItem> make_layer_item(const ItemPlan& plan) {
  switch (plan.type) {
    case ItemType::point14:
      return laz::make_point14();
    case ItemType::rgb14:
      return laz::make_rgb14(plan.version, false);
    case ItemType::rgb_nir14:
      return laz::make_rgb14(plan.version, true);
    case ItemType::wave_packet14:
      return laz::make_wave_packet14(plan.version);
    default:
      return laz::make_bytes14(plan.version, plan.bytes);
  }
}

/// Formats 0 to 5: the first point as it is, then one message of all parts of all points.
class PointwiseChunk : public LazChunk {
 public:
  PointwiseChunk(const LazInfo& info, std::string_view bytes, std::uint64_t points)
      : stride_(record_bytes(info)),
        first_(bytes.data()),
        left_(points),
        ends_(info.chunk_ends_known),
        decoder_(bytes.substr(stride_)) {
    std::size_t at = 0;
    for (const ItemPlan& plan : info.items) {
      parts_.push_back({at, make_point_item(plan)});
      if (!parts_.back().item) {
        known_ = false;
        return;
      }
      parts_.back().item->start(first_ + at);
      at += plan.bytes;
    }
  }
  [[nodiscard]] bool known() const { return known_; }

  bool decode(char* records, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i, records += stride_) {
      if (first_ != nullptr) {
        std::memcpy(records, std::exchange(first_, nullptr), stride_);
        continue;
      }
      for (const Part& part : parts_) part.item->decode(decoder_, records + part.at);
      if (!decoder_.sound(false)) return false;
    }
    left_ -= count;
    return decoder_.sound(ends_ && left_ == 0);
  }

 private:
  struct Part {
    std::size_t at;
    std::unique_ptr<laz::PointItem> item;
  };

  std::size_t stride_;
  const char* first_;
  std::uint64_t left_;
  bool ends_;
  laz::Decoder decoder_;
  std::vector<Part> parts_;
  bool known_ = true;
};

/// Formats 6 to 10: the first point as it is, the number of points, the lengths of all layers, the layers.
class LayeredChunk : public LazChunk {
 public:
  LayeredChunk(const LazInfo& info, std::string_view bytes)
      : stride_(record_bytes(info)), first_(bytes.data()) {
    std::size_t at = 0;
    for (const ItemPlan& plan : info.items) {
      parts_.push_back({at, make_layer_item(plan)});
      layers_ += parts_.back().item->layers();
      at += plan.bytes;
    }
  }

  /// Finds the layers; false where they are not there, or where the chunk has another number of points.
  bool start(std::string_view bytes, std::uint64_t points) {
    const std::size_t head = stride_ + 4 + 4 * layers_;
    if (bytes.size() < head || las_number<std::uint32_t>(bytes, stride_) != points) return false;
    left_ = points;
    const unsigned channel = (static_cast<unsigned char>(first_[15]) >> 4U) & 3U;
    std::size_t length_at = stride_ + 4;
    std::size_t at = head;
    for (const Part& part : parts_) {
      std::vector<std::string_view> layers;
      for (std::size_t k = 0; k < part.item->layers(); ++k, length_at += 4) {
        const auto length = las_number<std::uint32_t>(bytes, length_at);
        if (length > bytes.size() - at) return false;
        layers.push_back(bytes.substr(at, length));
        at += length;
      }
      part.item->start(first_ + part.at, channel, layers);
    }
    return true;
  }

  bool decode(char* records, std::size_t count) override {
    left_ -= count;
    if (first_ != nullptr && count > 0) {
      std::memcpy(records, std::exchange(first_, nullptr), stride_);
      records += stride_;
      --count;
    }
    while (count > 0) {
      const std::size_t now = std::min(count, kStrip);
      steps_.resize(now);
      for (const Part& part : parts_) {
        part.item->decode({records + part.at, stride_}, steps_);
        if (!part.item->sound(false)) return false;
      }
      records += now * stride_;
      count -= now;
    }
    return left_ > 0 ||
           std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.item->sound(true); });
  }

 private:
  static constexpr std::size_t kStrip = 512;  ///< points whose records stay in the cache from layer to layer

  struct Part {
    std::size_t at;
    std::unique_ptr<laz::LayerItem> item;
  };

  std::size_t stride_;
  const char* first_;
  std::uint64_t left_ = 0;
  std::size_t layers_ = 0;
  std::vector<Part> parts_;
  std::vector<laz::PointStep> steps_;
};

/// nullptr where the chunk has not even the bytes it must have.
std::unique_ptr<LazChunk> open_laz_chunk(const LazInfo& info, const LazChunkPlace& place,
                                         std::string_view file) {
  const std::string_view bytes = file.substr(place.begin, place.end - place.begin);
  if (bytes.size() < record_bytes(info)) return nullptr;
  if (info.layered) {
    auto chunk = std::make_unique<LayeredChunk>(info, bytes);
    if (!chunk->start(bytes, place.points)) return nullptr;
    return chunk;
  }
  auto chunk = std::make_unique<PointwiseChunk>(info, bytes, place.points);
  if (!chunk->known()) return nullptr;
  return chunk;
}

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
