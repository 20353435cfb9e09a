// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/question_pictures.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limen/project/state/scan_names.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/project/evaluate_project.h"
#include "limen/report/project/project_axes.h"

namespace limen {
namespace {

constexpr std::size_t kMostPoints = 5000;           // of a scan in a picture
constexpr std::array<double, 2> kCut = {0.6, 2.0};  // metres above what is lowest
constexpr double kSize = 480.0;                     // of a half, the drawing's units

/// The places of a scan that are at the height of windows, from above; none of a model.
std::vector<Vector2d> seen_from_above(const ProjectPicture& picture, const Matrix3d& view_from_scan) {
  std::vector<Vector3d> points;
  std::vector<double> heights;
  for (const Vector3d& point : picture.points.points) {
    points.emplace_back(view_from_scan * point);
    heights.push_back(points.back().z());
  }
  if (points.empty()) return {};
  const double lowest = quantile(std::move(heights), 0.02);
  std::vector<Vector2d> kept;
  for (const Vector3d& point : points) {
    const double height = point.z() - lowest;
    if (height > kCut[0] && height < kCut[1]) kept.emplace_back(point.head<2>());
  }
  const std::size_t step = kept.size() / kMostPoints + 1;
  std::vector<Vector2d> thinned;
  for (std::size_t k = 0; k < kept.size(); k += step) thinned.push_back(kept[k]);
  return thinned;
}

/// Where the central part of the places lies: its middle, and half its larger side.
std::pair<Vector2d, double> extent_of(const std::vector<Vector2d>& places) {
  Vector2d low;
  Vector2d high;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const Vector2d& place : places) values.push_back(place[axis]);
    low[axis] = quantile(values, 0.03);
    high[axis] = quantile(std::move(values), 0.97);
  }
  return {0.5 * (low + high), 0.5 * (high - low).maxCoeff()};
}

std::string half(const std::vector<Vector2d>& places, const Vector2d& middle, double scale, double left,
                 const std::string& name) {
  std::string dots;
  for (const Vector2d& place : places) {
    const Vector2d at = scale * (place - middle);
    if (at.cwiseAbs().maxCoeff() < 0.5 * kSize)
      dots += fmt::format("M{:.0f} {:.0f}h0", left + 0.5 * kSize + at.x(), 0.5 * kSize - at.y());
  }
  return fmt::format(
      "<rect x=\"{0:.0f}\" y=\"0\" width=\"{1:.0f}\" height=\"{1:.0f}\" fill=\"#fff\" stroke=\"#bbb\"/>"
      "<path d=\"{2}\" stroke=\"#1d2a35\" stroke-width=\"1.8\" stroke-linecap=\"round\"/>"
      "<text x=\"{3:.0f}\" y=\"{4:.0f}\" font-family=\"sans-serif\" font-size=\"15\" fill=\"#666\" "
      "translate=\"no\">{5}</text>\n",
      left, kSize, dots, left + 4.0, kSize + 18.0, escaped(name));
}

std::string picture_of(const ProjectResult& result, const ProjectLink& link,
                       const std::vector<ProjectPicture>& pictures) {
  const auto source = static_cast<std::size_t>(link.source);
  const auto target = static_cast<std::size_t>(link.target);
  const std::optional<Rigid3>& placed = result.scans[target].frame_from_scan;
  const Matrix3d axes = project_axes(result) * (placed ? placed->rotation : Matrix3d::Identity());
  const std::vector<Vector2d> left =
      seen_from_above(pictures[source], axes * link.target_from_source.rotation);
  const std::vector<Vector2d> right = seen_from_above(pictures[target], axes);
  if (left.empty() || right.empty()) return {};
  const auto [left_middle, left_reach] = extent_of(left);
  const auto [right_middle, right_reach] = extent_of(right);
  const double scale = 0.46 * kSize / std::max({left_reach, right_reach, 0.5});
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"alike\" viewBox=\"0 0 {:.0f} {:.0f}\" "
             "role=\"img\" aria-label=\"Both scans from above\">\n",
             2 * kSize + 20.0, kSize + 24.0) +
         half(left, left_middle, scale, 0.0, shown_name(result.scans[source])) +
         half(right, right_middle, scale, kSize + 20.0, shown_name(result.scans[target])) + "</svg>\n";
}

const ProjectLink* link_between(const ProjectResult& result, const std::vector<std::string>& scans) {
  const auto name = [&](int scan) { return scan_name(result.scans[static_cast<std::size_t>(scan)]); };
  for (const ProjectLink& link : result.links) {
    if (scans.size() == 2 && name(link.source) == scans[0] && name(link.target) == scans[1]) return &link;
  }
  return nullptr;
}

}  // namespace

std::vector<std::vector<Decision>> asked_of(const ProjectQuestion& question) {
  std::vector<std::vector<Decision>> asked;
  for (const Decision& answer : question.answers) {
    const auto same = [&](const std::vector<Decision>& others) { return others[0].scans == answer.scans; };
    const auto known = std::find_if(asked.begin(), asked.end(), same);
    if (known == asked.end())
      asked.push_back({answer});
    else
      known->push_back(answer);
  }
  return asked;
}

std::string asked_words(const std::vector<Decision>& answers) {
  const std::vector<std::string>& scans = answers.front().scans;
  return fmt::format("Are these two the same room? {} and {}", scans.front(), scans.back());
}

std::vector<std::string> question_pictures(const ProjectResult& result,
                                           const std::vector<ProjectPicture>& pictures) {
  std::vector<std::string> drawn;
  for (const ProjectQuestion& question : result.questions) {
    for (const std::vector<Decision>& answers : asked_of(question)) {
      if (pictures.size() != result.scans.size() || drawn.size() >= kMostPictures) return drawn;
      const ProjectLink* link = link_between(result, answers.front().scans);
      drawn.push_back(link == nullptr ? "" : picture_of(result, *link, pictures));
    }
  }
  return drawn;
}

}  // namespace limen
