// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// Sets of 3-D segments registered from any rotation: never a wrong pose called registered.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "run_program.h"
#include "support/synthetic_segments.h"
#include <nlohmann/json.hpp>

#include "limen/geometry/random_vectors.h"
#include "limen/register/register_segments.h"

namespace limen {
namespace {

/// How many cases a test tries: LIMEN_TEST_CASES, else few enough for every day.
int cases() {
  const char* wanted = std::getenv("LIMEN_TEST_CASES");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : 25;
}

struct Tally {
  int right = 0;
  int wrong = 0;
  int listed = 0;  // ambiguous or under-constrained, the truth among the poses
  int missed = 0;
};

struct Pair {
  std::vector<Segment> source;
  std::vector<Segment> target;
};

bool is_true(const Rigid3& pose, const Rigid3& truth, const Vector3d& middle) {
  return (pose * middle - truth * middle).norm() < 0.05 &&
         rotation_angle(pose.rotation.transpose() * truth.rotation) < radians(0.5);
}

/// Moves the source of a pair at random, registers it, and counts what came out.
void count(const Pair& pair, bool same_building, RandomStream& random, Tally& tally) {
  const Rigid3 truth{synthetic::random_rotation(random),
                     uniform_vector(Vector3d(-50, -50, -9), Vector3d(50, 50, 9), random)};
  const std::vector<Segment> source = synthetic::moved(pair.source, inverse(truth));
  const Vector3d middle = source[source.size() / 2].a;
  const RegistrationResult result =
      register_segments({Vector3d::Zero(), source}, {Vector3d::Zero(), pair.target});
  if (result.outcome == Outcome::no_match) {
    ++tally.missed;
    return;
  }
  bool listed = is_true(result.best.target_from_source, truth, middle) && same_building;
  if (result.outcome == Outcome::registered) {
    ++(listed ? tally.right : tally.wrong);
    return;
  }
  for (const Hypothesis& other : result.alternatives)
    listed = listed || is_true(other.target_from_source, truth, middle);
  ++(listed ? tally.listed : tally.missed);
}

TEST(Segments, HalfOfTheEdgesInCommon) {
  Tally tally;
  for (int seed = 0; seed < cases(); ++seed) {
    RandomStream random(101, static_cast<std::uint64_t>(seed));
    const double common = random.uniform(0.3, 0.6);
    std::vector<Segment> first;
    std::vector<Segment> second;
    for (const Segment& edge : synthetic::joined(synthetic::random_building(1, 2, 2, random))) {
      const double drawn = random.uniform();
      if (drawn < 0.5 + 0.5 * common) first.push_back(edge);
      if (drawn > 0.5 - 0.5 * common) second.push_back(edge);
    }
    const synthetic::Detector detector{0.9, 0.2, 0.2, 0.01};
    count({synthetic::detect(first, detector, random), synthetic::detect(second, detector, random)}, true,
          random, tally);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.right, 0.95 * cases());
}

TEST(Segments, ARoomInABuilding) {
  Tally tally;
  for (int seed = 0; seed < cases(); ++seed) {
    RandomStream random(102, static_cast<std::uint64_t>(seed));
    const auto rooms = synthetic::random_building(2, 3, 2, random);
    const auto& room = rooms[random.below(static_cast<std::uint32_t>(rooms.size()))];
    count({synthetic::detect(room, {0.6, 0.2, 0.3, 0.01}, random), synthetic::joined(rooms)}, true, random,
          tally);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GE(tally.right, 0.95 * cases());
}

TEST(Segments, ARoomOfAnotherBuilding) {
  Tally tally;
  for (int seed = 0; seed < cases(); ++seed) {
    RandomStream random(103, static_cast<std::uint64_t>(seed));
    const auto here = synthetic::random_building(1, 2, 2, random);
    const auto elsewhere = synthetic::random_building(1, 3, 3, random);
    count({synthetic::detect(here[0], {}, random), synthetic::joined(elsewhere)}, false, random, tally);
  }
  EXPECT_EQ(tally.wrong, 0);
}

TEST(Segments, RoomsThatOccurTwiceAreListed) {
  Tally tally;
  for (int seed = 0; seed < cases(); ++seed) {
    RandomStream random(104, static_cast<std::uint64_t>(seed));
    const auto rooms = synthetic::random_building(1, 2, 2, random);
    std::vector<Segment> model = synthetic::joined(rooms);
    const Rigid3 copy{synthetic::random_heading(random), Vector3d(40, 5, 0)};
    for (const Segment& edge : synthetic::moved(model, copy)) model.push_back(edge);
    count({synthetic::detect(rooms[0], {}, random), model}, true, random, tally);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.right, 0);
  EXPECT_EQ(tally.listed, cases());
}

std::string json_of_segments(const std::vector<Segment>& segments) {
  nlohmann::json list = nlohmann::json::array();
  for (const Segment& s : segments)
    list.push_back({{"a", {s.a.x(), s.a.y(), s.a.z()}}, {"b", {s.b.x(), s.b.y(), s.b.z()}}});
  return nlohmann::json{{"segments", list}}.dump();
}

using SegmentFilesTest = ProgramTest;

TEST_F(SegmentFilesTest, TheProgramRegistersThem) {
  RandomStream random(105);
  const auto rooms = synthetic::random_building(1, 2, 2, random);
  const Rigid3 truth{synthetic::random_rotation(random), Vector3d(3, 4, 5)};
  const auto scan = synthetic::moved(synthetic::detect(rooms[2], {}, random), inverse(truth));
  write_whole(work() / "a.json", json_of_segments(scan));
  write_whole(work() / "b.json", json_of_segments(synthetic::joined(rooms)));
  write_whole(work() / "c.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const ProgramRun done = run({"register", "a.json", "b.json", "--method", "segments", "-o", "out"});
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const auto result = nlohmann::json::parse(read_whole(work() / "out" / "result.json"));
  EXPECT_EQ(result["outcome"], "registered");
  EXPECT_EQ(result["inputs"]["source"]["segments"], scan.size());
  EXPECT_GT(result["evidence"]["matched_segments"], 10);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(result["target_from_source"][i][3].get<double>(),
                truth.translation[static_cast<Eigen::Index>(i)], 0.05);
  }
  for (const std::string other : {"c.xyz", "missing.json"}) {
    const ProgramRun failed = run({"register", "a.json", other, "--method", "segments", "-o", "none"});
    EXPECT_EQ(failed.status, 2);
    EXPECT_NE(failed.err.find(other), std::string::npos) << failed.err;
    EXPECT_FALSE(std::filesystem::exists(work() / "none"));
  }
}

}  // namespace
}  // namespace limen
