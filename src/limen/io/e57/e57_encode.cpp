// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_encode.h"

#include <algorithm>
#include <bit>

namespace limen {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

namespace {

template <typename Value>
void append_bytes(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void E57Encoder::append(double value) {
  range_.add(value);
  if (column_.storage == E57Storage::float32) {
    append_bytes(bytes_, static_cast<float>(value));
  } else {
    append_bytes(bytes_, value);
  }
}

bool E57Encoder::append_integer(std::int64_t value) {
  if (value < column_.minimum || value > column_.maximum) return false;
  range_.add(static_cast<double>(value));
  const std::uint64_t raw = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(column_.minimum);
  waiting_ |= filled_ < 64 ? raw << filled_ : 0;
  const unsigned room = 64 - filled_;
  filled_ += column_.bits;
  if (filled_ < 64) return true;
  append_bytes(bytes_, waiting_);
  filled_ -= 64;
  waiting_ = filled_ > 0 ? raw >> room : 0;
  return true;
}

void E57Encoder::finish() {
  for (; filled_ > 0; filled_ -= std::min(filled_, 8U), waiting_ >>= 8U) {
    bytes_ += static_cast<char>(waiting_ & 255U);
  }
}

std::string_view E57Encoder::take(std::size_t count) {
  const std::string_view bytes = std::string_view(bytes_).substr(taken_, count);
  taken_ += bytes.size();
  return bytes;
}

void E57Encoder::forget_taken() {
  bytes_.erase(0, taken_);
  taken_ = 0;
}

}  // namespace limen
