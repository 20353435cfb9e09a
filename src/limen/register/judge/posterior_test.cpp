// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "limen/register/judge/evidence_table.h"
#include "limen/register/judge/look_alike_odds.h"

namespace limen {
namespace {

/// A pose under which this much agrees.
FoundPose pose(double agreeing_m2, double contradicted_m2 = 0.0) {
  FoundPose found;
  found.score.agreeing_m2 = found.score.evidence_m2 = agreeing_m2;
  found.score.contradicted_m2 = contradicted_m2;
  return found;
}

/// Under any two poses other surface agrees.
PairQuestions questions_of(const std::vector<FoundPose>& poses) {
  PairQuestions questions;
  questions.contrast = [&poses](std::size_t a, std::size_t b) {
    return PoseContrast{poses[a].score.evidence_m2, poses[b].score.evidence_m2,
                        poses[a].score.contradicted_m2, poses[b].score.contradicted_m2};
  };
  return questions;
}

Posterior weighed(const std::vector<FoundPose>& poses, const std::vector<LookAlikeEvidence>& things = {},
                  PairSort sort = PairSort::rooms) {
  PairQuestions questions = questions_of(poses);
  if (!things.empty()) questions.look_alike = [&](std::size_t k) { return things[k]; };
  return weigh_poses(poses, sort, questions);
}

/// Things of a room agree under a pose, by so many nats.
LookAlikeEvidence things(double nats) {
  LookAlikeEvidence evidence;
  evidence.otherwise_nats.fill(nats);
  evidence.alike_nats.fill(std::min(0.0, nats));
  return evidence;
}

double sum(const Posterior& all) {
  return std::accumulate(all.probabilities.begin(), all.probabilities.end(), 0.0) +
         all.others.nothing_shared + all.others.look_alike + all.others.unlisted_pose;
}

TEST(Posterior, WithoutAPoseNothingIsShared) {
  EXPECT_EQ(weighed({}).others.nothing_shared, 1.0);
}

RC_GTEST_PROP(Posterior, AllSumsToOneAndTheOrderOfPosesMeansNothing, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 7);
  std::vector<FoundPose> poses;
  std::vector<LookAlikeEvidence> said;
  for (std::size_t k = 0; k < count; ++k) {
    poses.push_back(pose(*rc::gen::inRange(0, 400) / 10.0 + 1e-3 * static_cast<double>(k),
                         *rc::gen::inRange(0, 50) / 10.0));
    said.push_back(things(*rc::gen::inRange(-60, 200) / 10.0));
  }
  const Posterior all = weighed(poses, said);
  RC_ASSERT(std::abs(sum(all) - 1.0) < 1e-9);
  RC_ASSERT(std::is_sorted(all.probabilities.begin() + 1, all.probabilities.end(), std::greater<>()));
  std::vector<FoundPose> turned(poses.rbegin(), poses.rend());
  const Posterior back = weighed(turned, {said.rbegin(), said.rend()});
  RC_ASSERT(std::abs(back.best() - all.best()) < 1e-9);
  RC_ASSERT(back.order.front() == count - 1 - all.order.front());
}

TEST(Posterior, MuchCommonSurfaceLeavesTheBestAlone) {
  const Posterior all = weighed({pose(40), pose(12)});
  EXPECT_EQ(all.order.front(), 0U);
  EXPECT_GT(all.best(), 0.999);
  EXPECT_LT(all.by_chance(), 1e-6);
}

TEST(Posterior, HardlyAnyCommonSurfaceMeansNothingShared) {
  EXPECT_GT(weighed({pose(2)}).others.nothing_shared, 0.8);
}

TEST(Posterior, ManyPosesOfHardlyAnySurfaceDoNotTakeFromOne) {
  std::vector<FoundPose> poses{pose(35)};
  const double alone = weighed(poses, {things(8)}).best();
  std::vector<LookAlikeEvidence> said{things(8)};
  for (int k = 0; k < 30; ++k) {
    poses.push_back(pose(1.5, 1.0));
    said.push_back(things(0));
  }
  EXPECT_NEAR(weighed(poses, said).best(), alone, 1e-3);
}

TEST(Posterior, PosesThatNothingDistinguishesShare) {
  const std::vector<FoundPose> poses{pose(30), pose(30)};
  PairQuestions questions;
  questions.contrast = [](std::size_t, std::size_t) { return PoseContrast{}; };
  const Posterior all = weigh_poses(poses, PairSort::rooms, questions);
  EXPECT_NEAR(all.probabilities[0], 0.5, 1e-6);
  EXPECT_NEAR(all.probabilities[1], 0.5, 1e-6);
}

TEST(Posterior, ContradictedSurfaceIsBorneAsAShareOfWhatIsSeen) {
  const double none = weighed({pose(60)}).best();
  EXPECT_GT(weighed({pose(60, 5)}).best(), 0.9 * none);
  EXPECT_LT(weighed({pose(8, 8)}).best(), 0.05);
  double before = 1.0;
  for (const double contradicted : {0.0, 1.0, 2.0, 4.0, 8.0, 16.0}) {
    const double best = weighed({pose(12, contradicted)}).best();
    EXPECT_LE(best, before) << contradicted;
    before = best;
  }
}

TEST(Posterior, ALookAlikePlaceIsExcludedByThingsAndByHowSurfacesWereBuilt) {
  EXPECT_LT(weighed({pose(40)}, {things(0)}).best(), 0.6);
  EXPECT_GT(weighed({pose(40)}, {things(9)}).best(), 0.99);
  EXPECT_LT(weighed({pose(40)}, {things(-4)}).best(), 0.02);
  LookAlikeEvidence built;
  built.built.one.fill(9.0);
  EXPECT_GT(weighed({pose(40)}, {built}).best(), 0.999);
}

TEST(Posterior, ThingsSeenThroughADoorOutweighTheWallsOfALookAlike) {
  std::vector<FoundPose> poses{pose(30), pose(9)};
  poses[1].refined.target_from_source.translation = Vector3d(8.0, 0.0, 0.0);
  EXPECT_EQ(weighed(poses, {things(0), things(0)}).order.front(), 0U);
  const Posterior all = weighed(poses, {things(-9), things(9)});
  EXPECT_EQ(all.order.front(), 1U);
  EXPECT_GT(all.best(), 0.9);
}

TEST(Posterior, APoseBesideTheBestIsNoLookAlikePlace) {
  std::vector<FoundPose> poses = {pose(70.0, 2.3), pose(46.0, 14.6)};
  const std::vector<LookAlikeEvidence> look_alike = {things(9.0), things(9.0)};
  poses[1].refined.target_from_source.translation = Vector3d(8.0, 0.0, 0.0);
  const double far = weighed(poses, look_alike).best();
  poses[1].refined.target_from_source.translation = Vector3d(0.2, 0.0, 0.0);
  const Posterior near = weighed(poses, look_alike);
  EXPECT_EQ(near.order.front(), 0U);
  EXPECT_GT(near.best(), far);
  EXPECT_LT(near.probabilities[1], 1e-6);
}

TEST(Posterior, AStreetShowsMuchThatRepeats) {
  EXPECT_GT(weighed({pose(10)}).best(), 0.9);
  EXPECT_LT(weighed({pose(10)}, {}, PairSort::streets).best(), 0.1);
  EXPECT_GT(weighed({pose(90)}, {}, PairSort::streets).best(), 0.999);
}

TEST(Posterior, ARoomMayBeBehindOtherWindowsToo) {
  const auto best = [](const std::vector<FoundPose>& poses, double repeats) {
    PairQuestions questions = questions_of(poses);
    questions.repeats = repeats;
    return weigh_poses(poses, PairSort::through_wall, questions).best();
  };
  EXPECT_GT(best({pose(30)}, 1.0), 0.999);
  EXPECT_LT(best({pose(30), pose(14)}, 1.0), 0.95);
  EXPECT_GT(best({pose(30), pose(14)}, 0.05), best({pose(30), pose(14)}, 1.0));
  EXPECT_GT(best({pose(30), pose(14, 2)}, 1.0), 0.999) << "what is contradicted is not that room";
}

TEST(Posterior, ARoomBehindAnotherWindowIsBuiltOtherwise) {
  const auto best = [](double of_first, double of_second) {
    std::vector<LookAlikeEvidence> said(2);
    for (std::size_t k = 0; k < said.size(); ++k) {
      said[k].otherwise = 0.0;
      said[k].built.one.fill(k == 0 ? of_first : of_second);
    }
    return weighed({pose(30), pose(14)}, said, PairSort::through_wall).best();
  };
  EXPECT_LT(best(0.0, 0.0), 0.95);
  EXPECT_GT(best(6.0, 0.0), 0.99);
}

TEST(Posterior, ThroughWindowsHowSurfacesWereBuiltExcludesChance) {
  const auto all = [](PairSort sort, double built_nats) {
    LookAlikeEvidence evidence;
    evidence.otherwise = 0.0;
    evidence.built.one.fill(built_nats);
    return weighed({pose(9)}, {evidence}, sort);
  };
  for (const PairSort sort : {PairSort::through_wall, PairSort::past_wall}) {
    EXPECT_LT(all(sort, 6.0).by_chance(), 0.5 * all(sort, 0.0).by_chance());
    EXPECT_GT(all(sort, -6.0).by_chance(), all(sort, 0.0).by_chance());
    EXPECT_EQ(all(sort, 0.0).others.look_alike, 0.0) << "look-alike rooms are searched there";
  }
}

TEST(Posterior, WhatChanceReachesInAModelIsLearnedThere) {
  const auto in_model = [](double asked, double explained, double others) {
    std::vector<FoundPose> poses{pose(30), pose(8), pose(8)};
    poses[0].walls = {asked, explained};
    poses[1].walls = poses[2].walls = {asked, others};
    return weighed(poses, {}, PairSort::in_model).best();
  };
  EXPECT_GT(in_model(60, 57, 20), 0.999);
  EXPECT_LT(in_model(60, 15, 14), 0.5);
}

TEST(Posterior, MoreWallsOfTheModelNeverMakeAPoseWorse) {
  // What chance reaches is much: a pose whose walls are hardly the model's gains less surface than it loses.
  std::vector<FoundPose> poses = {pose(89.0, 4.7), pose(95.0, 4.7)};
  poses[1].walls.asked = 17.5;
  double before = -1e9;
  for (double explained = 0.0; explained <= 17.5; explained += 0.5) {
    poses[0].walls.asked = 17.5;
    poses[0].walls.explained = explained;
    const double nats = nats_against_chance(poses, PairSort::in_model)[0];
    EXPECT_GE(nats, before - 1e-9) << explained;
    before = nats;
  }
}

TEST(Posterior, ABeliefMovesTheOddsBetweenPoses) {
  std::vector<FoundPose> poses{pose(30), pose(30)};
  PairQuestions questions;
  questions.contrast = [](std::size_t, std::size_t) { return PoseContrast{}; };
  poses[1].log_prior = 4.0;
  const Posterior all = weigh_poses(poses, PairSort::rooms, questions);
  EXPECT_EQ(all.order.front(), 1U);
  EXPECT_NEAR(all.probabilities[1] / all.probabilities[0], std::exp(-4.0), 1e-6);
}

/// Probabilities of the best pose, another one, a look-alike and chance.
Posterior odds(double best, double other, double look_alike, double chance, double slid = 0.0) {
  return {{0, 1}, {best, other}, {0.9 * chance, look_alike, 0.1 * chance}, slid};
}

const std::vector<UnobservedFreedom> kHeld;
const std::vector<UnobservedFreedom> kOpen = {{false, Vector3d::UnitX(), "shift along (1.00, 0.00, 0.00)"}};

TEST(OutcomeOf, ABestPoseIsRegisteredAtTheRiskAndProbableAtTheOther) {
  EXPECT_EQ(outcome_of(odds(0.9991, 0.0009, 0.0, 0.0), kHeld), Outcome::registered);
  EXPECT_EQ(outcome_of(odds(0.9989, 0.0011, 0.0, 0.0), kHeld), Outcome::probable);
  EXPECT_EQ(outcome_of(odds(0.951, 0.0, 0.049, 0.0), kHeld), Outcome::probable);
  EXPECT_EQ(outcome_of(odds(0.949, 0.0, 0.051, 0.0), kHeld), Outcome::ambiguous);
  EXPECT_EQ(outcome_of(odds(0.951, 0.0, 0.0, 0.049), kHeld), Outcome::probable);
  VerdictOptions options;
  options.risk = 0.01;
  options.probable_risk = 0.2;
  EXPECT_EQ(outcome_of(odds(0.991, 0.009, 0.0, 0.0), kHeld, options), Outcome::registered);
  EXPECT_EQ(outcome_of(odds(0.81, 0.19, 0.0, 0.0), kHeld, options), Outcome::probable);
}

TEST(OutcomeOf, WhereSomethingIsOpenThePlaceHasToBeProbable) {
  EXPECT_EQ(outcome_of(odds(0.9999, 0.0001, 0.0, 0.0), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.951, 0.049, 0.0, 0.0), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.85, 0.0, 0.15, 0.0), kOpen), Outcome::ambiguous);
  // A pose further on along what is open is the same place, and no other pose where nothing is.
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0, 0.5), kOpen), Outcome::under_constrained);
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0), kOpen), Outcome::ambiguous);
  EXPECT_EQ(outcome_of(odds(0.5, 0.5, 0.0, 0.0, 0.5), kHeld), Outcome::ambiguous);
}

