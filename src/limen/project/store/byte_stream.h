// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "limen/base/error.h"

namespace limen {

// What is kept goes to bytes and back by one function for both directions:
//
//   void transfer(auto& bytes, Is<Plane> auto& plane) { bytes(plane.normal, plane.offset); }
//
// Numbers, enumerations, strings, matrices of fixed size, and arrays, vectors and optionals of what can be
// transferred need none.

/// `T` is `Of`, const or not.
template <typename T, typename Of>
concept Is = std::same_as<std::remove_const_t<T>, Of>;

template <typename Value>
inline constexpr bool kIsPlain = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

/// Puts values one after the other as the machine holds them (little-endian): the bytes that come back are
/// the bytes that went in.
class ByteWriter {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (put(values), ...);
  }
  void require(bool /*holds*/) const {}  // it is the reader's question

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  template <typename Value>
  void put(const Value& value) {
    if constexpr (kIsPlain<Value>)
      put_raw(&value, sizeof value);
    else
      transfer(*this, value);
  }
  template <int Rows, int Columns>
  void put(const Eigen::Matrix<double, Rows, Columns>& matrix) {
    put_raw(matrix.data(), sizeof(double) * static_cast<std::size_t>(matrix.size()));
  }
  void put(const std::string& text) {
    put(text.size());
    bytes_ += text;
  }
  template <typename Value>
  void put(const std::vector<Value>& values) {
    put(values.size());
    if constexpr (kIsPlain<Value>)
      put_raw(values.data(), values.size() * sizeof(Value));
    else
      for (const Value& value : values) put(value);
  }
  template <typename Value, std::size_t N>
  void put(const std::array<Value, N>& values) {
    for (const Value& value : values) put(value);
  }
  template <typename Value, std::size_t N>
  void put(const Value (&values)[N]) {
    for (const Value& value : values) put(value);
  }
  template <typename Value>
  void put(const std::optional<Value>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  void put_raw(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }

  std::string bytes_;
};

/// Takes them back in the same order. Throws Error that names `where` where the bytes end too early.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }
  /// Throws Error where what was read cannot be.
  void require(bool holds) const {
    if (!holds) throw Error("the file is damaged", where_, "remove it: it is made again by the next run");
  }

 private:
  template <typename Value>
  void get(Value& value) {
    if constexpr (kIsPlain<Value>)
      get_raw(&value, sizeof value);
    else
      transfer(*this, value);
  }
  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    require(byte <= 1);
    value = byte == 1;
  }
  template <int Rows, int Columns>
  void get(Eigen::Matrix<double, Rows, Columns>& matrix) {
    get_raw(matrix.data(), sizeof(double) * static_cast<std::size_t>(matrix.size()));
  }
  void get(std::string& text) {
    text.resize(get_count(1));
    get_raw(text.data(), text.size());
  }
  template <typename Value>
  void get(std::vector<Value>& values) {
    if constexpr (kIsPlain<Value>) {
      values.resize(get_count(sizeof(Value)));
      get_raw(values.data(), values.size() * sizeof(Value));
    } else {
      const std::size_t count = get_count(1);
      values.clear();
      // One by one: there may be fewer than damaged bytes say.
      while (values.size() < count) get(values.emplace_back());
    }
  }
  template <typename Value, std::size_t N>
  void get(std::array<Value, N>& values) {
    for (Value& value : values) get(value);
  }
  template <typename Value, std::size_t N>
  void get(Value (&values)[N]) {
    for (Value& value : values) get(value);
  }
  template <typename Value>
  void get(std::optional<Value>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  /// A count of things of at least `least_bytes` each: never more than the bytes could hold.
  std::size_t get_count(std::size_t least_bytes) {
    std::uint64_t count = 0;
    get(count);
    require(count <= (bytes_.size() - at_) / least_bytes);
    return static_cast<std::size_t>(count);
  }
  void get_raw(void* to, std::size_t size) {
    require(size <= bytes_.size() - at_);
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::string where_;
};

template <typename... Values>
std::string bytes_of_all(const Values&... values) {
  ByteWriter writer;
  writer(values...);
  return writer.bytes();
}

/// The value again. `where` is in messages. Throws Error where the bytes are damaged.
template <typename Value>
Value value_from(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  Value value;
  reader(value);
  return value;
}

/// Whether it is a place in a list of `size`.
inline bool is_place(std::int32_t index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// Whether it is one of an enumeration from 0 to `last`.
template <typename Value>
bool is_value(Value value, Value last) {
  return static_cast<std::int64_t>(value) >= 0 && value <= last;
}

}  // namespace limen
