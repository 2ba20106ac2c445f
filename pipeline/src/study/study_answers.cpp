// SPDX-License-Identifier: MIT
#include "papilla/pipeline/study/study_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla {
namespace {

constexpr std::string_view k_header = "study,participant,trial,experiment,first,second,answer,seconds,when";
constexpr std::size_t k_fields = 9;
constexpr double k_longest_s = 1e6;

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A line of a file.
class Line {
 public:
  Line(const Study& study, std::string_view text, const std::string& file, std::size_t number)
      : study_(study), text_(text), file_(file), number_(number) {}

  StudyAnswer answer() const {
    const std::vector<std::string_view> fields = fields_of(text_);
    if (fields.size() != k_fields) fail(fmt::format("has {} fields, not {}", fields.size(), k_fields));
    if (fields[0] != study_.id)
      fail(fmt::format("is of the study '{}', this one is '{}'", printable(fields[0]), study_.id));
    StudyAnswer answer;
    answer.participant = counted(fields[1], "participant", study_.participants.size());
    const std::vector<std::size_t> order = study_.order_of(answer.participant);
    answer.place = counted(fields[2], "trial", order.size());
    const std::size_t trial = order[answer.place - 1];
    expect(fields[3], "experiment", study_.experiments[study_.trials[trial].experiment].id);
    const std::vector<std::size_t>& stimuli = study_.trials[trial].stimuli;
    expect(fields[4], "first", study_.stimuli[stimuli[0]].label());
    expect(fields[5], "second", stimuli.size() > 1 ? study_.stimuli[stimuli[1]].label() : "");
    if (const std::string why = why_no_answer(study_, trial, fields[6]); !why.empty()) fail("answer: " + why);
    answer.answer = fields[6];
    const auto seconds = number_of<double>(fields[7]);
    if (!seconds || !(*seconds >= 0 && *seconds <= k_longest_s))
      fail(fmt::format("seconds: '{}' is no number from 0 to {}", printable(fields[7]), k_longest_s));
    answer.seconds = *seconds;
    answer.when = printable(fields[8]);
    return answer;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(fmt::format("{}: line {}: {}", file_, number_, reason));
  }

  std::size_t counted(std::string_view field, const char* name, std::size_t most) const {
    const auto number = number_of<std::size_t>(field);
    if (!number || *number < 1 || *number > most)
      fail(fmt::format("{}: '{}' is no number from 1 to {}", name, printable(field), most));
    return *number;
  }

  void expect(std::string_view field, const char* name, const std::string& expected) const {
    if (field != expected)
      fail(fmt::format("{}: '{}', but the study has '{}' there", name, printable(field), expected));
  }

  const Study& study_;
  std::string_view text_;
  const std::string& file_;
  std::size_t number_;
};

}  // namespace

std::string_view answers_header() noexcept { return k_header; }

std::string answer_line(const Study& study, const StudyAnswer& answer) {
  const StudyTrial& trial = study.trials[study.order_of(answer.participant)[answer.place - 1]];
  return fmt::format("{},{},{},{},{},{},{},{:.3f},{}", study.id, answer.participant, answer.place,
                     study.experiments[trial.experiment].id, study.stimuli[trial.stimuli[0]].label(),
                     trial.stimuli.size() > 1 ? study.stimuli[trial.stimuli[1]].label() : "", answer.answer,
                     answer.seconds, answer.when);
}

std::string why_no_answer(const Study& study, std::size_t trial, std::string_view answer) {
  const StudyExperiment& experiment = study.experiments[study.trials[trial].experiment];
  if (experiment.kind == StudyAnswerKind::choice) {
    if (answer == "first" || answer == "second") return "";
    return fmt::format("'{}' is neither first nor second", printable(answer));
  }
  if (experiment.kind == StudyAnswerKind::rating) {
    const auto number = number_of<int>(answer);
    if (number && *number >= experiment.low && *number <= experiment.high) return "";
    return fmt::format("'{}' is no whole number from {} to {}", printable(answer), experiment.low, experiment.high);
  }
  if (std::find(experiment.labels.begin(), experiment.labels.end(), answer) != experiment.labels.end()) return "";
  return fmt::format("'{}' is none of {}", printable(answer), fmt::join(experiment.labels, ", "));
}

std::vector<StudyAnswer> parse_answers(const Study& study, std::string_view text, const std::string& name) {
  std::vector<StudyAnswer> answers;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos)
      throw InvalidInput(
          fmt::format("{}: line {}: has no end, it was cut off; papilla study run takes it away and asks "
                      "again",
                      name, number));
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (number == 1) {
      if (line != k_header)
        throw InvalidInput(fmt::format("{}: line 1: '{}' is not {}", name, printable(line), k_header));
      continue;
    }
    answers.push_back(Line(study, line, name, number).answer());
  }
  return answers;
}

std::vector<StudyAnswer> read_answers(const Study& study, const std::vector<std::filesystem::path>& files) {
  std::map<std::size_t, std::string> file_of;
  std::map<std::pair<std::size_t, std::size_t>, StudyAnswer> last;
  for (const std::filesystem::path& file : files) {
    const std::string text = read_file(file);
    if (text.empty()) throw InvalidInput(file.string() + ": is empty");
    for (StudyAnswer& answer : parse_answers(study, text, file.string())) {
      const auto [known, is_new] = file_of.emplace(answer.participant, file.string());
      if (known->second != file.string())
        throw InvalidInput(
            fmt::format("{}: participant {} is in {}, too", file.string(), answer.participant, known->second));
      last[{answer.participant, answer.place}] = std::move(answer);
    }
  }
  std::vector<StudyAnswer> answers;
  for (auto& [key, answer] : last) answers.push_back(std::move(answer));
  return answers;
}

std::size_t next_place(const Study& study, std::size_t participant, const std::vector<StudyAnswer>& answers) {
  const std::size_t all = study.order_of(participant).size();
  std::set<std::size_t> answered;
  for (const StudyAnswer& answer : answers)
    if (answer.participant == participant) answered.insert(answer.place);
  for (std::size_t place = 1; place <= all; ++place)
    if (!answered.contains(place)) return place;
  return all + 1;
}

}  // namespace papilla
