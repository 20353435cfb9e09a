// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_extract.h"

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <vector>

#include "limen/base/progress.h"

namespace limen {
namespace {

bool is_type(const StepEntity* entity, std::string_view upper) {
  return entity != nullptr && entity->type.size() == upper.size() &&
         std::equal(upper.begin(), upper.end(), entity->type.begin(),
                    [](char a, char b) { return a == b || (b >= 'a' && b <= 'z' && a == b - 'a' + 'A'); });
}

bool is_ifc_type(std::string_view type) {
  return type.size() > 3 && (type[0] == 'I' || type[0] == 'i') && (type[1] == 'F' || type[1] == 'f') &&
         (type[2] == 'C' || type[2] == 'c');
}

/// All that the project, its units and the products refer to, over any number of steps.
std::unordered_set<std::int64_t> needed(const StepFile& file, const std::optional<Ifc4x3>& newer) {
  std::unordered_set<std::int64_t> ids;
  std::vector<std::int64_t> open;
  const auto add = [&](std::int64_t id) {
    if (ids.insert(id).second) open.push_back(id);
  };
  for (const StepEntity& entity : file.entities()) {
    if (is_type(&entity, "IFCPROJECT") || is_type(&entity, "IFCUNITASSIGNMENT") ||
        (has_ifc_shape(file, entity) && !(newer && newer->left_out(entity.id))))
      add(entity.id);
  }
  while (!open.empty()) {
    const StepEntity* entity = file.find(open.back());
    open.pop_back();
    if (entity != nullptr) for_each_step_reference(entity->arguments, add);
  }
  return ids;
}

/// Writes arguments on one line; texts with escapes or bytes beyond ASCII become empty, references to what is
/// not there become $.
class ArgumentWriter {
 public:
  ArgumentWriter(const StepFile& file, std::string& text) : file_(file), text_(text) {}

  void write(std::string_view arguments) {
    const StepComments comments(arguments);
    for (std::size_t at = 0; at < arguments.size(); ++at) {
      const char c = arguments[at];
      if (c == '\'') {
        at = write_text(arguments, at);
      } else if (c == '#') {
        at = write_reference(arguments, at);
      } else if (comments.begins_at(at)) {
        at = comments.behind(at) - 1;
      } else if (c > ' ' && c < 127) {
        text_ += c;
      }
    }
  }

 private:
  /// These return the place of the last character they took.
  std::size_t write_text(std::string_view arguments, std::size_t at) {
    const std::size_t end = std::min(arguments.find('\'', at + 1), arguments.size());
    const std::string_view word = arguments.substr(at, end - at);
    if (std::all_of(word.begin(), word.end(), [](char k) { return k >= ' ' && k < 127 && k != '\\'; })) {
      text_.append(word);
    } else {
      text_ += '\'';
    }
    text_ += '\'';
    return end;
  }

  std::size_t write_reference(std::string_view arguments, std::size_t at) {
    std::size_t end = at + 1;
    while (end < arguments.size() && arguments[end] >= '0' && arguments[end] <= '9') ++end;
    const std::string_view word = arguments.substr(at, end - at);
    const std::optional<std::int64_t> id = step_reference(word);
    if (id && file_.find(*id) != nullptr) {
      text_.append(word);
    } else {
      text_ += '$';
    }
    return end - 1;
  }

  const StepFile& file_;
  std::string& text_;
};

/// A project for a file that has lost its own: with the file's units where these are there.
std::string project_for(const StepFile& file) {
  std::int64_t next = 1;
  std::string units = "$";
  for (const StepEntity& entity : file.entities()) {
    if (is_type(&entity, "IFCPROJECT")) return {};
    if (is_type(&entity, "IFCUNITASSIGNMENT")) units = '#' + std::to_string(entity.id);
    next = entity.id + 1;
  }
  const std::string length = std::to_string(next + 1);
  const std::string angle = std::to_string(next + 2);
  const std::string both = std::to_string(next + 3);
  std::string text;
  if (units == "$") {
    text += "#" + length + "=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n";
    text += "#" + angle + "=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n";
    text += "#" + both + "=IFCUNITASSIGNMENT((#" + length + ",#" + angle + "));\n";
    units = '#' + both;
  }
  return text + "#" + std::to_string(next) + "=IFCPROJECT('0',$,$,$,$,$,$,$," + units + ");\n";
}

}  // namespace

bool has_ifc_shape(const StepFile& file, const StepEntity& entity) {
  if (entity.arguments.size() < 20) return false;
  const std::vector<std::string_view> arguments = step_arguments(entity.arguments);
  if (arguments.size() < 7) return false;
  const std::optional<std::int64_t> shape = step_reference(arguments[6]);
  return shape && is_type(file.find(*shape), "IFCPRODUCTDEFINITIONSHAPE");
}

std::string text_of_shapes(const StepFile& file, const std::optional<Ifc4x3>& newer) {
  std::string text =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_"
      "SCHEMA(('";
  text += (newer ? "IFC4" : file.schema()) + "'));\nENDSEC;\nDATA;\n";
  const std::unordered_set<std::int64_t> ids = needed(file, newer);
  ArgumentWriter writer(file, text);
  for (const StepEntity& entity : file.entities()) {
    CancelScope::check();
    if (ids.count(entity.id) == 0 || !is_ifc_type(entity.type)) continue;
    text += '#';
    text += std::to_string(entity.id);
    text += '=';
    if (newer) {
      writer.write(Ifc4x3::in_ifc4(entity));
    } else {
      writer.write(entity.type);
      text += '(';
      writer.write(entity.arguments);
      text += ')';
    }
    text += ";\n";
  }
  text += project_for(file);
  return text + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace limen
