// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/bim_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/flat_faces.h"
#include "limen/io/record_table.h"
#include "limen/io/scan_builder.h"

namespace limen {
namespace {

constexpr double kLargestBuilding_m = 1000.0;
constexpr double kSmallestBuilding_m = 1.0;

struct Box3 {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);

  void add(const PolygonMesh& mesh) {
    for (const std::uint32_t corner : mesh.corners) {
      const Vector3d& x = mesh.points[corner];
      if (!(x.cwiseAbs().maxCoeff() < 1e9)) continue;
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  [[nodiscard]] bool empty() const { return low.x() > high.x(); }
};

void move(PolygonMesh& mesh, const Vector3d& shift) {
  for (Vector3d& point : mesh.points) point -= shift;
}

void question_size(const Box3& box, BimModel& model) {
  const double side = (box.high - box.low).maxCoeff();
  if (side >= kSmallestBuilding_m && side <= kLargestBuilding_m) return;
  model.warnings.push_back(fmt::format(
      "the model measures {:.4g} m from end to end, {} for a building: the length unit in the file "
      "(1 unit = {:.6g} m) is questionable",
      side, side > kLargestBuilding_m ? "much" : "little", model.metres_per_unit));
}

/// Faces of each mesh, meshes on all threads.
template <typename Raw>
std::vector<std::vector<BimFace>> faces_of(const std::vector<Raw>& raw, bool elements, Monitor& monitor) {
  std::vector<std::vector<BimFace>> faces(raw.size());
  parallel_for(raw.size(), 1, [&](std::size_t begin, std::size_t end) {
    monitor.throw_if_cancelled();
    for (std::size_t i = begin; i < end; ++i)
      faces[i] = flat_faces(raw[i].mesh, elements ? static_cast<std::int32_t>(i) : -1);
  });
  return faces;
}

}  // namespace

BimKind kind_of_ifc_type(const std::string& type, const std::string& predefined) {
  static constexpr std::array<std::pair<std::string_view, BimKind>, 34> kKinds{{
      {"ifcwallelement", BimKind::wall},
      {"ifcwall", BimKind::wall},
      {"ifccurtainwall", BimKind::wall},
      {"ifcslab", BimKind::slab},
      {"ifcfooting", BimKind::slab},
      {"ifcroof", BimKind::roof},
      {"ifccolumn", BimKind::column},
      {"ifcpile", BimKind::column},
      {"ifcchimney", BimKind::column},
      {"ifcbeam", BimKind::beam},
      {"ifcmember", BimKind::beam},
      {"ifcstair", BimKind::stair},
      {"ifcramp", BimKind::stair},
      {"ifcrailing", BimKind::railing},
      {"ifccovering", BimKind::covering},
      {"ifcplate", BimKind::plate},
      {"ifcwindow", BimKind::window},
      {"ifcdoor", BimKind::door},
      {"ifcfurn", BimKind::furniture},
      {"ifcsystemfurniture", BimKind::furniture},
      {"ifcflow", BimKind::furniture},
      {"ifcdistribution", BimKind::furniture},
      {"ifcenergyconversion", BimKind::furniture},
      {"ifcsanitary", BimKind::furniture},
      {"ifclight", BimKind::furniture},
      {"ifclamp", BimKind::furniture},
      {"ifcspaceheater", BimKind::furniture},
      {"ifcelectric", BimKind::furniture},
      {"ifcoutlet", BimKind::furniture},
      {"ifcswitchingdevice", BimKind::furniture},
      {"ifcairterminal", BimKind::furniture},
      {"ifcwasteterminal", BimKind::furniture},
      {"ifcsite", BimKind::terrain},
      {"ifcgeographicelement", BimKind::terrain},
  }};
  const std::string name = lower_case(type);
  const auto found = std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& known) {
    return std::string_view(name).substr(0, known.first.size()) == known.first;
  });
  if (found == kKinds.end()) return BimKind::other;
  if (found->second == BimKind::slab && lower_case(predefined) == "roof") return BimKind::roof;
  return found->second;
}

BimModel built(RawModel raw, Monitor& monitor) {
  BimModel model = std::move(raw.head);
  Box3 box;
  for (const RawElement& element : raw.elements) box.add(element.mesh);
  if (box.empty()) {
    throw Error("the model has no surface", model.name,
                "export it with its geometry (IFC with shape representations, OBJ or PLY with faces)");
  }
  question_size(box, model);
  model.local_origin = round_origin_near(0.5 * (box.low + box.high));
  for (RawElement& element : raw.elements) move(element.mesh, model.local_origin);
  for (RawSpace& space : raw.spaces) move(space.mesh, model.local_origin);

  for (RawElement& element : raw.elements) model.elements.push_back(std::move(element.about));
  for (std::vector<BimFace>& faces : faces_of(raw.elements, true, monitor))
    std::move(faces.begin(), faces.end(), std::back_inserter(model.faces));
  std::vector<std::vector<BimFace>> boundaries = faces_of(raw.spaces, false, monitor);
  for (std::size_t i = 0; i < raw.spaces.size(); ++i) {
    model.spaces.push_back(std::move(raw.spaces[i].about));
    model.spaces.back().faces = std::move(boundaries[i]);
  }
  if (model.faces.empty())
    throw Error("the model's faces have no area", model.name, "check how it was exported");
  model.check();
  return model;
}

}  // namespace limen
