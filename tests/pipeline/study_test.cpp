// SPDX-License-Identifier: MIT
#include "papilla/pipeline/study/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/pipeline/study/simulated_participant.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"
#include "papilla/pipeline/study/study_answers.hpp"
#include "papilla/pipeline/study/study_stimuli.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The message that `work` ends with.
template <class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

std::size_t experiment_index(const Study& study, std::string_view id) {
  for (std::size_t e = 0; e < study.experiments.size(); ++e)
    if (study.experiments[e].id == id) return e;
  return study.experiments.size();
}

// Design --------------------------------------------------------------------------------------------------------------

TEST(StudyDesign, HasTheStimuliOfTheSource) {
  const Study study = design_study();
  std::set<std::string> grains, models;
  std::set<double> heights, dimensions, sizes;
  for (const StudyStimulus& s : study.stimuli) {
    grains.insert(s.grain);
    models.insert(s.model);
    heights.insert(s.height);
    sizes.insert(s.size_mm);
    if (s.dimension) dimensions.insert(*s.dimension);
  }
  for (const char* grain : {"spheres6", "spheres8", "ovals6", "ovals8", "quads6", "quads8", "fractal"})
    EXPECT_TRUE(grains.contains(grain)) << grain;
  for (const double height : {1.0, 2.0, 4.0}) EXPECT_TRUE(heights.contains(height));
  EXPECT_EQ(dimensions, (std::set<double>{2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8, 2.9}));
  EXPECT_EQ(sizes, (std::set<double>{40, 80}));
  for (const char* model :
       {"heightfield", "textured-normal", "orthogonal", "lateral", "graph-orthogonal", "graph-lateral"})
    EXPECT_TRUE(models.contains(model)) << model;
  // 2 × 5 grains; 3 × 3 × 4 and 9 × 4 ratings; 8 pairs × 2 orders × 4 models and 6 × 2 × 3 grains, each twice.
  EXPECT_EQ(study.order_of(1).size(), 10U + 36 + 36 + 128 + 72);
}

TEST(StudyDesign, IsBalanced) {
  const Study study = design_study({.participants = 24});
  const std::size_t grains = experiment_index(study, "grains");
  std::map<std::size_t, int> left_out, first_block;
  for (std::size_t p = 1; p <= 24; ++p) {
    std::map<std::size_t, int> count;
    std::map<std::string, int> right;
    for (const std::size_t trial : study.order_of(p)) {
      ++count[trial];
      if (study.experiments[study.trials[trial].experiment].kind == StudyAnswerKind::choice)
        ++right[study.right_answer(study.trials[trial])];
    }
    // Of every pair both orders, equally often.
    EXPECT_EQ(right["first"], right["second"]);
    for (std::size_t t = 0; t < study.trials.size(); ++t) {
      const StudyExperiment& experiment = study.experiments[study.trials[t].experiment];
      if (study.trials[t].experiment == grains)
        left_out[t] += count[t] == 0 ? 1 : 0;
      else
        EXPECT_EQ(count[t], experiment.kind == StudyAnswerKind::choice ? 2 : 1);
    }
    for (const StudyBlock& block : study.participants[p - 1])
      if (study.experiments[study.trials[block.trials[0]].experiment].id == "roughness") {
        ++first_block[*std::min_element(block.trials.begin(), block.trials.end())];
        break;
      }
  }
  // Twelve trials, two of which everyone lacks; four models, each of which is first for a quarter.
  EXPECT_EQ(left_out.size(), 12U);
  for (const auto& [trial, times] : left_out) EXPECT_EQ(times, 4);
  EXPECT_EQ(first_block.size(), 4U);
  for (const auto& [model, times] : first_block) EXPECT_EQ(times, 6);
}

TEST(StudyDesign, OrdersAreRandomRepeatableAndGiveNothingAway) {
  const Study a = design_study({.seed = 3}), b = design_study({.seed = 3}), c = design_study({.seed = 4});
  EXPECT_EQ(study_json(a), study_json(b));
  EXPECT_NE(a.id, c.id);
  EXPECT_NE(a.order_of(1), a.order_of(2));
  EXPECT_NE(a.order_of(1), c.order_of(1));
  // File names: not in the order of the stimuli.
  std::vector<std::string> files;
  for (const StudyStimulus& s : a.stimuli) files.push_back(s.file);
  EXPECT_FALSE(std::is_sorted(files.begin(), files.end()));
  EXPECT_EQ(std::set<std::string>(files.begin(), files.end()).size(), files.size());
}

