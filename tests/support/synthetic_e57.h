// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limen/base/random.h"
#include "limen/io/table/point_file.h"

/// E57 files for tests, put together by other means than the library's writer.
namespace limen::testing_e57 {

/// CRC-32C bit by bit.
inline std::uint32_t slow_crc32c(std::string_view bytes) {
  std::uint32_t state = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    state ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) state = (state >> 1U) ^ ((state & 1U) != 0 ? 0x82F63B78U : 0U);
  }
  return ~state;
}

template <typename Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Cuts payloads into pages with check sums.
inline std::string paged(std::string logical, std::size_t page_bytes) {
  const std::size_t payload = page_bytes - 4;
  logical.resize((logical.size() + payload - 1) / payload * payload, '\0');
  std::string file;
  for (std::size_t at = 0; at < logical.size(); at += payload) {
    const std::string page = logical.substr(at, payload);
    const std::uint32_t sum = slow_crc32c(page);
    file += page;
    for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>((sum >> shift) & 255U);
  }
  return file;
}

/// A column: its element of the prototype (without brackets) and its stream.
struct Column {
  std::string element;
  std::string stream;
};

/// Appends the lowest `width` bits of each value, one bit after the other.
inline std::string packed_bits(const std::vector<std::uint64_t>& values, unsigned width) {
  std::string bytes((values.size() * width + 7) / 8, '\0');
  std::size_t at = 0;
  for (const std::uint64_t value : values) {
    for (unsigned bit = 0; bit < width; ++bit, ++at) {
      if (((value >> bit) & 1U) != 0) bytes[at / 8] = static_cast<char>(bytes[at / 8] | (1 << (at % 8)));
    }
  }
  return bytes;
}

template <typename Value>
std::string packed_numbers(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) put(bytes, static_cast<Value>(value));
  return bytes;
}

inline Column float_column(const std::string& name, const std::vector<double>& values, bool single = false) {
  return {fmt::format("{} type=\"Float\"{}", name, single ? " precision=\"single\"" : ""),
          single ? packed_numbers<float>(values) : packed_numbers<double>(values)};
}

/// Integers of `width` bits above `minimum`.
inline Column integer_column(const std::string& name, std::int64_t minimum, unsigned width,
                             const std::vector<std::int64_t>& values, const std::string& more = "") {
  const std::uint64_t span = width == 0    ? 0
                             : width >= 64 ? ~std::uint64_t{0}
                                           : (std::uint64_t{1} << width) - 1;
  std::vector<std::uint64_t> raw;
  for (const std::int64_t value : values)
    raw.push_back(static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(minimum));
  const auto maximum = static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + span);
  return {fmt::format("{} type=\"{}\" minimum=\"{}\" maximum=\"{}\"{}", name,
                      more.empty() ? "Integer" : "ScaledInteger", minimum, maximum, more),
          packed_bits(raw, width)};
}

struct ScanParts {
  std::vector<Column> columns;
  std::uint64_t points = 0;
  std::string before_points;  ///< XML of the scan: name, pose, limits
};

/// How the file is laid out.
struct Layout {
  std::size_t page_bytes = 1024;
  std::uint64_t packet_seed = 0;  ///< not 0: streams advance unequally, index and empty packets between them
  std::size_t packet_bytes = 600;
  bool xml_first = false;   ///< the description before the points
  bool marked = false;      ///< a byte order mark before the description
  std::string images = "";  ///< "BLOB0" in it is the offset of the first of the blobs
  std::vector<std::string> blobs = {};
  std::string root = "";  ///< further elements of the root
};

inline std::string data_packet(const std::vector<std::string_view>& parts) {
  std::string body;
  put(body, static_cast<std::uint16_t>(parts.size()));
  for (const std::string_view part : parts) put(body, static_cast<std::uint16_t>(part.size()));
  for (const std::string_view part : parts) body += part;
  while (body.size() % 4 != 0) body += '\0';
  std::string packet{1, 0};
  put(packet, static_cast<std::uint16_t>(body.size() + 3));
  return packet + body;
}

/// A packet of another kind: 0 index, 2 empty.
inline std::string other_packet(char kind, std::size_t bytes) {
  std::string packet{kind, 0};
  put(packet, static_cast<std::uint16_t>(bytes - 1));
  packet.resize(bytes, '\x55');
  return packet;
}

inline std::string packets_of(const std::vector<Column>& columns, const Layout& layout) {
  std::string bytes;
  RandomStream random(layout.packet_seed);
  std::vector<std::string_view> rest;
  for (const Column& column : columns) rest.emplace_back(column.stream);
  const auto any = [&] {
    return std::any_of(rest.begin(), rest.end(), [](auto part) { return !part.empty(); });
  };
  while (any()) {
    std::vector<std::string_view> parts;
    for (std::string_view& stream : rest) {
      const std::size_t most = layout.packet_seed == 0
                                   ? layout.packet_bytes
                                   : random.below(static_cast<std::uint32_t>(layout.packet_bytes));
      parts.push_back(stream.substr(0, most));
      stream.remove_prefix(parts.back().size());
    }
    bytes += data_packet(parts);
    if (layout.packet_seed != 0 && random.below(4) == 0) bytes += other_packet(0, 32);
    if (layout.packet_seed != 0 && random.below(4) == 0) bytes += other_packet(2, 4 + 4 * random.below(5));
    if (layout.packet_seed != 0 && random.below(6) == 0) bytes += data_packet({});
  }
  return bytes;
}

