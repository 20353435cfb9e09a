// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limen {

/// Which item holds which cell: of all that were put into a cell the one with the least lot. Items are
/// numbered from 0 as their cells are first met.
class CellTable {
 public:
  explicit CellTable(std::size_t room = 0) : slots_(slots_for(room)) {}

  enum class Outcome { fresh, better, worse };
  struct Place {
    Outcome outcome;
    std::size_t index;  ///< number of the item
  };
  /// Puts an item into a cell, which it holds from then on unless the outcome is worse.
  Place put(std::uint64_t key, std::uint64_t lot) {
    if (3 * (size_ + 1) > 2 * slots_.size()) widen();
    Slot& slot = slots_[find(key)];
    if (slot.index == kEmpty) {
      slot = {key, lot, static_cast<std::uint32_t>(size_)};
      return {Outcome::fresh, size_++};
    }
    if (lot >= slot.lot) return {Outcome::worse, slot.index};
    slot.lot = lot;
    return {Outcome::better, slot.index};
  }
  /// The cell is held by an item with this lot or a lower one.
  [[nodiscard]] bool has_better(std::uint64_t key, std::uint64_t lot) const {
    const Slot& slot = slots_[find(key)];
    return slot.index != kEmpty && slot.lot <= lot;
  }
  /// Asks the machine to bring the slot of a cell near: it is looked at soon.
  void expect(std::uint64_t key) const { __builtin_prefetch(&slots_[home(key)]); }
  [[nodiscard]] std::size_t size() const { return size_; }
  void clear() {
    slots_.assign(slots_.size(), Slot{});
    size_ = 0;
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;
  struct Slot {
    std::uint64_t key = 0;
    std::uint64_t lot = 0;
    std::uint32_t index = kEmpty;
  };

  static std::size_t slots_for(std::size_t room) { return room + room / 2 + 16; }

  [[nodiscard]] std::size_t home(std::uint64_t key) const {
    return static_cast<std::size_t>((static_cast<unsigned __int128>(key) * slots_.size()) >> 64U);
  }
  /// The slot of the key, or the empty one where it would stand.
  [[nodiscard]] std::size_t find(std::uint64_t key) const {
    const std::size_t count = slots_.size();
    std::size_t at = home(key);
    while (slots_[at].index != kEmpty && slots_[at].key != key) at = at + 1 == count ? 0 : at + 1;
    return at;
  }
  void widen() {
    std::vector<Slot> old(slots_for(2 * (size_ + 8)));
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.index != kEmpty) slots_[find(slot.key)] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace limen
