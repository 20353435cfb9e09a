// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/bounded_json.h"

#include <sstream>

#include <gtest/gtest.h>

namespace limen {
namespace {

using nlohmann::json;

std::string nested(int depth, const std::string& open, const std::string& close) {
  std::string text;
  for (int k = 0; k < depth; ++k) text += open;
  text += "1";
  for (int k = 0; k < depth; ++k) text += close;
  return text;
}

TEST(BoundedJson, ValuesUpToTheBoundAreRead) {
  EXPECT_EQ(parsed_json<json>(std::string(R"({"a": [1, {"b": null}]})"))["a"][0], 1);
  EXPECT_EQ(parsed_json<json>(nested(kDeepestJson, "[", "]")).size(), 1U);
  EXPECT_THROW(parsed_json<json>(nested(kDeepestJson + 1, "[", "]")), JsonTooDeep);
  EXPECT_THROW(parsed_json<nlohmann::ordered_json>(nested(kDeepestJson + 1, "{\"a\":", "}")), JsonTooDeep);
  // Beside one another, not in one another.
  std::string wide = "[0";
  for (int k = 0; k < 1000; ++k) wide += ",[1]";
  EXPECT_EQ(parsed_json<json>(wide + "]").size(), 1001U);
}

TEST(BoundedJson, WhatIsDeeperOrNoJsonIsNothingToWhoAsksSo) {
  std::istringstream deep(nested(130000, "[", "]"));
  EXPECT_TRUE(json_or_nothing<json>(deep).is_discarded());
  EXPECT_TRUE(json_or_nothing<json>(std::string("{")).is_discarded());
  EXPECT_TRUE(json_or_nothing<json>(std::string("1e999")).is_discarded());
  EXPECT_EQ(json_or_nothing<json>(std::string("[2]"))[0], 2);
  EXPECT_THROW(parsed_json<json>(std::string("{")), json::parse_error);
}

}  // namespace
}  // namespace limen
