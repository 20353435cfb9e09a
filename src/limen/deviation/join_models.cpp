// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/join_models.h"

#include <set>

namespace limen {
namespace {

BimFace moved_face(const BimFace& face, const Rigid3& pose) {
  BimFace moved = face;
  moved.plane = transformed(pose, face.plane);
  moved.frame.origin = pose * face.frame.origin;
  moved.frame.u = pose.rotation * face.frame.u;
  moved.frame.v = pose.rotation * face.frame.v;
  return moved;
}

}  // namespace

JoinedModel join_models(const std::vector<PlacedModel>& models) {
  JoinedModel joined;
  std::set<std::string> known;  // of the models before
  for (std::size_t k = 0; k < models.size(); ++k) {
    const BimModel& model = models[k].model;
    if (k == 0) {
      joined.model = model;
      joined.model.elements.clear();
      joined.model.faces.clear();
      joined.model.openings.clear();
      joined.model.spaces.clear();
    }
    const Rigid3 pose = to_local(models[k].first_from_model, model.local_origin, joined.model.local_origin);
    std::vector<std::int32_t> place(model.elements.size(), -1);  // among all; -1: an earlier model has it
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
      const BimElement& element = model.elements[e];
      if (!element.guid.empty() && known.count(element.guid) > 0) {
        ++joined.doubled;
        continue;
      }
      place[e] = static_cast<std::int32_t>(joined.model.elements.size());
      joined.model.elements.push_back(element);
      joined.model_of_element.push_back(static_cast<std::int32_t>(k));
    }
    for (const BimFace& face : model.faces) {
      const std::int32_t element = place[static_cast<std::size_t>(face.element)];
      if (element < 0) continue;
      joined.model.faces.push_back(k == 0 ? face : moved_face(face, pose));
      joined.model.faces.back().element = element;
    }
    for (const BimFace& face : model.faces) {
      const std::string& guid = model.elements[static_cast<std::size_t>(face.element)].guid;
      if (!guid.empty()) known.insert(guid);
    }
  }
  return joined;
}

}  // namespace limen
