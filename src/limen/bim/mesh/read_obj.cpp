// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/bim/ifc/ifc_types.h"
#include "limen/bim/mesh/read_mesh.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

/// Only the beginning of a file is asked what it is.
constexpr std::size_t kLookedAt = std::size_t{1} << 16U;
constexpr std::size_t kMostVertices = 0xfffffff0U;

bool blank_in_line(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Takes the next word off the front of `line`; empty at its end.
std::string_view take_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && blank_in_line(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !blank_in_line(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

class ObjReader {
 public:
  explicit ObjReader(const std::string& name) : name_(name) {}

  RawModel read(std::string_view bytes) {
    while (!bytes.empty()) {
      CancelScope::check();
      const TextLine line = first_line(bytes);
      bytes.remove_prefix(line.bytes);
      ++number_;
      take_line(line.text);
    }
    if (vertices_.empty()) throw Error("there are no vertices", name_, "check how the file was exported");
    return finished();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(what, fmt::format("{}, line {}", name_, number_), "the OBJ file is damaged: export it again");
  }

  void take_line(std::string_view line) {
    // A line that ends with a backslash goes on in the next.
    if (!continued_.empty() || (!line.empty() && line.back() == '\\')) {
      const bool goes_on = !line.empty() && line.back() == '\\';
      continued_ += std::string(line.substr(0, line.size() - (goes_on ? 1 : 0))) + " ";
      if (goes_on) return;
      const std::string whole = std::exchange(continued_, {});
      take_statement(whole);
      return;
    }
    take_statement(line);
  }

  void take_statement(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word == "v") take_vertex(line);
    if (word == "f") take_face(line);
    if (word == "o") start_element(object_, line);
    if (word == "g") start_element(group_, line);
  }

  void take_vertex(std::string_view line) {
    Vector3d x;
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> value = parse_number(take_word(line));
      if (!value) fail("a vertex needs three numbers");
      x[k] = *value;
    }
    if (vertices_.size() >= kMostVertices) fail("there are too many vertices");
    vertices_.push_back(x);
  }

  /// Indices count from 1, or back from the last vertex where they are negative.
  [[nodiscard]] std::uint32_t index_of(std::string_view word) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const auto count = static_cast<std::int64_t>(vertices_.size());
    if (error != std::errc{} || end != digits.data() + digits.size())
      fail(fmt::format("\"{}\" is not a vertex number", word.substr(0, 40)));
    if (value < -count || value > count || value == 0)
      fail(fmt::format("a face refers to vertex {}, but only {} come before it", value, count));
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : count + value);
  }

  void take_face(std::string_view line) {
    std::vector<std::uint32_t> ring;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
      ring.push_back(index_of(word));
    if (ring.size() < 3) {
      ++too_short_;
      return;
    }
    faces_[current_element()].push_back(std::move(ring));
  }

  void start_element(std::string& which, std::string_view line) {
    which = std::string(trimmed(line));
    if (&which == &object_) group_.clear();
    current_.reset();
  }

  /// The same name later on is the same element.
  std::size_t current_element() {
    if (current_) return *current_;
    const std::string name =
        object_.empty() || group_.empty() || group_ == "default" ? object_ + group_ : object_ + "/" + group_;
    const auto [place, is_new] = by_name_.try_emplace(name, names_.size());
    if (is_new) {
      names_.push_back(name);
      const BimKind of_group = kind_of_ifc_type(group_);
      kinds_.push_back(of_group == BimKind::other ? kind_of_ifc_type(object_) : of_group);
      faces_.emplace_back();
    }
    current_ = place->second;
    return *current_;
  }

  /// Each element gets the vertices it uses.
  RawModel finished() {
    RawModel model;
    model.head.name = name_;
    model.head.schema = "OBJ";
    if (too_short_ > 0)
      model.head.warnings.push_back(
          fmt::format("{} faces with fewer than three corners are left out", too_short_));
    std::vector<std::uint32_t> place(vertices_.size(), 0);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      RawElement element;
      Solid shape;
      element.about.type = names_[i].empty() ? "mesh" : names_[i];
      element.about.name = names_[i];
      element.about.kind = kinds_[i];
      for (std::vector<std::uint32_t>& ring : faces_[i]) {
        for (std::uint32_t& corner : ring) corner = local(corner, place, shape.mesh.points);
        shape.mesh.add(ring);
      }
      for (const std::uint32_t corner : used_) place[corner] = 0;
      used_.clear();
      element.shapes.push_back(std::move(shape));
      model.elements.push_back(std::move(element));
    }
    return model;
  }

  std::uint32_t local(std::uint32_t corner, std::vector<std::uint32_t>& place,
                      std::vector<Vector3d>& points) {
    if (place[corner] == 0) {
      used_.push_back(corner);
      points.push_back(vertices_[corner]);
      place[corner] = static_cast<std::uint32_t>(points.size());
    }
    return place[corner] - 1;
  }

  const std::string& name_;
  std::size_t number_ = 0;
  std::string continued_;
  std::string object_;
  std::string group_;
  std::optional<std::size_t> current_;
  std::map<std::string, std::size_t> by_name_;
  std::vector<std::string> names_;
  std::vector<BimKind> kinds_;
  std::vector<std::vector<std::vector<std::uint32_t>>> faces_;  ///< per element
  std::vector<Vector3d> vertices_;
  std::vector<std::uint32_t> used_;  ///< vertices of the element being finished
  std::size_t too_short_ = 0;
};

}  // namespace

bool looks_like_obj(std::string_view bytes) {
  static constexpr std::array<std::string_view, 14> kWords{
      "v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "mg", "usemap"};
  const bool whole = bytes.size() <= kLookedAt;
  bytes = bytes.substr(0, kLookedAt);
  bool vertex = false;
  while (!bytes.empty()) {
    const TextLine line = first_line(bytes);
    bytes.remove_prefix(line.bytes);
    if (bytes.empty() && !whole) break;  // cut through
    std::string_view rest = line.text;
    const std::string_view word = take_word(rest);
    if (word.empty() || word.front() == '#') continue;
    if (std::find(kWords.begin(), kWords.end(), word) == kWords.end()) return false;
    if (word == "v") vertex = true;
    if (vertex && word == "f") return true;
  }
  return vertex;
}

RawModel read_obj(std::string_view bytes, const std::string& name) {
  return ObjReader(name).read(bytes);
}

}  // namespace limen