/// The physical offset of a logical one.
inline std::uint64_t physical(std::uint64_t logical, std::size_t page_bytes) {
  return logical / (page_bytes - 4) * page_bytes + logical % (page_bytes - 4);
}

inline std::string scan_element(const ScanParts& scan, std::uint64_t offset) {
  std::string xml = "<vectorChild type=\"Structure\">\n" + scan.before_points;
  xml += fmt::format("<points type=\"CompressedVector\" fileOffset=\"{:020}\" recordCount=\"{}\">", offset,
                     scan.points);
  xml += "<prototype type=\"Structure\">";
  for (const Column& column : scan.columns) xml += "<" + column.element + "/>\n";
  return xml + "</prototype><codecs type=\"Vector\"></codecs></points></vectorChild>\n";
}

/// `offsets`: of the scans, then of the blobs.
inline std::string xml_of(const std::vector<ScanParts>& scans, const std::vector<std::uint64_t>& offsets,
                          const Layout& layout) {
  std::string images = layout.images;
  for (std::size_t k = 0; k < layout.blobs.size(); ++k) {
    const std::string mark = fmt::format("BLOB{}", k);
    images.replace(images.find(mark), mark.size(), fmt::format("{:020}", offsets[scans.size() + k]));
  }
  std::string xml = layout.marked ? "\xEF\xBB\xBF" : "";
  xml +=
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- kept -->\n<e57Root type=\"Structure\" "
      "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">\n" +
      layout.root + "<data3D type=\"Vector\">\n";
  for (std::size_t k = 0; k < scans.size(); ++k) xml += scan_element(scans[k], offsets[k]);
  return xml + "</data3D>\n<images2D type=\"Vector\">" + images + "</images2D>\n</e57Root>\n";
}

/// The head, sections and description in one stretch, as payloads.
inline std::string logical_file(const std::vector<ScanParts>& scans, const Layout& layout) {
  const std::vector<std::uint64_t> zeros(scans.size() + layout.blobs.size(), 0);
  const std::size_t xml_bytes = xml_of(scans, zeros, layout).size();
  std::string body;
  std::uint64_t at = 48 + (layout.xml_first ? (xml_bytes + 3) / 4 * 4 : 0);
  std::vector<std::uint64_t> offsets;
  for (const ScanParts& scan : scans) {
    const std::string packets = packets_of(scan.columns, layout);
    offsets.push_back(physical(at + body.size(), layout.page_bytes));
    std::string section{1, 0, 0, 0, 0, 0, 0, 0};
    put(section, std::uint64_t{32} + packets.size());
    put(section, physical(at + body.size() + 32, layout.page_bytes));
    put(section, std::uint64_t{0});
    body += section + packets;
  }
  for (const std::string& blob : layout.blobs) {
    offsets.push_back(physical(at + body.size(), layout.page_bytes));
    put(body, std::uint64_t{0});
    put(body, std::uint64_t{16} + blob.size());
    body += blob;
    while (body.size() % 4 != 0) body += '\0';
  }
  std::string xml = xml_of(scans, offsets, layout);
  const std::uint64_t xml_at = layout.xml_first ? 48 : 48 + body.size();
  if (layout.xml_first) xml.resize((xml_bytes + 3) / 4 * 4, '\n');
  const std::size_t payload = layout.page_bytes - 4;
  std::string head = "ASTM-E57";
  put(head, std::uint32_t{1});
  put(head, std::uint32_t{0});
  put(head, std::uint64_t{(48 + body.size() + xml.size() + payload - 1) / payload * layout.page_bytes});
  put(head, physical(xml_at, layout.page_bytes));
  put(head, std::uint64_t{xml.size()});
  put(head, std::uint64_t{layout.page_bytes});
  return layout.xml_first ? head + xml + body : head + body + xml;
}

inline std::string file_of(const std::vector<ScanParts>& scans, const Layout& layout = {}) {
  return paged(logical_file(scans, layout), layout.page_bytes);
}

/// All values of a cloud, column by column, read in pieces of `most` rows.
inline std::vector<std::vector<double>> read_all(const PointFile& file, std::size_t cloud = 0,
                                                 std::size_t most = 1000) {
  std::vector<std::vector<double>> columns(file.clouds()[cloud].fields.size());
  const auto stream = file.read(cloud);
  while (const auto table = stream->next(most)) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::size_t before = columns[k].size();
      columns[k].resize(before + table->rows);
      load_numbers(*table, table->fields[k], {0, table->rows}, columns[k].data() + before);
    }
  }
  return columns;
}

}  // namespace limen::testing_e57
