// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/store.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/files/file_hash.h"
#include "limen/project/inputs/project_files.h"
#include "limen/project/run/store_jobs.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using testing_io::TemporaryFolder;

class Notes : public Monitor {
 public:
  void note(std::string_view text) override { said.emplace_back(text); }
  std::vector<std::string> said;
};

const std::string kKey = "0123-0-aa";
const std::string kOther = "4567-0-aa";

/// A plane with one sample on it; `sample_plane` is the number of its plane that it states.
PreparedScan little_scan(std::int32_t sample_plane = 0) {
  PreparedScan scan;
  PlanarPolygon plane;
  plane.parts = {{{{0, 0}, {1, 0}, {1, 1}}, {}}};
  scan.extracted.features.planes = {plane};
  scan.extracted.features.samples = {{Vector3d::Zero(), Vector3d::UnitZ(), sample_plane, 1.0F, 1.0F}};
  scan.reach.extend(Vector3d::Zero());
  return scan;
}

RegistrationResult little_result(int plane = 0) {
  RegistrationResult result;
  result.matches = {{plane, 0, 0.0, 0.0, 1.0}};
  return result;
}

const TargetOptions kSizes{0.05, 0.3};
const PairCounts kCounts{{1, 0}, {1, 0}};

/// One kind of entry: where it lies under kKey, and whether the store has it.
struct Entry {
  std::string file;
  std::function<bool(const Store&)> has;
};

std::vector<Entry> entries() {
  return {
      {"features/" + kKey, [](const Store& store) { return store.load_features(kKey).has_value(); }},
      {"features/" + kKey, [](const Store& store) { return store.has_features(kKey); }},
      {"digests/" + kKey, [](const Store& store) { return store.load_digest(kKey).has_value(); }},
      {"digests/" + kKey, [](const Store& store) { return store.has_features(kKey); }},
      {"pictures/" + kKey, [](const Store& store) { return store.has_picture(kKey); }},
      {"targets/" + kKey + "-spheres0.05-boards0.3",
       [](const Store& store) { return store.load_targets(kKey, kSizes).has_value(); }},
      {"pairs/" + kKey + "_" + kOther,
       [](const Store& store) { return store.has_pair(kKey, kOther, kCounts); }},
  };
}

void fill(const Store& store) {
  Scan picture;
  picture.points = {Vector3d::Zero()};
  for (const auto& [key, other] : {std::pair(kKey, kOther), {kOther, kKey}}) {
    store.save_features(key, little_scan());
    store.save_picture(key, picture);
    store.save_targets(key, kSizes, {{TargetKind::board, Vector3d(1, 2, 3), 0.001, 50}});
    store.save_pair(key, other, little_result());
  }
}

TEST(Store, AnEntryOfAnotherKeyIsRemovedWithANote) {
  const TemporaryFolder folder;
  for (const Entry& entry : entries()) {
    Notes notes;
    const Store store(folder / "store", "options", notes);
    fill(store);
    const fs::path mine = folder / "store" / entry.file;
    const bool pair = entry.file.starts_with("pairs");
    const fs::path other =
        mine.parent_path() /
        (pair ? kOther + "_" + kKey : kOther + mine.filename().string().substr(kKey.size()));
    ASSERT_TRUE(entry.has(store)) << entry.file;
    fs::copy_file(other, mine, fs::copy_options::overwrite_existing);
    EXPECT_FALSE(entry.has(store)) << entry.file;
    EXPECT_FALSE(fs::exists(mine)) << entry.file;
    ASSERT_EQ(notes.said.size(), 1U) << entry.file;
    EXPECT_NE(notes.said[0].find("another key"), std::string::npos) << notes.said[0];
  }
}

TEST(Store, AnEntryWithAnyOtherByteIsRemovedWithANote) {
  const TemporaryFolder folder;
  for (const Entry& entry : entries()) {
    Notes notes;
    const Store store(folder / "store", "options", notes);
    fill(store);
    const fs::path mine = folder / "store" / entry.file;
    const std::string whole = testing_io::slurp(mine);
    for (std::size_t k = 0; k < whole.size(); ++k) {
      std::string damaged = whole;
      damaged[k] = static_cast<char>(damaged[k] ^ 1);
      std::ofstream(mine, std::ios::binary) << damaged;
      EXPECT_FALSE(entry.has(store)) << entry.file << " byte " << k;
    }
    // Of another version of the format is no damage, but missing: four bytes.
    EXPECT_EQ(notes.said.size(), whole.size() - 4) << entry.file;
  }
}

TEST(Store, AnEntryThatPointsToWhatIsNotThereIsRemovedWithANote) {
  const TemporaryFolder folder;
  Notes notes;
  const Store store(folder / "store", "options", notes);
  fill(store);
  // As one who knows the format writes it, its hash right.
  store.save_pair(kKey, kOther, little_result(7));
  EXPECT_FALSE(store.has_pair(kKey, kOther, kCounts));
  EXPECT_EQ(notes.said.size(), 1U);
  PreparedScan forged = little_scan();
  forged.extracted.features.openings.emplace_back();
  forged.extracted.features.openings.back().facade = 1 << 20;
  store.save_features(kKey, forged);
  EXPECT_FALSE(store.has_features(kKey));
  EXPECT_FALSE(store.load_features(kKey));
  EXPECT_EQ(notes.said.size(), 2U);
}

TEST(StoreJobs, OfAFileThatWasReplacedAfterItsHashNothingIsKept) {
  const TemporaryFolder folder;
  const fs::path path = folder.write(
      "scan.ply",
      testing_io::simple_ply<float>(testing_io::room_points(20000, 1), testing_io::Writing::little));
  const Store store(folder / "store", "options");
  const ProjectOptions options;
  ProjectFile file{path.string(), false, std::string(64, 'a'), {}, {}};
  EXPECT_THROW((void)make_features(file, options, store, silent_monitor()), Error);
  EXPECT_FALSE(store.load_file(file.key()));
  EXPECT_FALSE(store.has_features(store.feature_key(file.key(), 0)));
  EXPECT_FALSE(store.has_picture(store.feature_key(file.key(), 0)));
  file.sha256 = sha256_of_file(path);
  EXPECT_NO_THROW((void)make_features(file, options, store, silent_monitor()));
  EXPECT_TRUE(store.has_features(store.feature_key(file.key(), 0)));
}

}  // namespace
}  // namespace limen
