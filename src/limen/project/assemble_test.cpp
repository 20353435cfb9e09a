// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/assemble.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limen {
namespace {

/// Four scans in a row, every pair sure of its pose, the first of them off by so much.
std::vector<std::string> notes_where_off(double off_m, double moved_m2 = 0.0,
                                         Outcome outcome = Outcome::registered) {
  std::vector<ProjectNode> nodes(4);
  ProjectResult result;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    nodes[k].scan = k;
    result.scans.emplace_back();
    result.scans.back().file = std::string(1, static_cast<char>('a' + k));
  }
  std::vector<TriedPair> pairs;
  for (std::size_t source = 1; source < nodes.size(); ++source) {
    for (std::size_t target = 0; target < source; ++target) {
      TriedPair pair{source, target, {}};
      pair.result.outcome = Outcome::registered;
      Vector3d& shift = pair.result.best.target_from_source.translation;
      shift.x() = 2.0 * static_cast<double>(source - target) + (pairs.empty() ? off_m : 0.0);
      pair.result.best.probability = 1.0;
      pair.result.best.score = pair.result.best.agreeing_m2 = 30.0;
      pair.result.others = OtherExplanations{0.0, 0.0, 0.0};
      pair.result.sigma.centre = shift;
      if (moved_m2 > 0.0 && pairs.empty()) {
        pair.result.moved = {{0, 0, 0.06, 0.0, moved_m2}};
        pair.result.outcome = outcome;
      }
      pairs.push_back(pair);
    }
  }
  assemble(nodes, pairs, {}, {}, {}, {}, result);
  return result.notes;
}

TEST(Assemble, APairThatIsSureBesideTheOthersIsNoted) {
  for (const double off_m : {0.0, 0.06, 3.0}) {
    std::size_t noted = 0;
    for (const std::string& note : notes_where_off(off_m))
      noted += note.find("moved or rebuilt") != std::string::npos ? 1 : 0;
    EXPECT_EQ(noted, off_m == 0.06 ? 1U : 0U) << off_m;
  }
}

TEST(Assemble, PlanesBesideTheirCounterpartsAreNoted) {
  const std::vector<std::string> notes = notes_where_off(0.0, 4.0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("b and a (4.0 m2, up to 60 mm)"), std::string::npos) << notes[0];
  EXPECT_TRUE(notes_where_off(0.0, 4.0, Outcome::ambiguous).empty());
}

}  // namespace
}  // namespace limen
