// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace limen {

/// Letters to insert, drop, replace or swap with their neighbour to make one word of another (optimal string
/// alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The one of `known` that was meant by a word that is none of them: it differs by a third of its letters at
/// most, or begins with what was written. Empty where none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// One option or positional argument of a command. What CLI11 does is behind it, so that its headers, which
/// are slow to compile, are read in few places.
class Argument {
 public:
  explicit Argument(CLI::Option& option) : option_(&option) {}

  Argument* required();
  Argument* type_name(const std::string& name);
  Argument* group(const std::string& name);
  /// Words it takes each time it is given.
  Argument* type_size(int words);
  /// Given several times, all words are kept; each time it takes no more than `type_size` words.
  Argument* take_all();
  /// Takes all words that follow it.
  Argument* take_list();
  /// Nothing but these is taken.
  Argument* one_of(const std::vector<std::string>& values);
  /// A whole number from `low` to `high`, both included.
  Argument* in_range(int low, int high);
  /// A whole number from 0 on that fits into 64 bits.
  Argument* count();
  /// `fault` tells what is wrong with a word; nothing where it is good.
  Argument* check(const std::function<std::string(const std::string&)>& fault);

 private:
  CLI::Option* option_;
};

/// The program, or one command of it, while its options are being declared. Values given stay as they are
/// where an option is not used; they and this must outlive the parsing.
class CommandLine {
 public:
  explicit CommandLine(CLI::App& app) : app_(&app) {}
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// `name`: "-o,--output DIR" with the word for its value, or "SCAN" for a positional argument. `Value`: a
  /// text, texts, int, double, or std::size_t, of which a number below 0, which would wrap around, or one too
  /// large is an error. What is returned lives as long as this.
  template <typename Value>
  Argument* add_option(const std::string& name, Value& value, const std::string& description);
  Argument* add_flag(const std::string& name, bool& value, const std::string& description);
  /// `run` is called where the command was given and all of the line was understood.
  CommandLine* add_command(const std::string& name, const std::string& description,
                           std::function<void()> run);
  /// Of a command: "" hides it from the help.
  CommandLine* group(const std::string& name);
  /// What describes and parses it.
  [[nodiscard]] const CLI::App& parser() const { return *app_; }

 private:
  Argument* keep(CLI::Option* option);

  CLI::App* app_;
  std::deque<Argument> arguments_;
  std::deque<CommandLine> commands_;
};

}  // namespace limen