TEST(StudyDesign, NamesWhatCanNotBe) {
  EXPECT_NE(complaint([] { design_study({.experiments = {"grain"}}); }).find("did you mean 'grains'?"),
            std::string::npos);
  EXPECT_NE(complaint([] { design_study({.dimensions = {2.1}}); }).find("dimensions: two or more"), std::string::npos);
  EXPECT_NE(complaint([] { design_study({.dimensions = {2.1, 3}}); }).find("3 is not from"), std::string::npos);
  EXPECT_NE(complaint([] { design_study({.models = {"heightfield"}}); }).find("models"), std::string::npos);
  EXPECT_NE(complaint([] { design_study({.height_steps = {1}}); }).find("height_steps"), std::string::npos);
  EXPECT_NE(complaint([] { design_study({.heights = {2, 2}}); }).find("twice"), std::string::npos);
  EXPECT_NE(complaint([] { design_study({.participants = 0}); }).find("participants"), std::string::npos);
}

// Files ---------------------------------------------------------------------------------------------------------------

class StudyFile : public testing::Test {
 protected:
  Study read(const std::string& text) const {
    const fs::path file = folder_.path() / "STUDY.json";
    std::ofstream(file, std::ios::binary) << text;
    return read_study(file);
  }
  TemporaryFolder folder_{"papilla-test"};
};

TEST_F(StudyFile, IsReadAsItWasWritten) {
  for (const char* language : {"en", "de"}) {
    const std::string text = study_json(design_study({.participants = 3, .language = language, .seed = 9}));
    EXPECT_EQ(study_json(read(text)), text);
  }
}

TEST_F(StudyFile, NamesThePlaceOfWhatIsWrong) {
  const Json good = Json::parse(study_json(design_study({.participants = 2})));
  const auto said = [&](const char* pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    return complaint([&] { read(bad.dump()); });
  };
  EXPECT_NE(said("/versoin", 1).find("did you mean 'version'?"), std::string::npos);
  EXPECT_NE(said("/version", 2).find("at /version: only version 1"), std::string::npos);
  EXPECT_NE(said("/stimuli/3/file", "../../etc/passwd").find("at /stimuli/3/file"), std::string::npos);
  EXPECT_NE(said("/stimuli/3/file", "/etc/passwd").find("at /stimuli/3/file"), std::string::npos);
  EXPECT_NE(said("/stimuli/0/model", "magic").find("at /stimuli/0/model"), std::string::npos);
  EXPECT_NE(said("/trials/5/stimuli", Json::array({100000})).find("at /trials/5/stimuli/0"), std::string::npos);
  EXPECT_NE(said("/trials/0/experiment", 1.5).find("at /trials/0/experiment"), std::string::npos);
  EXPECT_NE(said("/participants/1/0/trials", Json::array()).find("at /participants/1/0/trials"), std::string::npos);
  EXPECT_NE(said("/experiments/0/labels/0", "a,b").find("at /experiments/0/labels/0"), std::string::npos);
  EXPECT_NE(said("/experiments/1/range", Json::array({5, 1})).find("at /experiments/1/range"), std::string::npos);
  EXPECT_NE(said("/id", "a,b").find("at /id"), std::string::npos);
}

/// What the schema allows is what the reader reads: the same keys of every object.
TEST_F(StudyFile, SchemaKnowsTheReadersKeys) {
  const Json schema = Json::parse(std::ifstream(PAPILLA_SCHEMAS "/study.schema.json"));
  const Json good = Json::parse(study_json(design_study({.participants = 1})));
  const auto known = [&](const char* pointer) {
    Json bad = good;
    bad[Json::json_pointer(pointer)]["spoon"] = 1;
    const std::string text = complaint([&] { read(bad.dump()); }), head = "known are ";
    std::set<std::string> keys;
    std::string key;
    for (const char c : text.substr(text.find(head) + head.size()) + ",")
      if (c == ',')
        keys.insert(std::exchange(key, {}));
      else if (c != ' ')
        key += c;
    return keys;
  };
  const auto of_schema = [](const Json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.at("properties").items()) keys.insert(key);
    return keys;
  };
  EXPECT_EQ(known(""), of_schema(schema));
  EXPECT_EQ(known("/experiments/0"), of_schema(schema["$defs"]["experiment"]));
  EXPECT_EQ(known("/stimuli/0"), of_schema(schema["$defs"]["stimulus"]));
  EXPECT_EQ(known("/trials/0"), of_schema(schema["$defs"]["trial"]));
  EXPECT_EQ(known("/participants/0/0"), of_schema(schema["$defs"]["block"]));
  // Every key that must be there must be there for the reader, too.
  for (const auto& key : schema["required"]) {
    Json bad = good;
    bad.erase(key.get<std::string>());
    EXPECT_NE(complaint([&] { read(bad.dump()); }).find("'" + key.get<std::string>() + "' is missing"),
              std::string::npos);
  }
}

