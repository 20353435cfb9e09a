// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "ifc_helper/shape_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

#include "ifc_helper/placement.h"
#include <ifcpp/IFC4/include/IfcBooleanOperator.h>
#include <ifcpp/IFC4/include/IfcBooleanResult.h>
#include <ifcpp/IFC4/include/IfcCsgSelect.h>
#include <ifcpp/IFC4/include/IfcCsgSolid.h>
#include <ifcpp/IFC4/include/IfcElementarySurface.h>
#include <ifcpp/IFC4/include/IfcHalfSpaceSolid.h>
#include <ifcpp/IFC4/include/IfcMappedItem.h>
#include <ifcpp/IFC4/include/IfcPolygonalBoundedHalfSpace.h>
#include <ifcpp/IFC4/include/IfcRepresentationMap.h>
#include <ifcpp/geometry/Carve/GeometryConverter.h>

namespace limen::ifc {
namespace {

using Mesh = carve::mesh::MeshSet<3>;
using Transform = Eigen::Affine3d;

/// Polygons per circle so that the chord is near the arc, within bounds.
int circle_corners(double radius_m) {
  constexpr double kSagitta_m = 2e-3;
  if (!(radius_m > kSagitta_m)) return 12;
  const double half_step = std::acos(1.0 - kSagitta_m / radius_m);
  return std::clamp(4 * static_cast<int>(std::ceil(M_PI / half_step / 4.0)), 12, 96);
}

struct Box {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);

  void add(const ShapeNode& node) {
    for (const Vector3d& point : node.points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    for (const ShapeNode& child : node.children) add(child);
  }
  [[nodiscard]] bool empty() const { return low.x() > high.x(); }
  [[nodiscard]] Vector3d centre() const { return 0.5 * (low + high); }
  [[nodiscard]] double radius() const { return 0.5 * (high - low).norm(); }
};

void add_mesh(Mesh& mesh, ShapeNode& node) {
  const auto base = static_cast<std::uint32_t>(node.points.size());
  for (const auto& vertex : mesh.vertex_storage) node.points.emplace_back(vertex.v.x, vertex.v.y, vertex.v.z);
  std::vector<carve::mesh::Vertex<3>*> corners;
  for (carve::mesh::Mesh<3>* part : mesh.meshes) {
    for (carve::mesh::Face<3>* face : part->faces) {
      corners.clear();
      face->getVertices(corners);
      std::vector<std::uint32_t> polygon;
      for (const carve::mesh::Vertex<3>* corner : corners)
        polygon.push_back(base + static_cast<std::uint32_t>(corner - mesh.vertex_storage.data()));
      if (polygon.size() >= 3) node.polygons.push_back(std::move(polygon));
    }
  }
}

ShapeNode node_of(const ItemShapeData& data) {
  ShapeNode node;
  for (const auto& mesh : data.m_meshsets) {
    if (mesh) add_mesh(*mesh, node);
  }
  for (const auto& mesh : data.m_meshsets_open) {
    if (mesh) add_mesh(*mesh, node);
  }
  return node;
}

void transform(const Transform& b_from_a, ShapeNode& node) {
  for (Vector3d& point : node.points) point = b_from_a * point;
  for (ShapeNode& child : node.children) transform(b_from_a, child);
}

/// The solid between two copies of a ring.
ShapeNode prism(const std::vector<Vector3d>& bottom, const std::vector<Vector3d>& top) {
  ShapeNode node;
  node.points = bottom;
  node.points.insert(node.points.end(), top.begin(), top.end());
  const auto size = static_cast<std::uint32_t>(bottom.size());
  std::vector<std::uint32_t> down;
  std::vector<std::uint32_t> up;
  for (std::uint32_t k = 0; k < size; ++k) {
    down.push_back(size - 1 - k);
    up.push_back(size + k);
    const std::uint32_t next = (k + 1) % size;
    node.polygons.push_back({k, next, size + next, size + k});
  }
  node.polygons.push_back(std::move(down));
  node.polygons.push_back(std::move(up));
  return node;
}

/// How good a representation is for us; nothing: no body.
int rank_of(const IfcRepresentation& representation) {
  std::wstring name =
      representation.m_RepresentationIdentifier ? representation.m_RepresentationIdentifier->m_value : L"";
  static const std::array<const wchar_t*, 10> kNoBody = {
      L"Axis",      L"Box",      L"FootPrint", L"Annotation", L"Profile",
      L"Clearance", L"Lighting", L"CoG",       L"Plan",       L"Survey"};
  if (name == L"Body") return 0;
  if (std::find(kNoBody.begin(), kNoBody.end(), name) != kNoBody.end()) return -1;
  return name == L"Body-FallBack" || name == L"Facetation" || name == L"Tessellation" ? 1 : 2;
}

/// The representations of the best rank that there is; of lesser ones the first.
std::vector<const IfcRepresentation*> bodies_of(const IfcProduct& product) {
  std::vector<const IfcRepresentation*> best;
  int best_rank = 100;
  if (!product.m_Representation) return best;
  for (const auto& representation : product.m_Representation->m_Representations) {
    const int rank = representation ? rank_of(*representation) : -1;
    if (rank < 0 || rank > best_rank || (rank == best_rank && rank == 1)) continue;
    if (rank < best_rank) best.clear();
    best_rank = rank;
    best.push_back(representation.get());
  }
  return best;
}

/// Walks the items of a representation.
class ItemWalker {
 public:
  ItemWalker(GeometryConverter& converter, const std::function<void(const std::string&)>& tell)
      : representations_(*converter.getRepresentationConverter()),
        metres_per_unit_(representations_.getUnitConverter()->getLengthInMeterFactor()),
        tell_(tell) {}

