// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "limen/io/las/laz/laz_arithmetic.h"

namespace limen::laz {

/// The parts of a point that are coded separately, by their numbers in the LASzip record.
enum class ItemType : std::uint16_t {
  byte = 0,
  point10 = 6,
  gps_time11 = 7,
  rgb12 = 8,
  wave_packet13 = 9,
  point14 = 10,
  rgb14 = 11,
  rgb_nir14 = 12,
  wave_packet14 = 13,
  byte14 = 14
};

/// A part of the points: what, how many bytes, coded how.
struct ItemPlan {
  ItemType type = ItemType::byte;
  std::size_t bytes = 0;
  int version = 2;
};

/// One part of points that are coded one by one (formats 0 to 5): all parts share one message.
class PointItem {
 public:
  PointItem() = default;
  PointItem(const PointItem&) = delete;
  PointItem& operator=(const PointItem&) = delete;
  virtual ~PointItem() = default;

  /// The first point of a chunk, which is stored as it is.
  virtual void start(const char* raw) = 0;
  /// Writes the part of the next point to `out`.
  virtual void decode(Decoder& decoder, char* out) = 0;
};

/// Versions 1 and 2 of the parts of formats 0 to 5; nullptr for what is not known.
std::unique_ptr<PointItem> make_point10(int version);
std::unique_ptr<PointItem> make_gps_time11(int version);
std::unique_ptr<PointItem> make_rgb12(int version);
std::unique_ptr<PointItem> make_bytes(int version, std::size_t count);
std::unique_ptr<PointItem> make_wave_packet13(int version);

/// How the points of a layered chunk follow one another, as far as the layers depend on it.
struct PointStep {
  std::uint8_t channel = 0;  ///< of the scanner: each has models and predictions of its own
  std::uint8_t from = 0;     ///< that of the point before
  bool fresh = false;        ///< the channel's first point
  bool gps_time_changes = false;
  bool scan_angle_changes = false;
  bool source_changes = false;
  std::uint8_t echo = 0;   ///< 2: first return, 1: last, 3: both
  std::uint8_t level = 0;  ///< distance of return number and number of returns
  std::uint8_t z_context = 0;
};

/// Where the records are written.
struct RecordPlace {
  char* first = nullptr;
  std::size_t stride = 0;
};

/// One part of points whose values are coded in layers (formats 6 to 10): each layer is a message of its own.
class LayerItem {
 public:
  LayerItem() = default;
  LayerItem(const LayerItem&) = delete;
  LayerItem& operator=(const LayerItem&) = delete;
  virtual ~LayerItem() = default;

  [[nodiscard]] virtual std::size_t layers() const = 0;
  /// The first point of a chunk, and the bytes of each layer; an empty one: its values never change.
  virtual void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) = 0;
  /// Writes the part of the next points. Item point14 fills the steps, the others follow them.
  virtual void decode(const RecordPlace& out, std::vector<PointStep>& steps) = 0;
  /// As far as the bytes can tell.
  [[nodiscard]] virtual bool sound(bool at_end) const = 0;
};

/// Versions 3 and 4 of the parts of formats 6 to 10. They differ in what a value is predicted from where
/// channels alternate.
std::unique_ptr<LayerItem> make_point14();
std::unique_ptr<LayerItem> make_rgb14(int version, bool with_infrared);
std::unique_ptr<LayerItem> make_bytes14(int version, std::size_t count);
std::unique_ptr<LayerItem> make_wave_packet14(int version);

}  // namespace limen::laz
