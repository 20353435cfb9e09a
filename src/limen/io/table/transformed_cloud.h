// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/scan_file.h"

namespace limen {

/// A file in memory and its name for messages.
struct NamedBytes {
  std::string_view bytes;
  std::string name;
};

/// What became of a point file that was moved.
struct TransformedCloud {
  std::size_t points = 0;
  std::string format;              ///< of the input, in a user's words
  std::vector<std::string> notes;  ///< sentences about what was left out or could not be moved
};

}  // namespace limen
