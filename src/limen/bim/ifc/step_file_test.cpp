// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/step_file.h"

#include <string>

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(StepFile, CommentsTextsAndLostSemicolons) {
  const std::string text =
      "ISO-10303-21;\nFILE_SCHEMA(('ifc4'));\n/* #9=X(); */ #2 = IFCB('a;b''c', /* no */ (1,(2,3)), $ ) ;\n"
      "#1=IFCA(#2,.T.)\n#3=IFCC('lost mark);\n#4=IFCD();\nEND-ISO-10303-21;\n";
  const StepFile file(text);
  EXPECT_EQ(file.schema(), "IFC4");
  EXPECT_TRUE(file.whole());
  EXPECT_EQ(file.entities().size(), 3U);
  EXPECT_EQ(file.damaged(), 1U);
  ASSERT_NE(file.find(2), nullptr);
  const auto arguments = step_arguments(file.find(2)->arguments);
  ASSERT_EQ(arguments.size(), 3U);
  EXPECT_EQ(step_text(arguments[0]), "a;b'c");
  EXPECT_EQ(step_references(step_arguments(file.find(1)->arguments)[0]), std::vector<std::int64_t>{2});
  EXPECT_EQ(file.find(9), nullptr);
  EXPECT_NE(file.find(4), nullptr);
  EXPECT_DOUBLE_EQ(step_number("IFCLENGTHMEASURE(0.3048)").value_or(0.0), 0.3048);
  EXPECT_EQ(step_enumeration(".Roof."), "ROOF");
}

}  // namespace
}  // namespace limen
