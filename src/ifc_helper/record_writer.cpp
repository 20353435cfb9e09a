// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "ifc_helper/record_writer.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "limen/base/system.h"

namespace limen::ifc {

void Payload::put_little(std::uint64_t value, int size) {
  for (int k = 0; k < size; ++k) bytes_ += static_cast<char>((value >> (8 * k)) & 0xffU);
}

void Payload::put_number(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_little(bits, 8);
}

void Payload::put_text(std::string_view text) {
  put_count(text.size());
  bytes_ += text;
}

RecordWriter::RecordWriter(int descriptor) : descriptor_(descriptor) {
  write_all(kIfcStreamMagic);
}

void RecordWriter::write(IfcRecord record, const Payload& payload) const {
  Payload head;
  head.put_byte(static_cast<std::uint8_t>(record));
  head.put_count(payload.bytes().size());
  write_all(head.bytes() + payload.bytes());
}

void RecordWriter::write_all(std::string_view bytes) const {
  while (!bytes.empty()) {
    const std::ptrdiff_t written = write_some(descriptor_, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) std::_Exit(4);  // nobody listens any more
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace limen::ifc
