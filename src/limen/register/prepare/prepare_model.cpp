// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_model.h"

#include <vector>

#include "limen/base/error.h"
#include "limen/sight/model_space.h"

namespace limen {

PreparedScan prepare_model(const BimModel& model, const ModelFeatureOptions& options, Monitor& monitor) {
  PreparedScan prepared;
  ModelFeatures made = model_features(model, options);
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
