// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "json_value.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

using Json = JsonValue::Json;

constexpr int k_version = 1;
constexpr double k_most = 1e6;

Json stimulus_json(const StudyStimulus& s) {
  Json json{{"file", s.file}, {"grain", s.grain}, {"height", s.height}, {"model", s.model}};
  if (s.dimension) json["dimension"] = *s.dimension;
  json["size_mm"] = s.size_mm;
  json["depth_mm"] = s.depth_mm;
  json["limited_share"] = s.limited_share;
  return json;
}

Json experiment_json(const StudyExperiment& e) {
  Json json{
      {"id", e.id},         {"kind", to_string(e.kind)}, {"instructions", e.instructions}, {"question", e.question},
      {"labels", e.labels}, {"seconds", e.seconds}};
  if (e.kind == StudyAnswerKind::rating) json["range"] = {e.low, e.high};
  if (e.kind == StudyAnswerKind::choice) json["factor"] = e.factor;
  return json;
}

Json trial_json(const StudyTrial& t) {
  Json json{{"experiment", t.experiment}, {"stimuli", t.stimuli}};
  if (!t.pictures.empty()) json["pictures"] = t.pictures;
  return json;
}

Json participant_json(const std::vector<StudyBlock>& blocks) {
  Json json = Json::array();
  for (const StudyBlock& block : blocks) {
    Json& one = json.emplace_back(Json::object());
    if (!block.shown.empty()) one["shown"] = block.shown;
    one["trials"] = block.trials;
  }
  return json;
}

/// An array with a line an element.
template <class List, class ToJson>
std::string lines(const char* key, const List& list, const ToJson& to_json) {
  std::string text = std::string("  \"") + key + "\": [";
  for (std::size_t i = 0; i < list.size(); ++i)
    text += (i == 0 ? "\n    " : ",\n    ") + to_json(list[i]).dump(-1, ' ', false, Json::error_handler_t::replace);
  return text + "\n  ]";
}

std::size_t read_index(const JsonValue& value, std::size_t size, const char* of) {
  const double number = value.number(0, k_most);
  if (number != std::floor(number) || number >= static_cast<double>(size))
    value.fail("is no number of one of " + std::to_string(size) + " " + of);
  return static_cast<std::size_t>(number);
}

std::vector<std::size_t> read_indices(const JsonValue& value, std::size_t size, const char* of) {
  std::vector<std::size_t> indices;
  for (const JsonValue& index : value.list()) indices.push_back(read_index(index, size, of));
  return indices;
}

bool is_plain(const std::string& text) {
  const auto is_plain_letter = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-' || c > 127;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), is_plain_letter);
}

/// A name below the folder of the file.
std::string read_name(const JsonValue& value) {
  std::string name = value.text();
  const std::filesystem::path path(name);
  bool is_below = !name.empty() && path.is_relative();
  for (const auto& piece : path) is_below = is_below && piece != "..";
  if (!is_below) value.fail("'" + name + "' must be a file below the folder of this one");
  return name;
}

StudyStimulus read_stimulus(const JsonValue& value) {
  value.expect_keys({"file", "grain", "height", "model", "dimension", "size_mm", "depth_mm", "limited_share"});
  StudyStimulus s;
  s.file = read_name(value.require("file"));
  std::vector<std::string_view> grains = grain_names();
  grains.emplace_back("fractal");
  s.grain = value.require("grain").one_of(grains);
  s.height = value.require("height").number(1e-3, 1e3);
  const JsonValue model = value.require("model");
  s.model = model.text();
  if (!force_model(s.model)) model.fail("'" + s.model + "' is no force model");
  if (const auto v = value.get("dimension")) s.dimension = v->number(2, 3);
  if (s.dimension.has_value() != (s.grain == "fractal"))
    value.fail("'dimension' is of the grain \"fractal\", and needed there");
  s.size_mm = value.require("size_mm").number(1, 1e4);
  s.depth_mm = value.require("depth_mm").number(0, 1e3);
  s.limited_share = value.require("limited_share").number(0, 1);
  return s;
}

