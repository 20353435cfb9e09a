// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/ply/ply.h"

namespace limen {
namespace {

using namespace testing_io;

Scan full_scan(bool mobile) {
  Scan scan;
  scan.name = "full";
  scan.local_origin = {1050000.0, 6840000.0, 100.0};
  scan.points = random_points(40000, {-20.0, -30.0, 0.0}, 50.0, 1);
  if (mobile) scan.centres = random_points(40000, {0.0, 0.0, 2.0}, 5.0, 2);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.times_s.push_back(54160.0 + 3.4e-6 * static_cast<double>(i));
    scan.intensities.push_back(static_cast<float>(i) / 7.0F);
    scan.topology.line.push_back(static_cast<std::int32_t>(i / 100));
    scan.topology.index.push_back(static_cast<std::int32_t>(i % 100));
    for (std::size_t k = 0; k < 3; ++k) scan.colours.push_back(static_cast<std::uint8_t>((i + k) % 256));
  }
  return scan;
}

void expect_near(const Scan& a, const Scan& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.centres.size(), b.centres.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_LT((a.local_origin + a.points[i] - b.local_origin - b.points[i]).norm(), 3e-9);
  for (std::size_t i = 0; i < a.centres.size(); ++i)
    ASSERT_LT((a.local_origin + a.centres[i] - b.local_origin - b.centres[i]).norm(), 3e-9);
  EXPECT_EQ(a.times_s, b.times_s);
  EXPECT_EQ(a.intensities, b.intensities);
  EXPECT_EQ(a.colours, b.colours);
  EXPECT_EQ(a.topology.line, b.topology.line);
  EXPECT_EQ(a.topology.index, b.topology.index);
}

TEST(WritePly, ReadsBackAllThatIsKnown) {
  const TemporaryFolder folder;
  for (const bool mobile : {true, false}) {
    const Scan scan = full_scan(mobile);
    write_ply(folder / "full.ply", scan);
    expect_near(scan, read_scan(folder / "full.ply"));
  }
  EXPECT_EQ(folder.files(), 1U);
}

TEST(WritePly, KeepsWhatIsKnownOfAStaticCentre) {
  const TemporaryFolder folder;
  Scan scan;
  scan.points = room_points(3000, 3);
  write_ply(folder / "unknown.ply", scan);
  EXPECT_FALSE(read_scan(folder / "unknown.ply").centre_known());
  scan.centres = {{0.25, 1.0 / 3.0, -0.1}};
  write_ply(folder / "known.ply", scan);
  EXPECT_EQ(read_scan(folder / "known.ply").centres, scan.centres);
}

TEST(WritePly, SaysWhereItCannotWrite) {
  const Scan scan = full_scan(false);
  EXPECT_THROW(write_ply("/nonexistent-folder/out.ply", scan), Error);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_ply("/dev/full", scan), Error);
}

}  // namespace
}  // namespace limen
