// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_bytes.h"

#include <algorithm>
#include <cmath>

#include "limen/base/text.h"

namespace limen {
namespace {

constexpr double kLargest = 65535.0;

}  // namespace

QuantisedPoints quantise(const std::vector<Vector3d>& points) {
  const Extent extent = extent_of(points);
  QuantisedPoints result;
  result.low = extent.low;
  result.step = (extent.high - extent.low) / kLargest;
  result.numbers.reserve(3 * points.size());
  for (const Vector3d& point : points) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double step = result.step[axis];
      const double number = step > 0 ? std::round((point[axis] - result.low[axis]) / step) : 0.0;
      result.numbers.push_back(static_cast<std::uint16_t>(std::clamp(number, 0.0, kLargest)));
    }
  }
  return result;
}

QuantisedPoints quantise(const std::vector<Triangle3>& faces) {
  std::vector<Vector3d> corners;
  corners.reserve(3 * faces.size());
  for (const Triangle3& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  return quantise(corners);
}

std::vector<std::uint8_t> bytes_of(const std::vector<std::uint16_t>& numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * numbers.size());
  for (const std::uint16_t number : numbers) {
    bytes.push_back(static_cast<std::uint8_t>(number & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(number >> 8));
  }
  return bytes;
}

std::vector<std::uint16_t> packed_colours(const std::vector<std::uint8_t>& colours) {
  std::vector<std::uint16_t> packed;
  packed.reserve(colours.size() / 3);
  for (std::size_t i = 0; i + 2 < colours.size(); i += 3) {
    const int number = (colours[i] >> 3 << 11) | (colours[i + 1] >> 2 << 5) | (colours[i + 2] >> 3);
    packed.push_back(static_cast<std::uint16_t>(number));
  }
  return packed;
}

std::vector<std::uint8_t> stretched(const std::vector<float>& intensities) {
  std::vector<float> sorted;
  for (const float value : intensities) {
    if (std::isfinite(value)) sorted.push_back(value);
  }
  if (sorted.empty()) return std::vector<std::uint8_t>(intensities.size(), 0);
  std::sort(sorted.begin(), sorted.end());
  const float low = sorted[sorted.size() / 50];
  const float high = sorted[sorted.size() - 1 - sorted.size() / 50];
  const float scale = high > low ? 255.0F / (high - low) : 0.0F;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(intensities.size());
  for (const float value : intensities) {
    const float stretch = std::isfinite(value) ? std::clamp(scale * (value - low), 0.0F, 255.0F) : 0.0F;
    bytes.push_back(static_cast<std::uint8_t>(stretch));
  }
  return bytes;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : printable_lines(as_utf8(text))) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

}  // namespace limen
