// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/length_unit.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(LengthUnit, NamesAndFactors) {
  for (const LengthUnit& unit : length_units()) {
    EXPECT_EQ(length_unit(unit.name)->metres_per_unit, unit.metres_per_unit);
    EXPECT_EQ(unit_name(unit.metres_per_unit), unit.name);
  }
  EXPECT_EQ(length_unit("ft")->metres_per_unit, 0.3048);
  EXPECT_NEAR(length_unit("us-ft")->metres_per_unit, 0.3048006096, 1e-10);
  EXPECT_FALSE(length_unit("furlong"));
  EXPECT_EQ(unit_name(0.25), "0.25 m");
}

}  // namespace
}  // namespace limen
