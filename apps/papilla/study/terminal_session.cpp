// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/terminal_session.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>

#include "papilla/core/one_line.hpp"
#include "papilla/core/trace.hpp"
#include "shown_format.hpp"

namespace papilla::app {
namespace {

void say(const std::string& text) { std::fputs(shown_lines(text).c_str(), stderr); }

std::optional<std::string> read_line() {
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// What a typed line means as an answer: the number of a label, a rating, or the label itself.
std::string meant(const StudyExperiment& experiment, const std::string& typed) {
  if (experiment.kind == StudyAnswerKind::rating) return typed;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(typed.data(), typed.data() + typed.size(), number);
  const bool is_number = error == std::errc() && end == typed.data() + typed.size();
  if (experiment.kind == StudyAnswerKind::choice)
    return is_number && number == 1 ? "first" : is_number && number == 2 ? "second" : typed;
  return is_number && number >= 1 && number <= experiment.labels.size() ? experiment.labels[number - 1] : typed;
}

std::string choices_text(const StudyExperiment& experiment) {
  std::string text;
  const bool is_named = experiment.kind != StudyAnswerKind::rating ||
                        experiment.labels.size() == static_cast<std::size_t>(experiment.high - experiment.low + 1);
  if (!is_named)
    return shown_format("  {} {} ... {} {}\n", experiment.low, experiment.labels.front(), experiment.high,
                        experiment.labels.back());
  const int first = experiment.kind == StudyAnswerKind::rating ? experiment.low : 1;
  for (std::size_t i = 0; i < experiment.labels.size(); ++i)
    text += shown_format("  {} {}\n", first + static_cast<int>(i), experiment.labels[i]);
  return text;
}

/// What may be typed as an answer: numbers.
std::string answers_text(const StudyExperiment& experiment) {
  if (experiment.kind == StudyAnswerKind::rating) return shown_format("{} to {}", experiment.low, experiment.high);
  return shown_format("1 to {}", experiment.labels.size());
}

/// The terminal side of one session.
class Terminal {
 public:
  Terminal(StudySession& session, StimulusPlayer& player) : session_(session), player_(player) {}

  void run() {
    const std::size_t first = session_.next();
    say(shown_format("participant {}, {} of {} trials answered in {}\n", session_.participant(), session_.answered(),
                     session_.trials(), session_.answers_file().string()));
    if (session_.removed_bytes() > 0) say("the last line of it was cut off: its trial is asked again\n");
    if (first <= session_.trials()) say("r: feel it again, b: back to the one before, q: stop; it goes on there\n");
    std::optional<std::size_t> corrected;
    while (corrected || session_.next() <= session_.trials()) {
      const std::size_t place = corrected.value_or(session_.next());
      corrected.reset();
      if (!begin_block(place)) return;
      switch (ask(place)) {
        case End::stop: return;
        case End::back: corrected = std::max<std::size_t>(place, 2) - 1; break;
        case End::answered: break;
      }
    }
    say("all trials are answered, thank you\n");
  }

 private:
  enum class End { answered, back, stop };

  /// Instructions, and plates to get used to, at the first trial of a block or when a session goes on in it.
  bool begin_block(std::size_t place) {
    std::size_t before = 0, number = 0;
    for (const StudyBlock& block : session_.study().participants[session_.participant() - 1]) {
      ++number;
      if (place > before + block.trials.size()) {
        before += block.trials.size();
        continue;
      }
      if (block_ == number) return true;
      block_ = number;
      const StudyExperiment& experiment = experiment_of(place);
      say(shown_format("\n{}\n", experiment.instructions));
      if (block.shown.empty()) return true;
      for (const std::size_t stimulus : block.shown) feel(stimulus, "");
      say("Enter to begin> ");
      const auto line = read_line();
      return line && *line != "q";
    }
    return true;
  }

  End ask(std::size_t place) {
    const StudyTrial& trial = session_.study().trials[session_.trial_at(place)];
    const StudyExperiment& experiment = experiment_of(place);
    say(shown_format("\ntrial {} of {}\n", place, session_.trials()));
    if (!trial.pictures.empty()) {
      say("pictures:");
      for (const std::string& picture : trial.pictures) say(shown_format(" {}", session_.file(picture).string()));
      say("\n");
    }
    const auto feel_all = [&] {
      bool all = true;
      for (std::size_t i = 0; i < trial.stimuli.size(); ++i)
        all &= feel(trial.stimuli[i], trial.stimuli.size() < 2 ? "" : i == 0 ? "first: " : "second: ");
      return all;
    };
    bool is_felt = feel_all();
    const Stopwatch clock;
    for (;;) {
      say(shown_format("{}\n", experiment.question) + choices_text(experiment) + "> ");
      const auto line = read_line();
      if (!line || *line == "q") return End::stop;
      if (*line == "b") return End::back;
      if (*line == "r") {
        is_felt = feel_all();
        continue;
      }
      if (!is_felt) {
        say("a plate was not there, so that no answer is taken: r tries again, q stops\n");
        continue;
      }
      if (session_.record(place, meant(experiment, *line), clock.seconds()).empty()) return End::answered;
      say(shown_format("'{}' is none of {} and r, b, q\n", *line, answers_text(experiment)));
    }
  }

  /// @returns whether the plate was there, or a command to play it was shown.
  bool feel(std::size_t stimulus, const std::string& which) {
    const std::filesystem::path file = session_.file(session_.study().stimuli[stimulus].file);
    if (!player_.plays()) {
      say(shown_format("{}{}\n", which, player_.command(file)));
      return true;
    }
    say(shown_format("{}plate is there ...", which));
    player_.start(file);
    const std::string why = player_.wait();
    say(why.empty() ? std::string(" gone\n") : shown_format(" {}; r tries again\n", why));
    return why.empty();
  }

  const StudyExperiment& experiment_of(std::size_t place) const {
    return session_.study().experiments[session_.study().trials[session_.trial_at(place)].experiment];
  }

  StudySession& session_;
  StimulusPlayer& player_;
  std::size_t block_ = 0;
};

}  // namespace

void run_in_terminal(StudySession& session, StimulusPlayer& player) { Terminal(session, player).run(); }

}  // namespace papilla::app
