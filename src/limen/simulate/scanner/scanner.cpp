// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/scanner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kLargestRangeM = 120.0;
/// Reflectivity * cos(incidence) * (10 m / range)^2 that still gives an echo.
constexpr double kLeastSignal = 2.5e-4;

/// What became of one pulse: nothing, or a range on a surface.
struct Return {
  double range_m = -1.0;
  double cosine = 0.0;
  int surface = -1;
  bool mirrored = false;  ///< seen in a pane: not where it seems to be
  [[nodiscard]] bool found() const { return surface >= 0; }
};

/// Openings a ray has passed on its way, and where.
struct Passage {
  std::array<int, 6> openings{};
  std::array<double, 6> ranges{};
  std::size_t count = 0;
  void add(int opening, double range) {
    if (count < openings.size()) {
      openings[count] = opening;
      ranges[count++] = range;
    }
  }
};

/// The bit of OpeningSight::cells for a point in the opening.
std::uint64_t cell_of(const TrueOpening& opening, const Vector3d& x) {
  const Vector3d u = opening.outer[1] - opening.outer[0];
  const Vector3d v = opening.outer[3] - opening.outer[0];
  const auto cell = [&](const Vector3d& axis) {
    const double share = axis.dot(x - opening.outer[0]) / axis.squaredNorm();
    return static_cast<unsigned>(std::clamp(static_cast<int>(std::floor(8.0 * share)), 0, 7));
  };
  return std::uint64_t{1} << (8U * cell(v) + cell(u));
}

/// A unit vector turned by small angles about two axes across it.
Vector3d jittered(const Vector3d& direction, double sigma, RandomStream& random) {
  const Vector3d across = direction.unitOrthogonal();
  const Vector3d other = direction.cross(across);
  const double by_other = sigma * random.normal();
  const double by_across = sigma * random.normal();
  return (direction + by_across * across + by_other * other).normalized();
}

/// Fires the pulses of one line and turns their returns into echoes.
class LineScanner {
 public:
  LineScanner(const RayCaster& caster, const std::vector<TrueOpening>& openings,
              const ScannerOptions& options, std::uint64_t seed)
      : caster_(caster), openings_(openings), o_(options), seed_(seed) {}

  void scan(const ScanPattern& pattern, std::size_t line, Sweep& into) const {
    std::vector<Return> returns(pattern.pulses_per_line);
    for (std::size_t i = 0; i < returns.size(); ++i) returns[i] = fire(pattern.pulse(line, i), line, i, into);
    for (std::size_t i = 0; i < returns.size(); ++i)
      if (returns[i].found()) measure(returns, pattern.pulse(line, i), line, i, into);
  }

 private:
  Return fire(const Pulse& pulse, std::size_t line, std::size_t index, Sweep& into) const {
    RandomStream random(seed_, (line << 24U) + index);
    const Vector3d direction =
        o_.angle_jitter_rad > 0.0 ? jittered(pulse.direction, o_.angle_jitter_rad, random) : pulse.direction;
    Passage passage;
    const Return result = follow(pulse.origin, direction, random, passage);
    if (!result.found()) return result;
    const int own = caster_.mesh().surfaces()[static_cast<std::size_t>(result.surface)].opening;
    if (own >= 0 && !result.mirrored) ++into.sights[static_cast<std::size_t>(own)].parts;
    for (std::size_t i = 0; i < passage.count; ++i) {
      OpeningSight& sight = into.sights[static_cast<std::size_t>(passage.openings[i])];
      ++sight.crossed;
      if (own == passage.openings[i]) continue;
      ++sight.through;
      sight.cells |= cell_of(openings_[static_cast<std::size_t>(passage.openings[i])],
                             pulse.origin + passage.ranges[i] * direction);
    }
    return result;
  }

  /// Follows a ray through panes and free openings to the surface that sends it back.
  Return follow(Vector3d origin, Vector3d direction, RandomStream& random, Passage& passage) const {
    double from = 0.05;
    double before = 0.0;  // the way to the pane that threw the ray back
    for (int step = 0; step < 12; ++step) {
      RayHit hit = caster_.cast(origin, direction, from);
      if (!hit.found() || hit.inside || hit.range_m > kLargestRangeM) return {};
      const Surface& surface = caster_.mesh().surfaces()[static_cast<std::size_t>(hit.surface)];
      const bool glass = surface.element == Element::glass;
      if (!glass && surface.element != Element::portal) {
        hit.range_m += before;
        Return result = accepted(hit, surface, random);
        result.mirrored = before > 0.0;
        return result;
      }
      if (glass) {
        const double fate = random.uniform();
        if (before == 0.0 && fate < o_.glass_return_share) return {hit.range_m, hit.cosine, hit.surface};
        if (fate < o_.glass_return_share + o_.glass_loss_share) return {};
        if (before == 0.0 && fate < o_.glass_return_share + o_.glass_loss_share + o_.glass_mirror_share) {
          before = hit.range_m;
          origin += hit.range_m * direction;
          direction -= 2.0 * surface.plane.normal.dot(direction) * surface.plane.normal;
          from = 1e-3;
          continue;
        }
      }
      if (surface.opening >= 0 && before == 0.0) passage.add(surface.opening, hit.range_m);
      from = hit.range_m + 1e-3;
    }
    return {};
  }

