// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "http/browser.hpp"
#include "json/study_json.hpp"
#include "option_checks.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/pipeline/study/simulated_participant.hpp"
#include "papilla/pipeline/study/study_analysis.hpp"
#include "papilla/pipeline/study/study_answers.hpp"
#include "papilla/pipeline/study/study_stimuli.hpp"
#include "shown_format.hpp"
#include "study/analysis_page.hpp"
#include "study/page_session.hpp"
#include "study/study_session.hpp"
#include "study/terminal_session.hpp"
#include "text/study_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string what, output, answers, pictures, device;
  std::vector<std::string> files;
  StudyDesignOptions design;
  StudyStimulusOptions stimuli;
  StudyAnalysisOptions analysis;
  SimulatedParticipant truth;
  std::optional<int> participants;
  int participant = 0, port = 0, runs = 0;
  double play_seconds = 8;
  bool page = false, no_open = false;

  std::string study() const {
    if (files.empty()) throw UsageError("study " + what + " needs a STUDY.json");
    return files.front();
  }
  void require_only_study() const {
    if (files.size() > 1) throw UsageError("study " + what + " takes no '" + files[1] + "'");
  }
};

/// Answers are to the study that lies beside them: another one in its place would make them worthless.
void require_no_answers(const fs::path& folder) {
  const fs::path answers = folder / "answers";
  std::error_code error;
  if (!fs::is_directory(answers, error)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(answers, error))
    if (entry.path().extension() == ".csv")
      throw InvalidInput(entry.path().string() + ": is of the study that is there; give -o another folder");
}

Json run_new(const Options& options, const VerbContext& context) {
  if (options.output.empty()) throw UsageError("study new needs -o: a folder");
  if (!options.files.empty()) throw UsageError("study new takes no '" + options.files.front() + "'");
  StudyDesignOptions design = options.design;
  design.participants = options.participants.value_or(design.participants);
  design.seed = context.seed;
  const fs::path folder = options.output, file = folder / "STUDY.json";
  Study study = design_study(design);
  require_no_answers(folder);
  make_folder(folder);
  declare_output(file, "--output");
  require_writable(file);
  study = write_stimuli(std::move(study), folder, options.stimuli, context.progress);
  write_atomically(file, study_json(study));
  context.console.print(study_design_text(file.string(), study));
  Json json = study_design_json(study);
  json["study"] = file.string();
  return json;
}

Json run_session(const Options& options, const VerbContext& context) {
  options.require_only_study();
  if (options.participant < 1) throw UsageError("study run needs --participant: a number from 1");
  StudySession session(options.study(), static_cast<std::size_t>(options.participant), options.answers);
  StimulusPlayer player(options.device, options.play_seconds);
  Json json{{"study", session.study().id},
            {"participant", options.participant},
            {"answers", session.answers_file().string()}};
  if (options.page) {
    std::optional<PageDoor> door;
    json["url"] = run_on_page(session, player, options.port, context.deadline, [&](const std::string& url) {
      context.console.print("asking at " + url + " until all is answered or Ctrl-C\n");
      if (!options.no_open && !context.console.silent() && !open_in_browser(door.emplace(url).file().string()))
        context.console.print("no browser could be started; open the page by hand\n");
    });
  } else {
    run_in_terminal(session, player);
  }
  context.console.print(shown_format("{}: {} of {} trials answered\n", session.answers_file().string(),
                                     session.answered(), session.trials()));
  json["answered"] = session.answered();
  json["trials"] = session.trials();
  json["done"] = session.next() > session.trials();
  return json;
}

Json run_analyse(const Options& options, const VerbContext& context) {
  const Study study = read_study(options.study());
  if (options.files.size() < 2) throw UsageError("study analyse needs files of answers behind STUDY.json");
  const bool is_page = !options.output.empty();
  if (is_page && fs::path(options.output).extension() != ".html")
    throw UsageError("study analyse: -o must be an .html file");
  StudyAnalysisOptions analysis_options = options.analysis;
  analysis_options.seed = context.seed;
  const StudyAnalysis analysis = analyse_study(
      study, read_answers(study, {options.files.begin() + 1, options.files.end()}), analysis_options, context.progress);
  context.console.print(study_analysis_text(analysis, analysis_options.confidence));
  Json json = study_analysis_json(analysis, analysis_options.confidence);
  if (!is_page && options.pictures.empty()) return json;
  const std::vector<StudyPicture> pictures = study_pictures(study, analysis);
  if (is_page) {
    write_atomically(options.output, study_page(study, analysis, pictures, analysis_options.confidence));
    json["page"] = options.output;
  }
  if (options.pictures.empty()) return json;
  make_folder(options.pictures);
  json["pictures"] = Json::array();
  for (const StudyPicture& picture : pictures) {
    const fs::path file = fs::path(options.pictures) / (picture.name + ".svg");
    write_atomically(file, picture.svg);
    json["pictures"].push_back(file.string());
  }
  return json;
}

