// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <vector>

namespace limen {

/// One entity of a STEP file: #id = TYPE(arguments);
struct StepEntity {
  std::int64_t id = 0;
  std::string_view type;       ///< as written, usually upper case
  std::string_view arguments;  ///< between the outer brackets
};

/// The comments of a piece of STEP text. Where the last one ends is looked up once, so that passing over any
/// number of comments that never close takes time linear in the text.
class StepComments {
 public:
  /// `bytes` must outlive the object.
  explicit StepComments(std::string_view bytes);
  [[nodiscard]] bool begins_at(std::size_t at) const;
  /// The place behind the comment that begins at `at`; one that never closes is no comment, but two
  /// characters.
  [[nodiscard]] std::size_t behind(std::size_t at) const;

 private:
  std::string_view bytes_;
  std::size_t last_end_;  ///< of the last "*/"
};

/// The entities of a STEP physical file (ISO 10303-21), without knowledge of what they mean. Statements that
/// are damaged are counted and passed over.
class StepFile {
 public:
  /// `bytes` must outlive the object. Of entities with one number the first counts.
  explicit StepFile(std::string_view bytes);

  [[nodiscard]] const std::vector<StepEntity>& entities() const { return entities_; }  ///< by ascending id
  [[nodiscard]] const StepEntity* find(std::int64_t id) const;
  [[nodiscard]] std::size_t damaged() const { return damaged_; }
  /// The first name in FILE_SCHEMA, upper case; empty where there is none.
  [[nodiscard]] const std::string& schema() const { return schema_; }
  /// Whether the file is closed by END-ISO-10303-21.
  [[nodiscard]] bool whole() const { return whole_; }

 private:
  void read_statement(std::string_view statement);

  std::vector<StepEntity> entities_;
  std::unordered_map<std::int64_t, std::size_t> by_id_;
  std::size_t damaged_ = 0;
  std::string schema_;
  bool whole_ = false;
};

/// The arguments between the outermost commas, blanks trimmed.
std::vector<std::string_view> step_arguments(std::string_view arguments);

/// Calls work(id) for each #12 of the arguments, texts passed over.
template <typename Work>
void for_each_step_reference(std::string_view arguments, const Work& work) {
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

/// What one argument says; nothing where it says something else.
std::optional<std::int64_t> step_reference(std::string_view argument);  ///< #12
std::vector<std::int64_t> step_references(std::string_view argument);   ///< (#1,#2) or #1
std::optional<double> step_number(std::string_view argument);           ///< 1. or IFCREAL(1.)
std::string step_enumeration(std::string_view argument);                ///< .ROOF. -> "ROOF"
/// A text in UTF-8 without control characters: '' and \\ are undone, \X\, \X2\, \X4\ and \S\ decoded; bytes
/// beyond ASCII are UTF-8 where they can be, else Latin-1. Empty for $.
std::string step_text(std::string_view argument);

}  // namespace limen
