// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/start_option.h"

#include <string>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"

namespace limen {
namespace {

TEST(StartOption, ReadsTheIdentityAndDeviations) {
  EXPECT_FALSE(start_of("", "").has_value());
  const auto start = start_of("identity", "30cm,0.5deg");
  ASSERT_TRUE(start.has_value());
  EXPECT_TRUE(start->target_from_source.rotation.isIdentity());
  EXPECT_DOUBLE_EQ(start->sigma_m, 0.3);
  EXPECT_DOUBLE_EQ(start->sigma_rad, radians(0.5));
  EXPECT_DOUBLE_EQ(start_of("identity", "1.5km,1rad")->sigma_m, 1500.0);
  EXPECT_DOUBLE_EQ(start_of("identity", "")->sigma_m, StartPrior{}.sigma_m);
}

TEST(StartOption, SaysWhatIsWrong) {
  for (const char* bad :
       {"2m", "2,5", "2m,5", "m,deg", "-1m,5deg", "0m,5deg", "nanm,5deg", "2m,5deg,", "2ft,5deg"}) {
    try {
      (void)start_of("identity", bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("--start-sigma"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(start_of("", "2m,5deg"), Error);
  EXPECT_THROW(start_of("no/such/file.txt", ""), Error);
}

}  // namespace
}  // namespace limen
