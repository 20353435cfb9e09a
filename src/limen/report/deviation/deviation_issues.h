// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/deviation/deviation.h"
#include "limen/report/bcf/bcf_file.h"

namespace limen {

struct IssueOptions {
  double moved_m = 0.015;  ///< an element that is elsewhere by more is an issue: LOA30's bound; > 0
  double matter_m = 0.5;   ///< an object not in the model whose longest side is at least this is one, > 0

  void check() const;
};

/// A model's own file, and how one comes into its coordinates from those of the elements.
struct IssueModel {
  std::string file;  ///< its name, no folder
  Rigid3
      file_from_elements;  ///< world to world, metres; for a map's coordinates: before they become the map's
  double scale = 1.0;      ///< of the map: distances of the file are those of the elements / scale
};

/// What a building's deviation is made of.
struct IssueInputs {
  const BimModel& model;                              ///< elements and faces
  const std::vector<ElementDeviation>& elements;      ///< measured
  const std::vector<UnmodelledObject>& unmodelled;    ///< measured
  const std::vector<IssueModel>& models;              ///< files; the first one is that of unmodelled objects
  const std::vector<std::int32_t>& model_of_element;  ///< empty: all of the first
  const std::vector<Vector3d>& scanners;  ///< places, world of the elements: issues are seen from them
};

/// Of each kind, the worst first: elements that are missing, that stand elsewhere (by more than the bound,
/// and than three of their sigmas), objects in the model's extent that it lacks.
std::vector<BcfTopic> deviation_issues(const IssueInputs& inputs, const IssueOptions& options);

/// Elements, the worst first: missing ones by the surface that rays passed, then found ones by how far they
/// are off, then those not judged.
std::vector<std::size_t> worst_first(const std::vector<ElementDeviation>& elements);

/// By how much an element is off: its shift, or its median distance where no direction of a shift is held.
double off_m(const ElementDeviation& it);

/// Whether it is elsewhere by more than the bound, and beyond doubt.
bool has_moved(const ElementDeviation& it, double moved_m);

}  // namespace limen
