// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/model_info.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/model/plausible_size.h"

namespace limen {
namespace {

/// A face of a room that looks down like this is floor: normals point out of the room.
constexpr double kDownwards = -0.9;

struct Sum {
  std::size_t elements = 0;
  std::size_t faces = 0;
  double area_m2 = 0.0;
};

Json json_of_kinds(const BimModel& model) {
  std::map<BimKind, Sum> sums;
  for (const BimElement& element : model.elements) ++sums[element.kind].elements;
  for (const BimFace& face : model.faces) {
    Sum& sum = sums[model.elements[static_cast<std::size_t>(face.element)].kind];
    ++sum.faces;
    sum.area_m2 += face.area_m2;
  }
  Json json = Json::array();
  for (const auto& [kind, sum] : sums) {
    Json entry;
    entry["kind"] = to_string(kind);
    entry["elements"] = sum.elements;
    entry["faces"] = sum.faces;
    entry["area_m2"] = sum.area_m2;
    json.push_back(entry);
  }
  return json;
}

/// Storeys in the order of the file, with what each holds.
Json json_of_storeys(const BimModel& model) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> elements;
  std::map<std::string, std::size_t> rooms;
  const auto note = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const BimElement& element : model.elements) {
    note(element.storey);
    ++elements[element.storey];
  }
  for (const BimSpace& space : model.spaces) {
    note(space.storey);
    ++rooms[space.storey];
  }
  Json json = Json::array();
  for (const std::string& name : names) {
    Json entry;
    entry["name"] = name;
    entry["elements"] = elements[name];
    entry["rooms"] = rooms[name];
    json.push_back(entry);
  }
  return json;
}

Json json_of_openings(const BimModel& model) {
  std::size_t windows = 0;
  std::size_t doors = 0;
  for (const BimOpening& opening : model.openings) {
    if (opening.filling < 0) continue;
    const BimKind kind = model.elements[static_cast<std::size_t>(opening.filling)].kind;
    windows += kind == BimKind::window ? 1 : 0;
    doors += kind == BimKind::door ? 1 : 0;
  }
  Json json;
  json["count"] = model.openings.size();
  json["with_window"] = windows;
  json["with_door"] = doors;
  return json;
}

Json json_of_rooms(const BimModel& model) {
  Json json = Json::array();
  for (const BimSpace& space : model.spaces) {
    double floor = 0.0;
    for (const BimFace& face : space.faces) {
      if (face.plane.normal.z() < kDownwards) floor += face.area_m2;
    }
    Json entry;
    entry["name"] = space.name;
    entry["storey"] = space.storey;
    entry["guid"] = space.guid;
    entry["floor_m2"] = floor;
    json.push_back(entry);
  }
  return json;
}

std::string extent_text(const Json& model) {
  const auto side = [&](std::size_t k) {
    return model["high"][k].get<double>() - model["low"][k].get<double>();
  };
  return fmt::format("from            {}\nto              {}\nsize            {:.3f} x {:.3f} x {:.3f} m\n",
                     point_text(model["low"]), point_text(model["high"]), side(0), side(1), side(2));
}

std::string name_text(const Json& name) {
  return name.get<std::string>().empty() ? "(no name)" : name.get<std::string>();
}

/// Rooms of a large building are counted, not listed.
std::string rooms_text(const Json& rooms) {
  constexpr std::size_t kMostListed = 30;
  std::string text = fmt::format("rooms           {}\n", rooms.size());
  if (rooms.size() > kMostListed) return text;
  for (const Json& room : rooms)
    text += fmt::format("  {:<24} {:>9.2f} m2  {}\n", name_text(room["name"]), room["floor_m2"].get<double>(),
                        room["storey"].get<std::string>());
  return text;
}

}  // namespace

std::string point_text(const Json& point) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", point[0].get<double>(), point[1].get<double>(),
                     point[2].get<double>());
}

Json json_of_model(const std::string& path, const BimModel& model) {
  std::vector<Vector3d> corners;
  for (const BimFace& face : model.faces) {
    for (const Vector2d& p : face.outline.outer) corners.push_back(face.frame.to_space(p));
  }
  Vector3d low = corners.empty() ? Vector3d::Zero() : corners.front();
  Vector3d high = low;
  for (const Vector3d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  Json json;
  json["file"] = path;
  json["format"] = model.schema;
  json["metres_per_unit"] = model.metres_per_unit;
  json["georeferenced"] = model.georeferenced;
  json["low"] = json_of(Vector3d(model.local_origin + low));
  json["high"] = json_of(Vector3d(model.local_origin + high));
  json["local_origin"] = json_of(model.local_origin);
  json["elements"] = model.elements.size();
  json["faces"] = model.faces.size();
  json["kinds"] = json_of_kinds(model);
  json["storeys"] = json_of_storeys(model);
  json["openings"] = json_of_openings(model);
  json["rooms"] = json_of_rooms(model);
  json["warnings"] = model.warnings;
  if (const std::string remark = offset_remark(offset_of_model(path, model)); !remark.empty())
    json["warnings"].push_back(remark);
  if (const std::string hint = axes_hint(model); !hint.empty()) json["warnings"].push_back(hint);
  return json;
}

std::string text_of_model(const Json& model) {
  std::string text = fmt::format("file            {}\nformat          {}\nunit            {:g} m\n",
                                 model["file"].get<std::string>(), model["format"].get<std::string>(),
                                 model["metres_per_unit"].get<double>());
  text +=
      fmt::format("coordinates     {}\n", model["georeferenced"].get<bool>() ? "of a map" : "the file's own");
  text += extent_text(model);
  text += fmt::format("elements        {} with {} faces\n", model["elements"].get<std::size_t>(),
                      model["faces"].get<std::size_t>());
  for (const Json& kind : model["kinds"])
    text += fmt::format("  {:<13} {:>6} {:>12.2f} m2\n", kind["kind"].get<std::string>(),
                        kind["elements"].get<std::size_t>(), kind["area_m2"].get<double>());
  text += fmt::format("storeys         {}\n", model["storeys"].size());
  for (const Json& storey : model["storeys"])
    text += fmt::format("  {:<24} {} elements, {} rooms\n", name_text(storey["name"]),
                        storey["elements"].get<std::size_t>(), storey["rooms"].get<std::size_t>());
  const Json& openings = model["openings"];
  text += fmt::format("openings        {}: {} with a window, {} with a door\n",
                      openings["count"].get<std::size_t>(), openings["with_window"].get<std::size_t>(),
                      openings["with_door"].get<std::size_t>());
  text += rooms_text(model["rooms"]);
  for (const Json& warning : model["warnings"])
    text += fmt::format("warning         {}\n", warning.get<std::string>());
  return text;
}

}  // namespace limen