/// A file of answers a participant, or with --runs only what the study would find.
Json run_simulate(const Options& options, const VerbContext& context) {
  options.require_only_study();
  const Study study = read_study(options.study());
  const auto participants =
      static_cast<std::size_t>(options.participants.value_or(static_cast<int>(study.participants.size())));
  if (participants < 1 || participants > study.participants.size())
    throw UsageError("--participants: the study has " + std::to_string(study.participants.size()));
  if (options.output.empty() && options.runs < 1) throw UsageError("study simulate needs -o: a folder, or --runs");
  Json json{{"study", study.id}, {"participants", participants}};
  if (!options.output.empty()) {
    make_folder(options.output);
    json["answers"] = Json::array();
    for (std::size_t p = 1; p <= participants; ++p) {
      std::string text = std::string(answers_header()) + "\n";
      for (const StudyAnswer& answer : simulate_answers(study, p, options.truth, context.seed))
        text += answer_line(study, answer) + "\n";
      const fs::path file = fs::path(options.output) / participant_file_name(p);
      write_atomically(file, text);
      json["answers"].push_back(file.string());
    }
    context.console.print(shown_format("{}: answers of {} simulated participants\n", options.output, participants));
  }
  if (options.runs < 1) return json;
  const std::vector<StudyPower> powers = simulate_power(study, participants, options.truth, options.runs, context.seed,
                                                        options.analysis, context.progress);
  context.console.print(study_power_text(powers, options.analysis.confidence));
  json["thresholds"] = study_power_json(powers);
  return json;
}

Json run(const Options& options, VerbContext& context) {
  if (options.what == "new") return run_new(options, context);
  if (options.what == "run") return run_session(options, context);
  if (options.what == "analyse") return run_analyse(options, context);
  return run_simulate(options, context);
}

void add_design_options(CLI::App& verb, Options& options) {
  StudyDesignOptions& design = options.design;
  const auto list = [&](const char* name, auto& value, const char* help) {
    verb.add_option(name, value, help)->delimiter(',')->capture_default_str()->group("New");
  };
  list("--experiments", design.experiments, "Which: grains, recognisability, roughness, dimension, height");
  list("--grains", design.grains, "Test grains, as papilla synthesize grain names them");
  list("--heights", design.heights, "Factors of their relief that are rated");
  list("--height-steps", design.height_steps, "Factors of their relief that are compared with 1");
  list("--dimensions", design.dimensions, "Fractal dimensions, above 2 and below 3");
  list("--grain-models", design.grain_models, "Force models of grains");
  list("--models", design.models, "Force models of fractals");
  verb.add_option("--repetitions", design.repetitions, "How often each pair is chosen from, in either order")
      ->type_name("N")
      ->check(in_range(1, 100))
      ->capture_default_str()
      ->group("New");
  verb.add_option("--language", design.language, "Of the texts")
      ->transform(one_of({"en", "de"}))
      ->capture_default_str()
      ->group("New");
  const auto above_0 = [&](const char* name, double& value, const char* unit, const char* help) {
    verb.add_option(name, value, help)->type_name(unit)->check(positive())->capture_default_str()->group("New");
  };
  above_0("--relief-mm", options.stimuli.relief_mm, "MM", "Relief of x1 on 40 mm, peak to valley");
  above_0("--stiffness", options.stimuli.stiffness, "N/M", "Of the plates");
  verb.add_option("--friction", options.stimuli.friction, "Of the plates")
      ->check(in_range(0, 10))
      ->capture_default_str()
      ->group("New");
}

