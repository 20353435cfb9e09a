// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A value, mostly of an enumeration, and what it is called in files and options. All of them are an array.
template <typename Value>
struct Named {
  Value value;
  const char* name;
};

/// The name of a value; empty where the list does not have it.
template <typename Value, std::size_t Size>
constexpr const char* name_of(const Named<Value> (&list)[Size], Value value) {
  for (const Named<Value>& it : list) {
    if (it.value == value) return it.name;
  }
  return "";
}

/// The value of that name; nothing where the list does not have it.
template <typename Value, std::size_t Size>
constexpr std::optional<Value> value_called(const Named<Value> (&list)[Size], std::string_view name) {
  for (const Named<Value>& it : list) {
    if (name == it.name) return it.value;
  }
  return std::nullopt;
}

/// All names, in their order.
template <typename Value, std::size_t Size>
std::vector<std::string> names_in(const Named<Value> (&list)[Size]) {
  std::vector<std::string> names;
  for (const Named<Value>& it : list) names.emplace_back(it.name);
  return names;
}

}  // namespace limen
