// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/ifc_extract.h"

#include <algorithm>
#include <charconv>
#include <unordered_set>
#include <vector>

namespace limen {
namespace {

/// Calls work(reference) for each #12 of the arguments, texts and comments passed over.
template <typename Work>
void for_each_reference(std::string_view arguments, const Work& work) {
  bool in_text = false;
  for (std::size_t at = 0; at < arguments.size(); ++at) {
    if (arguments[at] == '\'') in_text = !in_text;
    if (in_text || arguments[at] != '#') continue;
    std::int64_t id = 0;
    const auto [end, error] =
        std::from_chars(arguments.data() + at + 1, arguments.data() + arguments.size(), id);
    if (error == std::errc{}) work(id);
  }
}

bool is_type(const StepEntity* entity, std::string_view upper) {
  return entity != nullptr && entity->type.size() == upper.size() &&
         std::equal(upper.begin(), upper.end(), entity->type.begin(),
                    [](char a, char b) { return a == b || (b >= 'a' && b <= 'z' && a == b - 'a' + 'A'); });
}

/// IfcProduct.Representation is the seventh argument of every product.
bool has_shape(const StepFile& file, const StepEntity& entity) {
  if (entity.arguments.size() < 20) return false;
  const std::vector<std::string_view> arguments = step_arguments(entity.arguments);
  if (arguments.size() < 7) return false;
  const std::optional<std::int64_t> shape = step_reference(arguments[6]);
  return shape && is_type(file.find(*shape), "IFCPRODUCTDEFINITIONSHAPE");
}

/// All that the project and the products refer to, over any number of steps.
std::unordered_set<std::int64_t> needed(const StepFile& file) {
  std::unordered_set<std::int64_t> ids;
  std::vector<std::int64_t> open;
  const auto add = [&](std::int64_t id) {
    if (ids.insert(id).second) open.push_back(id);
  };
  for (const StepEntity& entity : file.entities()) {
    if (is_type(&entity, "IFCPROJECT") || has_shape(file, entity)) add(entity.id);
  }
  while (!open.empty()) {
    const StepEntity* entity = file.find(open.back());
    open.pop_back();
    if (entity != nullptr) for_each_reference(entity->arguments, add);
  }
  return ids;
}

/// The arguments on one line; texts with escapes or bytes beyond ASCII become empty.
void append_arguments(std::string_view arguments, std::string& text) {
  for (std::size_t at = 0; at < arguments.size(); ++at) {
    const char c = arguments[at];
    if (c == '\'') {
      const std::size_t end = std::min(arguments.find('\'', at + 1), arguments.size());
      const std::string_view word = arguments.substr(at, end - at);
      const bool plain =
          std::all_of(word.begin(), word.end(), [](char k) { return k >= ' ' && k < 127 && k != '\\'; });
      if (plain) text.append(word);
      text += plain ? "'" : "''";
      at = end;
    } else if (c == '/' && arguments.substr(at, 2) == "/*") {
      const std::size_t end = arguments.find("*/", at + 2);
      at = end == std::string_view::npos ? at + 1 : end + 1;
    } else if (c > ' ' && c < 127) {
      text += c;
    }
  }
}

}  // namespace

std::string text_of_shapes(const StepFile& file) {
  std::string text =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_"
      "SCHEMA(('";
  text += file.schema() + "'));\nENDSEC;\nDATA;\n";
  const std::unordered_set<std::int64_t> ids = needed(file);
  for (const StepEntity& entity : file.entities()) {
    if (ids.count(entity.id) == 0) continue;
    text += '#';
    text += std::to_string(entity.id);
    text += '=';
    append_arguments(entity.type, text);
    text += '(';
    append_arguments(entity.arguments, text);
    text += ");\n";
  }
  return text + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace limen