void add_session_options(CLI::App& verb, Options& options) {
  verb.add_option("--participant", options.participant, "Who answers, from 1")
      ->type_name("N")
      ->check(in_range(1, 10000))
      ->group("Run");
  writes(verb.add_option("--answers", options.answers,
                         "CSV that the answers are added to; default answers/participant-NNN.csv beside STUDY.json"))
      ->type_name("FILE")
      ->group("Run");
  verb.add_option(
          "--device", options.device,
          "Play each plate on it by papilla-player: sim[:PRESET] or hid[:VID:PID]; without it commands are shown")
      ->type_name("DEVICE")
      ->group("Run");
  verb.add_option("--play-seconds", options.play_seconds, "How long a plate is played")
      ->type_name("S")
      ->check(in_range(0.1, 3600))
      ->capture_default_str()
      ->group("Run");
  CLI::Option* page = verb.add_flag("--page", options.page,
                                    "Ask on a page of this machine, at an address with a secret token, not here");
  page->group("Run");
  verb.add_option("--port", options.port, "Of the page; 0 takes any that is free")
      ->type_name("N")
      ->check(in_range(0, 65535))
      ->needs(page)
      ->group("Run");
  verb.add_flag("--no-open", options.no_open, "Don't start a browser")->needs(page)->group("Run");
}

void add_analysis_options(CLI::App& verb, Options& options) {
  writes_into(verb.add_option("--pictures", options.pictures, "Write the pictures as SVG into this folder"))
      ->type_name("DIR")
      ->group("Analyse");
  add_choice(verb, "--shape", options.analysis.shape,
             {{"logistic", PsychometricShape::logistic}, {"normal", PsychometricShape::normal}},
             "Of the psychometric function, default logistic")
      ->group("Analyse");
  verb.add_option("--confidence", options.analysis.confidence, "Of the intervals")
      ->check(in_range(0.5, 0.999))
      ->capture_default_str()
      ->group("Analyse");
  verb.add_option("--simulations", options.analysis.simulations, "Of each deviance, for its p; 0: no p")
      ->type_name("N")
      ->check(in_range(0, 100000))
      ->capture_default_str()
      ->group("Analyse");
}

void add_simulation_options(CLI::App& verb, Options& options) {
  SimulatedParticipant& truth = options.truth;
  verb.add_option("--runs", options.runs,
                  "Simulate the study so often and count how often the interval holds the truth")
      ->type_name("N")
      ->check(in_range(1, 100000))
      ->group("Simulate");
  const auto above_0 = [&](const char* name, double& value, const char* help) {
    verb.add_option(name, value, help)->check(positive())->capture_default_str()->group("Simulate");
  };
  above_0("--dimension-threshold", truth.dimension_threshold, "True difference of dimension told in three of four");
  above_0("--height-threshold", truth.height_threshold, "The same in octaves of height");
  above_0("--spread", truth.spread, "True spread of the logarithm of the difference");
  verb.add_option("--lapse", truth.lapse, "True share of lapses")
      ->check(in_range(0, 0.4))
      ->capture_default_str()
      ->group("Simulate");
  verb.add_option("--between", truth.between, "Standard deviation of the threshold's logarithm between participants")
      ->check(in_range(0, 3))
      ->capture_default_str()
      ->group("Simulate");
}

}  // namespace

void add_study(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"study", "Asks people what they feel: makes stimuli and orders, asks, and analyses the answers",
       "papilla study new -o study --experiments dimension; papilla study run study/STUDY.json --participant 1 --page"},
      [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("what", options->what, "new, run, analyse or simulate")
      ->required()
      ->transform(one_of({"new", "run", "analyse", "simulate"}));
  reads(verb->add_option("files", options->files, "STUDY.json; analyse: and files of answers"))->type_name("FILE");
  writes_if_file(verb->add_option("-o,--output", options->output,
                                  "New: the study's folder. Analyse: an .html file. Simulate: folder of the answers"))
      ->type_name("OUT");
  verb->add_option("--participants", options->participants,
                   "New: how many, default 20. Simulate: how many, default all")
      ->type_name("N")
      ->check(in_range(1, 10000));
  add_design_options(*verb, *options);
  add_session_options(*verb, *options);
  add_analysis_options(*verb, *options);
  add_simulation_options(*verb, *options);
}

}  // namespace papilla::app
