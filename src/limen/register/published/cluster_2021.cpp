// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limen/base/parallel.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/planes/polygon_distance.h"
#include "limen/match/solvers/rotation_from_directions.h"
#include "limen/match/solvers/translation_from_planes.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2021, section 3.2.2: polygons clustered by direction, then by offset; one pair of
// planes from each of three associated clusters makes a hypothesis, and the best by (10) is kept.
//
// Departures from the printed text:
// - "by their offset" is announced and never defined: planes of one direction whose offsets lie within
//   `same_offset_m` of the one of most inliers are one, which represents them;
// - all triples are enumerated, as printed, but compared in the order of an upper estimate of (10) - what the
//   offsets alone allow, axis by axis, every overlap being as large as the smaller polygon - and no further
//   than to where the estimate falls below the best value found;
// - the three clusters that the text takes for granted may be missing: then there is no pose, and why is
// said;
// - those of match/planes/direction_clusters.h (algorithm 1), polygon_distance.h (7, 9, 10),
//   match/solvers/rotation_from_directions.h (11 to 19) and translation_from_planes.h (20 to 22).

namespace limen {
namespace {

using Polygons = std::vector<PlanarPolygon>;

/// The three clusters of one scan: C^h, C^v1, C^v2.
struct MainClusters {
  std::array<const DirectionCluster*, 3> of = {nullptr, nullptr, nullptr};
  std::string why_none;

  [[nodiscard]] bool found() const { return why_none.empty(); }
};

MainClusters main_clusters(const DirectionClusters& found, const char* side) {
  MainClusters main;
  if (found.horizontal < 0 || found.clusters.size() < 3 || found.independent < 3) {
    main.why_none = fmt::format("the planes of the {} lie in fewer than three independent directions", side);
    return main;
  }
  std::size_t next = 1;
  for (std::size_t k = 0; k < 3; ++k)
    main.of[static_cast<int>(k) == found.horizontal ? 0 : next++] = &found.clusters[k];
  return main;
}

/// C^h with C^h, and the vertical clusters by the smallest angle at the start.
void associate(const MainClusters& source, MainClusters& target, const Matrix3d& start) {
  const auto alike = [&](std::size_t i, std::size_t j) {
    return std::abs((start * source.of[i]->direction).dot(target.of[j]->direction));
  };
  if (alike(1, 2) + alike(2, 1) > alike(1, 1) + alike(2, 2)) std::swap(target.of[1], target.of[2]);
}

Matrix3d aligned(const MainClusters& source, const MainClusters& target, const Matrix3d& start) {
  const auto directions = [](const MainClusters& main, const Matrix3d& turn) {
    return MainDirections{turn * main.of[0]->direction, turn * main.of[1]->direction,
                          turn * main.of[2]->direction};
  };
  return rotation_from_main_directions(directions(source, start), directions(target, Matrix3d::Identity())) *
         start;
}

/// One direction of both scans after the alignment, everything turned into the target's frame.
struct OffsetAxis {
  Vector3d direction = Vector3d::UnitZ();
  Polygons source;  // turned, not shifted
  Polygons target;
  std::vector<int> source_ones;  // one for each offset, index into `source`
  std::vector<int> target_ones;
};

/// One of the pairs I_m of planes, and how much (10) can be along its axis where the pair coincides.
struct Pairing {
  int source = -1;
  int target = -1;
  double shift_m = 0.0;  // along the axis
  double most_m2 = 0.0;
};

/// "then by their offset": one plane for each, of most inliers.
std::vector<int> by_offset(const Polygons& polygons, const Vector3d& direction, double tolerance_m) {
  std::vector<int> ones;
  const auto place = [&](int k) { return direction.dot(polygons[static_cast<std::size_t>(k)].centroid); };
  for (int k = 0; k < static_cast<int>(polygons.size()); ++k) {
    if (std::none_of(ones.begin(), ones.end(),
                     [&](int one) { return std::abs(place(one) - place(k)) < tolerance_m; }))
      ones.push_back(k);
  }
  return ones;
}

Polygons members(const Polygons& all, const DirectionCluster& cluster, const Matrix3d& turn) {
  Polygons chosen;
  for (const int k : cluster.planes)
    chosen.push_back(transformed({turn, Vector3d::Zero()}, all[static_cast<std::size_t>(k)]));
  return chosen;
}

/// What (10) can be at most along one axis under a shift, by the offsets alone.
double most_agreement(const OffsetAxis& axis, double shift_m, double max_distance_m) {
  constexpr double kSlackM = 0.05;  // planes are not quite parallel
  double total = 0.0;
  for (const PlanarPolygon& a : axis.source) {
    double met = 0.0;
    for (const PlanarPolygon& b : axis.target) {
      const double apart = std::abs(axis.direction.dot(a.centroid - b.centroid) + shift_m);
      const double ratio = std::max(0.0, apart - kSlackM) / max_distance_m;
      met += std::max(0.0, 1.0 - ratio * ratio) * std::min(a.area_m2, b.area_m2);
    }
    total += std::min(met, a.area_m2);
  }
  return total;
}

std::vector<Pairing> pairings(const OffsetAxis& axis, double max_distance_m) {
  std::vector<Pairing> list;
  for (const int i : axis.source_ones) {
    for (const int j : axis.target_ones) {
      const double shift_m = axis.direction.dot(axis.target[static_cast<std::size_t>(j)].centroid -
                                                axis.source[static_cast<std::size_t>(i)].centroid);
      list.push_back({i, j, shift_m, most_agreement(axis, shift_m, max_distance_m)});
    }
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Pairing& a, const Pairing& b) { return a.most_m2 > b.most_m2; });
  return list;
}

/// One hypothesis: J_1, J_2, J_3.
struct Triple {
  std::array<std::uint16_t, 3> pairing = {0, 0, 0};
  float most_m2 = 0.0F;
};

using Axes = std::array<OffsetAxis, 3>;
using Pairings = std::array<std::vector<Pairing>, 3>;

/// I_1 x I_2 x I_3, what promises most first.
std::vector<Triple> triples(const Pairings& of) {
  std::vector<Triple> all;
  all.reserve(of[0].size() * of[1].size() * of[2].size());
  for (std::size_t i = 0; i < of[0].size(); ++i) {
    for (std::size_t j = 0; j < of[1].size(); ++j) {
      for (std::size_t k = 0; k < of[2].size(); ++k) {
        const double most = of[0][i].most_m2 + of[1][j].most_m2 + of[2][k].most_m2;
        all.push_back(
            {{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k)},
             static_cast<float>(most)});
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Triple& a, const Triple& b) { return a.most_m2 > b.most_m2; });
  return all;
}

/// (20) to (22): the source is turned already, so that R is the identity here.
Vector3d shift_of(const Triple& triple, const Axes& axes, const Pairings& of) {
  std::vector<PlanePair> pairs;
  for (std::size_t m = 0; m < 3; ++m) {
    const Pairing& pairing = of[m][triple.pairing[m]];
    pairs.push_back({axes[m].source[static_cast<std::size_t>(pairing.source)].centroid,
                     axes[m].target[static_cast<std::size_t>(pairing.target)].plane, 1.0});
  }
  return translation_from_planes(Matrix3d::Identity(), pairs).translation;
}

/// rdist under one shift: (10) within each pair of clusters.
double agreement_at(const Vector3d& shift, const Axes& axes) {
  double total = 0.0;
  for (const OffsetAxis& axis : axes) {
    Polygons moved;
    for (const PlanarPolygon& polygon : axis.source)
      moved.push_back(transformed({Matrix3d::Identity(), shift}, polygon));
    total += scan_agreement(moved, axis.target);
  }
  return total;
}

struct Best {
  Vector3d shift = Vector3d::Zero();
  double agreement_m2 = 0.0;
};

/// "keep the translation calculated by the best hypothesis".
Best best_of(const std::vector<Triple>& ordered, const Axes& axes, const Pairings& of) {
  constexpr std::size_t kRound = 64;
  Best best;
  std::vector<Best> round(kRound);
  for (std::size_t first = 0; first < ordered.size(); first += kRound) {
    if (ordered[first].most_m2 < best.agreement_m2) break;
    const std::size_t count = std::min(kRound, ordered.size() - first);
    parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        round[k].shift = shift_of(ordered[first + k], axes, of);
        round[k].agreement_m2 = agreement_at(round[k].shift, axes);
      }
    });
    for (std::size_t k = 0; k < count; ++k) {
      if (round[k].agreement_m2 > best.agreement_m2) best = round[k];
    }
  }
  return best;
}

}  // namespace