  [[nodiscard]] double metres_per_unit() const { return metres_per_unit_; }

  std::vector<ShapeNode> nodes_of(const IfcRepresentation& representation, int depth = 0) {
    std::vector<ShapeNode> nodes;
    for (const auto& item : representation.m_Items) {
      if (!item) continue;
      if (const auto mapped = std::dynamic_pointer_cast<IfcMappedItem>(item)) {
        for (ShapeNode& node : nodes_of_map(*mapped, depth)) nodes.push_back(std::move(node));
        continue;
      }
      ShapeNode node = guarded(item, depth);
      if (!node.empty()) nodes.push_back(std::move(node));
    }
    return nodes;
  }

 private:
  using Item = std::shared_ptr<IfcRepresentationItem>;

  std::vector<ShapeNode> nodes_of_map(const IfcMappedItem& mapped, int depth) {
    constexpr int kDeepestMap = 8;
    if (!mapped.m_MappingSource || !mapped.m_MappingSource->m_MappedRepresentation || depth >= kDeepestMap) {
      tell_("a mapped item has no source");
      return {};
    }
    const auto origin = std::dynamic_pointer_cast<IfcPlacement>(mapped.m_MappingSource->m_MappingOrigin);
    const Transform b_from_a =
        frame_of(mapped.m_MappingTarget.get(), metres_per_unit_) * frame_of(origin.get(), metres_per_unit_);
    std::vector<ShapeNode> nodes = nodes_of(*mapped.m_MappingSource->m_MappedRepresentation, depth + 1);
    for (ShapeNode& node : nodes) transform(b_from_a, node);
    return nodes;
  }

  /// An item that fails is reported and left out; the others of the product stay.
  ShapeNode guarded(const Item& item, int depth) {
    std::string problem;
    try {
      return node_of_item(item, depth);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const carve::exception& error) {
      problem = error.str();
    } catch (const std::exception& error) {
      problem = error.what();
    }
    tell_("item #" + std::to_string(item->m_entity_id) + ": " + problem);
    return {};
  }

