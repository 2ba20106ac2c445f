// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation_files.hpp"

#include <gtest/gtest.h>

#include "json/evaluation_json.hpp"

namespace papilla::app {
namespace {

TEST(Evaluation, QuotesAndEscapesNames) {
  const std::vector<EvaluationRun> runs{
      {"a<b>", "\"x\"", "f,1", "error", {{0.5, 2}}, "direct", "<script>", true, {}, {{{0.25, 2}}}}};
  EXPECT_EQ(runs_csv(runs),
            "method,solver,input,error_name,repeat,seconds,error\r\n"
            "a<b>,\"\"\"x\"\"\",\"f,1\",error,0,0.5,2\r\n"
            "a<b>,\"\"\"x\"\"\",\"f,1\",error,1,0.25,2\r\n");
  const std::string html = runs_html("kind", {}, runs);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_NE(html.find("a&lt;b&gt;"), std::string::npos);
  EXPECT_EQ(runs_json(runs)[0]["repeats"][0][0]["seconds"], 0.25);
}

TEST(Stability, TablesHaveNoBlankCell) {
  StabilitySuite suite{"s", "S", "e", "r", {}};
  suite.cells.push_back({"a|b", "in", Outcome::holds, 0.5, {}, {}, 0.1, ""});
  suite.cells.push_back({"c", "in", Outcome::refuses, {}, {}, 3, 0.1, "a <reason>"});
  const std::string md = stability_markdown({suite});
  EXPECT_EQ(md.find("|  |"), std::string::npos);
  EXPECT_NE(md.find("| in | holds 0.5 | refuses |"), std::string::npos);
  EXPECT_NE(md.find("a\\|b"), std::string::npos);
  EXPECT_EQ(stability_html({suite}).find("<reason>"), std::string::npos);
  EXPECT_NE(stability_csv({suite}).find("s,c,in,refuses,,,3,0.1,a <reason>"), std::string::npos);
}

}  // namespace
}  // namespace papilla::app
