// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/study/study.hpp"

namespace papilla {

/// What a participant said to one trial.
struct StudyAnswer {
  std::size_t participant = 1;  ///< From 1.
  std::size_t place = 1;        ///< Of the trial in the participant's order, from 1.
  std::string answer;           ///< A label of the question, a number, "first" or "second".
  double seconds = 0;           ///< From the question to the answer.
  std::string when;             ///< UTC, "2026-01-31T12:00:00Z".
};

/// First line of a file of answers:
///     study,participant,trial,experiment,first,second,answer,seconds,when
/// `first` and `second` are labels of the stimuli, the second one empty where there is one. No field has a comma.
std::string_view answers_header() noexcept;

/// The answer as a line without end. @pre participant and place exist in the study.
std::string answer_line(const Study& study, const StudyAnswer& answer);

/// Why this is no answer to the trial; empty when it is one.
std::string why_no_answer(const Study& study, std::size_t trial, std::string_view answer);

/// The answers of a file. A trial may be answered more than once: people correct themselves.
/// @param name  of the file, for messages.
/// @throws InvalidInput naming file, line and reason: another header, fields that are missing or too many, an answer
/// that does not fit its question, a trial or stimulus that is not the study's, another study, a last line without end.
std::vector<StudyAnswer> parse_answers(const Study& study, std::string_view text, const std::string& name);

/// Answers of several files, the last one of each trial.
/// @throws IoError, as parse_answers(), and InvalidInput when a participant is in two files.
std::vector<StudyAnswer> read_answers(const Study& study, const std::vector<std::filesystem::path>& files);

/// The first trial of a participant that has no answer, from 1; one more than there are when all have.
std::size_t next_place(const Study& study, std::size_t participant, const std::vector<StudyAnswer>& answers);

}  // namespace papilla
