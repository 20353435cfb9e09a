// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/deviation/deviation_issues.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/model/scan.h"

namespace limen {
namespace {

constexpr double kSureSigmas = 3.0;
constexpr double kNearestViewM = 0.7;  // of a scanner to what is looked at

/// Extent of each element, world of the elements.
std::vector<Extent> extents_of(const BimModel& model) {
  std::vector<Extent> extents(model.elements.size(), {Vector3d::Constant(1e300), Vector3d::Constant(-1e300)});
  for (const BimFace& face : model.faces) {
    Extent& extent = extents[static_cast<std::size_t>(face.element)];
    for (const Vector2d& p : face.outline.outer) {
      const Vector3d x = model.local_origin + face.frame.to_space(p);
      extent.low = extent.low.cwiseMin(x);
      extent.high = extent.high.cwiseMax(x);
    }
  }
  return extents;
}

/// From the scanner that stood nearest, but not inside what is looked at; else from above and aside.
BcfCamera view_of(const Extent& extent, const std::vector<Vector3d>& scanners) {
  const Vector3d middle = 0.5 * (extent.low + extent.high);
  const Vector3d* best = nullptr;
  double nearest = 0.0;
  for (const Vector3d& place : scanners) {
    const double distance = (place - place.cwiseMax(extent.low).cwiseMin(extent.high)).norm();
    if (distance < kNearestViewM || (best != nullptr && distance >= nearest)) continue;
    best = &place;
    nearest = distance;
  }
  if (best != nullptr) return looking_at(*best, middle);
  const double away = 1.0 + 1.5 * (extent.high - extent.low).norm();
  return looking_at(middle + away * Vector3d(-0.6, -0.6, 0.5), middle);
}

/// Into the coordinates of the file that a viewer opens.
void bring_into_file(BcfTopic& topic, const IssueModel& model) {
  const auto place = [&](const Vector3d& x) {
    return Vector3d((model.file_from_elements * x) / model.scale);
  };
  topic.camera.place = place(topic.camera.place);
  topic.camera.direction = model.file_from_elements.rotation * topic.camera.direction;
  topic.camera.up = model.file_from_elements.rotation * topic.camera.up;
  for (auto& [from, to] : topic.lines) {
    from = place(from);
    to = place(to);
  }
  topic.model = model.file;
}

std::string name_of(const BimElement& element) {
  return element.name.empty() ? element.type : element.name;
}

std::string storey_words(const BimElement& element) {
  return element.storey.empty() ? std::string() : fmt::format(" Storey: {}.", element.storey);
}

/// Millimetres along the axes, only where something was seen.
std::string shift_words(const ElementShift& shift) {
  std::string text = fmt::format(
      "It is displaced by ({:.0f}, {:.0f}, {:.0f}) mm from its position in the model",
      1e3 * shift.shift_m.x() + 0.0, 1e3 * shift.shift_m.y() + 0.0, 1e3 * shift.shift_m.z() + 0.0);
  text += fmt::format(", one standard deviation ({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * shift.sigma_m.x(),
                      1e3 * shift.sigma_m.y(), 1e3 * shift.sigma_m.z());
  if (!shift.open.empty()) text += fmt::format("; {} of 3 directions were not seen", shift.open.size());
  return text + ".";
}

BcfTopic element_topic(const BimElement& element, const ElementDeviation& it) {
  BcfTopic topic;
  topic.ifc_guid = element.guid;
  const std::string name = name_of(element);
  const std::string storey = storey_words(element);
  // A mesh has no GUID; its number identifies it.
  const std::string who = element.guid.empty() ? fmt::format("{} {}", it.element, name) : element.guid;
  if (it.presence == Presence::not_found) {
    topic.label = "missing";
    topic.priority = "high";
    topic.colour = "D02020";
    const bool has_leaf = element.kind == BimKind::door || element.kind == BimKind::window;
    topic.title = fmt::format("{}: {}", has_leaf ? "Missing, or open" : "Missing", name);
    topic.description = fmt::format(
        "{} {} of the model was not found{}: the scanner saw through {:.2f} m2 of its surface, and points "
        "lie "
        "on {:.2f} m2.{}",
        element.type, name, has_leaf ? ", or its leaf was open" : "", it.passed_m2, it.covered_m2, storey);
  } else {
    topic.label = "moved";
    topic.priority = "medium";
    topic.colour = "E07000";
    topic.title = fmt::format("Moved by {:.0f} mm: {}", 1e3 * it.shift.shift_m.norm(), name);
    topic.description = fmt::format(
        "{} {}. {} Median of the distances {:.1f} mm, 95 % within {:.1f} mm, {} points.{}", element.type,
        name, shift_words(it.shift), 1e3 * it.median_m, 1e3 * it.p95_m, it.points, storey);
  }
  topic.key = fmt::format("limen deviation\n{}\n{}", topic.label, who);
  return topic;
}

BcfTopic unmodelled_topic(const UnmodelledObject& piece, const BimModel& model, const IssueInputs& inputs) {
  const Extent extent{model.local_origin + piece.low, model.local_origin + piece.high};
  const Vector3d size = piece.high - piece.low;
  const Vector3d middle = model.local_origin + piece.centre;
  BcfTopic topic;
  topic.label = "not in the model";
  topic.priority = "low";
  topic.title = fmt::format("Not in the model: {:.1f} x {:.1f} x {:.1f} m", size.x(), size.y(), size.z());
  topic.description = fmt::format(
      "{} points of an object of {:.2f} x {:.2f} x {:.2f} m at ({:.2f}, {:.2f}, {:.2f}) lie on no element of "
      "the model.",
      piece.points, size.x(), size.y(), size.z(), middle.x(), middle.y(), middle.z());
  topic.key =
      fmt::format("limen deviation\nmatter\n{:.2f} {:.2f} {:.2f}", middle.x(), middle.y(), middle.z());
  topic.lines = edges_of(extent.low, extent.high);
  topic.camera = view_of(extent, inputs.scanners);
  bring_into_file(topic, inputs.models.front());
  return topic;
}

}  // namespace

void IssueOptions::check() const {
  if (!(moved_m > 0.0)) throw_bad_option("moved_m", moved_m, "more than 0");
  if (!(matter_m > 0.0)) throw_bad_option("matter_m", matter_m, "more than 0");
}

double off_m(const ElementDeviation& it) {
  return it.shift.held > 0 ? it.shift.shift_m.norm() : std::abs(it.median_m);
}

bool has_moved(const ElementDeviation& it, double moved_m) {
  const double shift = it.shift.shift_m.norm();
  if (it.presence != Presence::found || it.shift.held == 0 || shift <= moved_m) return false;
  // Along the shift, as if the deviations along the axes were all of it at once: on the safe side.
  const double sigma = it.shift.shift_m.cwiseAbs().dot(it.shift.sigma_m) / shift;
  return shift > kSureSigmas * sigma;
}

std::vector<std::size_t> worst_first(const std::vector<ElementDeviation>& elements) {
  std::vector<std::size_t> order(elements.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto badness = [&](std::size_t k) -> std::pair<int, double> {
    const ElementDeviation& it = elements[k];
    if (it.presence == Presence::not_found) return {2, it.passed_m2};
    if (it.presence == Presence::found) return {1, off_m(it)};
    return {0, 0.0};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return badness(a) > badness(b); });
  return order;
}

std::vector<BcfTopic> deviation_issues(const IssueInputs& inputs, const IssueOptions& options) {
  options.check();
  const std::vector<Extent> extents = extents_of(inputs.model);
  std::vector<BcfTopic> topics;
  for (const std::size_t k : worst_first(inputs.elements)) {
    const ElementDeviation& it = inputs.elements[k];
    if (it.presence != Presence::not_found && !has_moved(it, options.moved_m)) continue;
    BcfTopic topic = element_topic(inputs.model.elements[k], it);
    topic.camera = view_of(extents[k], inputs.scanners);
    const std::int32_t model = inputs.model_of_element.empty() ? 0 : inputs.model_of_element[k];
    bring_into_file(topic, inputs.models[static_cast<std::size_t>(model)]);
    topics.push_back(std::move(topic));
  }
  for (const UnmodelledObject& piece : inputs.unmodelled) {
    if (piece.within_model && (piece.high - piece.low).maxCoeff() >= options.matter_m)
      topics.push_back(unmodelled_topic(piece, inputs.model, inputs));
  }
  return topics;
}

}  // namespace limen
