// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/bcf/bcf_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "limen/base/version.h"
#include "limen/files/file_hash.h"
#include "limen/files/xml_text.h"
#include "limen/files/zip.h"

namespace limen {
namespace {

constexpr const char* kFieldOfView = "60";  // degrees: the standard allows 45 to 60
constexpr std::size_t kIfcGuidLength = 22;

/// A GUID made of a text (RFC 4122: version 5 in form, its hash SHA-256).
std::string guid_of(const std::string& key) {
  std::string hex = sha256_of(key).substr(0, 32);
  hex[12] = '5';
  hex[16] = "89ab"[static_cast<std::size_t>(hex[16] >= 'a' ? hex[16] - 'a' + 10 : hex[16] - '0') % 4];
  return hex.substr(0, 8) + "-" + hex.substr(8, 4) + "-" + hex.substr(12, 4) + "-" + hex.substr(16, 4) + "-" +
         hex.substr(20);
}

void add_point(pugi::xml_node node, const Vector3d& x) {
  const char* names[] = {"X", "Y", "Z"};
  for (Eigen::Index k = 0; k < 3; ++k) add_text(node, names[k], fmt::format("{}", x[k] + 0.0));
}

bool is_ifc_guid(const std::string& guid) {
  return guid.size() == kIfcGuidLength && std::all_of(guid.begin(), guid.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '$';
         });
}

std::string version_text() {
  pugi::xml_document document = begun_xml();
  pugi::xml_node version = document.append_child("Version");
  version.append_attribute("VersionId") = "2.1";
  add_text(version, "DetailedVersion", "2.1");
  return xml_text(document);
}

/// What tells the viewpoint's GUID from the topic's.
std::string view_key(const BcfTopic& topic) {
  return topic.key + "\nview";
}

std::string markup_text(const BcfTopic& topic, std::size_t number, const std::string& date) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node markup = document.append_child("Markup");
  if (!topic.model.empty()) {
    pugi::xml_node file = markup.append_child("Header").append_child("File");
    file.append_attribute("IsExternal") = "true";
    add_text(file, "Filename", topic.model);
  }
  pugi::xml_node node = markup.append_child("Topic");
  node.append_attribute("Guid") = guid_of(topic.key).c_str();
  node.append_attribute("TopicType") = "Issue";
  node.append_attribute("TopicStatus") = "Open";
  add_text(node, "Title", topic.title);
  if (!topic.priority.empty()) add_text(node, "Priority", topic.priority);
  add_text(node, "Index", fmt::format("{}", number));
  if (!topic.label.empty()) add_text(node, "Labels", topic.label);
  add_text(node, "CreationDate", date);
  add_text(node, "CreationAuthor", fmt::format("limen {}", kVersion));
  add_text(node, "Description", topic.description);
  pugi::xml_node view = markup.append_child("Viewpoints");
  view.append_attribute("Guid") = guid_of(view_key(topic)).c_str();
  add_text(view, "Viewpoint", "viewpoint.bcfv");
  return xml_text(document);
}

void add_component(pugi::xml_node parent, const std::string& guid) {
  parent.append_child("Component").append_attribute("IfcGuid") = guid.c_str();
}

std::string view_text(const BcfTopic& topic) {
  pugi::xml_document document = begun_xml();
  pugi::xml_node view = document.append_child("VisualizationInfo");
  view.append_attribute("Guid") = guid_of(view_key(topic)).c_str();
  pugi::xml_node components = view.append_child("Components");
  const bool named = is_ifc_guid(topic.ifc_guid);
  if (named) add_component(components.append_child("Selection"), topic.ifc_guid);
  components.append_child("Visibility").append_attribute("DefaultVisibility") = "true";
  if (named && !topic.colour.empty()) {
    pugi::xml_node colour = components.append_child("Coloring").append_child("Color");
    colour.append_attribute("Color") = topic.colour.c_str();
    add_component(colour, topic.ifc_guid);
  }
  pugi::xml_node camera = view.append_child("PerspectiveCamera");
  add_point(camera.append_child("CameraViewPoint"), topic.camera.place);
  add_point(camera.append_child("CameraDirection"), topic.camera.direction);
  add_point(camera.append_child("CameraUpVector"), topic.camera.up);
  add_text(camera, "FieldOfView", kFieldOfView);
  if (!topic.lines.empty()) {
    pugi::xml_node lines = view.append_child("Lines");
    for (const auto& [from, to] : topic.lines) {
      pugi::xml_node line = lines.append_child("Line");
      add_point(line.append_child("StartPoint"), from);
      add_point(line.append_child("EndPoint"), to);
    }
  }
  return xml_text(document);
}

}  // namespace

BcfCamera looking_at(const Vector3d& place, const Vector3d& aim) {
  constexpr double kNearest = 0.3;    // metres
  constexpr double kSteepest = 0.98;  // cosine to the vertical
  BcfCamera camera;
  camera.place = place;
  Vector3d direction = aim - place;
  if (direction.norm() < kNearest || std::abs(direction.normalized().z()) > kSteepest) {
    camera.place += Vector3d(-1.0, -1.0, 0.5);
    direction = aim - camera.place;
  }
  camera.direction = direction.normalized();
  camera.up = (Vector3d::UnitZ() - camera.direction.z() * camera.direction).normalized();
  return camera;
}

std::vector<std::pair<Vector3d, Vector3d>> edges_of(const Vector3d& low, const Vector3d& high) {
  const auto corner = [&](unsigned k) {
    return Vector3d((k & 1U) != 0 ? high.x() : low.x(), (k & 2U) != 0 ? high.y() : low.y(),
                    (k & 4U) != 0 ? high.z() : low.z());
  };
  std::vector<std::pair<Vector3d, Vector3d>> edges;
  for (unsigned k = 0; k < 8; ++k) {
    for (unsigned axis = 1; axis < 8; axis *= 2) {
      if ((k & axis) == 0) edges.emplace_back(corner(k), corner(k | axis));
    }
  }
  return edges;
}

std::string bcf_file(const std::vector<BcfTopic>& topics, const std::string& date) {
  std::vector<ZipFile> files = {{"bcf.version", version_text()}};
  for (std::size_t k = 0; k < topics.size(); ++k) {
    const std::string folder = guid_of(topics[k].key) + "/";
    files.push_back({folder + "markup.bcf", markup_text(topics[k], k + 1, date)});
    files.push_back({folder + "viewpoint.bcfv", view_text(topics[k])});
  }
  return zipped(files);
}

}  // namespace limen
