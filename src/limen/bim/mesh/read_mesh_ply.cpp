// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/bim/mesh/read_mesh.h"
#include "limen/files/text_numbers.h"
#include "limen/io/ply/ply_header.h"
#include "limen/io/table/record_table.h"

namespace limen {
namespace {

bool holds_faces(const PlyElement& element) {
  return element.name == "face" && element.count > 0 && element.has_lists();
}

/// The corners of a face among its properties.
std::size_t corner_property(const PlyElement& face, const std::string& name) {
  for (std::size_t k = 0; k < face.properties.size(); ++k) {
    const std::string& property = face.properties[k].name;
    if (face.properties[k].count_type && (property == "vertex_indices" || property == "vertex_index"))
      return k;
  }
  throw Error("the faces have no list vertex_indices", name, "export the mesh as triangles or polygons");
}

/// One record: the values of each property.
using Record = std::vector<std::vector<double>>;

/// Goes through the records of a PLY file, binary or text, and hands them out element by element.
class RecordWalker {
 public:
  RecordWalker(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : bytes_(bytes), header_(header), name_(name), at_(header.body), line_(header.lines.size()) {}

  void walk(const PlyElement& element, const std::function<void(const Record&)>& take) {
    const bool text = header_.encoding == PlyEncoding::ascii;
    if (!text && element.least_bytes() == 0) return;
    Record record(element.properties.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      CancelScope::check();
      if (text) {
        read_text(element, record);
      } else {
        read_binary(element, record);
      }
      take(record);
    }
  }

 private:
  void read_text(const PlyElement& element, Record& record) {
    std::vector<std::string_view> words;
    while (words.empty()) {
      if (at_ >= bytes_.size()) {
        throw Error(fmt::format("the file ends within its {} elements named {}", element.count, element.name),
                    name_, "get the whole file, or correct the count");
      }
      const TextLine line = first_line(bytes_.substr(at_));
      at_ += line.bytes;
      ++line_;
      words = split_tokens(line.text);
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < record.size(); ++k) {
      std::size_t count = 1;
      if (element.properties[k].count_type) {
        const auto listed = next < words.size() ? parse_count(words[next++]) : std::nullopt;
        if (!listed) fail();
        count = *listed;
      }
      if (count > words.size() - next) fail();
      record[k].clear();
      for (std::size_t j = 0; j < count; ++j) {
        const std::optional<double> value = parse_number(words[next++]);
        if (!value) fail();
        record[k].push_back(*value);
      }
    }
  }

  [[noreturn]] void fail() const {
    throw Error("the line does not match the header", fmt::format("{}, line {}", name_, line_),
                "the PLY file is damaged: export it again");
  }

  void read_binary(const PlyElement& element, Record& record) {
    // Throws where the file ends before the record does; the loads below are inside then.
    const bool swapped = header_.swapped();
    const std::size_t end = at_ + ply_record_bytes(bytes_, at_, element, swapped, name_);
    for (std::size_t k = 0; k < record.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      std::size_t count = 1;
      if (property.count_type) {
        count = static_cast<std::size_t>(load_number(bytes_.data() + at_, *property.count_type, swapped));
        at_ += size_of(*property.count_type);
      }
      record[k].clear();
      for (std::size_t j = 0; j < count; ++j, at_ += size_of(property.type))
        record[k].push_back(load_number(bytes_.data() + at_, property.type, swapped));
    }
    at_ = end;
  }

  std::string_view bytes_;
  const PlyHeader& header_;
  const std::string& name_;
  std::size_t at_;
  std::size_t line_;
};

std::array<std::size_t, 3> coordinates_of(const PlyElement& vertex, const std::string& name) {
  std::array<std::size_t, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string wanted(1, "xyz"[k]);
    const auto found =
        std::find_if(vertex.properties.begin(), vertex.properties.end(),
                     [&](const PlyProperty& p) { return lower_case(p.name) == wanted && !p.count_type; });
    if (found == vertex.properties.end())
      throw Error("the vertices have no " + wanted, name, "export the mesh with x, y and z");
    at[k] = static_cast<std::size_t>(found - vertex.properties.begin());
  }
  return at;
}

std::vector<std::uint32_t> ring_of(const std::vector<double>& corners, const PlyHeader& header,
                                   const std::string& name) {
  const auto count = static_cast<double>(header.elements[header.vertex(name)].count);
  std::vector<std::uint32_t> ring;
  for (const double corner : corners) {
    if (!(corner >= 0.0 && corner < count)) {
      throw Error(fmt::format("a face refers to vertex {}, but there are only {}", corner, count), name,
                  "the PLY file is damaged: export it again");
    }
    ring.push_back(static_cast<std::uint32_t>(corner));
  }
  return ring;
}

}  // namespace

bool looks_like_mesh_ply(std::string_view bytes) {
  if (bytes.substr(0, 3) != "ply") return false;
  try {
    const PlyHeader header = parse_ply_header(bytes, "");
    return std::any_of(header.elements.begin(), header.elements.end(), holds_faces);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    return false;
  }
}

RawModel read_mesh_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const PlyElement& vertex = header.elements[header.vertex(name)];
  const std::array<std::size_t, 3> xyz = coordinates_of(vertex, name);
  RawElement element;
  Solid shape;
  element.about.type = "mesh";
  RecordWalker walker(bytes, header, name);
  std::size_t too_short = 0;
  for (const PlyElement& part : header.elements) {
    if (&part == &vertex) {
      walker.walk(part, [&](const Record& r) {
        shape.mesh.points.push_back(header.offset + Vector3d(r[xyz[0]][0], r[xyz[1]][0], r[xyz[2]][0]));
      });
    } else if (holds_faces(part)) {
      const std::size_t corners = corner_property(part, name);
      walker.walk(part, [&](const Record& r) {
        const std::vector<std::uint32_t> ring = ring_of(r[corners], header, name);
        if (ring.size() < 3) {
          ++too_short;
        } else {
          shape.mesh.add(ring);
        }
      });
    } else {
      walker.walk(part, [](const Record&) {});
    }
  }
  RawModel model;
  model.head.name = name;
  model.head.schema = "PLY";
  if (too_short > 0)
    model.head.warnings.push_back(
        fmt::format("{} faces with fewer than three corners are left out", too_short));
  element.shapes.push_back(std::move(shape));
  model.elements.push_back(std::move(element));
  return model;
}

}  // namespace limen
