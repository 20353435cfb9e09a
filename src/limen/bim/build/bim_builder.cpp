// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/build/bim_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/bim/build/opening_boxes.h"
#include "limen/bim/solid/solid_faces.h"
#include "limen/io/table/scan_builder.h"

namespace limen {
namespace {

constexpr double kLargestBuilding_m = 1000.0;
constexpr double kSmallestBuilding_m = 1.0;

void question_size(const Box3& box, BimModel& model) {
  const double side = (box.high - box.low).maxCoeff();
  if (side >= kSmallestBuilding_m && side <= kLargestBuilding_m) return;
  model.warnings.push_back(fmt::format(
      "the model measures {:.4g} m from end to end, {} for a building: the length unit in the file "
      "(1 unit = {:.6g} m) is questionable",
      side, side > kLargestBuilding_m ? "much" : "little", model.metres_per_unit));
}

/// One box of all shapes of all elements.
Box3 box_of(const std::vector<RawElement>& elements) {
  Box3 box;
  for (const RawElement& element : elements) {
    for (const Solid& shape : element.shapes) {
      const Box3 part = limen::box_of(shape);
      if (part.empty()) continue;
      box.add(part.low);
      box.add(part.high);
    }
  }
  return box;
}

void move_all(RawModel& raw, const Vector3d& shift) {
  const auto move_shapes = [&](std::vector<Solid>& shapes) {
    for (Solid& shape : shapes) move(shape, 1.0, shift);
  };
  for (RawElement& element : raw.elements) move_shapes(element.shapes);
  for (RawOpening& opening : raw.openings) move_shapes(opening.shapes);
  for (RawSpace& space : raw.spaces) move_shapes(space.shapes);
}

/// The openings' solids, by the element they are cut out of.
std::vector<std::vector<const Solid*>> cutters_of(const RawModel& raw) {
  std::vector<std::vector<const Solid*>> cutters(raw.elements.size());
  for (const RawOpening& opening : raw.openings) {
    for (const std::int32_t host : opening.hosts) {
      for (const Solid& shape : opening.shapes) cutters[static_cast<std::size_t>(host)].push_back(&shape);
    }
  }
  return cutters;
}

/// What became of one element or room.
struct BuiltElement {
  std::vector<BimFace> faces;
  std::string warning;
};

BuiltElement outcome_of(const std::vector<Solid>& shapes, const std::vector<const Solid*>& cutters) {
  BuiltElement outcome;
  try {
    SolidFaces made = solid_faces(shapes, cutters);
    outcome.faces = std::move(made.faces);
    if (made.open_cutters > 0)
      outcome.warning =
          fmt::format("{} of its solids are not closed: sides of openings may be missing", made.open_cutters);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    outcome.warning = fmt::format("its surface could not be made ({})", error.problem());
  }
  return outcome;
}

/// Makes all faces, elements on all threads, and takes them in the elements' order.
template <typename Raw, typename Cutters, typename Take>
void make_faces(const std::vector<Raw>& raw, const Cutters& cutters, Monitor& monitor, const Take& take) {
  std::vector<BuiltElement> outcomes(raw.size());
  parallel_for(raw.size(), 1, [&](std::size_t begin, std::size_t end) {
    monitor.throw_if_cancelled();
    for (std::size_t i = begin; i < end; ++i) outcomes[i] = outcome_of(raw[i].shapes, cutters(i));
  });
  for (std::size_t i = 0; i < raw.size(); ++i) take(i, outcomes[i]);
}

std::string name_of(const BimElement& element) {
  return fmt::format("#{} {}{}", element.file_id, element.type,
                     element.name.empty() ? "" : " " + element.name);
}

}  // namespace

BimModel built(RawModel raw, Monitor& monitor) {
  BimModel model = std::move(raw.head);
  const Box3 box = box_of(raw.elements);
  const auto why = [&] { return model.warnings.empty() ? "" : ": " + model.warnings.front(); };
  if (box.empty()) {
    throw Error("the model has no surface" + why(), model.name,
                "export it with its geometry (IFC with shape representations, OBJ or PLY with faces)");
  }
  question_size(box, model);
  model.local_origin = round_origin_near(0.5 * (box.low + box.high));
  move_all(raw, model.local_origin);

  for (const RawElement& element : raw.elements) model.elements.push_back(element.about);
  const auto cutters = cutters_of(raw);
  make_faces(
      raw.elements, [&](std::size_t i) { return cutters[i]; }, monitor,
      [&](std::size_t i, BuiltElement& outcome) {
        for (BimFace& face : outcome.faces) {
          face.element = static_cast<std::int32_t>(i);
          model.faces.push_back(std::move(face));
        }
        if (!outcome.warning.empty())
          model.warnings.push_back(name_of(model.elements[i]) + ": " + outcome.warning);
      });
  make_faces(
      raw.spaces, [](std::size_t) { return std::vector<const Solid*>{}; }, monitor,
      [&](std::size_t i, BuiltElement& outcome) {
        model.spaces.push_back(std::move(raw.spaces[i].about));
        model.spaces.back().faces = std::move(outcome.faces);
      });
  if (model.faces.empty())
    throw Error("the model's faces have no area" + why(), model.name, "check how it was exported");
  model.openings = opening_boxes(raw);
  model.check();
  return model;
}

}  // namespace limen
