// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/packed_rows.h"

#include <cstring>
#include <memory>

#include "limen/base/error.h"

namespace limen {

bool same_kind(const Field& a, const Field& b) {
  return a.name == b.name && a.type == b.type && a.scale == b.scale && a.offset == b.offset &&
         a.bits.shift == b.bits.shift && a.bits.count == b.bits.count;
}

void PackedRows::require_columns(const RecordTable& like) {
  if (columns_.empty()) {
    swapped_ = like.swapped;
    columns_ = like.fields;
    for (const Field& field : columns_) {
      at_.push_back(record_bytes_);
      bytes_of_.push_back(size_of(field.type));
      record_bytes_ += bytes_of_.back();
    }
  }
  bool same = like.fields.size() == columns_.size() && like.swapped == swapped_;
  for (std::size_t k = 0; same && k < columns_.size(); ++k) same = same_kind(like.fields[k], columns_[k]);
  if (!same) throw Error("the columns of a cloud change within it", "", "please report it", Fault::internal);
}

void PackedRows::write(char* to, const RecordTable& table, std::size_t row) const {
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Field& field = table.fields[k];
    const char* const from = field.data + row * field.stride;
    // Fixed sizes: each copy is one move of the machine.
    switch (bytes_of_[k]) {
      case 1:
        to[at_[k]] = *from;
        break;
      case 2:
        std::memcpy(to + at_[k], from, 2);
        break;
      case 4:
        std::memcpy(to + at_[k], from, 4);
        break;
      default:
        std::memcpy(to + at_[k], from, 8);
    }
  }
}

void PackedRows::append(const RecordTable& table, std::size_t row) {
  const std::size_t end = bytes_.size();
  bytes_.resize(end + record_bytes_);
  write(bytes_.data() + end, table, row);
}

void PackedRows::replace(std::size_t at, const RecordTable& table, std::size_t row) {
  write(bytes_.data() + at * record_bytes_, table, row);
}

void PackedRows::copy(std::size_t from, std::size_t to) {
  if (from == to) return;
  std::memcpy(bytes_.data() + to * record_bytes_, bytes_.data() + from * record_bytes_, record_bytes_);
}

RecordTable PackedRows::table_at(const char* first, std::size_t rows) const {
  RecordTable table;
  table.rows = rows;
  table.swapped = swapped_;
  table.fields = columns_;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    table.fields[k].data = rows == 0 ? nullptr : first + at_[k];
    table.fields[k].stride = record_bytes_;
  }
  return table;
}

RecordTable PackedRows::view() const {
  return table_at(bytes_.data(), size());
}

RecordTable PackedRows::taken(const std::vector<std::uint32_t>& order) const {
  auto bytes = std::make_shared<std::vector<char>>(order.size() * record_bytes_);
  for (std::size_t i = 0; i < order.size(); ++i)
    std::memcpy(bytes->data() + i * record_bytes_, bytes_.data() + order[i] * record_bytes_, record_bytes_);
  RecordTable table = table_at(bytes->data(), order.size());
  table.keeper = std::move(bytes);
  return table;
}

}  // namespace limen
