// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/transverse_mercator.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kRadiusM = 6378137.0;  // a
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kScale = 0.9996;
constexpr double kFalseEastingM = 5e5;
constexpr double kFalseNorthingM = 1e7;
constexpr double kN = kFlattening / (2.0 - kFlattening);  // third flattening

/// A polynomial in n, lowest power first, times n^first.
double series(int first, std::initializer_list<double> coefficients) {
  double sum = 0.0;
  double power = std::pow(kN, first);
  for (const double coefficient : coefficients) {
    sum += coefficient * power;
    power *= kN;
  }
  return sum;
}

/// alpha_1 to alpha_6, Karney (2011) eq. (35).
std::array<double, 6> alphas() {
  return {series(1, {1.0 / 2, -2.0 / 3, 5.0 / 16, 41.0 / 180, -127.0 / 288, 7891.0 / 37800}),
          series(2, {13.0 / 48, -3.0 / 5, 557.0 / 1440, 281.0 / 630, -1983433.0 / 1935360}),
          series(3, {61.0 / 240, -103.0 / 140, 15061.0 / 26880, 167603.0 / 181440}),
          series(4, {49561.0 / 161280, -179.0 / 168, 6601661.0 / 7257600}),
          series(5, {34729.0 / 80640, -3418889.0 / 1995840}),
          series(6, {212378941.0 / 319334400})};
}

}  // namespace

UtmZone utm_zone_of(const Geodetic& place) {
  const double turns = std::floor((degrees(place.longitude_rad) + 180.0) / 6.0);
  const int number = static_cast<int>(turns - 60.0 * std::floor(turns / 60.0)) + 1;
  return {number, place.latitude_rad < 0.0};
}

std::optional<UtmZone> parse_utm_zone(const std::string& text) {
  UtmZone zone;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, zone.number);
  if (error != std::errc() || zone.number < 1 || zone.number > 60 || end - rest > 1) return {};
  if (rest == end) return zone;
  zone.south = *rest == 'S' || *rest == 's';
  const bool known = zone.south || *rest == 'N' || *rest == 'n';
  return known ? std::optional<UtmZone>(zone) : std::nullopt;
}

GridPlace to_utm(const Geodetic& place, const UtmZone& zone) {
  static const std::array<double, 6> alpha = alphas();
  const double rectifying =
      kRadiusM / (1.0 + kN) * series(0, {1.0, 0.0, 1.0 / 4, 0.0, 1.0 / 64, 0.0, 1.0 / 256});
  const double lambda =
      std::remainder(place.longitude_rad - radians(6.0 * zone.number - 183.0), 2.0 * std::numbers::pi);
  const double e = std::sqrt(kFlattening * (2.0 - kFlattening));
  const double sine = std::sin(place.latitude_rad);
  const double t = std::sinh(std::atanh(sine) - e * std::atanh(e * sine));  // tau', eqs. (7)-(9)
  const double xi0 = std::atan2(t, std::cos(lambda));                       // eq. (10)
  const double eta0 = std::asinh(std::sin(lambda) / std::hypot(t, std::cos(lambda)));
  double xi = xi0;
  double eta = eta0;
  double p = 1.0;
  double q = 0.0;
  for (std::size_t k = 0; k < alpha.size(); ++k) {  // eq. (11)
    const double j2 = 2.0 * static_cast<double>(k + 1);
    xi += alpha[k] * std::sin(j2 * xi0) * std::cosh(j2 * eta0);
    eta += alpha[k] * std::cos(j2 * xi0) * std::sinh(j2 * eta0);
    p += j2 * alpha[k] * std::cos(j2 * xi0) * std::cosh(j2 * eta0);
    q += j2 * alpha[k] * std::sin(j2 * xi0) * std::sinh(j2 * eta0);
  }
  GridPlace grid;
  grid.x = {kFalseEastingM + kScale * rectifying * eta,
            (zone.south ? kFalseNorthingM : 0.0) + kScale * rectifying * xi, place.height_m};
  grid.convergence_rad = std::atan(std::tan(xi0) * std::tanh(eta0)) + std::atan2(q, p);  // eqs. (23), (24)
  return grid;
}

Vector3d to_geocentric(const Geodetic& place) {
  const double e2 = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(place.latitude_rad);
  const double cosine = std::cos(place.latitude_rad);
  const double normal = kRadiusM / std::sqrt(1.0 - e2 * sine * sine);
  return {(normal + place.height_m) * cosine * std::cos(place.longitude_rad),
          (normal + place.height_m) * cosine * std::sin(place.longitude_rad),
          (normal * (1.0 - e2) + place.height_m) * sine};
}

Matrix3d east_north_up(const Geodetic& place) {
  const double sine = std::sin(place.latitude_rad);
  const double cosine = std::cos(place.latitude_rad);
  const double s = std::sin(place.longitude_rad);
  const double c = std::cos(place.longitude_rad);
  Matrix3d rows;
  rows << -s, c, 0.0, -sine * c, -sine * s, cosine, cosine * c, cosine * s, sine;
  return rows;
}

}  // namespace limen
