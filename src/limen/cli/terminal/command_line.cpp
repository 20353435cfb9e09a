// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/command_line.h"

#include <charconv>
#include <cstdint>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace limen {
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

Argument* CommandLine::add_option(const std::string& name, std::string& value,
                                  const std::string& description) {
  return keep(app_->add_option(name, value, description));
}

Argument* CommandLine::add_option(const std::string& name, std::vector<std::string>& values,
                                  const std::string& description) {
  return keep(app_->add_option(name, values, description));
}

Argument* CommandLine::add_option(const std::string& name, int& value, const std::string& description) {
  return keep(app_->add_option(name, value, description));
}

Argument* CommandLine::add_option(const std::string& name, std::size_t& value,
                                  const std::string& description) {
  return keep(app_->add_option(name, value, description))->count();
}

Argument* CommandLine::add_option(const std::string& name, double& value, const std::string& description) {
  return keep(app_->add_option(name, value, description));
}

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