// Stimuli -------------------------------------------------------------------------------------------------------------

TEST_F(StudyFile, StimuliAreTaggedFilesOfTheirModelHeightAndDimension) {
  Study study = design_study({.experiments = {"recognisability", "dimension"},
                              .grains = {"spheres6"},
                              .heights = {1, 2},
                              .dimensions = {2.2, 2.8},
                              .grain_models = {"heightfield", "orthogonal"},
                              .models = {"lateral", "graph-orthogonal"},
                              .participants = 1});
  study = write_stimuli(std::move(study), folder_.path());
  double depth_of_1 = 0;
  for (const StudyStimulus& stimulus : study.stimuli) {
    const Scene scene = read_gltf(folder_.path() / stimulus.file, {});
    const auto tagged = std::find_if(scene.materials.begin(), scene.materials.end(),
                                     [](const Material& m) { return m.haptic.has_value(); });
    ASSERT_NE(tagged, scene.materials.end()) << stimulus.label();
    const MaterialTag& tag = *tagged->haptic;
    ASSERT_TRUE(tag.height) << stimulus.label();
    EXPECT_EQ(tag.stiffness, 800);
    EXPECT_NEAR(1e3 * tag.height->scale_m, stimulus.depth_mm, 1e-6) << stimulus.label();
    EXPECT_EQ(tag.force_model.has_value(), stimulus.model != "heightfield");
    if (tag.force_model) {
      EXPECT_EQ(tag.force_model->name, stimulus.model);
    }
    if (stimulus.model == "orthogonal") {
      EXPECT_DOUBLE_EQ(tag.force_model->amplitude, 0.005 * stimulus.height);
    }
    if (stimulus.model == "lateral") {
      EXPECT_DOUBLE_EQ(tag.force_model->amplitude, 0.01);
    }
    if (stimulus.model == "graph-orthogonal") {
      EXPECT_EQ(tag.roughness->fractal_dimension, stimulus.dimension);
    }
    if (stimulus.grain == "spheres6" && stimulus.height == 1) depth_of_1 = stimulus.depth_mm;
    // The relief of a picture of 257 samples over 40 mm.
    if (stimulus.dimension) {
      EXPECT_EQ(tag.height->size, (std::array{257, 257}));
      EXPECT_NEAR(stimulus.depth_mm, 0.3, 1e-3);
    }
  }
  EXPECT_NEAR(depth_of_1, 0.3, 0.01);
  for (const StudyStimulus& stimulus : study.stimuli)
    if (stimulus.grain == "spheres6" && stimulus.height == 2) {
      EXPECT_NEAR(stimulus.depth_mm, 0.6, 0.02);
    }
  EXPECT_TRUE(fs::exists(folder_.path() / "pictures" / "spheres6.png"));
}

// Answers -------------------------------------------------------------------------------------------------------------

std::string csv_of(const Study& study, const std::vector<StudyAnswer>& answers) {
  std::string text = std::string(answers_header()) + "\n";
  for (const StudyAnswer& answer : answers) text += answer_line(study, answer) + "\n";
  return text;
}

TEST(StudyAnswers, AreReadAsTheyWereWritten) {
  const Study study = design_study({.participants = 2});
  const std::vector<StudyAnswer> answers = simulate_answers(study, 2, {}, 1);
  const std::vector<StudyAnswer> read = parse_answers(study, csv_of(study, answers), "a.csv");
  ASSERT_EQ(read.size(), answers.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].place, answers[i].place);
    EXPECT_EQ(read[i].answer, answers[i].answer);
    EXPECT_EQ(read[i].seconds, answers[i].seconds);
  }
  EXPECT_EQ(next_place(study, 2, read), study.order_of(2).size() + 1);
  EXPECT_EQ(next_place(study, 2, {read.begin(), read.begin() + 7}), 8U);
}

