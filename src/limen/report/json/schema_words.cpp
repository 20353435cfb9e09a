// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/schema_words.h"

#include <utility>

namespace limen::schema {

Json ref(const char* name) {
  return {{"$ref", std::string("#/$defs/") + name}};
}

Json nullable(const char* name) {
  return {{"anyOf", Json::array({ref(name), Json{{"type", "null"}}})}};
}

Json number(const char* description) {
  return {{"type", "number"}, {"description", description}};
}

Json number_or_null(const char* description) {
  return {{"type", {"number", "null"}}, {"description", description}};
}

Json whole(const char* description) {
  return {{"type", "integer"}, {"description", description}};
}

Json text(const char* description) {
  return {{"type", "string"}, {"description", description}};
}

Json flag(const char* description) {
  return {{"type", "boolean"}, {"description", description}};
}

Json words(std::initializer_list<const char*> all) {
  Json list = Json::array();
  for (const char* word : all) list.push_back(word);
  return {{"enum", list}};
}

Json list_of(const Json& items, const char* description) {
  return {{"type", "array"}, {"items", items}, {"description", description}};
}

Json numbers(int count, const char* description) {
  return {{"type", "array"},
          {"items", {{"type", "number"}}},
          {"minItems", count},
          {"maxItems", count},
          {"description", description}};
}

Json numbers_or_null(int count, const char* description) {
  Json json = numbers(count, description);
  json["items"] = {{"type", {"number", "null"}}};
  return json;
}

Json rows(int count, const char* description) {
  Json row = numbers(count, "a row");
  return {{"type", "array"},
          {"items", row},
          {"minItems", count},
          {"maxItems", count},
          {"description", description}};
}

Json object(Json properties, std::initializer_list<const char*> required) {
  Json names = Json::array();
  for (const char* name : required) names.push_back(name);
  return {{"type", "object"}, {"properties", std::move(properties)}, {"required", names}};
}

Json scanner_schema() {
  return object({{"source", words({"unknown", "assumed", "file", "user", "estimated", "per point"})},
                 {"place", numbers(3, "of a static scan, metres")},
                 {"confirmed", flag("the density of the points on planes confirms it")},
                 {"sigma_m", number("one standard deviation per axis, the largest")},
                 {"refuted", numbers(3, "a stated position that the data refute")}},
                {"source"});
}

Json pose_sigma_schema() {
  return object({{"rotation_rad", numbers_or_null(3, "about x, y, z of the frame, radians")},
                 {"translation_m", numbers_or_null(3, "along x, y, z, of the centre, metres")},
                 {"centre", numbers(3, "the point known best")}},
                {"rotation_rad", "translation_m", "centre"});
}

std::string schema_text(const char* title, Json fields, Json definitions) {
  fields["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  fields["title"] = title;
  fields["$defs"] = std::move(definitions);
  return to_text(fields);
}

}  // namespace limen::schema
