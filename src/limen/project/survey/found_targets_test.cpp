// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/found_targets.h"

#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kFoundSigmaM = 0.0005;

/// Spheres of a building, and scans that see some of them from frames of their own.
class Spheres {
 public:
  Spheres() {
    for (int k = 0; k < 20; ++k)
      places_.push_back(uniform_vector(Vector3d::Zero(), Vector3d(30.0, 20.0, 2.0), random_));
  }

  void scan(const std::vector<std::size_t>& seen) {
    const Rigid3 pose{uniform_rotation(random_),
                      uniform_vector(Vector3d(-9.0, -9.0, -9.0), Vector3d(9.0, 9.0, 9.0), random_)};
    TargetsOfScan targets{"s" + std::to_string(scans.size()), {}};
    for (const std::size_t k : seen) {
      FoundTarget target;
      target.centre = pose * places_[k];
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        target.centre[axis] += random_.uniform(-kFoundSigmaM, kFoundSigmaM);
      target.sigma_m = kFoundSigmaM;
      targets.targets.push_back(target);
      truth[targets.scan].push_back(k);
    }
    scans.push_back(targets);
  }

  /// The names that each sphere has.
  [[nodiscard]] std::map<std::size_t, std::set<std::string>> names() const {
    std::map<std::size_t, std::set<std::string>> names;
    std::istringstream lines(table_of_targets(scans, {}).text);
    std::map<std::string, std::size_t> row;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      const std::size_t comma = line.find(',');
      const std::string scan = line.substr(comma + 1, line.find(',', comma + 1) - comma - 1);
      names[truth.at(scan)[row[scan]++]].insert(line.substr(0, comma));
    }
    return names;
  }

  std::vector<TargetsOfScan> scans;
  std::map<std::string, std::vector<std::size_t>> truth;

 private:
  RandomStream random_{11, 1};
  std::vector<Vector3d> places_;
};

TEST(FoundTargets, OneScanJoinsTheNext) {
  Spheres spheres;
  spheres.scan({0, 1, 2, 3, 4});
  spheres.scan({9, 8, 7, 6, 5});     // shares nothing with the first
  spheres.scan({4, 2, 3, 5, 6, 7});  // joins both
  spheres.scan({12, 13, 14, 15});    // a group of their own
  spheres.scan({15, 14, 12, 13, 16});
  spheres.scan({17, 18});  // too few
  const auto names = spheres.names();
  std::set<std::string> used;
  for (const auto& [sphere, all] : names) {
    ASSERT_EQ(all.size(), 1U) << sphere;
    const bool shared = (sphere >= 2 && sphere <= 7) || (sphere >= 12 && sphere <= 15);
    EXPECT_EQ(all.begin()->find("unknown_") == std::string::npos, shared) << sphere << *all.begin();
    EXPECT_TRUE(used.insert(*all.begin()).second) << sphere;
  }
  EXPECT_NE(table_of_targets(spheres.scans, {}).words.find("20 of them matched between scans"),
            std::string::npos)
      << table_of_targets(spheres.scans, {}).words;
}

}  // namespace
}  // namespace limen