StudyExperiment read_experiment(const JsonValue& value) {
  value.expect_keys({"id", "kind", "instructions", "question", "labels", "seconds", "range", "factor"});
  StudyExperiment e;
  const JsonValue id = value.require("id");
  e.id = id.text();
  if (!is_plain(e.id)) id.fail("must be letters, digits, '.', '_' and '-'");
  const std::string kind = value.require("kind").one_of({"identification", "rating", "choice"});
  for (const StudyAnswerKind k : {StudyAnswerKind::identification, StudyAnswerKind::rating, StudyAnswerKind::choice})
    if (kind == to_string(k)) e.kind = k;
  e.instructions = value.require("instructions").text();
  e.question = value.require("question").text();
  e.seconds = value.require("seconds").number(0.1, 3600);
  const JsonValue labels = value.require("labels");
  e.labels = labels.texts();
  if (e.kind == StudyAnswerKind::rating) {
    const JsonValue range = value.require("range");
    if (range.list().size() != 2) range.fail("must be [low, high]");
    e.low = static_cast<int>(range.at(0).number(0, 1000));
    e.high = static_cast<int>(range.at(1).number(0, 1000));
    if (e.low >= e.high) range.fail("must rise");
    if (e.labels.size() != 2 && e.labels.size() != static_cast<std::size_t>(e.high - e.low + 1))
      labels.fail("must name both ends or every step");
  } else if (e.kind == StudyAnswerKind::choice) {
    e.factor = value.require("factor").one_of({"dimension", "height"});
    if (e.labels.size() != 2) labels.fail("must be two");
  } else {
    if (e.labels.size() < 2 || e.labels.size() > 20) labels.fail("must be 2 to 20");
    for (const JsonValue& label : labels.list())  // They stand in CSV.
      if (!is_plain(label.text())) label.fail("must be letters, digits, '.', '_' and '-'");
  }
  return e;
}

StudyTrial read_trial(const JsonValue& value, const Study& study) {
  value.expect_keys({"experiment", "stimuli", "pictures"});
  StudyTrial t;
  t.experiment = read_index(value.require("experiment"), study.experiments.size(), "experiments");
  const JsonValue stimuli = value.require("stimuli");
  t.stimuli = read_indices(stimuli, study.stimuli.size(), "stimuli");
  const StudyExperiment& experiment = study.experiments[t.experiment];
  const std::size_t wanted = experiment.kind == StudyAnswerKind::choice ? 2 : 1;
  if (t.stimuli.size() != wanted)
    stimuli.fail("must be " + std::to_string(wanted) + " for a " + std::string(to_string(experiment.kind)));
  if (const auto v = value.get("pictures"))
    for (const JsonValue& picture : v->list()) t.pictures.push_back(read_name(picture));
  if (const auto difference = study.difference_of(t); difference && !(*difference > 0))
    stimuli.fail("do not differ in " + experiment.factor);
  return t;
}

std::vector<StudyBlock> read_participant(const JsonValue& value, const Study& study) {
  std::vector<StudyBlock> blocks;
  for (const JsonValue& one : value.list()) {
    one.expect_keys({"shown", "trials"});
    StudyBlock& block = blocks.emplace_back();
    if (const auto v = one.get("shown")) block.shown = read_indices(*v, study.stimuli.size(), "stimuli");
    const JsonValue trials = one.require("trials");
    block.trials = read_indices(trials, study.trials.size(), "trials");
    if (block.trials.empty()) trials.fail("is empty");
    for (const std::size_t trial : block.trials)
      if (study.trials[trial].experiment != study.trials[block.trials.front()].experiment)
        trials.fail("are of more than one experiment");
  }
  if (blocks.empty()) value.fail("is empty");
  return blocks;
}

}  // namespace

Study read_study(const std::filesystem::path& path) {
  const Json json = read_json(path);
  const JsonValue root(json, path.string(), "");
  root.expect_keys(
      {"$schema", "$comment", "version", "id", "seed", "language", "experiments", "stimuli", "trials", "participants"});
  if (const JsonValue version = root.require("version"); version.number(0, k_most) != k_version)
    version.fail("only version 1 is known");
  Study study;
  const JsonValue id = root.require("id");
  study.id = id.text();
  if (!is_plain(study.id)) id.fail("must be letters, digits, '.', '_' and '-'");
  const JsonValue seed = root.require("seed");
  if (!seed.json().is_number_unsigned()) seed.fail("must be a whole number");
  study.seed = seed.json().get<std::uint64_t>();
  study.language = root.require("language").one_of({"en", "de"});
  std::set<std::string> ids;
  for (const JsonValue& value : root.require("experiments").list()) {
    study.experiments.push_back(read_experiment(value));
    if (!ids.insert(study.experiments.back().id).second) value.fail("its id is that of another one");
  }
  for (const JsonValue& value : root.require("stimuli").list()) study.stimuli.push_back(read_stimulus(value));
  for (const JsonValue& value : root.require("trials").list()) study.trials.push_back(read_trial(value, study));
  const JsonValue participants = root.require("participants");
  for (const JsonValue& value : participants.list()) study.participants.push_back(read_participant(value, study));
  if (study.participants.empty()) participants.fail("is empty");
  return study;
}

std::string study_json(const Study& study) {
  return "{\n  \"version\": " + std::to_string(k_version) + ",\n  \"id\": " + Json(study.id).dump() +
         ",\n  \"seed\": " + std::to_string(study.seed) + ",\n  \"language\": " + Json(study.language).dump() + ",\n" +
         lines("experiments", study.experiments, experiment_json) + ",\n" +
         lines("stimuli", study.stimuli, stimulus_json) + ",\n" + lines("trials", study.trials, trial_json) + ",\n" +
         lines("participants", study.participants, participant_json) + "\n}\n";
}

}  // namespace papilla
