// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "limen/base/error.h"

namespace limen {

/// Puts values one after the other as the machine holds them (little-endian): the bytes that come back are
/// the bytes that went in.
class ByteWriter {
 public:
  template <typename Value>
  void put(const Value& value) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    char raw[sizeof(Value)];
    std::memcpy(raw, &value, sizeof(Value));
    bytes_.append(raw, sizeof(Value));
  }
  template <int Rows, int Columns>
  void put(const Eigen::Matrix<double, Rows, Columns>& matrix) {
    for (Eigen::Index k = 0; k < matrix.size(); ++k) put(matrix.data()[k]);
  }
  void put(const std::string& text) {
    put_count(text.size());
    bytes_ += text;
  }
  void put_count(std::size_t count) { put(static_cast<std::uint64_t>(count)); }
  template <typename Value>
  void put_all(const std::vector<Value>& values) {
    put_count(values.size());
    for (const Value& value : values) put(value);
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes them back in the same order. Throws Error that names `where` where the bytes end too early.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  template <typename Value>
  Value get() {
    if constexpr (std::is_same_v<Value, std::string>) {
      const std::size_t size = get_count(1);
      std::string text(bytes_.substr(at_, size));
      at_ += size;
      return text;
    } else if constexpr (std::is_same_v<Value, bool>) {
      const auto value = get<std::uint8_t>();
      if (value > 1) fail();
      return value == 1;
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      need(sizeof(Value));
      Value value;
      std::memcpy(&value, bytes_.data() + at_, sizeof(Value));
      at_ += sizeof(Value);
      return value;
    } else {
      Value matrix;
      for (Eigen::Index k = 0; k < matrix.size(); ++k) matrix.data()[k] = get<double>();
      return matrix;
    }
  }
  template <typename Value>
  void get(Value& value) {
    value = get<Value>();
  }
  /// A count of things of at least `least_bytes` each: never more than the bytes could hold.
  std::size_t get_count(std::size_t least_bytes) {
    const auto count = get<std::uint64_t>();
    if (count > (bytes_.size() - at_) / least_bytes) fail();
    return static_cast<std::size_t>(count);
  }
  template <typename Value>
  std::vector<Value> get_all() {
    std::vector<Value> values(get_count(std::is_same_v<Value, std::string> ? 8 : sizeof(Value)));
    for (Value& value : values) value = get<Value>();
    return values;
  }
  /// One of the values of an enumeration from 0 to `last`.
  template <typename Value>
  void get_enum(Value& value, Value last) {
    value = get<Value>();
    require(static_cast<std::int64_t>(value) >= 0 && value <= last);
  }
  /// A place in a list of `size`, or -1 where `or_none`.
  void get_index(std::int32_t& index, std::size_t size, bool or_none = false) {
    index = get<std::int32_t>();
    require(index < 0 ? or_none && index == -1 : static_cast<std::size_t>(index) < size);
  }
  /// Throws Error where what was read cannot be.
  void require(bool holds) const {
    if (!holds) fail();
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  [[noreturn]] void fail() const {
    throw Error("the file is damaged", where_, "remove it: it is made again by the next run");
  }
  void need(std::size_t count) const {
    if (count > bytes_.size() - at_) fail();
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::string where_;
};

}  // namespace limen
