// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/prepared_bytes.h"

#include <filesystem>
#include <fstream>

#include "support/synthetic_room.h"
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/project/store/packed_file.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/register.h"

namespace limen {
namespace {

Scan turned_box(double angle_rad) {
  Scan scan = box_scan(20000, -0.9, 0.9);
  return moved(std::move(scan), {rotation_exp(Vector3d(0, 0, angle_rad)), Vector3d(0.3, -0.2, 0.0)});
}

TEST(PreparedBytes, AStationComesBackBitForBit) {
  const PreparedScan prepared = prepare_scan(turned_box(0.4), prepare_options({}));
  ASSERT_FALSE(prepared.extracted.features.planes.empty());
  const std::string bytes = bytes_of(prepared);
  EXPECT_EQ(bytes_of(prepared_from(bytes, "here")), bytes);
}

TEST(PreparedBytes, AScanFromManyPlacesComesBackBitForBit) {
  Scan scan = box_scan(20000, -0.9, 0.9);
  scan.centres.assign(scan.size(), Vector3d(0.1, 0.0, 0.0));
  scan.centres.front() = Vector3d::Zero();
  const std::string bytes = bytes_of(prepare_scan(scan, prepare_options({})));
  EXPECT_EQ(bytes_of(prepared_from(bytes, "here")), bytes);
}

TEST(PreparedBytes, ARegistrationFromTheStoreGivesTheSameBits) {
  const RegisterOptions options;
  const auto prepared = [&](double angle) {
    return prepare_scan(turned_box(angle), prepare_options(options));
  };
  const auto kept = [&](double angle) { return prepared_from(bytes_of(prepared(angle)), "here"); };
  const RegistrationResult fresh = register_prepared({prepared(0.0), prepared(0.7)}, options);
  const RegistrationResult again = register_prepared({kept(0.0), kept(0.7)}, options);
  EXPECT_FALSE(fresh.reason.empty());
  const auto counts_of = [](const PreparedScan& side) {
    const Features& features = side.extracted.features;
    return FeatureCounts{features.planes.size(), features.openings.size()};
  };
  const PairCounts counts{counts_of(prepared(0.0)), counts_of(prepared(0.7))};
  EXPECT_EQ(bytes_of(again), bytes_of(fresh));
  EXPECT_EQ(bytes_of(result_from(bytes_of(fresh), "here", counts)), bytes_of(fresh));
}

TEST(PreparedBytes, BytesThatEndTooEarlyAreRefused) {
  const std::string bytes = bytes_of(prepare_scan(turned_box(0.4), prepare_options({})));
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, bytes.size() / 3, bytes.size() - 1})
    EXPECT_THROW((void)prepared_from(std::string_view(bytes).substr(0, size), "here"), Error) << size;
}

TEST(PreparedBytes, WhatPointsToNoPlaneIsRefused) {
  PreparedScan prepared = prepare_scan(turned_box(0.4), prepare_options({}));
  std::vector<SurfaceSample>& samples = prepared.extracted.features.samples;
  ASSERT_FALSE(samples.empty());
  const auto planes = static_cast<std::int32_t>(prepared.extracted.features.planes.size());
  for (const std::int32_t plane : {planes, std::int32_t{1} << 30, std::int32_t{-2}}) {
    samples.back().plane = plane;
    EXPECT_THROW((void)prepared_from(bytes_of(prepared), "here"), Error) << plane;
    EXPECT_THROW(require_prepared(bytes_of(prepared), "here"), Error) << plane;
  }
  samples.back().plane = planes - 1;
  EXPECT_NO_THROW(require_prepared(bytes_of(prepared), "here"));
}

TEST(PreparedBytes, AResultThatPointsToNoFeatureIsRefused) {
  RegistrationResult result;
  result.matches = {{4, 2, 0.0, 0.0, 1.0}};
  result.openings = {{1, 0, 0.0, 0.0}};
  result.thickness = {{3, 1, 1, 0.3, 0.01}};
  const std::string bytes = bytes_of(result);
  EXPECT_NO_THROW((void)result_from(bytes, "here", {{5, 2}, {3, 1}}));
  EXPECT_THROW((void)result_from(bytes, "here", {{4, 2}, {3, 1}}), Error);
  EXPECT_THROW((void)result_from(bytes, "here", {{5, 1}, {3, 1}}), Error);
  EXPECT_THROW((void)result_from(bytes, "here", {{5, 2}, {2, 1}}), Error);
  EXPECT_THROW((void)result_from(bytes, "here", {{5, 2}, {3, 0}}), Error);
}

TEST(PackedFile, WhatIsDamagedOrOfAnotherKeyIsRefusedAndOfAnotherVersionMissing) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "limen-packed-file-test";
  const std::string bytes(5000, 'a');
  const EntryHead head{"TEST", 3, "key of it"};
  write_packed(path, head, bytes);
  EXPECT_EQ(read_packed(path, head), bytes);
  EXPECT_FALSE(read_packed(path, {"TEST", 4, "key of it"}).has_value());
  EXPECT_THROW((void)read_packed(path, {"OTHR", 3, "key of it"}), Error);
  EXPECT_THROW((void)read_packed(path, {"TEST", 3, "key of me"}), Error);
  EXPECT_THROW((void)read_packed(path, {"TEST", 3, "key"}), Error);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(-3, std::ios::end);
    file.put('x');
  }
  EXPECT_THROW((void)read_packed(path, head), Error);
  std::filesystem::resize_file(path, 20);
  EXPECT_THROW((void)read_packed(path, head), Error);
  std::filesystem::remove(path);
  EXPECT_FALSE(read_packed(path, head).has_value());
}

}  // namespace
}  // namespace limen
