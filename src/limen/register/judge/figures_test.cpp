// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/figures.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace limen {
namespace {

/// Pieces all over an upright box that is at a place.
std::vector<Vector3d> standing(const Vector3d& foot, const Vector3d& size) {
  constexpr double kPieceM = 0.1;
  std::vector<Vector3d> pieces;
  for (double x = 0.5 * kPieceM; x < size.x(); x += kPieceM)
    for (double y = 0.5 * kPieceM; y < size.y(); y += kPieceM)
      for (double z = 0.5 * kPieceM; z < size.z(); z += kPieceM) pieces.push_back(foot + Vector3d(x, y, z));
  return pieces;
}

const Vector3d kPerson(0.5, 0.3, 1.75);

std::optional<double> at_zero(const Vector3d&) {
  return 0.0;
}

std::optional<double> nowhere(const Vector3d&) {
  return std::nullopt;
}

long count_in(const std::vector<int>& figures) {
  return std::count_if(figures.begin(), figures.end(), [](int number) { return number >= 0; });
}

TEST(Figures, WhoStandsClearIsOne) {
  const std::vector<Vector3d> person = standing({2, 1, 0}, kPerson);
  EXPECT_EQ(count_in(find_figures(person, at_zero)), static_cast<long>(person.size()));
  EXPECT_EQ(count_in(find_figures(person, nowhere)), static_cast<long>(person.size()));
  EXPECT_TRUE(find_figures({}, at_zero).empty());
}

TEST(Figures, HalfSeenOneStillIs) {
  // A table hides the legs.
  std::vector<Vector3d> person = standing({2, 1, 0}, kPerson);
  person.erase(std::remove_if(person.begin(), person.end(), [](const Vector3d& x) { return x.z() < 0.9; }),
               person.end());
  EXPECT_EQ(count_in(find_figures(person, at_zero)), static_cast<long>(person.size()));
}

TEST(Figures, FurnitureIsNone) {
  EXPECT_EQ(count_in(find_figures(standing({0, 0, 0}, {0.5, 0.5, 0.9}), at_zero)), 0);    // a chair
  EXPECT_EQ(count_in(find_figures(standing({0, 0, 0}, {1.2, 0.4, 1.8}), at_zero)), 0);    // a cupboard
  EXPECT_EQ(count_in(find_figures(standing({0, 0, 1.9}, {0.4, 0.4, 0.8}), at_zero)), 0);  // below a ceiling
}

TEST(Figures, TwoAreDistinguishedAndWhoTouchesATableIsNone) {
  std::vector<Vector3d> room = standing({0, 0, 0}, kPerson);
  const std::vector<Vector3d> other = standing({2, 0, 0}, kPerson);
  const std::vector<Vector3d> table = standing({2.5, 0, 0.7}, {1.5, 0.8, 0.1});
  room.insert(room.end(), other.begin(), other.end());
  std::vector<int> figures = find_figures(room, at_zero);
  EXPECT_EQ(count_in(figures), static_cast<long>(room.size()));
  EXPECT_NE(figures.front(), figures.back());
  room.insert(room.end(), table.begin(), table.end());
  figures = find_figures(room, at_zero);
  EXPECT_EQ(count_in(figures), static_cast<long>(room.size() - other.size() - table.size()));
}

TEST(Figures, TurnedAndMovedTheyAreTheSame) {
  const std::vector<Vector3d> person = standing({2, 1, 0}, kPerson);
  for (const double angle : {0.3, 1.1, 2.0}) {
    std::vector<Vector3d> moved;
    for (const Vector3d& x : person)
      moved.push_back({std::cos(angle) * x.x() - std::sin(angle) * x.y() - 700.0,
                       std::sin(angle) * x.x() + std::cos(angle) * x.y() + 30.0, x.z()});
    EXPECT_EQ(count_in(find_figures(moved, at_zero)), static_cast<long>(person.size()));
  }
}

}  // namespace
}  // namespace limen