TEST(StudyAnswers, NameFileLineAndReasonOfDamage) {
  const Study study = design_study({.participants = 2});
  const std::string good = csv_of(study, simulate_answers(study, 1, {}, 1));
  const auto said = [&](const std::function<void(std::vector<std::string>&)>& damage, std::size_t line = 3) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < good.size();) {
      const std::size_t end = good.find('\n', at);
      lines.push_back(good.substr(at, end - at));
      at = end + 1;
    }
    std::vector<std::string> fields;
    std::string field;
    for (const char c : lines[line - 1] + ",")
      if (c == ',')
        fields.push_back(std::exchange(field, {}));
      else
        field += c;
    damage(fields);
    lines[line - 1].clear();
    for (std::size_t i = 0; i < fields.size(); ++i) lines[line - 1] += (i ? "," : "") + fields[i];
    std::string text;
    for (const std::string& l : lines) text += l + "\n";
    return complaint([&] { parse_answers(study, text, "a.csv"); });
  };
  EXPECT_EQ(said([](auto&) {}), "no exception");
  EXPECT_NE(said([](auto& f) { f.pop_back(); }).find("a.csv: line 3: has 8 fields, not 9"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[0] = "another"; }).find("line 3: is of the study 'another'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[1] = "3"; }).find("participant: '3' is no number from 1 to 2"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[2] = "0"; }).find("trial: '0'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[2] = "2x"; }).find("trial: '2x'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[3] = "height"; }).find("experiment: 'height', but the study has 'grains'"),
            std::string::npos);
  EXPECT_NE(said([](auto& f) { f[4] = "quads9"; }).find("first: 'quads9'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[6] = "nothing"; }).find("answer: 'nothing' is none of"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[7] = "-1"; }).find("seconds: '-1'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[7] = "nan"; }).find("seconds: 'nan'"), std::string::npos);
  EXPECT_NE(said([](auto& f) { f[0] = "studie"; }, 1).find("line 1: "), std::string::npos);
  EXPECT_NE(complaint([&] { parse_answers(study, good.substr(0, good.size() - 5), "a.csv"); }).find("has no end"),
            std::string::npos);
}

TEST(StudyAnswers, TheLastOfATrialCountsAndNobodyIsTakenTwice) {
  const Study study = design_study({.participants = 2});
  const TemporaryFolder folder("papilla-test");
  std::vector<StudyAnswer> answers = simulate_answers(study, 1, {}, 1);
  answers.resize(20);
  StudyAnswer corrected = answers[15];
  corrected.answer = corrected.answer == "1" ? "2" : "1";
  answers.push_back(corrected);
  const fs::path a = folder.path() / "a.csv", b = folder.path() / "b.csv", empty = folder.path() / "c.csv";
  std::ofstream(a) << csv_of(study, answers);
  std::ofstream(b) << csv_of(study, {answers[0]});
  std::ofstream(empty) << "";
  const std::vector<StudyAnswer> read = read_answers(study, {a});
  ASSERT_EQ(read.size(), 20U);
  EXPECT_EQ(read[15].answer, corrected.answer);
  EXPECT_NE(complaint([&] { read_answers(study, {a, b}); }).find("participant 1 is in"), std::string::npos);
  EXPECT_NE(complaint([&] { read_answers(study, {empty}); }).find("c.csv: is empty"), std::string::npos);
}

// Analysis ------------------------------------------------------------------------------------------------------------

std::vector<StudyAnswer> all_answers(const Study& study, const SimulatedParticipant& truth, std::uint64_t seed) {
  std::vector<StudyAnswer> answers;
  for (std::size_t p = 1; p <= study.participants.size(); ++p)
    for (StudyAnswer& answer : simulate_answers(study, p, truth, seed)) answers.push_back(std::move(answer));
  return answers;
}

