// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_model.h"

#include <cmath>

#include "limen/base/error.h"
#include "limen/extract/model/model_features.h"
#include "limen/sight/model_space.h"

namespace limen {
namespace {

/// Whether an upward ray from `at` leaves the closed boundary an odd number of times.
bool inside(const BimSpace& room, const Vector3d& at) {
  // Not quite upright, so that it meets no upright face or edge along its length.
  const Vector3d ray = Vector3d(0.0123, 0.0071, 1.0).normalized();
  int crossed = 0;
  for (const BimFace& face : room.faces) {
    const double slope = face.plane.normal.dot(ray);
    if (std::abs(slope) < 1e-9) continue;
    const double range = -face.plane.signed_distance(at) / slope;
    if (range > 0 && contains(face.outline, face.frame.to_plane(at + range * ray))) ++crossed;
  }
  return crossed % 2 == 1;
}

}  // namespace

std::string room_at(const std::vector<BimSpace>& rooms, const Vector3d& at) {
  for (const BimSpace& room : rooms) {
    if (!inside(room, at)) continue;
    std::string name = room.name.empty() ? room.guid : room.name;
    if (!room.storey.empty()) name += ", " + room.storey;
    return name;
  }
  return {};
}

PreparedScan prepare_model(const BimModel& model, Monitor& monitor) {
  PreparedScan prepared;
  ModelFeatures made = model_features(model);
  prepared.extracted.features = std::move(made.features);
  // Nobody levels ground as it was drawn, and the street goes on beyond it: a ray from a window that passes
  // through it tells nothing. What a scan has of ground still finds it in the model.
  std::erase_if(prepared.extracted.features.samples, [&](const SurfaceSample& sample) {
    const std::int32_t element = made.elements[static_cast<std::size_t>(sample.plane)];
    return model.elements[static_cast<std::size_t>(element)].kind == BimKind::terrain;
  });
  monitor.throw_if_cancelled();
  if (prepared.extracted.features.planes.empty()) {
    throw Error("the model has no walls, slabs or other built surface", model.name,
                "give a model with geometry; `limen info` lists what it has");
  }
  prepared.space = std::make_unique<ModelSpace>(prepared.extracted.features);
  prepared.upright = prepared.surely_upright = true;
  prepared.model = true;
  prepared.rooms = model.spaces;
  prepared.settle_reach();
  return prepared;
}

}  // namespace limen
