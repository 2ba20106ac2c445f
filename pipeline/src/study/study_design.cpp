// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/study/balanced_order.hpp"
#include "papilla/study/seeded_random.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

constexpr std::array<std::string_view, 5> k_experiments = {"grains", "recognisability", "roughness", "dimension",
                                                           "height"};
constexpr std::array k_recognised_grains = {"spheres6", "spheres8", "quads6", "quads8", "ovals6", "ovals8"};
constexpr double k_small_mm = 40, k_large_mm = 80;  // Schulze 2005, 8.3.1.

/// Text in both languages.
struct Words {
  const char *en, *de;
  std::string in(const std::string& language) const { return language == "de" ? de : en; }
};

StudyExperiment experiment_of(std::string_view id, const std::string& language) {
  const auto in = [&](const Words& words) { return words.in(language); };
  StudyExperiment made;
  made.id = id;
  if (id == "grains") {
    made.kind = StudyAnswerKind::identification;
    made.instructions =
        in({"The pictures show six grains. Feel each plate without seeing it and say which grain it is. "
            "What is tested is the simulation, not you.",
            "Die Bilder zeigen sechs Narbungen. Fühlen Sie jede Platte, ohne sie zu sehen, und sagen "
            "Sie, welche Narbung es ist. Geprüft wird die Simulation, nicht Sie."});
    made.question = in({"Which grain is it?", "Welche Narbung ist es?"});
    made.labels.assign(k_recognised_grains.begin(), k_recognised_grains.end());
    made.seconds = 30;
  } else if (id == "recognisability") {
    made.instructions =
        in({"You see a grain and feel it. How well do you recognise by touch what you see? Your own "
            "judgement is asked.",
            "Sie sehen eine Narbung und fühlen sie. Wie gut erkennen Sie im Gefühlten, was Sie sehen? "
            "Gefragt ist Ihr persönliches Urteil."});
    made.question = in({"The grain in the picture is …", "Die Narbung im Bild ist …"});
    for (const Words& step : {Words{"not recognisable", "nicht erkennbar"},
                              {"imaginably recognisable", "vorstellbar erkennbar"},
                              {"sufficiently recognisable", "ausreichend erkennbar"},
                              {"well recognisable", "gut erkennbar"},
                              {"perfectly recognisable", "perfekt erkennbar"}})
      made.labels.push_back(in(step));
  } else if (id == "roughness") {
    made.instructions =
        in({"First feel the smoothest and the roughest plate of this block. Then give each plate a "
            "number from 1, smooth, to 20, rough.",
            "Fühlen Sie zuerst die glatteste und die raueste Platte dieses Blocks. Geben Sie dann jeder "
            "Platte eine Zahl von 1, glatt, bis 20, rau."});
    made.question = in({"How rough is it?", "Wie rau ist sie?"});
    made.labels = {in({"smooth", "glatt"}), in({"rough", "rau"})};
    made.high = 20;
  } else {
    const bool is_height = id == "height";
    made.kind = StudyAnswerKind::choice;
    made.instructions =
        is_height ? in({"Two plates, one after the other. Say which relief is higher. If you are not sure, guess.",
                        "Zwei Platten nacheinander. Sagen Sie, welches Relief höher ist. Raten Sie, wenn Sie nicht "
                        "sicher sind."})
                  : in({"Two plates, one after the other. Say which one is rougher. If you are not sure, guess.",
                        "Zwei Platten nacheinander. Sagen Sie, welche rauer ist. Raten Sie, wenn Sie nicht sicher "
                        "sind."});
    made.question = is_height ? in({"Which relief is higher?", "Welches Relief ist höher?"})
                              : in({"Which one is rougher?", "Welche ist rauer?"});
    made.labels = {in({"the first", "die erste"}), in({"the second", "die zweite"})};
    made.factor = id;
  }
  return made;
}

[[noreturn]] void refuse(const std::string& option, const std::string& reason) {
  throw InvalidInput("design_study: " + option + ": " + reason);
}

void require_distinct(const std::vector<double>& list, const std::string& option, double low, double high) {
  for (const double value : list)
    if (!(value >= low && value <= high)) refuse(option, fmt::format("{} is not from {} to {}", value, low, high));
  if (std::set<double>(list.begin(), list.end()).size() != list.size()) refuse(option, "a value stands there twice");
}

void require_known(const std::vector<std::string>& list, const std::string& option,
                   const std::vector<std::string_view>& known) {
  if (list.empty()) refuse(option, "is empty");
  for (const std::string& name : list)
    if (std::find(known.begin(), known.end(), name) == known.end())
      refuse(option, fmt::format("'{}' is none of {}{}", name, fmt::join(known, ", "), did_you_mean(name, known)));
  if (std::set<std::string>(list.begin(), list.end()).size() != list.size())
    refuse(option, "a name stands there twice");
}

