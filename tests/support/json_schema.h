// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

/// Holds files against the schemas that limen prints.
namespace limen::testing_schema {

using json = nlohmann::ordered_json;

/// The part of JSON Schema that the schema uses; tells the first fault, or nothing.
class Validator {
 public:
  explicit Validator(json schema) : root_(std::move(schema)) {}
  [[nodiscard]] std::string fault(const json& value) const { return fault(value, root_, "$"); }

 private:
  static bool is_type(const json& value, const std::string& type) {
    if (type == "null") return value.is_null();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    return type == "array" ? value.is_array() : value.is_object();
  }

  static bool has_type(const json& value, const json& types) {
    if (types.is_string()) return is_type(value, types);
    return std::any_of(types.begin(), types.end(), [&](const json& type) { return is_type(value, type); });
  }

  [[nodiscard]] std::string fault(const json& value, const json& schema, const std::string& at) const {
    if (schema.contains("$ref"))
      return fault(value, root_["$defs"][schema["$ref"].get<std::string>().substr(8)], at);
    if (schema.contains("anyOf")) {
      for (const json& one : schema["anyOf"])
        if (fault(value, one, at).empty()) return {};
      return at + " fits none of its forms: " + fault(value, schema["anyOf"][0], at);
    }
    if (schema.contains("type") && !has_type(value, schema["type"])) return at + " has another type";
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      return at + " is another word";
    if (schema.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
      return at + " has another form";
    if (value.is_number() &&
        (value < schema.value("minimum", json(-1e300)) || value > schema.value("maximum", json(1e300))))
      return at + " is out of bounds";
    if (value.is_array()) return array_fault(value, schema, at);
    return value.is_object() ? object_fault(value, schema, at) : "";
  }

  [[nodiscard]] std::string array_fault(const json& value, const json& schema, const std::string& at) const {
    if (value.size() < schema.value("minItems", 0U) || value.size() > schema.value("maxItems", 1000000U))
      return at + " has another length";
    for (std::size_t k = 0; k < value.size() && schema.contains("items"); ++k) {
      const std::string found = fault(value[k], schema["items"], at + "[" + std::to_string(k) + "]");
      if (!found.empty()) return found;
    }
    return {};
  }

  [[nodiscard]] std::string object_fault(const json& value, const json& schema, const std::string& at) const {
    for (const json& name : schema.value("required", json::array()))
      if (!value.contains(name.get<std::string>())) return at + " lacks " + name.get<std::string>();
    const json properties = schema.value("properties", json::object());
    for (const auto& [name, field] : value.items()) {
      // Nothing is written that the contract does not name.
      if (!properties.empty() && !properties.contains(name)) return at + "." + name + " is not in the schema";
      if (!properties.contains(name)) continue;
      const std::string found = fault(field, properties[name], at + "." + name);
      if (!found.empty()) return found;
    }
    return {};
  }

  json root_;
};

}  // namespace limen::testing_schema
