// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"
#include "limen/report/project/page_parts.h"
#include "limen/report/project/project_axes.h"

namespace limen {
namespace {

constexpr double kWide = 1000.0;  // of a drawing, its own units
constexpr double kHigh = 220.0;
constexpr double kLeft = 56.0;
constexpr double kRight = 12.0;
constexpr double kTop = 12.0;
constexpr double kBottom = 34.0;
constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
constexpr std::array<const char*, 3> kColours{"var(--good)", "var(--doubt)", "var(--weak)"};

/// The least of 1, 2, 5, 10, ... that is not less.
double round_above(double value) {
  double unit = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-9))));
  for (const double step : {1.0, 2.0, 5.0, 10.0}) {
    if (step * unit >= value * (1.0 - 1e-9)) return step * unit;
  }
  return 10.0 * unit;
}

class PassChart {
 public:
  explicit PassChart(const PassCorrection& correction) : knots_(correction.knots) {
    double most = 0.0;
    for (const PassKnot& knot : knots_)
      most = std::max(most, (knot.moved_m.cwiseAbs() + 2.0 * knot.moved_sigma_m).maxCoeff());
    reach_mm_ = round_above(1e3 * most);
    length_m_ = std::max(1e-9, knots_.back().distance_m);
  }

  [[nodiscard]] std::string drawn() const {
    std::string text = fmt::format(
        "<svg class=\"plan chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"correction along the "
        "way\">\n",
        kWide, kHigh);
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      const double y = height(share * reach_mm_);
      text += fmt::format("<line class=\"wall\" x1=\"{}\" y1=\"{:.1f}\" x2=\"{}\" y2=\"{:.1f}\"/>", kLeft, y,
                          kWide - kRight, y);
      text += fmt::format("<text class=\"scale\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>\n",
                          kLeft - 6, y + 4, share * reach_mm_);
    }
    const double step = round_above(length_m_ / 8.0);
    for (double at = 0.0; at <= length_m_; at += step)
      text +=
          fmt::format("<text class=\"scale\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g} m</text>\n",
                      width(at), kHigh - 12, at);
    for (std::size_t axis = 0; axis < 3; ++axis) text += curve(axis);
    return text + "</svg>\n";
  }

 private:
  [[nodiscard]] double width(double metres) const {
    return kLeft + (kWide - kLeft - kRight) * metres / length_m_;
  }
  [[nodiscard]] double height(double mm) const {
    return kTop + (kHigh - kTop - kBottom) * 0.5 * (1.0 - mm / reach_mm_);
  }

  [[nodiscard]] std::string curve(std::size_t axis) const {
    const auto k = static_cast<Eigen::Index>(axis);
    std::string line;
    std::string above;
    std::string below;
    for (const PassKnot& knot : knots_) {
      const double x = width(knot.distance_m);
      const double value = 1e3 * knot.moved_m[k];
      const double band = 2e3 * knot.moved_sigma_m[k];
      line += fmt::format("{:.1f},{:.1f} ", x, height(value));
      above += fmt::format("{:.1f},{:.1f} ", x, height(value + band));
      std::string point = fmt::format("{:.1f},{:.1f} ", x, height(value - band));
      point += below;
      below = std::move(point);
    }
    return fmt::format(
        "<polygon points=\"{0}{1}\" fill=\"{2}\" fill-opacity=\".15\"/>"
        "<polyline points=\"{3}\" fill=\"none\" stroke=\"{2}\" stroke-width=\"2\"/>\n",
        above, below, kColours[axis], line);
  }

  const std::vector<PassKnot>& knots_;
  double reach_mm_ = 1.0;
  double length_m_ = 1.0;
};

double rms_mm(const PassCorrection& correction) {
  double squares = 0.0;
  for (const PassKnot& knot : correction.knots) squares += knot.moved_m.squaredNorm();
  return 1e3 * std::sqrt(squares / static_cast<double>(correction.knots.size()));
}

}  // namespace

std::string pass_charts(const ProjectResult& result) {
  std::string text;
  bool bent = false;
  for (const ProjectScan& scan : result.scans) {
    if (!scan.mobile || !scan.readable) continue;
    const bool is_bent = scan.correction && !scan.correction->knots.empty();
    if (!is_bent && scan.rigid.empty()) continue;
    const std::string words =
        is_bent ? fmt::format("drift corrected along {:.0f} m, by {:.1f} mm (root mean square)",
                              scan.correction->knots.back().distance_m, rms_mm(*scan.correction))
                : scan.rigid;
    text += fmt::format("<div><p>{}: {}</p>\n{}</div>\n", escaped(shown_name(scan)), escaped(words),
                        is_bent ? PassChart(*scan.correction).drawn() : "");
    bent = bent || is_bent;
  }
  if (text.empty()) return {};
  std::string key;
  for (std::size_t axis = 0; axis < 3; ++axis)
    key += fmt::format(" <b style=\"color:{}\">{}</b>", kColours[axis], kAxes[axis]);
  std::string head = "<section class=\"card wide keep drift\"><h2>Drift of the passes</h2>\n";
  if (bent)
    head += fmt::format(
        "<p class=\"soft\">Correction of the scanner position in millimetres against the distance travelled, "
        "in addition to the pose of the whole pass, along the frame's{}; the bands are two standard "
        "deviations.</p>\n",
        key);
  return head + "<div class=\"charts\">" + text + "</div></section>\n";
}

}  // namespace limen
