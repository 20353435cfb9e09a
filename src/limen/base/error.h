// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace limen {

/// Who has to act on an error; decides the program's exit status.
enum class Fault {
  input,     ///< a file, a value or an option the user gave (exit status 2)
  internal,  ///< a broken invariant: ours (exit status 1)
  cancelled  ///< the user interrupted the work (exit status 130)
};

/// The one exception type of the library. It says what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  /// `what`: the fault in a few words; `where`: file, line, byte, option; `remedy`: what the user can do.
  Error(std::string what, std::string where, std::string remedy, Fault fault = Fault::input);

  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& remedy() const { return remedy_; }
  [[nodiscard]] Fault fault() const { return fault_; }

 private:
  std::string problem_;
  std::string where_;
  std::string remedy_;
  Fault fault_;
};

/// Thrown where a bound of an options aggregate does not hold: names the option, its value and the bound.
[[noreturn]] void throw_bad_option(const std::string& option, double value, const std::string& bound);

}  // namespace limen
