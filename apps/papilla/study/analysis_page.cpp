// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/analysis_page.hpp"

#include <fmt/format.h>

#include "html_text.hpp"
#include "papilla/core/error.hpp"
#include "text/study_text.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_style =
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em;max-width:80rem}table{border-collapse:collapse;"
    "font-variant-numeric:tabular-nums}td,th{padding:2px 10px;text-align:left;vertical-align:top;border-bottom:1px "
    "solid "
    "#8886}td.n{text-align:right}svg{max-width:100%;height:auto;display:block;margin:1em 0}.soft{opacity:.75}";

std::string cell(const std::string& text) { return "<td>" + html_text(text); }
std::string number(double value) { return fmt::format("<td class=\"n\">{:.4g}", value); }

std::string thresholds_table(const StudyAnalysis& analysis) {
  if (analysis.thresholds.empty()) return "";
  std::string html =
      "<h2>Thresholds</h2><p>The difference that is told in three of four choices.</p><table><tr><th>experiment"
      "<th>condition<th>threshold<th>unit<th>slope<th>lapses<th>deviance<th>degrees<th>p of fit<th>choices</tr>\n";
  for (const StudyThreshold& t : analysis.thresholds) {
    int choices = 0;
    for (const ChoiceLevel& level : t.levels) choices += level.trials;
    html += "<tr>" + cell(t.experiment) + cell(t.condition) + cell(threshold_text(t.threshold)) +
            cell(std::string(difference_unit(t.factor))) + cell(estimate_text(t.slope)) + number(t.fit.function.lapse) +
            number(t.fit.deviance) + number(t.fit.degrees) +
            (t.fit.degrees >= 1 ? number(t.fit.deviance_p) : cell("-")) + number(choices) + "</tr>\n";
  }
  html +=
      "</table><h3>By participant</h3><table><tr><th>experiment<th>condition<th>participant<th>threshold"
      "<th>choices</tr>\n";
  for (const StudyThreshold& t : analysis.thresholds)
    for (const ParticipantThreshold& own : t.participants)
      html += "<tr>" + cell(t.experiment) + cell(t.condition) + number(static_cast<double>(own.participant)) +
              cell(threshold_text(own.threshold)) + number(own.trials) + "</tr>\n";
  return html + "</table>\n";
}

std::string effects_table(const StudyAnalysis& analysis) {
  std::string html =
      "<h2>Effects of factors</h2><p>Each with the others as they are. Ratings in steps of their scale, right answers "
      "in "
      "log "
      "odds.</p><table><tr><th>experiment<th>factor<th>level<th>against<th>effect<th>answers<th>participants</tr>\n";
  for (const StudyRegression& r : analysis.regressions) {
    if (!r.problem.empty())
      html += "<tr>" + cell(r.experiment) + "<td colspan=\"6\">" + html_text("none: " + r.problem) + "</tr>\n";
    for (const StudyEffect& e : r.effects)
      html += "<tr>" + cell(r.experiment) + cell(e.factor) + cell(e.level) + cell(e.reference) +
              cell(estimate_text(e.effect) + (e.is_determined ? "" : ", no finite value fits best")) +
              number(static_cast<double>(r.answers)) + number(static_cast<double>(r.participants)) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string ratings_table(const StudyAnalysis& analysis) {
  if (analysis.ratings.empty()) return "";
  std::string html =
      "<h2>Ratings</h2><table><tr><th>experiment<th>stimulus<th>answers<th>mean<th>deviation<th>answers by step</tr>\n";
  for (const StudyRating& r : analysis.ratings)
    html += "<tr>" + cell(r.experiment) + cell(r.stimulus) + number(r.answers) + number(r.mean) + number(r.deviation) +
            cell(fmt::format("{}", fmt::join(r.counts, " "))) + "</tr>\n";
  return html + "</table>\n";
}

std::string recognition_tables(const StudyAnalysis& analysis) {
  std::string html;
  for (const StudyRecognition& r : analysis.recognitions) {
    html += fmt::format(
        "<h2>Grains on {:g} mm</h2><p>Right {}, right shape {}, coarse or fine right {}. Rows: "
        "presented; columns: answered.</p><table><tr><th>",
        r.size_mm, html_text(estimate_text(r.right)), html_text(estimate_text(r.shape)),
        html_text(estimate_text(r.fineness)));
    for (const std::string& label : r.labels) html += "<th>" + html_text(label);
    html += "</tr>\n";
    for (std::size_t i = 0; i < r.labels.size(); ++i) {
      html += "<tr><th>" + html_text(r.labels[i]);
      for (const int count : r.counts[i]) html += number(count);
      html += "</tr>\n";
    }
    html += "</table>\n";
  }
  return html;
}

}  // namespace

std::string study_page(const Study& study, const StudyAnalysis& analysis, const std::vector<StudyPicture>& pictures,
                       double confidence) {
  std::string html = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
      "<meta name=\"color-scheme\" content=\"light dark\"><meta http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; style-src 'unsafe-inline'\"><title>Study {0}</title><style>{1}</style>\n"
      "<h1>Study {0}</h1><p>{2} participants, {3} of {4} trials answered. In brackets the interval of {5:g} %, of each "
      "number by itself; … is an end that the answers leave open.</p>\n",
      html_text(study.id), k_style, analysis.participants, analysis.answers, analysis.trials, 100 * confidence);
  if (pictures.empty()) html += "<p>No plots: gnuplot is not installed, or there is nothing to draw.</p>\n";
  for (const StudyPicture& picture : pictures) {
    const std::size_t root = picture.svg.find("<svg");
    html += root == std::string::npos ? picture.svg : picture.svg.substr(root);
  }
  html += thresholds_table(analysis) + effects_table(analysis) + ratings_table(analysis) + recognition_tables(analysis);
  return html + fmt::format("<footer class=\"soft\">papilla {}</footer></html>\n", version());
}

}  // namespace papilla::app
