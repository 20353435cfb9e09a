// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/measure_elements.h"

#include <algorithm>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kMissingShare = 0.01;   // of an element's surface, that rays passed: less says little of it
constexpr double kLeastJudgedM2 = 0.05;  // surface that rays reached; with less an element is not judged
constexpr double kLeastMissingM2 = 0.1;  // that rays passed through where an element is not found
constexpr double kFoundShare = 0.5;  // of the surface that rays reached; an element with less is not found

/// What may let light pass: that rays went through it is no evidence.
bool may_be_pane(BimKind kind) {
  return kind == BimKind::window || kind == BimKind::plate;
}

Presence presence_of(const ElementDeviation& it, BimKind kind, const DeviationOptions& options) {
  const double reached = it.covered_m2 + it.passed_m2;
  const bool seen =
      it.points >= static_cast<std::size_t>(options.min_points) && it.covered_m2 >= kLeastJudgedM2;
  if (seen && (it.covered_share >= kFoundShare || may_be_pane(kind))) return Presence::found;
  if (reached < kLeastJudgedM2 || may_be_pane(kind)) return Presence::not_judged;
  const double least = std::max(kLeastMissingM2, kMissingShare * it.area_m2);
  const bool missing = it.covered_share < kFoundShare && it.passed_m2 >= least;
  return missing ? Presence::not_found : Presence::not_judged;
}

/// Coverage of one element by its faces.
void cover(const std::vector<std::size_t>& of_element, const ModelFaces& faces, const FaceEvidence& evidence,
           ElementDeviation& it) {
  for (const std::size_t k : of_element) {
    it.covered_m2 += evidence.coverage[k].covered_m2;
    if (faces.panes[k] == 0) it.passed_m2 += evidence.coverage[k].passed_m2;
  }
  const double reached = it.covered_m2 + it.passed_m2;
  it.covered_share = reached > 0.0 ? it.covered_m2 / reached : 0.0;
}

}  // namespace

std::vector<ElementDeviation> elements_of(const BimModel& model) {
  std::vector<ElementDeviation> elements(model.elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) elements[e].element = static_cast<std::int32_t>(e);
  for (const BimFace& face : model.faces)
    elements[static_cast<std::size_t>(face.element)].area_m2 += face.area_m2;
  return elements;
}

ElementShift measure_elements(const BimModel& model, const ModelFaces& faces, const FaceEvidence& evidence,
                              const DeviationOptions& options, std::vector<ElementDeviation>& elements) {
  std::vector<std::vector<std::size_t>> faces_of_element(elements.size());
  for (std::size_t k = 0; k < faces.elements.size(); ++k)
    faces_of_element[static_cast<std::size_t>(faces.elements[k])].push_back(k);
  const auto known = [&](const std::vector<std::size_t>& of_element) {
    std::vector<FaceOffset> offsets;
    for (const std::size_t k : of_element) {
      if (evidence.offsets[k].points > 0) offsets.push_back(evidence.offsets[k]);
    }
    return offsets;
  };
  parallel_for(elements.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      cover(faces_of_element[e], faces, evidence, elements[e]);
      elements[e].presence = presence_of(elements[e], model.elements[e].kind, options);
      elements[e].shift = shift_of(known(faces_of_element[e]), options);
    }
  });
  std::vector<FaceOffset> all;
  for (const std::vector<std::size_t>& of_element : faces_of_element) {
    const std::vector<FaceOffset> offsets = known(of_element);
    all.insert(all.end(), offsets.begin(), offsets.end());
  }
  return shift_of(all, options);
}

FacesExtent extent_of(const ModelFaces& faces) {
  FacesExtent extent;
  for (const FlatFace& face : faces.faces) {
    for (const Vector2d& p : face.outline.outer) {
      extent.low = extent.low.cwiseMin(face.frame.to_space(p));
      extent.high = extent.high.cwiseMax(face.frame.to_space(p));
    }
  }
  return extent;
}

}  // namespace limen