void check(const StudyDesignOptions& options) {
  const std::vector<std::string_view> surfaces = {"heightfield", "textured-normal", "orthogonal", "lateral",
                                                  "lateral-isotropic"};
  const std::vector<std::string_view> added = {"orthogonal", "lateral", "lateral-isotropic", "graph-orthogonal",
                                               "graph-lateral"};
  require_known(options.experiments, "experiments", study_experiments());
  require_known(options.grains, "grains", grain_names());
  require_known(options.grain_models, "grain_models", surfaces);
  require_known(options.models, "models", added);
  require_distinct(options.heights, "heights", 0.1, 10);
  require_distinct(options.height_steps, "height_steps", 1.01, 10);
  require_distinct(options.dimensions, "dimensions", 2.02, 2.98);
  if (options.heights.empty()) refuse("heights", "is empty");
  if (options.height_steps.empty()) refuse("height_steps", "is empty");
  if (options.dimensions.size() < 2) refuse("dimensions", "two or more are needed");
  if (options.repetitions < 1 || options.repetitions > 100)
    refuse("repetitions", fmt::format("{} is not from 1 to 100", options.repetitions));
  if (options.participants < 1 || options.participants > 10000)
    refuse("participants", fmt::format("{} is not from 1 to 10000", options.participants));
  if (options.language != "en" && options.language != "de")
    refuse("language", "'" + options.language + "' is none of en, de");
}

/// Adds each stimulus and trial once.
class Designer {
 public:
  explicit Designer(const StudyDesignOptions& options) : options_(options) {
    study_.seed = options.seed;
    study_.language = options.language;
    study_.participants.resize(static_cast<std::size_t>(options.participants));
    for (std::size_t p = 0; p < study_.participants.size(); ++p) random_.emplace_back(options.seed, p + 1);
  }

  Study design() && {
    for (const std::string_view id : k_experiments) {
      if (std::find(options_.experiments.begin(), options_.experiments.end(), id) == options_.experiments.end())
        continue;
      study_.experiments.push_back(experiment_of(id, options_.language));
      if (id == "grains") add_grains();
      if (id == "recognisability") add_recognisability();
      if (id == "roughness") add_roughness();
      if (id == "dimension") add_dimension();
      if (id == "height") add_height();
    }
    name_files();
    const std::string json = study_json(study_);
    study_.id = sha256_hex(std::as_bytes(std::span(json))).substr(0, 16);
    return std::move(study_);
  }

 private:
  std::size_t stimulus(const StudyStimulus& wanted) {
    const auto found = std::find_if(study_.stimuli.begin(), study_.stimuli.end(), [&](const StudyStimulus& known) {
      return known.grain == wanted.grain && known.height == wanted.height && known.model == wanted.model &&
             known.dimension == wanted.dimension && known.size_mm == wanted.size_mm;
    });
    if (found != study_.stimuli.end()) return static_cast<std::size_t>(found - study_.stimuli.begin());
    study_.stimuli.push_back(wanted);
    return study_.stimuli.size() - 1;
  }
  std::size_t grain(const std::string& name, double height, const std::string& model, double size_mm = k_small_mm) {
    return stimulus({.file = {}, .grain = name, .height = height, .model = model, .size_mm = size_mm});
  }
  std::size_t fractal(double dimension, const std::string& model) {
    return stimulus({.file = {}, .grain = "fractal", .model = model, .dimension = dimension});
  }

  std::size_t trial(std::vector<std::size_t> stimuli, std::vector<std::string> pictures = {}) {
    study_.trials.push_back({study_.experiments.size() - 1, std::move(stimuli), std::move(pictures)});
    return study_.trials.size() - 1;
  }
  static std::string picture(const std::string& grain) { return "pictures/" + grain + ".png"; }

  /// The same blocks for all, each in random order, and all in the order of Williams's square.
  void add_balanced(const std::vector<StudyBlock>& blocks, int repetitions) {
    for (std::size_t p = 0; p < study_.participants.size(); ++p)
      for (int repetition = 0; repetition < repetitions; ++repetition)
        for (const std::size_t b : balanced_order(blocks.size(), p + static_cast<std::size_t>(repetition))) {
          StudyBlock block = blocks[b];
          if (repetition > 0) block.shown.clear();
          random_[p].shuffle(block.trials);
          study_.participants[p].push_back(std::move(block));
        }
  }

  void add_grains() {
    std::vector<std::string> pictures;
    for (const char* name : k_recognised_grains) pictures.push_back(picture(name));
    for (const double size_mm : {k_large_mm, k_small_mm}) {
      StudyBlock all;
      for (const char* name : k_recognised_grains) {
        const std::size_t felt = grain(name, 1, options_.grain_models.front(), size_mm);
        if (size_mm == k_large_mm) all.shown.push_back(felt);
        all.trials.push_back(trial({felt}, pictures));
      }
      for (std::size_t p = 0; p < study_.participants.size(); ++p) {
        StudyBlock block = all;
        const std::size_t left_out = (p + (size_mm == k_large_mm ? 0 : all.trials.size() / 2)) % all.trials.size();
        block.trials.erase(block.trials.begin() + static_cast<std::ptrdiff_t>(left_out));
        random_[p].shuffle(block.trials);
        study_.participants[p].push_back(std::move(block));
      }
    }
  }