TEST(StudyAnalysis, FindsWhatWasPutIn) {
  const Study study = design_study({.participants = 12});
  const StudyAnalysis analysis = analyse_study(study, all_answers(study, {}, 2), {.simulations = 50});
  EXPECT_EQ(analysis.participants, 12U);
  EXPECT_EQ(analysis.answers, analysis.trials);
  ASSERT_EQ(analysis.thresholds.size(), 4U + 3);
  for (const StudyThreshold& threshold : analysis.thresholds) {
    const double truth = threshold.factor == "dimension" ? 0.25 : 0.5;
    EXPECT_NEAR(threshold.threshold.value, truth, 0.3 * truth) << threshold.condition;
    ASSERT_TRUE(threshold.threshold.is_bounded());
    EXPECT_LT(*threshold.threshold.high / *threshold.threshold.low, 4);
    EXPECT_EQ(threshold.participants.size(), 12U);
  }
  const auto effect = [&](const char* experiment, const char* factor, const char* level) {
    for (const StudyRegression& r : analysis.regressions)
      if (r.experiment == experiment)
        for (const StudyEffect& e : r.effects)
          if (e.factor == factor && e.level == level) return e.effect;
    ADD_FAILURE() << experiment << " " << factor << " " << level;
    return Estimate{};
  };
  // 19 steps over 0.8 of dimension; 4 − (octaves − 1)²; nothing of grain and model.
  const Estimate per_tenth = effect("roughness", "dimension", "per 0.1");
  EXPECT_NEAR(per_tenth.value, 19.0 / 8, 0.3);  // Cut off at the ends of the scale.
  EXPECT_LT(*per_tenth.high - *per_tenth.low, 0.6);
  EXPECT_GT(*effect("recognisability", "height", "x2").low, 0);
  EXPECT_TRUE(effect("recognisability", "height", "x4").covers(0));
  EXPECT_TRUE(effect("recognisability", "model", "lateral").covers(0));
  EXPECT_GT(*effect("dimension", "difference", "per doubling").low, 0);
  ASSERT_EQ(analysis.recognitions.size(), 2U);
  for (const StudyRecognition& r : analysis.recognitions) {
    EXPECT_EQ(r.answers, 60);
    // 0.55 + 0.45/3 and 0.75 + 0.25/2.
    EXPECT_NEAR(r.shape.value, 0.7, 3 * std::sqrt(0.7 * 0.3 / 60));
    EXPECT_NEAR(r.fineness.value, 0.875, 3 * std::sqrt(0.875 * 0.125 / 60));
  }
  EXPECT_EQ(analysis.ratings.size(), 36U + 36);
}

TEST(StudyAnalysis, TakesWhatIsThereOfASession) {
  const Study study = design_study({.participants = 3});
  EXPECT_THROW(analyse_study(study, {}), InvalidInput);
  for (const std::size_t count : {1U, 5U, 11U, 13U, 60U, 90U, 100U}) {
    std::vector<StudyAnswer> answers = simulate_answers(study, 1, {}, 1);
    answers.resize(count);
    const StudyAnalysis analysis = analyse_study(study, answers, {.simulations = 10});
    EXPECT_EQ(analysis.answers, count);
    EXPECT_EQ(analysis.trials, study.order_of(1).size());
    for (const StudyRegression& r : analysis.regressions) EXPECT_NE(r.effects.empty(), r.problem.empty());
  }
}

// A participant of known threshold, 8 levels of 20 choices: the interval holds the threshold in 95 of 100 runs. Of 100
// runs a nominal cover of 95 % would hold 95 or more only every other time; 1000 tell it.
TEST(StudyPowerTest, TheIntervalOfOneParticipantHoldsTheThresholdIn95Of100Runs) {
  const Study study =
      design_study({.experiments = {"dimension"}, .models = {"lateral"}, .repetitions = 10, .participants = 1});
  const std::vector<StudyPower> powers = simulate_power(study, 1, {}, 1000, 1);
  ASSERT_EQ(powers.size(), 1U);
  EXPECT_EQ(powers[0].runs, 1000);
  EXPECT_GE(powers[0].covered, 950);
  EXPECT_LE(powers[0].covered, 985);     // Wider than it must be is no merit,
  EXPECT_GE(powers[0].determined, 930);  // nor is covering by an open end.
  EXPECT_NEAR(powers[0].median, 0.25, 0.02);
}

// The same of six people that differ: the threshold of the median one.
TEST(StudyPowerTest, TheIntervalOfSeveralHoldsTheirMedianThresholdIn95Of100Runs) {
  const Study study =
      design_study({.experiments = {"dimension"}, .models = {"lateral"}, .repetitions = 4, .participants = 6});
  const std::vector<StudyPower> powers = simulate_power(study, 6, {.between = 0.3}, 100, 1);
  ASSERT_EQ(powers.size(), 1U);
  EXPECT_GE(powers[0].covered, 95);
  EXPECT_GE(powers[0].determined, 95);
}

TEST(StudyPowerTest, DoesNotDependOnThreadsAndGrowsSharper) {
  const Study study =
      design_study({.experiments = {"height"}, .grains = {"quads6"}, .repetitions = 2, .participants = 8});
  const std::vector<StudyPower> few = simulate_power(study, 2, {}, 20, 5), again = simulate_power(study, 2, {}, 20, 5),
                                many = simulate_power(study, 8, {}, 20, 5);
  EXPECT_EQ(few[0].median, again[0].median);
  EXPECT_EQ(few[0].median_ratio, again[0].median_ratio);
  EXPECT_LT(many[0].median_ratio, few[0].median_ratio);
}

}  // namespace
}  // namespace papilla
