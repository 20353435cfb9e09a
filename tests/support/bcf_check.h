// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// What the BIM Collaboration Format 2.1 (buildingSMART) asks of a file, as rules: which elements stand in
// which, in what order and how often, and what their words and attributes may be.
#pragma once

#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "limen/files/zip.h"

namespace limen {

/// An element within another: how often it may stand there, and its type.
struct BcfChild {
  std::string name;
  int least = 0;
  int most = 1;  ///< -1: any number
  std::string type;
};

struct BcfAttribute {
  std::string name;
  bool required = false;
  std::string type;
};

/// Elements within, in their order; or words of a plain type where there are none.
struct BcfType {
  std::vector<BcfChild> children;
  std::vector<BcfAttribute> attributes;
};

/// The rules of markup.bcf and viewpoint.bcfv, as far as their parts are in use.
inline const std::map<std::string, BcfType>& bcf_types() {
  static const std::vector<BcfChild> kXyz = {
      {"X", 1, 1, "double"}, {"Y", 1, 1, "double"}, {"Z", 1, 1, "double"}};
  static const std::map<std::string, BcfType> kTypes = {
      {"Version", {{{"DetailedVersion", 0, 1, "string"}}, {{"VersionId", true, "version"}}}},
      {"Markup",
       {{{"Header", 0, 1, "Header"},
         {"Topic", 1, 1, "Topic"},
         {"Comment", 0, -1, "Comment"},
         {"Viewpoints", 0, -1, "ViewPoint"}},
        {}}},
      {"Header", {{{"File", 1, -1, "File"}}, {}}},
      {"File",
       {{{"Filename", 0, 1, "string"}, {"Date", 0, 1, "dateTime"}, {"Reference", 0, 1, "string"}},
        {{"IfcProject", false, "ifcGuid"},
         {"IfcSpatialStructureElement", false, "ifcGuid"},
         {"IsExternal", false, "boolean"}}}},
      {"ViewPoint",
       {{{"Viewpoint", 0, 1, "string"}, {"Snapshot", 0, 1, "string"}, {"Index", 0, 1, "int"}},
        {{"Guid", true, "guid"}}}},
      {"Topic",
       {{{"ReferenceLink", 0, -1, "string"},
         {"Title", 1, 1, "filled"},
         {"Priority", 0, 1, "string"},
         {"Index", 0, 1, "int"},
         {"Labels", 0, -1, "string"},
         {"CreationDate", 1, 1, "dateTime"},
         {"CreationAuthor", 1, 1, "filled"},
         {"ModifiedDate", 0, 1, "dateTime"},
         {"ModifiedAuthor", 0, 1, "string"},
         {"DueDate", 0, 1, "dateTime"},
         {"AssignedTo", 0, 1, "string"},
         {"Stage", 0, 1, "string"},
         {"Description", 0, 1, "string"}},
        {{"Guid", true, "guid"}, {"TopicType", false, "string"}, {"TopicStatus", false, "string"}}}},
      {"Comment",
       {{{"Date", 1, 1, "dateTime"}, {"Author", 1, 1, "filled"}, {"Comment", 1, 1, "string"}},
        {{"Guid", true, "guid"}}}},
      {"VisualizationInfo",
       {{{"Components", 0, 1, "Components"},
         {"OrthogonalCamera", 0, 1, "OrthogonalCamera"},
         {"PerspectiveCamera", 0, 1, "PerspectiveCamera"},
         {"Lines", 0, 1, "Lines"}},
        {{"Guid", true, "guid"}}}},
      {"Components",
       {{{"Selection", 0, 1, "ComponentList"},
         {"Visibility", 1, 1, "Visibility"},
         {"Coloring", 0, 1, "Coloring"}},
        {}}},
      {"ComponentList", {{{"Component", 1, -1, "Component"}}, {}}},
      {"Component",
       {{{"OriginatingSystem", 0, 1, "string"}, {"AuthoringToolId", 0, 1, "string"}},
        {{"IfcGuid", false, "ifcGuid"}}}},
      {"Visibility", {{{"Exceptions", 0, 1, "ComponentList"}}, {{"DefaultVisibility", false, "boolean"}}}},
      {"Coloring", {{{"Color", 1, -1, "Color"}}, {}}},
      {"Color", {{{"Component", 1, -1, "Component"}}, {{"Color", false, "colour"}}}},
      {"PerspectiveCamera",
       {{{"CameraViewPoint", 1, 1, "Xyz"},
         {"CameraDirection", 1, 1, "Xyz"},
         {"CameraUpVector", 1, 1, "Xyz"},
         {"FieldOfView", 1, 1, "fieldOfView"}},
        {}}},
      {"Xyz", {kXyz, {}}},
      {"Lines", {{{"Line", 1, -1, "Line"}}, {}}},
      {"Line", {{{"StartPoint", 1, 1, "Xyz"}, {"EndPoint", 1, 1, "Xyz"}}, {}}},
  };
  return kTypes;
}

/// Whether words are of a plain type.
inline bool is_bcf_word(const std::string& text, const std::string& type) {
  static const std::map<std::string, std::regex> kForms = {
      {"filled", std::regex("[^]*\\S[^]*")},
      {"int", std::regex("[+-]?[0-9]{1,9}")},
      {"double", std::regex("[+-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+-]?[0-9]+)?")},
      {"boolean", std::regex("true|false|0|1")},
      {"version", std::regex("2\\.1")},
      {"dateTime",
       std::regex("[0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])T([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9]"
                  "(\\.[0-9]+)?(Z|[+-][0-9]{2}:[0-9]{2})?")},
      {"guid", std::regex("[a-f0-9]{8}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{12}")},
      {"ifcGuid", std::regex("[0-9A-Za-z_$]{22}")},
      {"colour", std::regex("[0-9A-F]{6}([0-9A-F]{2})?")}};
  if (type == "string") return true;
  if (type == "fieldOfView") {
    const double degrees = std::atof(text.c_str());
    return is_bcf_word(text, "double") && degrees >= 45.0 && degrees <= 60.0;
  }
  const auto form = kForms.find(type);
  return form != kForms.end() && std::regex_match(text, form->second);
}

/// What is wrong with an element, by its type; `where` is its path.
inline void find_bcf_faults(const pugi::xml_node& node, const std::string& type, const std::string& where,
                            std::vector<std::string>& faults) {
  const auto rules = bcf_types().find(type);
  if (rules == bcf_types().end()) {
    if (!is_bcf_word(node.text().get(), type))
      faults.push_back(where + " is no " + type + ": " + node.text().get());
    if (node.find_child([](const pugi::xml_node& child) { return child.type() == pugi::node_element; }))
      faults.push_back(where + " holds elements");
    return;
  }
  std::set<std::string> known;
  for (const BcfAttribute& attribute : rules->second.attributes) {
    known.insert(attribute.name);
    const pugi::xml_attribute found = node.attribute(attribute.name.c_str());
    if (!found && attribute.required) faults.push_back(where + " lacks " + attribute.name);
    if (found && !is_bcf_word(found.value(), attribute.type))
      faults.push_back(where + " " + attribute.name + " is no " + attribute.type + ": " + found.value());
  }
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    if (known.count(attribute.name()) == 0) faults.push_back(where + " has an attribute " + attribute.name());
  }
  // A sequence: each rule takes what it can, what is left over is out of place.
  pugi::xml_node child = node.first_child();
  for (const BcfChild& rule : rules->second.children) {
    int count = 0;
    for (; child && rule.name == child.name(); child = child.next_sibling()) {
      ++count;
      find_bcf_faults(child, rule.type, where + "/" + rule.name, faults);
    }
    if (count < rule.least || (rule.most >= 0 && count > rule.most))
      faults.push_back(where + " has " + std::to_string(count) + " of " + rule.name);
  }
  if (child) faults.push_back(where + " has " + child.name() + " out of place");
}

