// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "limen/base/error.h"

namespace limen {

/// A file's bytes, mapped for reading, with a guard for the case that somebody makes the file shorter
/// meanwhile (or its disk fails). The system answers the next look at such a byte with a signal that ends the
/// process; here what is missing reads as zeros instead, and require_inputs_whole() reports it.
class GuardedMapping {
 public:
  /// Maps the first `size` (> 0) bytes of `descriptor`, which it keeps and closes; `name` is for messages.
  /// What cannot be mapped has no data.
  GuardedMapping(int descriptor, std::size_t size, std::string name);
  ~GuardedMapping();
  GuardedMapping(const GuardedMapping&) = delete;
  GuardedMapping& operator=(const GuardedMapping&) = delete;

  [[nodiscard]] const char* data() const { return data_; }  ///< null where nothing is mapped
  /// Gives the memory of the bytes back to the system; they are read again where they are wanted again.
  void forget() const;
  [[nodiscard]] bool whole() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  int descriptor_;
  std::size_t size_;
  std::string name_;
  char* data_ = nullptr;
  std::size_t slot_;  ///< in the table that the signal handler looks into
};

/// Throws Error where a file that is mapped at present has become shorter: nothing that was made of it
/// counts.
void require_inputs_whole();

/// Does `work`, which reads mapped files. Where one of them became shorter meanwhile that is what the error
/// says, not what the work made of the zeros.
template <typename Work>
auto with_whole_inputs(const Work& work) {
  try {
    auto result = work();
    require_inputs_whole();
    return result;
  } catch (const Error& error) {
    if (error.fault() == Fault::input) require_inputs_whole();
    throw;
  }
}

}  // namespace limen
