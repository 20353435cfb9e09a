// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Every file of tests/corpus meets its reader: none may crash it or make it blame itself.
#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "fuzz/readers.h"
#include "run_program.h"
#include <gtest/gtest.h>

namespace limen {

void PrintTo(const FuzzedReader& reader, std::ostream* out) {  // NOLINT: the name is GoogleTest's
  *out << reader.name;
}

namespace {

namespace fs = std::filesystem;

class Corpus : public testing::TestWithParam<FuzzedReader> {};

TEST_P(Corpus, BringsNoReaderDown) {
  const fs::path folder = fs::path(LIMEN_CORPUS) / GetParam().name;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty()) << folder;
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.string());
    EXPECT_NO_THROW(read_strange(GetParam(), read_whole(file)));
  }
}

INSTANTIATE_TEST_SUITE_P(EveryReader, Corpus, testing::ValuesIn(fuzzed_readers()),
                         [](const auto& reader) { return std::string(reader.param.name); });

}  // namespace
}  // namespace limen
