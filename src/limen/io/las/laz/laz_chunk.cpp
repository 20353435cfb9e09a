// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_chunk.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "limen/io/las/laz/laz_prediction.h"

namespace limen {
namespace {

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

}  // namespace

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

}  // namespace limen
