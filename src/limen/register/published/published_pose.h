// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/match/openings/opening_walls.h"
#include "limen/model/features.h"

namespace limen {

/// The best of the random trials.
struct BestTrial {
  std::size_t trial = 0;  ///< RandomStream(seed, trial) draws the hypothesis again
  double cost = 0.0;
  std::size_t judged = 0;  ///< trials whose sample gave a hypothesis
};

/// The random search of 2022, 3.2, and 2023, III-B and IV-C: `draw(RandomStream&)` gives a hypothesis or
/// nothing, `cost(hypothesis)` is minimised over all trials; the first of equals is taken. The same for any
/// number of threads. None where no trial gave a hypothesis.
template <typename Draw, typename Cost>
std::optional<BestTrial> best_trial(std::size_t trials, std::uint64_t seed, const Draw& draw,
                                    const Cost& cost) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> costs(trials, kNone);
  parallel_for(trials, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t trial = begin; trial < end; ++trial) {
      RandomStream random(seed, trial);
      if (const auto hypothesis = draw(random)) costs[trial] = cost(*hypothesis);
    }
  });
  const auto lowest = std::min_element(costs.begin(), costs.end());
  if (lowest == costs.end() || *lowest == kNone) return std::nullopt;
  BestTrial best;
  best.trial = static_cast<std::size_t>(lowest - costs.begin());
  best.cost = *lowest;
  best.judged =
      static_cast<std::size_t>(std::count_if(costs.begin(), costs.end(), [](double c) { return c < kNone; }));
  return best;
}

/// A wall of a scan with the edges and corners of its openings, as 2022 and 2023, III, draw from them.
struct WallEdges {
  Vector3d normal = Vector3d::UnitX();  ///< unit, towards the scanner
  Vector3d right = Vector3d::UnitY();   ///< unit, as the scanner sees it; up is normal x right
  std::vector<Segment> vertical;        ///< upwards
  std::vector<Segment> horizontal;      ///< to the right
  std::vector<Vector3d> corners;
};

/// The walls of a scan that have openings, all four edges of each. `upright`: z is up.
std::vector<WallEdges> wall_edges(const Features& features, bool upright);

/// All edges of all walls.
std::vector<Segment> all_edges(const std::vector<WallEdges>& walls);

/// One item of a list that is not empty.
template <typename Item>
const Item& drawn(const std::vector<Item>& items, RandomStream& random) {
  return items[random.below(static_cast<std::uint32_t>(items.size()))];
}

// What the papers' own methods take and give. Each is one source of this room.

/// Two scans as a published method sees them.
struct PublishedInput {
  const Features& source;
  const Features& target;
  /// target_from_source before registration, local frames: what "smallest angle" is asked of.
  Rigid3 start = {};
  bool source_outside = false;  ///< the source looks at the building from outside, as a mobile scan does
  bool target_outside = false;
  bool upright = false;           ///< z points up in both frames
  double wall_thickness_m = 0.0;  ///< as the user knows it; 0: not known
  std::uint64_t seed = 1;         ///< of the random trials
};

/// The polygons of one scan that take part in 2021, section 3: of one that looks in from outside only those
/// of the points behind its façades (3.1.2), else all but those that it sees outside. Most inliers first, at
/// most 24; the paper has 22 and 23.
std::vector<PlanarPolygon> common_polygons(const Features& features, bool outside);

/// The one pose that a method ends with, and the number it was chosen by.
struct PublishedPose {
  Rigid3 target_from_source;          ///< local frames
  double criterion = 0.0;             ///< in the unit and sense that the method's header tells
  std::size_t hypotheses = 0;         ///< poses that were compared
  std::vector<Vector3d> not_held;     ///< unit, target frame: shifts that the method assumes
  std::optional<Vector3d> free_turn;  ///< the axis of a turn that it leaves open
};

/// A pose, or why the method has none.
struct PublishedAnswer {
  std::optional<PublishedPose> pose;
  std::string why_none;
};

/// The pose that lays the matched polygons on each other. The criterion is equation 10 summed over both
/// scans (rdist, symmetrised), m^2, higher is better; nothing is chosen by it.
PublishedAnswer register_threshold_2021(const PublishedInput& input);

/// The best hypothesis. The criterion is (10) over the polygons of associated clusters, summed over both
/// scans (rdist, symmetrised), m^2, higher is better.
PublishedAnswer register_cluster_2021(const PublishedInput& input);

/// The pose of smallest distance. The criterion is equation 14 over all edges of both scans, m^3, lower is
/// better. Deterministic for a seed.
PublishedAnswer register_openings_2022(const PublishedInput& input);

/// The pose of smallest distance. The criterion is equation 8, summed over both scans, m^2, lower is better.
/// Deterministic for a seed.
PublishedAnswer register_hybrid_2023(const PublishedInput& input);

/// The pose of smallest distance. The criterion is equation 8, summed over both sets, m^2, lower is better.
/// Deterministic for a seed.
PublishedAnswer register_segments_2023(const PublishedInput& input);

}  // namespace limen