TEST(OutcomeOf, WhereNothingSharedIsTheLikeliestNothingMatches) {
  EXPECT_EQ(outcome_of(odds(0.007, 0.0, 0.0, 0.993), kOpen), Outcome::no_match);
  EXPECT_EQ(outcome_of(odds(0.06, 0.54, 0.0, 0.4), kHeld), Outcome::no_match) << "many poses share that";
  EXPECT_EQ(outcome_of(odds(0.3, 0.3, 0.09, 0.31), kHeld), Outcome::no_match);
  EXPECT_EQ(outcome_of(odds(0.32, 0.3, 0.07, 0.31), kHeld), Outcome::ambiguous);
  EXPECT_EQ(outcome_of(odds(0.2, 0.1, 0.4, 0.3), kHeld), Outcome::ambiguous) << "a look-alike place";
  EXPECT_EQ(outcome_of(odds(0.2, 0.5, 0.0, 0.3, 0.3), kOpen), Outcome::ambiguous) << "the same place, slid";
  EXPECT_EQ(outcome_of({}, kHeld), Outcome::no_match);
}

TEST(ReasonOf, ItNamesWhatElseMayBe) {
  const auto reason = [](const Posterior& all) {
    return reason_of(outcome_of(all, kHeld), all, pose(7).score, {}, "a look-alike");
  };
  EXPECT_NE(reason(odds(0.9995, 0.0005, 0.0, 0.0)).find("7.0 m2 of surface agree"), std::string::npos);
  EXPECT_EQ(reason(odds(0.98631, 0.0, 0.01369, 0.0)),
            "probability 98.6 % (99.9 % is needed for registered): a look-alike");
  // What is below the limit does not read as if it reached it.
  EXPECT_NE(reason(odds(0.99898, 0.00102, 0.0, 0.0)).find("99.89 %"), std::string::npos);
  EXPECT_EQ(reason(odds(0.7, 0.0, 0.2, 0.1)), "a look-alike");
  EXPECT_NE(reason(odds(0.7, 0.0, 0.1, 0.2)).find("chance (20 %)"), std::string::npos);
  EXPECT_NE(reason(odds(0.7, 0.2, 0.1, 0.0)).find("one of them may be right"), std::string::npos);
  EXPECT_NE(reason(odds(0.1, 0.0, 0.1, 0.8)).find("do not overlap (80 %)"), std::string::npos);
}

