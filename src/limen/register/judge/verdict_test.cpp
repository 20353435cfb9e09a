// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/verdict.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

/// A pose held by one square metre in each direction, with the given surfaces.
JudgedPose pose(double agreeing_m2, double contradicted_m2, double shift_m) {
  JudgedPose judged;
  judged.refined.target_from_source.translation.x() = shift_m;
  judged.refined.centre.x() = shift_m;
  judged.refined.geometry_m2 = Matrix6d::Identity();
  judged.refined.information = 1e8 * Matrix6d::Identity();
  judged.score = {agreeing_m2, agreeing_m2, contradicted_m2, 100.0, 0.0, agreeing_m2};
  return judged;
}

/// What tells two poses apart: all of each.
Verdict judge_all(const std::vector<JudgedPose>& poses) {
  return judge(poses, [&](std::size_t a, std::size_t b) {
    return PoseContrast{poses[a].score.agreeing_m2, poses[b].score.agreeing_m2};
  });
}

TEST(Verdict, OneGoodPoseIsRegistered) {
  EXPECT_EQ(judge_all({pose(30, 0.5, 0), pose(20, 9, 3)}).outcome, Outcome::registered);
}

TEST(Verdict, NothingToJudgeIsNoMatch) {
  const Verdict verdict = judge_all({});
  EXPECT_EQ(verdict.outcome, Outcome::no_match);
  EXPECT_FALSE(verdict.reason.empty());
}

TEST(Verdict, TwoGoodPosesAreAmbiguous) {
  EXPECT_EQ(judge_all({pose(30, 0, 0), pose(29, 0, 2)}).outcome, Outcome::ambiguous);
}

TEST(Verdict, SurfaceThatAgreesUnderBothPosesTellsNothing) {
  // Both poses agree on 80 m2; of what tells them apart, 3 m2 speak for the first and 0.2 m2 for the second.
  const std::vector<JudgedPose> poses{pose(83, 0, 0), pose(80, 0.5, 0.12)};
  const auto contrast = [](std::size_t, std::size_t) { return PoseContrast{3.0, 0.2}; };
  EXPECT_EQ(judge(poses, contrast).outcome, Outcome::registered);
  const auto even = [](std::size_t, std::size_t) { return PoseContrast{3.0, 2.0}; };
  EXPECT_EQ(judge(poses, even).outcome, Outcome::ambiguous);
}