PublishedAnswer register_cluster_2021(const PublishedInput& input) {
  constexpr double kSameOffsetM = 0.05;  // planes of one direction nearer than this are one
  // 3.1: the polygons that both scans may have seen.
  const Polygons source = common_polygons(input.source, input.source_outside);
  const Polygons target = common_polygons(input.target, input.target_outside);
  // Algorithm 1: direction clustering.
  const DirectionClusters of_source = cluster_directions(source, Vector3d::UnitZ());
  const DirectionClusters of_target = cluster_directions(target, Vector3d::UnitZ());
  const MainClusters from = main_clusters(of_source, "source");
  MainClusters to = main_clusters(of_target, "target");
  if (!from.found()) return {std::nullopt, from.why_none};
  if (!to.found()) return {std::nullopt, to.why_none};
  // Direction cluster matching.
  associate(from, to, input.start.rotation);
  // Alignment: 3.3, equations 11 to 19.
  const Matrix3d rotation = aligned(from, to, input.start.rotation);
  // Hypotheses enumeration: pairs of planes of each pair of clusters, 3.4.
  Axes axes;
  Pairings of;
  for (std::size_t m = 0; m < 3; ++m) {
    OffsetAxis& axis = axes[m];
    axis.direction = to.of[m]->direction;
    axis.source = members(source, *from.of[m], rotation);
    axis.target = members(target, *to.of[m], Matrix3d::Identity());
    axis.source_ones = by_offset(axis.source, axis.direction, kSameOffsetM);
    axis.target_ones = by_offset(axis.target, axis.direction, kSameOffsetM);
    of[m] = pairings(axis, kAgreeingPlanesM);
  }
  const std::vector<Triple> ordered = triples(of);
  // Selection of the best hypothesis: equations 9 and 10.
  const Best best = best_of(ordered, axes, of);
  if (!(best.agreement_m2 > 0.0)) return {std::nullopt, "no candidate pose brings two polygons together"};
  PublishedPose pose;
  pose.target_from_source = {rotation, best.shift};
  pose.criterion = best.agreement_m2;
  pose.hypotheses = ordered.size();
  return {pose, {}};
}

}  // namespace limen
