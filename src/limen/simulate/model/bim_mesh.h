// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/bim_model.h"
#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// A part of a model's face and what it is to light.
struct BimPart {
  std::size_t face = 0;  ///< index into BimModel::faces
  Polygon outline;       ///< in the face's frame
  Element element = Element::wall;
};

/// What each face is made of. Panes are found by their form: in windows and upright plates, flat pieces at
/// most 5 cm thick; in doors, at most 3 cm thick and framed. A window without any is a block: its broad sides
/// become a frame of 6 cm and glass.
std::vector<BimPart> parts_of(const BimModel& model);

/// How the elements of a model were built, one entry per element.
struct BuiltState {
  std::vector<Vector3d> shift_m;  ///< from where the model has it
  std::vector<char> there;        ///< 0: missing, or an open door
};
/// Everything as planned.
BuiltState as_planned(const BimModel& model);

/// A model as a scanner meets it, about the model's local origin.
struct BimMesh {
  Mesh mesh;
  std::vector<int> element_of_surface;  ///< index into BimModel::elements; -1: not of the model
};

/// Elements of an IFC file that are closed solids are seen from outside only; light that gets inside them
/// through a crack is lost. All others, and meshes, are seen from both sides.
BimMesh build_mesh(const BimModel& model, const std::vector<BimPart>& parts, const BuiltState& built);

}  // namespace limen
