// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/view/view_page.h"

#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/version.h"
#include "limen/extract/model/model_features.h"
#include "limen/report/html/html_data.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/html_residuals.h"
#include "limen/report/html/report_page.h"

namespace limen {
namespace {

std::string id_of(std::size_t side) {
  return fmt::format("side-{}", side);
}

/// "1 234 567": thin spaces, which no line breaks at.
std::string grouped_digits(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, "\u202f");
  return text;
}

std::string side_words(const ViewSide& side) {
  const SceneSide& scene = side.scene;
  if (scene.points.empty()) return fmt::format("model, {} planes", scene.pictured.features.planes.size());
  if (side.points_read <= scene.points.size()) return grouped_digits(side.points_read) + " points";
  return fmt::format("{} of {} points", grouped_digits(scene.points.size()),
                     grouped_digits(side.points_read));
}

std::string scene_of(const ViewScene& scene) {
  Json json = {{"origin", json_of(scene.origin)}, {"sides", Json::array()}};
  std::string blobs;
  for (std::size_t k = 0; k < scene.sides.size(); ++k) {
    const ViewSide& side = scene.sides[k];
    const QuantisedPoints points = quantised_side(side.scene);
    json["sides"].push_back(id_of(k));
    json[id_of(k)] = side_json(side.name, side.scene, points);
    json[id_of(k)]["about"] = side_words(side);
    if (!side.path.empty()) {
      json[id_of(k)]["path"] = side.path;
      json[id_of(k)]["file_from_frame"] = json_of(to_matrix(side.file_from_frame));
    }
    for (const ViewPicture& picture : side.pictures)
      json[id_of(k)]["pictures"].push_back(
          {{"at", json_of(picture.place)},
           {"src", fmt::format("data:{};base64,{}", picture.type, base64(picture.bytes))}});
    const bool planes = !side.scene.pictured.features.planes.empty();
    blobs += side_blobs(id_of(k), side.scene, points,
                        planes ? plane_of_points(side.scene) : std::vector<std::uint8_t>{});
  }
  return json_element(std::move(json)) + blobs;
}

void move_features(const Rigid3& moved_from_old, Features& features) {
  for (PlanarPolygon& plane : features.planes) {
    plane.frame.origin = moved_from_old * plane.frame.origin;
    plane.frame.u = moved_from_old.rotation * plane.frame.u;
    plane.frame.v = moved_from_old.rotation * plane.frame.v;
    plane.plane.normal = moved_from_old.rotation * plane.plane.normal;
    plane.plane.offset = plane.plane.normal.dot(plane.frame.origin);
    plane.oriented = false;  // seen from both sides
  }
  for (Opening& opening : features.openings) {
    for (Vector3d& corner : opening.corners) corner = moved_from_old * corner;
    for (Vector3d& corner : opening.outline) corner = moved_from_old * corner;
  }
  features.segments.clear();
}

}  // namespace

SceneSide view_of_model(const BimModel& model, const Rigid3& frame_from_model, const Vector3d& origin) {
  PicturedSide pictured;
  pictured.features = model_features(model).features;
  const Vector3d old_origin = pictured.features.local_origin;
  RegisterInput input;
  input.model = model;
  SceneSide side = with_picture(scene_side(input), pictured);
  const Rigid3 local = to_local(frame_from_model, old_origin, origin);
  for (Triangle3& face : side.faces) {
    for (Vector3d& corner : face) corner = local * corner;
  }
  move_features(local, side.pictured.features);
  side.origin = origin;
  return side;
}

std::string view_page(const ViewScene& scene) {
  const PageParts parts = {{"title", escaped(scene.title)},
                           {"style", std::string(report_style()) + std::string(view_style())},
                           {"version", kVersion},
                           {"scene", scene_of(scene)},
                           {"script", std::string(view_script())}};
  std::string page = filled_in(view_pattern(), parts);
  if (page.size() > kMostPageBytes) {
    throw Error(fmt::format("the page would have {} MB, but at most {} MB are possible",
                            page.size() / 1000000, kMostPageBytes / 1000000),
                "view", "show fewer points (--most-points) or fewer models");
  }
  return page;
}

}  // namespace limen