TEST(Verdict, OfAnAmbiguousPairThePoseLeadsThatWhatTellsThemApartSpeaksFor) {
  // More surface agrees under the first; of what tells the two apart 4 m2 speak for the second.
  const std::vector<JudgedPose> poses{pose(34, 0, 0), pose(32, 0, 2), pose(30, 0, 4)};
  const auto contrast = [](std::size_t a, std::size_t b) {
    const double said[] = {2.0, 6.0, 1.0};
    return PoseContrast{said[a], said[b]};
  };
  Verdict verdict = judge(poses, contrast);
  ASSERT_EQ(verdict.outcome, Outcome::ambiguous);
  EXPECT_EQ(verdict.ranking.front(), 0U);
  const std::vector<std::size_t> rivals = verdict.rivals;
  verdict = led_by_likeliest(verdict, poses, contrast);
  EXPECT_EQ(verdict.outcome, Outcome::ambiguous);
  EXPECT_EQ(verdict.ranking, (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_EQ(verdict.rivals.size(), rivals.size());
  EXPECT_NE(std::find(verdict.rivals.begin(), verdict.rivals.end(), 0U), verdict.rivals.end());
  EXPECT_EQ(std::find(verdict.rivals.begin(), verdict.rivals.end(), 1U), verdict.rivals.end());
  // What is asked in a ring comes to an end.
  const auto ring = [](std::size_t a, std::size_t b) {
    return (b + 3 - a) % 3 == 1 ? PoseContrast{1.0, 2.0} : PoseContrast{2.0, 1.0};
  };
  verdict = led_by_likeliest(judge(poses, ring), poses, ring);
  EXPECT_EQ(verdict.ranking.size(), 3U);
  // A pose that is no answer does not lead.
  std::vector<JudgedPose> loose = poses;
  loose[1].refined.geometry_m2.topLeftCorner<3, 3>().setZero();
  EXPECT_EQ(led_by_likeliest(judge(loose, contrast), loose, contrast).ranking.front(), 0U);
}

TEST(Verdict, APoseLessProbableThanTheRiskIsNoRival) {
  // Nearly as much speaks for the second pose; by so much less it is less probable than one in a thousand.
  const std::vector<JudgedPose> poses{pose(40, 0, 0), pose(36, 0, 3)};
  const auto outcome = [&](double lead_m2, double risk, bool through_wall) {
    VerdictOptions options;
    options.risk = risk;
    options.through_wall = through_wall;
    return judge(
               poses,
               [&](std::size_t, std::size_t) {
                 return PoseContrast{8.0 + lead_m2, 8.0};
               },
               options)
        .outcome;
  };
  EXPECT_EQ(outcome(3.7, 0.001, false), Outcome::registered);
  EXPECT_EQ(outcome(3.5, 0.001, false), Outcome::ambiguous);
  EXPECT_EQ(outcome(3.7, 1e-5, false), Outcome::ambiguous);
  EXPECT_EQ(outcome(6.2, 1e-5, false), Outcome::registered);
  EXPECT_EQ(outcome(4.2, 0.001, true), Outcome::ambiguous);
  EXPECT_EQ(outcome(4.4, 0.001, true), Outcome::registered);
}

/// A pose in a model, with a share of fourteen observations of walls on its surface.
JudgedPose pose_in_model(double agreeing_m2, double shift_m, double share) {
  JudgedPose judged = pose(agreeing_m2, 0, shift_m);
  judged.walls = {14.0, 14.0 * share};
  return judged;
}

Verdict judge_in_model(const std::vector<JudgedPose>& poses) {
  VerdictOptions options;
  options.in_model = true;
  return judge(
      poses,
      [&](std::size_t a, std::size_t b) {
        return PoseContrast{poses[a].score.agreeing_m2, poses[b].score.agreeing_m2};
      },
      options);
}

TEST(Verdict, WallsThatChanceExplainsForbidAPose) {
  const JudgedPose corner = pose_in_model(20, 0, 0.5);  // of a larger room
  EXPECT_EQ(judge_in_model({corner}).outcome, Outcome::no_match);
  // Nor does it stand in the way of a right one.
  const Verdict verdict = judge_in_model({corner, pose_in_model(30, 3, 0.9)});
  EXPECT_EQ(verdict.outcome, Outcome::registered);
  EXPECT_EQ(verdict.ranking.front(), 1U);
}

TEST(Verdict, APoseThatHardlyExceedsWhatWrongOnesReachIsNotSure) {
  const JudgedPose wrong = pose_in_model(29.5, 0, 0.5);
  EXPECT_EQ(judge_in_model({wrong, pose_in_model(30, 3, 0.85)}).outcome, Outcome::ambiguous);
  EXPECT_EQ(judge_in_model({wrong, pose_in_model(36, 3, 0.85)}).outcome, Outcome::registered);
  EXPECT_EQ(judge_in_model({wrong, pose_in_model(27, 3, 0.65)}).outcome, Outcome::no_match);
}

TEST(Verdict, TheSamePoseTwiceIsNoRival) {
  const Verdict verdict = judge_all({pose(30, 0, 0), pose(30, 0, 0.01)});
  EXPECT_EQ(verdict.outcome, Outcome::registered);
  EXPECT_EQ(verdict.ranking.size(), 1U);
}

TEST(Verdict, AnImpossiblePoseIsNoRival) {
  // It agrees more, but a third of it stands where the other scan saw free space.
  EXPECT_EQ(judge_all({pose(20, 0, 0), pose(60, 11, 2)}).outcome, Outcome::registered);
}

TEST(Verdict, ContradictedPoseIsNoMatch) {
  EXPECT_EQ(judge_all({pose(30, 6, 0)}).outcome, Outcome::no_match);
}

TEST(Verdict, LittleEvidenceBearsLittleContradiction) {
  EXPECT_EQ(judge_all({pose(4, 0.3, 0)}).outcome, Outcome::no_match);
  EXPECT_EQ(judge_all({pose(4, 0.05, 0)}).outcome, Outcome::registered);
}

TEST(Verdict, TooLittleSurfaceIsNoMatch) {
  EXPECT_EQ(judge_all({pose(1, 0, 0)}).outcome, Outcome::no_match);
}

TEST(Verdict, AnOpenShiftIsNamed) {
  JudgedPose open = pose(30, 0, 0);
  open.refined.geometry_m2(4, 4) = 0.0;
  const Verdict verdict = judge_all({open});
  ASSERT_EQ(verdict.outcome, Outcome::under_constrained);
  ASSERT_EQ(verdict.unobserved.size(), 1U);
  EXPECT_FALSE(verdict.unobserved[0].rotation);
  EXPECT_NEAR(std::abs(verdict.unobserved[0].direction.y()), 1.0, 1e-9);
  EXPECT_NE(verdict.reason.find("shift along"), std::string::npos);
}

TEST(Verdict, ThroughAWallWithoutAnOpeningContradictionWeighsMore) {
  VerdictOptions options;
  options.through_wall = true;
  const auto outcome = [&](const JudgedPose& pose) {
    return judge(
               {pose}, [](std::size_t, std::size_t) { return PoseContrast{}; }, options)
        .outcome;
  };
  EXPECT_EQ(outcome(pose(40, 1.0, 0)), Outcome::registered);
  EXPECT_EQ(outcome(pose(40, 2.0, 0)), Outcome::ambiguous);
  JudgedPose opened = pose(40, 2.0, 0);
  opened.score.opening_m2 = 3.0;
  EXPECT_EQ(outcome(opened), Outcome::registered);
}

TEST(Verdict, AShiftThatIsHardlyKnownIsNamed) {
  JudgedPose loose = pose(30, 0, 0);
  loose.refined.information(4, 4) = 1.0 / (0.024 * 0.024);
  const Verdict verdict = judge_all({loose});
  EXPECT_EQ(verdict.outcome, Outcome::under_constrained);
  ASSERT_EQ(verdict.unobserved.size(), 1U);
  EXPECT_NEAR(verdict.unobserved[0].direction.y(), 1.0, 1e-9);
  EXPECT_NE(verdict.unobserved[0].name.find("24 mm"), std::string::npos);
}

TEST(Verdict, ATrajectoryThatDriftsFarLeavesAShiftOpen) {
  Matrix6d covariance = 1e-8 * Matrix6d::Identity();
  covariance.bottomRightCorner<3, 3>() += 0.03 * 0.03 * Matrix3d::Identity();
  EXPECT_TRUE(open_freedoms(pose(30, 0, 0).refined, covariance).list.empty());
  covariance(3, 3) = 0.06 * 0.06;
  const OpenFreedoms open = open_freedoms(pose(30, 0, 0).refined, covariance);
  EXPECT_TRUE(open.by_drift);
  ASSERT_EQ(open.list.size(), 1U);
  EXPECT_NE(open.list[0].name.find("60 mm"), std::string::npos);
  // What the surface itself leaves open comes first.
  JudgedPose slides = pose(30, 0, 0);
  slides.refined.geometry_m2(4, 4) = 0.0;
  EXPECT_FALSE(open_freedoms(slides.refined, covariance).by_drift);
}

TEST(Verdict, APoseFurtherOnAlongAnOpenShiftIsTheSamePlace) {
  JudgedPose open = pose(30, 0, 0);
  EXPECT_FALSE(is_slid(open.refined, pose(29, 0, 2).refined));
  open.refined.geometry_m2(3, 3) = 0.0;
  EXPECT_TRUE(is_slid(open.refined, pose(29, 0, 2).refined));
  JudgedPose elsewhere = pose(29, 0, 2);
  elsewhere.refined.target_from_source.translation.y() = 2;
  EXPECT_FALSE(is_slid(open.refined, elsewhere.refined));
}

TEST(Verdict, RivalsAlongAnOpenShiftAreTheSameAnswer) {
  JudgedPose open = pose(30, 0, 0);
  open.refined.geometry_m2(3, 3) = 0.0;
  EXPECT_EQ(judge_all({open, pose(29, 0, 2)}).outcome, Outcome::under_constrained);
  JudgedPose elsewhere = pose(29, 0, 0);
  elsewhere.refined.target_from_source.translation.y() = 2;
  EXPECT_EQ(judge_all({open, elsewhere}).outcome, Outcome::ambiguous);
}

TEST(Verdict, APoseThatMayTurnIsNoAnswer) {
  JudgedPose loose = pose(30, 0, 0);
  loose.refined.geometry_m2(2, 2) = 0.0;
  EXPECT_EQ(judge_all({loose}).outcome, Outcome::no_match);
}

TEST(Verdict, AShiftHeldOnlyThroughATurnIsOpen) {
  // Coupling: what holds the shift is the same tile that would have to hold the turn.
  JudgedPose coupled = pose(30, 0, 0);
  coupled.refined.geometry_m2(2, 4) = coupled.refined.geometry_m2(4, 2) = 0.9999;
  EXPECT_FALSE(unobserved_freedoms(coupled.refined, 0.03).empty());
}

TEST(Verdict, OptionsNameTheirBound) {
  VerdictOptions options;
  options.max_rival_share = 1.5;
  EXPECT_THROW(judge({}, {}, options), Error);
  for (const double probable : {0.001, 0.0005, 0.5}) {
    options = {};
    options.probable_risk = probable;
    EXPECT_THROW(options.check(), Error) << probable;
  }
}

}  // namespace
}  // namespace limen
