// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/prepare_files.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/files/file_hash.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

/// Rooms of ever fewer points, so that the last is ready first; among them what is no scan.
std::vector<ProjectFile> some_files(const TemporaryFolder& folder) {
  std::vector<ProjectFile> files;
  for (std::size_t k = 0; k < 6; ++k) {
    const std::string name = "scan_" + std::to_string(k) + ".ply";
    const std::filesystem::path path =
        k == 2
            ? folder.write(name, "no scan")
            : folder.write(name, testing_io::simple_ply<float>(testing_io::room_points(30000 - 5000 * k, k),
                                                               testing_io::Writing::little));
    files.push_back({path.string(), false, sha256_of_file(path), {}, {}});
  }
  // A large one, too.
  std::filesystem::resize_file(files[2].path, std::uintmax_t{33} << 20U);
  files[4].copy_of = files[0].path;
  files[5].fault = "may not be read";
  return files;
}

TEST(PrepareFiles, OutcomesComeInTheOrderOfTheFilesEachWithItsOwn) {
  const TemporaryFolder folder;
  const std::vector<ProjectFile> files = some_files(folder);
  for (const std::size_t memory_bytes : {std::size_t{0}, std::size_t{1} << 30U}) {
    const Store store(folder / ("store_" + std::to_string(memory_bytes)), "options");
    ProjectOptions options;
    options.reading.memory_bytes = memory_bytes;
    std::vector<std::pair<std::size_t, FileOutcome>> outcomes;
    prepare_files(files, options, store, silent_monitor(),
                  [&](std::size_t k, FileOutcome outcome) { outcomes.emplace_back(k, std::move(outcome)); });
    ASSERT_EQ(outcomes.size(), files.size());
    for (std::size_t k = 0; k < files.size(); ++k) {
      const auto& [number, outcome] = outcomes[k];
      EXPECT_EQ(number, k);
      EXPECT_EQ(outcome.record.has_value(), k == 0 || k == 1 || k == 3);
      EXPECT_EQ(outcome.fault.empty(), k != 2);
      if (!outcome.record) continue;
      EXPECT_EQ(outcome.record->points, std::vector<std::size_t>{30000 - 5000 * k});
    }
  }
}

TEST(PrepareFiles, WhatIsNoFaultOfAFileEndsTheWork) {
  const TemporaryFolder folder;
  const std::vector<ProjectFile> files = some_files(folder);
  const Store store(folder / "store", "options");
  // Files lie where the store's folders should be.
  std::filesystem::remove_all(folder / "store");
  (void)folder.write("store", "in the way");
  EXPECT_THROW(prepare_files(files, {}, store, silent_monitor(), [](std::size_t, const FileOutcome&) {}),
               StoreFault);
}

}  // namespace
}  // namespace limen
