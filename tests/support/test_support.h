// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"

/// What the tests of this folder share.
namespace limen::testing_io {

/// A folder that is gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "limen-io-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of a number, in this machine's order or the other.
template <typename Value>
std::string bytes_of(Value value, bool swapped = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

enum class Writing { ascii, little, big };

/// One number as a PLY of the given writing has it.
template <typename Value>
std::string number(Value value, Writing writing) {
  if (writing == Writing::ascii) return fmt::format("{} ", value);
  return bytes_of(value, writing == Writing::big);
}
inline std::string row_end(Writing writing) {
  return writing == Writing::ascii ? "\n" : "";
}
inline std::string format_line(Writing writing) {
  static constexpr std::array<const char*, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
  return fmt::format("ply\nformat {} 1.0\n", kNames[static_cast<std::size_t>(writing)]);
}

/// A PLY of points as Value (float or double); `comment` may be empty.
template <typename Value>
std::string simple_ply(const std::vector<Vector3d>& points, Writing writing,
                       const std::string& comment = "") {
  std::string text = format_line(writing) + comment + fmt::format("element vertex {}\n", points.size());
  for (const char* name : {"x", "y", "z"})
    text += fmt::format("property {} {}\n", sizeof(Value) == 4 ? "float" : "double", name);
  text += "end_header\n";
  for (const Vector3d& point : points) {
    for (int k = 0; k < 3; ++k) text += number(static_cast<Value>(point[k]), writing);
    text += row_end(writing);
  }
  return text;
}

/// Points in a box of `side` metres whose low corner is `low`.
inline std::vector<Vector3d> random_points(std::size_t count, const Vector3d& low, double side,
                                           std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(0.0, side);
    const double y = random.uniform(0.0, side);
    points.emplace_back(low + Vector3d(x, y, random.uniform(0.0, side)));
  }
  return points;
}

/// A hollow room of 8 x 6 x 3 m round 0,0,0: what a scanner there sees.
inline std::vector<Vector3d> room_points(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed);
  const Vector3d half{4.0, 3.0, 1.5};
  std::vector<Vector3d> points;
  while (points.size() < count) {
    const double x = random.normal();
    const double y = random.normal();
    const Vector3d ray = Vector3d(x, y, random.normal()).normalized();
    points.emplace_back(ray / (ray.cwiseAbs().cwiseQuotient(half)).maxCoeff());
  }
  return points;
}

/// A plain LZF packer: the longest match among the last few positions, else a literal.
inline std::string pack_lzf(const std::string& plain) {
  std::string packed;
  std::string run;
  const auto flush = [&] {
    if (!run.empty()) packed += static_cast<char>(run.size() - 1) + run;
    run.clear();
  };
  std::size_t at = 0;
  while (at < plain.size()) {
    std::size_t best = 0;
    std::size_t distance = 0;
    for (std::size_t back = 1; back <= std::min<std::size_t>(at, 600); ++back) {
      std::size_t length = 0;
      while (at + length < plain.size() && length < 264 && plain[at + length] == plain[at + length - back])
        ++length;
      if (length <= best) continue;
      best = length;
      distance = back;
    }
    if (best < 3) {
      run += plain[at++];
      if (run.size() == 32) flush();
      continue;
    }
    flush();
    const std::size_t code = best - 2;
    packed += static_cast<char>((std::min<std::size_t>(code, 7) << 5U) | ((distance - 1) >> 8U));
    if (code >= 7) packed += static_cast<char>(code - 7);
    packed += static_cast<char>((distance - 1) & 255U);
    at += best;
  }
  flush();
  return packed;
}

}  // namespace limen::testing_io
