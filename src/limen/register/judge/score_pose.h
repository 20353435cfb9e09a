// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "limen/register/judge/evidence_table.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

struct ScoreOptions {
  double surface_m = 0.06;  ///< surfaces nearer than this agree
  double free_m = 0.10;     ///< surface this far inside seen free space is contradicted
  double opening_m = 0.25;  ///< openings nearer than this within their wall agree
  bool openings = true;     ///< openings count
  std::size_t samples = 0;  ///< about how many of each scan are tested; 0: all
  bool ask_model = true;    ///< the scan is asked about a model's surface as well, not only the model
};

inline constexpr double kContradictionWeight = 4.0;

/// How well a pose explains both scans, asked both ways and averaged: m^2 of each scan's surface that the
/// other confirms (clipped, weighted 1 - d^2 / t^2: 2021, eq. 9-10 over the seen surface itself), and m^2
/// standing where the other's rays passed free. An opening that both scans see counts with its area.
struct PoseScore {
  double agreeing_m2 = 0.0;
  double contradicted_m2 = 0.0;
  double opening_m2 = 0.0;  ///< of agreeing_m2: openings seen from both sides
  /// Agreeing surface, each plane counting for no more than 5 m^2, however large: that two façades lie in one
  /// plane is one coincidence, not many.
  double evidence_m2 = 0.0;
  /// What openings would agree more, were each off by two of its deviations less: far windows are known to
  /// centimetres only, and a pose that is not where they are nearest may be none the worse.
  double unsure_opening_m2 = 0.0;

  /// What poses are ranked by, m^2. One contradicted square metre outweighs several agreeing ones: surfaces
  /// meet by chance, but nothing solid is where a ray passed.
  [[nodiscard]] double value() const { return evidence_m2 - kContradictionWeight * contradicted_m2; }
};

/// What distinguishes two poses, m^2: surface that agrees better under the one than under the other, each
/// plane counting for no more than 5 m^2, and surface that only one of them puts into seen free space.
/// Surface that agrees under both poses, however much of it there is, does not count.
struct PoseContrast {
  double for_first_m2 = 0.0;
  double for_second_m2 = 0.0;
  double against_first_m2 = 0.0;
  double against_second_m2 = 0.0;
};

/// Contrasts of one pose with others: what both scans say under it is asked once. Keeps copies of the views,
/// not of what they point to.
class PoseContrasts {
 public:
  PoseContrasts(const ScanView& source, const ScanView& target, const Rigid3& first,
                const ScoreOptions& options);
  ~PoseContrasts();
  PoseContrasts(const PoseContrasts&) = delete;
  PoseContrasts& operator=(const PoseContrasts&) = delete;

  [[nodiscard]] PoseContrast operator()(const Rigid3& second) const;

 private:
  struct Asked;
  ScoreOptions options_;
  std::unique_ptr<Asked> asked_;
};

/// Evidence of the share of contradicted surface for a pose against chance, natural logarithm. Under a
/// right pose it is a property of a pair (doors, people, glass, things that were moved): known as a beta
/// distribution only, and integrated out. So is the share that wrong poses contradict.
double nats_of_contradiction(double agreeing_m2, double contradicted_m2,
                             const evidence_table::Contradiction& table);

PoseScore score_pose(const ScanView& source, const ScanView& target, const Rigid3& target_from_source,
                     const ScoreOptions& options);

/// score_pose() for many poses of one pair: what does not depend on the pose is gathered once. Keeps copies
/// of the views, not of what they point to. Any number of threads may ask it at once.
class PoseScorer {
 public:
  PoseScorer(const ScanView& source, const ScanView& target, const ScoreOptions& options);
  ~PoseScorer();
  PoseScorer(const PoseScorer&) = delete;
  PoseScorer& operator=(const PoseScorer&) = delete;

  [[nodiscard]] PoseScore operator()(const Rigid3& target_from_source) const;

 private:
  struct Asked;
  ScanView source_;
  ScanView target_;
  ScoreOptions options_;
  std::unique_ptr<Asked> asked_;
};

}  // namespace limen
