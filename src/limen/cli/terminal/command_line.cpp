// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/command_line.h"

#include <algorithm>
#include <charconv>
#include <type_traits>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace limen {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table of distances between the beginnings of both words.
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kLeastBeginning = 3;
  std::string best;
  std::size_t least = 0;
  for (const std::string& one : known) {
    const bool begun = word.size() >= kLeastBeginning && one.starts_with(word);
    const std::size_t distance = begun ? 1 : edit_distance(word, one);
    const std::size_t bearable = std::max<std::size_t>(1, one.size() / 3);
    if (distance > bearable || (!best.empty() && distance >= least)) continue;
    best = one;
    least = distance;
  }
  return best;
}

namespace {

std::string fault_of_count(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec == std::errc() && read.ptr == end) return {};
  return read.ec == std::errc::result_out_of_range ? text + " is too large"
                                                   : text + " is not a whole number of 0 or more";
}

}  // namespace

Argument* Argument::required() {
  option_->required();
  return this;
}

Argument* Argument::type_name(const std::string& name) {
  option_->type_name(name);
  return this;
}

Argument* Argument::group(const std::string& name) {
  option_->group(name);
  return this;
}

Argument* Argument::type_size(int words) {
  option_->type_size(words);
  return this;
}

Argument* Argument::take_all() {
  option_->take_all()->allow_extra_args(false);
  return this;
}

Argument* Argument::take_list() {
  option_->take_all();
  return this;
}

Argument* Argument::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return this;
}

Argument* Argument::in_range(int low, int high) {
  option_->check(CLI::Range(low, high));
  return this;
}

Argument* Argument::count() {
  return check(fault_of_count);
}

Argument* Argument::check(const std::function<std::string(const std::string&)>& fault) {
  option_->check(fault);
  return this;
}

template <typename Value>
Argument* CommandLine::add_option(const std::string& name, Value& value, const std::string& description) {
  const std::size_t space = name.find(' ');
  CLI::Option* option = app_->add_option(name.substr(0, space), value, description);
  if (space != std::string::npos) option->type_name(name.substr(space + 1));
  Argument* argument = keep(option);
  return std::is_same_v<Value, std::size_t> ? argument->count() : argument;
}
template Argument* CommandLine::add_option(const std::string&, std::string&, const std::string&);
template Argument* CommandLine::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Argument* CommandLine::add_option(const std::string&, int&, const std::string&);
template Argument* CommandLine::add_option(const std::string&, std::size_t&, const std::string&);
template Argument* CommandLine::add_option(const std::string&, double&, const std::string&);

Argument* CommandLine::add_flag(const std::string& name, bool& value, const std::string& description) {
  return keep(app_->add_flag(name, value, description));
}

CommandLine* CommandLine::add_command(const std::string& name, const std::string& description,
                                      std::function<void()> run) {
  CLI::App* command = app_->add_subcommand(name, description);
  command->callback(std::move(run));
  return &commands_.emplace_back(*command);
}

CommandLine* CommandLine::group(const std::string& name) {
  app_->group(name);
  return this;
}

Argument* CommandLine::keep(CLI::Option* option) {
  return &arguments_.emplace_back(*option);
}

}  // namespace limen