  ShapeNode node_of_item(const Item& item, int depth) {
    if (const auto result = std::dynamic_pointer_cast<IfcBooleanResult>(item)) return boolean(result, depth);
    if (const auto solid = std::dynamic_pointer_cast<IfcCsgSolid>(item)) {
      const auto root = std::dynamic_pointer_cast<IfcBooleanResult>(solid->m_TreeRootExpression);
      if (root) return boolean(root, depth);
    }
    const auto data = std::make_shared<ItemShapeData>();
    if (const auto geometric = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(item)) {
      representations_.convertIfcGeometricRepresentationItem(geometric, data);
    } else if (const auto topological = std::dynamic_pointer_cast<IfcTopologicalRepresentationItem>(item)) {
      representations_.convertTopologicalRepresentationItem(topological, data);
    }
    return node_of(*data);
  }

  ShapeNode node_of_operand(const std::shared_ptr<IfcBooleanOperand>& operand, int depth) {
    if (const auto item = std::dynamic_pointer_cast<IfcRepresentationItem>(operand))
      return node_of_item(item, depth);
    return {};
  }

  /// A chain of differences, as walls under a roof have it, becomes one node.
  ShapeNode boolean(std::shared_ptr<IfcBooleanResult> result, int depth) {
    if (depth > kDeepestIfcNode / 3) {
      tell_("Boolean operations are nested too deep");
      return {};
    }
    constexpr std::size_t kLongestChain = 10000;
    std::vector<std::shared_ptr<IfcBooleanOperand>> cutters;
    std::shared_ptr<IfcBooleanOperand> first;
    const auto operation = operation_of(*result);
    while (result && operation_of(*result) == operation && cutters.size() < kLongestChain) {
      cutters.push_back(result->m_SecondOperand);
      first = result->m_FirstOperand;
      result = std::dynamic_pointer_cast<IfcBooleanResult>(first);
    }
    ShapeNode node;
    node.kind = operation;
    node.children.push_back(node_of_operand(first, depth + 1));
    Box box;
    box.add(node);
    if (box.empty()) return {};
    for (auto cutter = cutters.rbegin(); cutter != cutters.rend(); ++cutter) {
      const auto half_space = std::dynamic_pointer_cast<IfcHalfSpaceSolid>(*cutter);
      ShapeNode child = half_space ? half_space_node(*half_space, box) : node_of_operand(*cutter, depth + 1);
      if (!child.empty()) node.children.push_back(std::move(child));
    }
    return node.children.size() == 1 ? std::move(node.children.front()) : std::move(node);
  }

  static IfcNode operation_of(const IfcBooleanResult& result) {
    if (!result.m_Operator) return IfcNode::subtract;
    switch (result.m_Operator->m_enum) {
      case IfcBooleanOperator::ENUM_UNION:
        return IfcNode::unite;
      case IfcBooleanOperator::ENUM_INTERSECTION:
        return IfcNode::intersect;
      default:
        return IfcNode::subtract;
    }
  }

  /// The part of a half space that can touch what lies in `box`, as a closed mesh; a bound one is a prism cut
  /// by it.
  ShapeNode half_space_node(const IfcHalfSpaceSolid& half_space, const Box& box) {
    const auto surface = std::dynamic_pointer_cast<IfcElementarySurface>(half_space.m_BaseSurface);
    if (!surface) {
      tell_("a half space is not bounded by a plane");
      return {};
    }
    const Transform plane = frame_of(surface->m_Position.get(), metres_per_unit_);
    const bool agrees = !half_space.m_AgreementFlag || half_space.m_AgreementFlag->m_value;
    const Vector3d inwards = (agrees ? -1.0 : 1.0) * plane.linear().col(2);
    const double reach = 4.0 * box.radius() + std::abs(inwards.dot(box.centre() - plane.translation())) + 1.0;
    const Vector3d middle = box.centre() - inwards.dot(box.centre() - plane.translation()) * inwards;
    const Vector3d u = reach * plane.linear().col(0);
    const Vector3d v = reach * plane.linear().col(1);
    const std::vector<Vector3d> base = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    std::vector<Vector3d> far = base;
    for (Vector3d& corner : far) corner += reach * inwards;
    ShapeNode node = prism(base, far);
    const auto* bounded = dynamic_cast<const IfcPolygonalBoundedHalfSpace*>(&half_space);
    if (bounded == nullptr) return node;
    ShapeNode both;
    both.kind = IfcNode::intersect;
    both.children.push_back(boundary_prism(*bounded, box));
    if (both.children.front().empty()) return {};
    both.children.push_back(std::move(node));
    return both;
  }