/// The members of an archive by their names.
inline std::map<std::string, std::string> bcf_members(std::string_view bytes) {
  std::map<std::string, std::string> files;
  for (const ZipMember& member : zip_members(bytes))
    files[member.name] = unpacked(bytes, member, "bcf", 100000000);
  return files;
}

inline std::vector<std::string> bcf_faults_of_document(const std::string& text, const std::string& root,
                                                       const std::string& name) {
  std::vector<std::string> faults;
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return {name + " is no XML"};
  if (root != document.document_element().name()) return {name + " does not hold " + root};
  find_bcf_faults(document.document_element(), root, name, faults);
  return faults;
}

/// Everything that is wrong with a BCF file of version 2.1; nothing: it is one.
inline std::vector<std::string> bcf_faults(std::string_view bytes) {
  const std::map<std::string, std::string> files = bcf_members(bytes);
  std::vector<std::string> faults;
  const auto take = [&faults](const std::vector<std::string>& more) {
    faults.insert(faults.end(), more.begin(), more.end());
  };
  if (files.count("bcf.version") == 0) return {"there is no bcf.version"};
  take(bcf_faults_of_document(files.at("bcf.version"), "Version", "bcf.version"));
  std::set<std::string> guids;
  for (const auto& [name, text] : files) {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) continue;
    const std::string folder = name.substr(0, slash);
    if (!is_bcf_word(folder, "guid")) faults.push_back("the folder " + folder + " is no GUID");
    if (files.count(folder + "/markup.bcf") == 0) faults.push_back(folder + " has no markup.bcf");
    if (name != folder + "/markup.bcf") continue;
    take(bcf_faults_of_document(text, "Markup", name));
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size());
    const pugi::xml_node markup = document.child("Markup");
    if (folder != markup.child("Topic").attribute("Guid").value())
      faults.push_back(name + " is of another topic");
    for (const pugi::xml_node& view : markup.children("Viewpoints")) {
      const std::string guid = view.attribute("Guid").value();
      if (!guids.insert(guid).second) faults.push_back(guid + " is there twice");
      const auto file = files.find(folder + "/" + view.child("Viewpoint").text().get());
      if (file == files.end()) {
        faults.push_back(name + " names a viewpoint that is not there");
        continue;
      }
      take(bcf_faults_of_document(file->second, "VisualizationInfo", file->first));
      pugi::xml_document seen;
      seen.load_buffer(file->second.data(), file->second.size());
      if (guid != seen.child("VisualizationInfo").attribute("Guid").value())
        faults.push_back(file->first + " has another GUID than its topic says");
    }
  }
  return faults;
}

}  // namespace limen