  void add_recognisability() {
    std::vector<StudyBlock> blocks;
    for (const std::string& model : options_.grain_models) {
      StudyBlock& block = blocks.emplace_back();
      for (const std::string& name : options_.grains)
        for (const double height : options_.heights)
          block.trials.push_back(trial({grain(name, height, model)}, {picture(name)}));
    }
    add_balanced(blocks, 1);
  }

  /// The lowest dimension first.
  std::vector<double> sorted_dimensions() const {
    std::vector<double> sorted = options_.dimensions;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  void add_roughness() {
    const std::vector<double> dimensions = sorted_dimensions();
    std::vector<StudyBlock> blocks;
    for (const std::string& model : options_.models) {
      StudyBlock& block = blocks.emplace_back();
      block.shown = {fractal(dimensions.front(), model), fractal(dimensions.back(), model)};
      for (const double dimension : dimensions) block.trials.push_back(trial({fractal(dimension, model)}));
    }
    add_balanced(blocks, 1);
  }

  void add_pairs(std::size_t standard, const std::vector<std::size_t>& others, StudyBlock& block) {
    for (const std::size_t other : others) {
      block.trials.push_back(trial({standard, other}));
      block.trials.push_back(trial({other, standard}));
    }
  }

  void add_dimension() {
    const std::vector<double> dimensions = sorted_dimensions();
    std::vector<StudyBlock> blocks;
    for (const std::string& model : options_.models) {
      std::vector<std::size_t> others;
      for (const double dimension : std::span(dimensions).subspan(1)) others.push_back(fractal(dimension, model));
      add_pairs(fractal(dimensions.front(), model), others, blocks.emplace_back());
    }
    add_balanced(blocks, options_.repetitions);
  }

  void add_height() {
    const std::string& model = options_.grain_models.front();
    std::vector<StudyBlock> blocks;
    for (const std::string& name : options_.grains) {
      std::vector<std::size_t> others;
      for (const double height : options_.height_steps) others.push_back(grain(name, height, model));
      add_pairs(grain(name, 1, model), others, blocks.emplace_back());
    }
    add_balanced(blocks, options_.repetitions);
  }

  /// Numbers in random order.
  void name_files() {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < study_.stimuli.size(); ++i) numbers.push_back(i + 1);
    SeededRandom(options_.seed).shuffle(numbers);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      study_.stimuli[i].file = fmt::format("stimuli/s{:03}.glb", numbers[i]);
  }

  const StudyDesignOptions& options_;
  Study study_;
  std::vector<SeededRandom> random_;  // A participant's own.
};

/// Of a choice's factor.
double level_of(const StudyStimulus& stimulus, std::string_view factor) {
  return factor == "dimension" ? stimulus.dimension.value_or(2) : std::log2(stimulus.height);
}

}  // namespace

std::string_view to_string(StudyAnswerKind kind) noexcept {
  constexpr std::array<std::string_view, 3> k_names = {"identification", "rating", "choice"};
  return k_names[static_cast<std::size_t>(kind)];
}

std::string_view difference_unit(std::string_view factor) noexcept {
  return factor == "dimension" ? "of fractal dimension" : "octaves of height";
}

std::vector<std::string_view> study_experiments() { return {k_experiments.begin(), k_experiments.end()}; }

std::string StudyStimulus::label() const {
  return dimension ? fmt::format("{} {}", *dimension, model) : fmt::format("{} x{} {}", grain, height, model);
}

std::vector<std::size_t> Study::order_of(std::size_t participant) const {
  std::vector<std::size_t> order;
  for (const StudyBlock& block : participants.at(participant - 1))
    order.insert(order.end(), block.trials.begin(), block.trials.end());
  return order;
}

std::optional<double> Study::difference_of(const StudyTrial& trial) const {
  const StudyExperiment& experiment = experiments[trial.experiment];
  if (experiment.kind != StudyAnswerKind::choice) return std::nullopt;
  return std::abs(level_of(stimuli[trial.stimuli[1]], experiment.factor) -
                  level_of(stimuli[trial.stimuli[0]], experiment.factor));
}

std::string Study::right_answer(const StudyTrial& trial) const {
  const StudyExperiment& experiment = experiments[trial.experiment];
  if (experiment.kind == StudyAnswerKind::identification) return stimuli[trial.stimuli[0]].grain;
  if (experiment.kind == StudyAnswerKind::rating) return "";
  return level_of(stimuli[trial.stimuli[0]], experiment.factor) > level_of(stimuli[trial.stimuli[1]], experiment.factor)
             ? "first"
             : "second";
}

Study design_study(const StudyDesignOptions& options) {
  check(options);
  return Designer(options).design();
}

double session_seconds(const Study& study, std::size_t participant) {
  double seconds = 0;
  for (const std::size_t trial : study.order_of(participant))
    seconds += study.experiments[study.trials[trial].experiment].seconds;
  return seconds;
}

}  // namespace papilla
