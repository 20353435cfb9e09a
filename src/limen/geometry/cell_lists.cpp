// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/cell_lists.h"

#include <algorithm>
#include <utility>

#include "limen/base/random.h"

namespace limen {

CellLists::CellLists(std::vector<std::vector<std::int64_t>> cells_of) {
  std::size_t entries = 0;
  for (const std::vector<std::int64_t>& cells : cells_of) entries += cells.size();
  std::vector<std::pair<std::int64_t, std::int32_t>> all;
  all.reserve(entries);
  for (std::size_t k = 0; k < cells_of.size(); ++k) {
    for (const std::int64_t cell : cells_of[k]) all.emplace_back(cell, static_cast<std::int32_t>(k));
    cells_of[k] = {};
  }
  std::sort(all.begin(), all.end());
  std::size_t cells = 0;
  for (std::size_t k = 0; k < all.size(); ++k) cells += k == 0 || all[k].first != all[k - 1].first ? 1 : 0;
  std::size_t size = 2;
  while (size < 2 * cells) size *= 2;
  slots_.resize(size);
  things_.reserve(entries);
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    for (; end < all.size() && all[end].first == all[begin].first; ++end) things_.push_back(all[end].second);
    slots_[slot_of(all[begin].first)] = {all[begin].first, static_cast<std::uint32_t>(begin),
                                         static_cast<std::uint32_t>(end)};
    begin = end;
  }
}

std::span<const std::int32_t> CellLists::at(std::int64_t cell) const {
  if (slots_.empty()) return {};
  const Slot& slot = slots_[slot_of(cell)];
  return {things_.data() + slot.begin, slot.end - slot.begin};
}

std::size_t CellLists::slot_of(std::int64_t cell) const {
  std::size_t slot = mix64(static_cast<std::uint64_t>(cell)) & (slots_.size() - 1);
  while (slots_[slot].cell != kEmpty && slots_[slot].cell != cell) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

}  // namespace limen
