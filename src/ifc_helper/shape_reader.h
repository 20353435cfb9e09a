// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ifc_helper/record_writer.h"
#include <ifcpp/model/BuildingModel.h>

#include "limen/geometry/rigid.h"

class GeometryConverter;
class IfcProduct;
class IfcRepresentationItem;

namespace limen::ifc {

/// A solid, or a Boolean operation of others that limen carries out.
struct ShapeNode {
  IfcNode kind = IfcNode::mesh;
  std::vector<Vector3d> points;  ///< of a mesh, metres
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<ShapeNode> children;

  [[nodiscard]] bool empty() const { return kind == IfcNode::mesh ? polygons.empty() : children.empty(); }
  void append_to(Payload& payload) const;
};

/// Makes the shapes of products in world coordinates. Openings are not subtracted and Boolean differences are
/// not carried out: IfcPlusPlus does neither the same way twice.
class ShapeReader {
 public:
  /// `tell` hears what could not be made.
  ShapeReader(std::shared_ptr<BuildingModel> model, std::function<void(const std::string&)> tell);
  ~ShapeReader();
  ShapeReader(const ShapeReader&) = delete;
  ShapeReader& operator=(const ShapeReader&) = delete;

  /// The shapes of a product's body, one per representation item; none where it has no body.
  std::vector<ShapeNode> shapes_of(const IfcProduct& product);

 private:
  std::shared_ptr<BuildingModel> model_;
  std::unique_ptr<GeometryConverter> converter_;
  std::function<void(const std::string&)> tell_;
};

}  // namespace limen::ifc
