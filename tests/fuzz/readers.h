// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace limen {

/// A reader as a stranger's bytes meet it: it returns, or throws Error for the input. Anything else is a
/// fault.
struct FuzzedReader {
  std::string_view name;  ///< also of its folder in tests/corpus
  void (*read)(std::string_view bytes);
};

const std::vector<FuzzedReader>& fuzzed_readers();

/// Reads the bytes; an Error that blames the input is what may happen. Everything else is thrown on. A reader
/// that computes longer than seconds_allowed() is at fault too: std::runtime_error.
void read_strange(const FuzzedReader& reader, std::string_view bytes);

/// The seconds of computing within which any file of so many bytes is read: a line, not a parabola.
double seconds_allowed(std::size_t bytes);

}  // namespace limen
