// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_slots.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/io/las/las_fields.h"

namespace limen {
namespace {

constexpr std::size_t kNameBytes = 32;
constexpr std::size_t kMostRecord = 0xFFFF;

/// A place of the format: the names a column may have, and the widest integer that fits.
struct SlotPlace {
  std::string_view names;  ///< each with a space behind it
  LasStore store;
  std::size_t at;
  BitRange bits;
  int axis;
};

constexpr std::array<SlotPlace, 21> kPlaces{{
    {"x ", LasStore::coordinate, 0, {}, 0},
    {"y ", LasStore::coordinate, 4, {}, 1},
    {"z ", LasStore::coordinate, 8, {}, 2},
    {"intensity ", LasStore::word, 12, {}, 0},
    {"return_number ", LasStore::bits, 14, {0, 4}, 0},
    {"number_of_returns ", LasStore::bits, 14, {4, 4}, 0},
    {"synthetic ", LasStore::bits, 15, {0, 1}, 0},
    {"key_point ", LasStore::bits, 15, {1, 1}, 0},
    {"withheld ", LasStore::bits, 15, {2, 1}, 0},
    {"overlap ", LasStore::bits, 15, {3, 1}, 0},
    {"scanner_channel ", LasStore::bits, 15, {4, 2}, 0},
    {"scan_direction_flag ", LasStore::bits, 15, {6, 1}, 0},
    {"edge_of_flight_line ", LasStore::bits, 15, {7, 1}, 0},
    {"classification ", LasStore::byte, 16, {}, 0},
    {"user_data ", LasStore::byte, 17, {}, 0},
    {"scan_angle ", LasStore::angle, 18, {}, 0},
    {"point_source_id ", LasStore::word, 20, {}, 0},
    {"gps_time gpstime time t timestamp ", LasStore::time, 22, {}, 0},
    {"red r diffuse_red ", LasStore::colour, 30, {}, 0},
    {"green g diffuse_green ", LasStore::colour, 32, {}, 0},
    {"blue b diffuse_blue ", LasStore::colour, 34, {}, 0},
}};
constexpr SlotPlace kInfrared{"nir ", LasStore::word, 36, {}, 0};

bool bears(const SlotPlace& place, const std::string& name) {
  const std::string word = name + " ";
  for (std::size_t at = place.names.find(word); at != std::string_view::npos;
       at = place.names.find(word, at + 1)) {
    if (at == 0 || place.names[at - 1] == ' ') return true;
  }
  return false;
}

/// Every number of the type can be stored there without loss.
bool exact(LasStore store, Scalar type) {
  switch (store) {
    case LasStore::coordinate:
    case LasStore::angle:
      return true;
    case LasStore::bits:
    case LasStore::byte:
      return type == Scalar::uint8;
    case LasStore::word:
    case LasStore::colour:
      return type == Scalar::uint8 || type == Scalar::uint16;
    case LasStore::time:
      return type != Scalar::int64 && type != Scalar::uint64;
    default:
      return true;
  }
}

bool has_column(const CloudPlan& plan, const SlotPlace& place) {
  return std::any_of(plan.columns.begin(), plan.columns.end(),
                     [&](const ColumnPlan& column) { return bears(place, lower_case(column.name)); });
}

/// A standard value beside the more exact one that readers give its name: it is made anew from that one.
bool is_rounded_twin(const CloudPlan& plan, const std::string& name) {
  static constexpr std::string_view kStandard = "las_";
  if (name.substr(0, kStandard.size()) != kStandard) return false;
  const std::string_view exact_name = std::string_view(name).substr(kStandard.size());
  return std::any_of(plan.columns.begin(), plan.columns.end(),
                     [&](const ColumnPlan& column) { return lower_case(column.name) == exact_name; });
}

/// One description of extra bytes.
std::string description_of(const ColumnPlan& column) {
  static constexpr std::array<char, 10> kTypes{2, 1, 4, 3, 6, 5, 8, 7, 9, 10};  // in the order of Scalar
  std::string about(kLasDescriptionBytes, '\0');
  about[2] = kTypes[static_cast<std::size_t>(column.type)];
  const std::string name = column.name.substr(0, kNameBytes);
  std::copy(name.begin(), name.end(), about.begin() + 4);
  return about;
}

/// The places of columns, each given away once.
class Places {
 public:
  explicit Places(bool infrared) : infrared_(infrared) {}

  std::optional<LasSlot> take(const std::string& name, std::size_t column) {
    for (const SlotPlace& place : kPlaces) {
      if (bears(place, name)) return take(place, column);
    }
    if (infrared_ && bears(kInfrared, name)) return take(kInfrared, column);
    return {};
  }

 private:
  std::optional<LasSlot> take(const SlotPlace& place, std::size_t column) {
    if (!taken_.insert(place.names).second) return {};
    return LasSlot{column, place.store, place.at, place.bits, place.axis};
  }

  bool infrared_;
  std::set<std::string_view> taken_;
};

void check_columns(const CloudPlan& plan, const std::string& name) {
  for (const SlotPlace& place : kPlaces) {
    if (place.store != LasStore::coordinate || has_column(plan, place)) continue;
    throw Error("points without x, y and z cannot be written as LAS", name, "write another format");
  }
}

}  // namespace

LasSlots las_slots(const CloudPlan& plan, const std::string& name) {
  check_columns(plan, name);
  const bool coloured = std::any_of(kPlaces.begin(), kPlaces.end(), [&](const SlotPlace& place) {
    return place.store == LasStore::colour && has_column(plan, place);
  });
  const bool infrared = has_column(plan, kInfrared);
  LasSlots slots;
  slots.point_format = infrared ? 8 : (coloured ? 7 : 6);
  slots.point_bytes = las_point_bytes(slots.point_format);
  Places places(infrared);
  for (std::size_t k = 0; k < plan.columns.size(); ++k) {
    const ColumnPlan& column = plan.columns[k];
    if (is_rounded_twin(plan, lower_case(column.name))) continue;
    const std::optional<LasSlot> slot = places.take(lower_case(column.name), k);
    if (slot) slots.slots.push_back(*slot);
    if (slot && exact(slot->store, column.type)) continue;
    LasSlot extra{k, LasStore::extra, slots.point_bytes};
    extra.type = column.type;
    slots.slots.push_back(extra);
    slots.point_bytes += size_of(column.type);
    slots.extra_bytes += description_of(column);
  }
  if (slots.extra_bytes.size() > kMostRecord || slots.point_bytes > kMostRecord) {
    throw Error(fmt::format("{} values per point are more than LAS can hold", plan.columns.size()), name,
                "write PLY");
  }
  return slots;
}

}  // namespace limen
