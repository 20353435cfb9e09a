// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A program of libFuzzer for every reader of files: limen_fuzz --reader=NAME [options of libFuzzer] FOLDERS
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "readers.h"

#include "limen/base/parallel.h"

namespace {

const limen::FuzzedReader* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kOption = "--reader=";
  limen::set_thread_count(1);
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument.substr(0, kOption.size()) != kOption) continue;
    for (const limen::FuzzedReader& reader : limen::fuzzed_readers()) {
      if (reader.name == argument.substr(kOption.size())) chosen = &reader;
    }
  }
  if (chosen != nullptr) return 0;
  std::cerr << "limen_fuzz: say which reader:";
  for (const limen::FuzzedReader& reader : limen::fuzzed_readers())
    std::cerr << ' ' << kOption << reader.name;
  std::cerr << '\n';
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limen::read_strange(*chosen, {reinterpret_cast<const char*>(data), size});
  return 0;
}
