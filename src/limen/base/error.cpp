// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/error.h"

#include <utility>

#include <fmt/format.h>

namespace limen {
namespace {

std::string sentence(const std::string& problem, const std::string& where, const std::string& remedy) {
  std::string text = where.empty() ? problem : where + ": " + problem;
  if (!remedy.empty()) text += " (" + remedy + ")";
  return text;
}

}  // namespace

Error::Error(std::string what, std::string where, std::string remedy, Fault fault)
    : std::runtime_error(sentence(what, where, remedy)),
      problem_(std::move(what)),
      where_(std::move(where)),
      remedy_(std::move(remedy)),
      fault_(fault) {}

void throw_bad_option(const std::string& option, double value, const std::string& bound) {
  throw Error(fmt::format("{} is {}, but must be {}", option, value, bound), "", "change the option");
}

}  // namespace limen
