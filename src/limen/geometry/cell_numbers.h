// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace limen {

/// Numbers the occupied cells of a plane's grid in the order in which they are first met; open addressing.
class CellNumbers {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// `room`: that many slots are there from the start, about; there is no limit.
  explicit CellNumbers(std::size_t room = 0) {
    std::size_t size = 64;
    while (size < room) size *= 2;
    slots_.assign(size, {0, kNone});
  }
  /// The number of the cell at (x, y); a new one at its first call.
  std::uint32_t insert(std::int32_t x, std::int32_t y) {
    if (2 * keys_.size() >= slots_.size()) grow();
    const std::uint64_t key = key_of(x, y);
    Slot& slot = slots_[place_of(key)];
    if (slot.number == kNone) {
      slot = {key, static_cast<std::uint32_t>(keys_.size())};
      keys_.push_back(key);
    }
    return slot.number;
  }
  /// kNone where the cell is empty.
  [[nodiscard]] std::uint32_t find(std::int32_t x, std::int32_t y) const {
    return slots_[place_of(key_of(x, y))].number;
  }
  [[nodiscard]] std::int32_t x(std::size_t cell) const {
    return static_cast<std::int32_t>(keys_[cell] >> 32U);
  }
  [[nodiscard]] std::int32_t y(std::size_t cell) const {
    return static_cast<std::int32_t>(keys_[cell] & 0xffffffffU);
  }
  [[nodiscard]] std::size_t size() const { return keys_.size(); }

 private:
  struct Slot {
    std::uint64_t key;
    std::uint32_t number;
  };
  static std::uint64_t key_of(std::int32_t x, std::int32_t y) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U) | static_cast<std::uint32_t>(y);
  }
  /// Where the key is, or would be.
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const {
    std::size_t i = (key * 0x9e3779b97f4a7c15U) >> 32U & (slots_.size() - 1);
    while (slots_[i].number != kNone && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
    return i;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), {0, kNone});
    for (std::uint32_t k = 0; k < keys_.size(); ++k) slots_[place_of(keys_[k])] = {keys_[k], k};
  }

  std::vector<Slot> slots_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace limen
