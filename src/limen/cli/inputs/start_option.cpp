// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/start_option.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/project/decide/start_points.h"
#include "limen/report/pose_file.h"

namespace limen {
namespace {

constexpr const char* kAsked = "give a length and an angle with their units, as in --start-sigma 2m,5deg";

struct Unit {
  std::string_view name;
  double value;
};
constexpr std::array<Unit, 4> kLengths = {{{"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"m", 1.0}}};
const std::array<Unit, 2> kAngles = {{{"deg", radians(1.0)}, {"rad", 1.0}}};

/// "2m": the number times what its unit is worth; nothing where it is none.
template <std::size_t N>
std::optional<double> measure(std::string_view text, const std::array<Unit, N>& units) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  if (fault == std::errc() && value > 0.0 && value < 1e6) {
    for (const Unit& known : units)
      if (known.name == unit) return value * known.value;
  }
  return std::nullopt;
}

}  // namespace

double length_of(const std::string& text, const std::string& option) {
  const std::optional<double> length = measure(text, kLengths);
  if (!length)
    throw Error("\"" + text + "\" is not a length above 0", option,
                "give a length with its unit, as in " + option + " 0.5m");
  return *length;
}

std::optional<StartPrior> start_of(const std::string& pose, const std::string& sigma,
                                   const std::vector<std::string>& points,
                                   const std::function<double()>& unit_of_text) {
  if (!points.empty()) {
    if (!pose.empty() || !sigma.empty())
      throw Error("--start and --start-points both give a start", "--start-points", "give one of them");
    std::vector<ShownPoint> shown;
    for (const std::string& point : points) shown.push_back(shown_point(point));
    return start_from_points(shown);
  }
  if (pose.empty()) {
    if (sigma.empty()) return std::nullopt;
    throw Error("--start-sigma without --start", "--start-sigma " + sigma,
                "give the start as well: --start identity, or the file of a pose");
  }
  StartPrior start;
  if (pose != "identity") {
    const PoseFile file = read_pose_file(pose);
    start.target_from_source = chosen_pose(file, 0, pose);
    if (file.of_numbers) start.target_from_source.translation *= unit_of_text();
  }
  if (sigma.empty()) return start;
  const std::size_t comma = std::min(sigma.find(','), sigma.size());
  const std::string_view text = sigma;
  const std::optional<double> place = measure(text.substr(0, comma), kLengths);
  const std::optional<double> turn = measure(text.substr(std::min(comma + 1, text.size())), kAngles);
  if (!place || !turn)
    throw Error("the standard deviations of the start cannot be read", "--start-sigma " + sigma, kAsked);
  start.sigma_m = *place;
  start.sigma_rad = *turn;
  return start;
}

}  // namespace limen
