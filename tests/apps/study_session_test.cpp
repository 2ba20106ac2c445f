// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/study_session.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "json/study_json.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "study/analysis_page.hpp"
#include "study/page_session.hpp"
#include "study/stimulus_player.hpp"
#include "text/study_text.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

class StudySessionTest : public testing::Test {
 protected:
  StudySessionTest() { write_atomically(study_file_, study_json(study_)); }
  std::string right(std::size_t place) const {
    const StudyTrial& trial = study_.trials[study_.order_of(1)[place - 1]];
    return study_.experiments[trial.experiment].kind == StudyAnswerKind::rating ? "3" : study_.right_answer(trial);
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string complaint(const std::function<void()>& work) {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "no exception";
  }
  Study study_ = design_study({.experiments = {"grains", "recognisability", "dimension"}, .participants = 3});
  TemporaryFolder folder_{"papilla-test"};
  fs::path study_file_ = folder_.path() / "STUDY.json";
};

TEST_F(StudySessionTest, GoesOnWhereItWas) {
  const fs::path answers = folder_.path() / "answers" / "participant-001.csv";
  {
    StudySession session(study_file_, 1, "");
    EXPECT_EQ(session.answers_file(), answers);
    EXPECT_EQ(session.next(), 1U);
    for (std::size_t place = 1; place <= 5; ++place) EXPECT_EQ(session.record(place, right(place), 2.5), "");
  }
  // Killed while a line was being written.
  std::ofstream(answers, std::ios::app) << study_.id << ",1,6,gra";
  StudySession session(study_file_, 1, "");
  EXPECT_GT(session.removed_bytes(), 0U);
  EXPECT_EQ(session.answered(), 5U);
  EXPECT_EQ(session.next(), 6U);
  for (std::size_t place = session.next(); place <= session.trials(); place = session.next())
    EXPECT_EQ(session.record(place, right(place), 1), "");
  EXPECT_EQ(read_answers(study_, {answers}).size(), session.trials());
}

TEST_F(StudySessionTest, TakesCorrectionsAndRefusesWhatIsNoAnswer) {
  StudySession session(study_file_, 1, folder_.path() / "own.csv");
  EXPECT_NE(session.record(1, "banana", 1), "");
  EXPECT_NE(session.record(0, right(1), 1), "");
  EXPECT_NE(session.record(session.trials() + 1, right(1), 1), "");
  EXPECT_NE(session.record(1, right(1), -1), "");
  EXPECT_EQ(session.next(), 1U);
  EXPECT_EQ(session.record(1, "spheres6", 1), "");
  EXPECT_EQ(session.record(1, "quads8", 1), "");
  EXPECT_EQ(session.answered(), 1U);
  const std::vector<StudyAnswer> read = read_answers(study_, {folder_.path() / "own.csv"});
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].answer, "quads8");
}

TEST_F(StudySessionTest, IsOfOneParticipantOfTheStudy) {
  EXPECT_NE(complaint([&] { StudySession(study_file_, 4, ""); }).find("has participants 1 to 3, not 4"),
            std::string::npos);
  { StudySession(study_file_, 1, folder_.path() / "own.csv").record(1, right(1), 1); }
  EXPECT_NE(complaint([&] {
              StudySession(study_file_, 2, folder_.path() / "own.csv");
            }).find("answers of participant 1, not 2"),
            std::string::npos);
}

TEST_F(StudySessionTest, PageHasTheTrialsAndNothingThatTellsThemApart) {
  StudySession session(study_file_, 1, "");
  const StimulusPlayer silent("", 8), playing("sim", 8);
  const std::string page = session_page(session, silent);
  EXPECT_NE(page.find("papilla-player"), std::string::npos);
  EXPECT_NE(page.find("Which one is rougher?"), std::string::npos);
  EXPECT_EQ(session_page(session, playing).find("--device"), std::string::npos);
  for (const char* secret : {"graph-orthogonal", "textured-normal", "\"dimension\":", "depth_mm"})
    EXPECT_EQ(page.find(secret), std::string::npos) << secret;
  EXPECT_EQ(page.find("http:"), std::string::npos);
  EXPECT_EQ(page.find("https:"), std::string::npos);
}

TEST_F(StudySessionTest, PageShowsTextsAsTheyAre) {
  Study marked = study_;
  marked.experiments[0].question = "</script><b>Which?</b>";
  write_atomically(study_file_, study_json(marked));
  const StudySession session(study_file_, 1, "");
  const StimulusPlayer player("", 8);
  EXPECT_EQ(session_page(session, player).find("<b>Which?"), std::string::npos);
}

TEST_F(StudySessionTest, CommandsAreQuotedForAShell) {
  const StimulusPlayer player("", 8);
  EXPECT_EQ(player.command("a/s001.glb"), "papilla-player a/s001.glb --device hid --seconds 8");
  EXPECT_EQ(player.command("it's/s 1.glb"), "papilla-player 'it'\\''s/s 1.glb' --device hid --seconds 8");
}

TEST_F(StudySessionTest, AThresholdThatNothingBoundsHasNoNumber) {
  EXPECT_EQ(threshold_text({43.7, {}, {}}), "not determined");
  EXPECT_EQ(threshold_text({0.25, {}, 0.5}), "0.25 (… to 0.5), not determined");
  EXPECT_EQ(threshold_text({0.25, 0.125, 0.5}), "0.25 (0.125 to 0.5)");
  StudyAnalysis analysis;
  StudyThreshold& threshold = analysis.thresholds.emplace_back();
  threshold.experiment = "dimension", threshold.condition = "lateral";
  threshold.threshold = {43.7, {}, {}};
  const std::string text = study_analysis_text(analysis, 0.95);
  EXPECT_NE(text.find("not determined by the levels and answers"), std::string::npos) << text;
  EXPECT_EQ(text.find("43.7"), std::string::npos) << text;
}

TEST_F(StudySessionTest, AnalysisIsShownWithItsOpenEnds) {
  std::vector<StudyAnswer> answers;
  for (std::size_t place = 1; place <= study_.order_of(1).size(); ++place)
    answers.push_back({1, place, right(place), 1, ""});
  const StudyAnalysis analysis = analyse_study(study_, answers, {.simulations = 10});
  ASSERT_FALSE(analysis.thresholds.empty());
  const Json json = study_analysis_json(analysis, 0.95);
  // All right: no lower end.
  EXPECT_TRUE(json["thresholds"][0]["low"].is_null());
  EXPECT_FALSE(json["thresholds"][0]["determined"].get<bool>());
  EXPECT_EQ(json["thresholds"][0]["factor"], "dimension");
  EXPECT_NE(study_analysis_text(analysis, 0.95).find("the levels do not determine it"), std::string::npos);
  const std::string page = study_page(study_, analysis, {{"a", "<?xml?><svg id='x'></svg>"}}, 0.95);
  EXPECT_NE(page.find("<svg id='x'>"), std::string::npos);
  EXPECT_EQ(page.find("<?xml"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

}  // namespace
}  // namespace papilla::app
