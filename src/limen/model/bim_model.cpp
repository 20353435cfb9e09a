// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/bim_model.h"

#include <array>
#include <cmath>

#include "limen/base/error.h"

namespace limen {
namespace {

[[noreturn]] void throw_internal(const BimModel& model, const std::string& what) {
  throw Error(what, model.name, "this is an internal error of limen: please report it", Fault::internal);
}

void check_faces(const BimModel& model, const std::vector<BimFace>& faces, bool of_elements) {
  const auto elements = static_cast<std::int32_t>(model.elements.size());
  for (const BimFace& face : faces) {
    if (of_elements ? (face.element < 0 || face.element >= elements) : face.element != -1)
      throw_internal(model, "a face belongs to no element of the model");
    if (face.outline.outer.size() < 3) throw_internal(model, "a face has fewer than three corners");
    if (face.frame.u.cross(face.frame.v).dot(face.plane.normal) < 0.999)
      throw_internal(model, "a face's frame does not fit its normal");
  }
}

}  // namespace

const char* to_string(BimKind kind) {
  static constexpr std::array<const char*, 14> names = {"wall",  "slab",      "roof",     "column", "beam",
                                                        "stair", "railing",   "covering", "plate",  "window",
                                                        "door",  "furniture", "terrain",  "other"};
  return names[static_cast<std::size_t>(kind)];
}

void BimModel::check() const {
  check_faces(*this, faces, true);
  for (const BimSpace& space : spaces) check_faces(*this, space.faces, false);
  const auto count = static_cast<std::int32_t>(elements.size());
  for (const BimOpening& opening : openings) {
    if (opening.host < -1 || opening.host >= count || opening.filling < -1 || opening.filling >= count)
      throw_internal(*this, "an opening belongs to no element of the model");
    if (std::abs(opening.normal.norm() - 1.0) > 1e-6)
      throw_internal(*this, "an opening's normal is not of unit length");
  }
}

}  // namespace limen