  ShapeNode boundary_prism(const IfcPolygonalBoundedHalfSpace& half_space, const Box& box) {
    std::vector<vec2> outline;
    std::vector<vec2> ignored;
    representations_.getCurveConverter()->convertIfcCurve2D(half_space.m_PolygonalBoundary, outline, ignored);
    const Transform frame = frame_of(half_space.m_Position.get(), metres_per_unit_);
    const double middle = (frame.inverse() * box.centre()).z();
    const double reach = box.radius() + 1.0;
    std::vector<Vector3d> bottom;
    std::vector<Vector3d> top;
    for (const vec2& corner : outline) {
      bottom.emplace_back(frame * Vector3d(corner.x, corner.y, middle - reach));
      top.emplace_back(frame * Vector3d(corner.x, corner.y, middle + reach));
    }
    if (bottom.size() > 1 && (bottom.front() - bottom.back()).norm() < 1e-9) {
      bottom.pop_back();
      top.pop_back();
    }
    if (bottom.size() >= 3) return prism(bottom, top);
    tell_("the boundary of a half space is not a polygon");
    return {};
  }

  RepresentationConverter& representations_;
  double metres_per_unit_;
  const std::function<void(const std::string&)>& tell_;
};

// The signature is IfcPlusPlus's.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void hear(void* listener, std::shared_ptr<StatusCallback::Message> message) {
  if (!message || message->m_message_type != StatusCallback::MESSAGE_TYPE_ERROR) return;
  std::string text;
  for (const wchar_t c : message->m_message_text) text += c >= 32 && c < 127 ? static_cast<char>(c) : '?';
  (*static_cast<std::function<void(const std::string&)>*>(listener))(text);
}

}  // namespace

void ShapeNode::append_to(Payload& payload) const {
  payload.put_byte(static_cast<std::uint8_t>(kind));
  if (kind != IfcNode::mesh) {
    payload.put_count(children.size());
    for (const ShapeNode& child : children) child.append_to(payload);
    return;
  }
  payload.put_count(points.size());
  for (const Vector3d& point : points) {
    for (int k = 0; k < 3; ++k) payload.put_number(point[k]);
  }
  payload.put_count(polygons.size());
  for (const auto& polygon : polygons) {
    payload.put_count(polygon.size());
    for (const std::uint32_t corner : polygon) payload.put_count(corner);
  }
}

ShapeReader::ShapeReader(std::shared_ptr<BuildingModel> model, std::function<void(const std::string&)> tell)
    : model_(std::move(model)), tell_(std::move(tell)) {
  converter_ = std::make_unique<GeometryConverter>(model_);
  converter_->setMessageCallBack(&tell_, hear);
  GeometrySettings& settings = *converter_->getGeomSettings();
  settings.setHandleStyledItems(false);
  settings.setHandleLayerAssignments(false);
  settings.setNumVerticesPerCircle(24);
  settings.setMinNumVerticesPerArc(3);
  settings.setNumVerticesPerCircleGivenRadius(circle_corners);
  carve::setEpsilon(1.5e-5 *
                    converter_->getRepresentationConverter()->getUnitConverter()->getLengthInMeterFactor());
}

ShapeReader::~ShapeReader() = default;

std::vector<ShapeNode> ShapeReader::shapes_of(const IfcProduct& product) {
  ItemWalker walker(*converter_, tell_);
  const Transform world = world_frame_of(product.m_ObjectPlacement, walker.metres_per_unit());
  std::vector<ShapeNode> shapes;
  for (const IfcRepresentation* body : bodies_of(product)) {
    for (ShapeNode& node : walker.nodes_of(*body)) {
      transform(world, node);
      shapes.push_back(std::move(node));
    }
  }
  return shapes;
}

}  // namespace limen::ifc
