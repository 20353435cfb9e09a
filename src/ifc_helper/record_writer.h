// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "limen/bim/ifc/ifc_stream_format.h"

namespace limen::ifc {

/// A payload under construction; see ifc_stream_format.h.
class Payload {
 public:
  void put_byte(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void put_count(std::size_t value) { put_little(value, 4); }
  void put_entity(std::int64_t value) { put_little(static_cast<std::uint64_t>(value), 8); }
  void put_number(double value);
  void put_text(std::string_view text);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void put_little(std::uint64_t value, int size);

  std::string bytes_;
};

/// Writes records to a file descriptor; each is there as a whole, whatever happens next.
class RecordWriter {
 public:
  explicit RecordWriter(int descriptor);
  void write(IfcRecord record, const Payload& payload) const;

 private:
  void write_all(std::string_view bytes) const;

  int descriptor_;
};

}  // namespace limen::ifc
