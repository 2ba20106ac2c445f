// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/evaluation_files.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "evaluate/param_table.hpp"
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

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++count;
  return count;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<EvaluationRun> mapped_runs() {
  std::vector<EvaluationRun> runs{{"best", "newton", "50%_a&b.obj", "error", {}, "direct"},
                                  {"lscm", "cgal", "50%_a&b.obj", "error", {}, "direct"},
                                  {"lscm", "cgal", "50%_a&b.obj", "another error", {}, "direct"}};
  EvaluatedMap map{"50%_a&b.obj", 12, 3, 3, 1, {}, true, ""};
  map.distortion.measured_triangles = 12;
  map.distortion.symmetric_dirichlet = {4.0001234, 1.5e7};
  runs[0].map = map;
  map.failure = "no disk";
  runs[1].map = map;
  return runs;
}

TEST(ParamTable, CsvHasALineARow) {
  const std::vector<std::string> lines = lines_of(param_csv(mapped_runs(), {}));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].rfind("input,method,solver,chart_source,normalize,outcome,triangles,given_charts,charts,", 0), 0u);
  for (const std::string& line : lines) EXPECT_EQ(count_of(line, ","), count_of(lines[0], ",")) << line;
  EXPECT_EQ(lines[1].rfind("50%_a&b.obj,best,newton,auto,scene,valid,12,3,3,1,0,0,0,4.0001234,15000000,", 0), 0u);
  EXPECT_EQ(lines[2].rfind("50%_a&b.obj,lscm,cgal,auto,scene,no result,12,3,,,,,,,", 0), 0u);
  EXPECT_NE(lines[2].find(",no disk\r"), std::string::npos);
  const Json rows = param_rows_json(mapped_runs(), {});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["symmetric_dirichlet_mean"], 4.0001234);
  EXPECT_TRUE(rows[1]["charts"].is_null());
}

TEST(ParamTable, LatexIsBalanced) {
  ParamComparison comparison;
  comparison.charts = ChartSource::uv;
  const std::string latex = param_latex(mapped_runs(), comparison, "papilla evaluate param 'a\n\\input{x}'");
  for (const std::string environment : {"table*", "tabular"}) {
    EXPECT_EQ(count_of(latex, "\\begin{" + environment + "}"), 1u);
    EXPECT_EQ(count_of(latex, "\\end{" + environment + "}"), 1u);
  }
  int depth = 0;
  std::size_t dollars = 0, rows = 0, columns = 0;
  for (const std::string& line : lines_of(latex)) {
    if (line[0] == '%') continue;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\\' && i + 1 < line.size()) {
        ++i;
        continue;
      }
      depth += (line[i] == '{') - (line[i] == '}');
      EXPECT_GE(depth, 0);
      dollars += line[i] == '$';
      EXPECT_NE(line[i], '#');
    }
    if (line.rfind("\\begin{tabular}", 0) == 0) columns = line.rfind('}') - line.rfind('{') - 1;
    if (line.size() < 2 || line.substr(line.size() - 2) != "\\\\") continue;
    ++rows;
    // A heading over two columns stands for one more.
    EXPECT_EQ(count_of(line, "&") - count_of(line, "\\&") + count_of(line, "\\multicolumn{2}"), columns - 1) << line;
  }
  EXPECT_EQ(depth, 0);
  EXPECT_EQ(dollars % 2, 0u);
  EXPECT_EQ(rows, 4u);  // two of headings
  EXPECT_NE(latex.find("50\\%\\_a\\&b.obj & best (newton) & 3 & 1 & 0 & 4.0001 & $1.5\\times10^{7}$ &"),
            std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\n & lscm (cgal) & -- & -- & --"), std::string::npos) << latex;
  // The command stays in its comment.
  EXPECT_EQ(lines_of(latex)[0].rfind("% papilla ", 0), 0u);
  EXPECT_NE(lines_of(latex)[0].find("input{x}"), std::string::npos);
  EXPECT_EQ(latex_text("a\\b{~}<#>"), "a\\textbackslash{}b\\{\\textasciitilde{}\\}\\textless{}\\#\\textgreater{}");
}

}  // namespace
}  // namespace papilla::app
