// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "limen/geometry/spline_motion.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/table/cloud_writer.h"

namespace limen {

/// A cloud of an open file, and how it comes into the frame of the output.
struct PlacedCloud {
  const OpenPoints* input = nullptr;
  std::size_t cloud = 0;
  Rigid3 target_from_world;             ///< from the world of the file, its offset added
  std::optional<Vector3d> centre = {};  ///< scanner position in the world of the file, where there is one
  std::size_t source = 0;               ///< number of the file
  std::shared_ptr<const SplineMotion> bend = {};  ///< of a pass that drifted: by time, after the motion
  double colour_factor = 1.0;                     ///< to the kind of colours that the joined cloud has
};

/// Several clouds as one that is read in pieces: x y z as float64 in one frame, all other columns that any of
/// them has. Optical centres per point move with the points, normals turn, everything else stays as it was;
/// where a cloud lacks a column its points have 0 there, or not-a-number where the column takes it. Colours
/// of 8 and 16 bits and fractions are brought to one kind.
class JoinedClouds {
 public:
  /// `tell_source`: a column source_cloud says which file each point is from. Static clouds with different
  /// scanner positions give them per point. Throws Error where a cloud lacks x, y or z, or none has points.
  /// `system`: well-known text of the output's coordinate system; empty: that of the first cloud.
  JoinedClouds(std::vector<PlacedCloud> clouds, bool tell_source, const std::string& system = {});

  /// What a writer needs to know; the columns are those of the tables of read(), in their order.
  [[nodiscard]] const CloudPlan& plan() const { return plan_; }
  /// The plan with the largest values of colours and intensities that are no whole numbers of 8 or 16 bits:
  /// reads all points where there are such.
  [[nodiscard]] CloudPlan plan_with_largest() const;
  /// Sentences about what could not be carried over.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// The points of all clouds, one cloud after the other; forgets the bytes that were read.
  [[nodiscard]] std::unique_ptr<PointStream> read() const;

 private:
  void add_columns(const RecordTable& table, const CloudFacts& facts);
  void add_column(const std::string& name, Scalar type);
  void settle_centres();
  void settle_colours();

  std::vector<PlacedCloud> clouds_;
  bool tell_source_;
  CloudPlan plan_;
  std::set<std::string> mixed_;  ///< columns that some clouds lack or have of another type
  std::vector<std::string> notes_;
};

}  // namespace limen
