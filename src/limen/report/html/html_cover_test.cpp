// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_cover.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(ReportCover, IsEscapedAndLeftOutWhereNothingIsSaid) {
  EXPECT_EQ(cover_facts({}), "");
  const std::string html = cover_facts({"<b>Title</b>", "A & B", "", "", Language::german});
  EXPECT_EQ(html.find("<b>Title"), std::string::npos);
  EXPECT_NE(html.find("A &amp; B"), std::string::npos);
  EXPECT_NE(html.find("lang=\"de\""), std::string::npos);
  EXPECT_EQ(html.find("Operator"), std::string::npos);
}

}  // namespace
}  // namespace limen
