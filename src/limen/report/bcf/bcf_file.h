// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A camera of an issue, in the coordinates of the model's own file, metres.
struct BcfCamera {
  Vector3d place = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitX();  ///< unit
  Vector3d up = Vector3d::UnitZ();         ///< unit, across the direction
};

/// An issue that building modellers exchange.
struct BcfTopic {
  std::string key;          ///< what tells it from all others: the same key gives the same GUID
  std::string title;        ///< one line
  std::string description;  ///< sentences
  std::string label;        ///< "missing"
  std::string priority;     ///< "high"
  std::string model;        ///< file name of the model it is about
  std::string ifc_guid;     ///< of the element; empty, or not of 22 characters: none is named
  std::string colour;       ///< of the element, "D03000"
  BcfCamera camera;
  std::vector<std::pair<Vector3d, Vector3d>> lines;  ///< drawn in space
};

/// A camera at `place` that looks at `aim`; where that is too near or straight above it, it steps aside.
BcfCamera looking_at(const Vector3d& place, const Vector3d& aim);

/// The twelve edges of a box.
std::vector<std::pair<Vector3d, Vector3d>> edges_of(const Vector3d& low, const Vector3d& high);

/// The bytes of a BCF file of version 2.1 (buildingSMART, BIM Collaboration Format): bcf.version, and for
/// each topic a folder with markup.bcf and viewpoint.bcfv. `date`: when they were found,
/// "2026-03-01T12:00:00Z". The same topics and date give the same bytes.
std::string bcf_file(const std::vector<BcfTopic>& topics, const std::string& date);

}  // namespace limen