  [[nodiscard]] Return accepted(const RayHit& hit, const Surface& surface, RandomStream& random) const {
    if (random.uniform() < o_.loss_share) return {};
    const double fall = 10.0 / hit.range_m;
    const double signal = surface.reflectivity * hit.cosine * fall * fall;
    // Speckle: an echo near the threshold comes back sometimes.
    if (signal * (0.4 + 1.2 * random.uniform()) < kLeastSignal) return {};
    return {hit.range_m, hit.cosine, hit.surface};
  }

  void measure(const std::vector<Return>& returns, const Pulse& pulse, std::size_t line, std::size_t i,
               Sweep& into) const {
    RandomStream random(seed_, (line << 24U) + i + (std::uint64_t{1} << 60U));
    double range = returns[i].range_m;
    int surface = returns[i].mirrored ? -1 : returns[i].surface;
    // A beam that touches both sides of a depth edge measures something in between.
    if (i + 1 < returns.size() && returns[i + 1].found()) {
      const double step = returns[i + 1].range_m - range;
      if (std::abs(step) > 0.04 && std::abs(step) < 1.5 && !smooth(returns, i) &&
          random.uniform() < o_.mixed_pixel_share) {
        range += random.uniform(0.1, 0.9) * step;
        surface = -1;
      }
    }
    const Surface& material = caster_.mesh().surfaces()[static_cast<std::size_t>(returns[i].surface)];
    range += o_.noise_m * random.normal();
    if (range <= 0.05) return;
    const double brightness = material.reflectivity * returns[i].cosine * (1.0 + 0.05 * random.normal());
    into.echoes.push_back({.point = pulse.origin + range * pulse.direction,
                           .line = static_cast<std::uint32_t>(line),
                           .index = static_cast<std::uint32_t>(i),
                           .surface = surface,
                           .intensity = static_cast<float>(std::clamp(brightness, 0.0, 1.0))});
  }

  /// Neighbours on one surface are no depth edge however slanting it lies.
  static bool smooth(const std::vector<Return>& returns, std::size_t i) {
    return returns[i].surface == returns[i + 1].surface;
  }

  const RayCaster& caster_;
  const std::vector<TrueOpening>& openings_;
  const ScannerOptions& o_;
  std::uint64_t seed_;
};

void append(Sweep& sum, Sweep&& part) {
  sum.echoes.insert(sum.echoes.end(), part.echoes.begin(), part.echoes.end());
  for (std::size_t i = 0; i < part.sights.size(); ++i) {
    sum.sights[i].crossed += part.sights[i].crossed;
    sum.sights[i].through += part.sights[i].through;
    sum.sights[i].parts += part.sights[i].parts;
    sum.sights[i].cells |= part.sights[i].cells;
  }
}

}  // namespace

void ScannerOptions::check() const {
  if (!(noise_m >= 0.0 && noise_m < 0.5)) throw_bad_option("noise_m", noise_m, "0 <= noise_m < 0.5");
  if (!(angle_jitter_rad >= 0.0 && angle_jitter_rad < 0.1))
    throw_bad_option("angle_jitter_rad", angle_jitter_rad, "0 <= angle_jitter_rad < 0.1");
  for (const double share :
       {mixed_pixel_share, loss_share, glass_return_share, glass_loss_share, glass_mirror_share})
    if (!(share >= 0.0 && share <= 1.0)) throw_bad_option("share", share, "between 0 and 1");
}

Sweep sweep(const RayCaster& caster, const std::vector<TrueOpening>& openings, const ScanPattern& pattern,
            const ScannerOptions& options, std::uint64_t seed) {
  options.check();
  const LineScanner scanner(caster, openings, options, seed);
  Sweep empty;
  empty.sights.resize(openings.size());
  constexpr std::size_t kLines = 8;
  std::vector<Sweep> parts((pattern.lines + kLines - 1) / kLines, empty);
  parallel_for(pattern.lines, kLines, [&](std::size_t begin, std::size_t end) {
    for (std::size_t line = begin; line < end; ++line) scanner.scan(pattern, line, parts[begin / kLines]);
  });
  Sweep all = empty;
  std::size_t size = 0;
  for (const Sweep& part : parts) size += part.echoes.size();
  all.echoes.reserve(size);
  for (Sweep& part : parts) {
    append(all, std::move(part));
    part = Sweep{};
  }
  return all;
}

}  // namespace limen