TEST(ReasonOf, WhatContradictsTheBestOverlapIsNamedWhereThereIsAny) {
  EXPECT_EQ(overlap_words(3.21, 0.04), "best overlap 3.2 m2, which may be chance");
  EXPECT_EQ(overlap_words(3.21, 0.06),
            "best overlap 3.2 m2, but it puts 0.1 m2 of surface where the other scanner saw empty space");
}

TEST(ReasonOf, WhatIsOpenIsNamed) {
  const Posterior sure = odds(1.0, 0.0, 0.0, 0.0);
  EXPECT_EQ(reason_of(Outcome::under_constrained, sure, {}, {kOpen}, {}),
            "the common surface does not fix the shift along (1.00, 0.00, 0.00)");
  using Cause = OpenFreedoms::Cause;
  for (const auto& [cause, word] : {std::pair(Cause::drift, "drifts"), std::pair(Cause::moved, "were moved")})
    EXPECT_NE(reason_of(Outcome::under_constrained, sure, {}, {kOpen, cause}, {}).find(word),
              std::string::npos);
}

TEST(Posterior, ThroughWindowsContradictionSpeaksForALookAlikeRoom) {
  const auto look_alike = [](double agreeing_m2, double contradicted_m2) {
    return look_alike_through_windows(pose(agreeing_m2, contradicted_m2).score, PairSort::past_wall);
  };
  EXPECT_GT(odds_of(look_alike(20.0, 2.0)), 10.0 * odds_of(look_alike(20.0, 0.0)));
  // Agreeing surface excludes chance, and a look-alike room hardly.
  EXPECT_GT(odds_of(look_alike(40.0, 0.0)), 0.3 * odds_of(look_alike(20.0, 0.0)));
  EXPECT_GT(nats_against_chance({pose(40.0)}, PairSort::past_wall).front(),
            nats_against_chance({pose(20.0)}, PairSort::past_wall).front() + 10.0);
  const double stated = look_alike_through_windows({}, PairSort::past_wall, 0.05).otherwise;
  EXPECT_NEAR(stated, 0.05 * look_alike(0.0, 0.0).otherwise, 1e-12);
}

}  // namespace
}  // namespace limen
