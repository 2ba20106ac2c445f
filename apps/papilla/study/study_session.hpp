// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "papilla/core/append_file.hpp"
#include "papilla/pipeline/study/study.hpp"
#include "papilla/pipeline/study/study_answers.hpp"

namespace papilla::app {

/// "participant-003.csv".
std::string participant_file_name(std::size_t participant);

/// A participant's way through a study. Every answer is on the disk before the next question; a session that was ended
/// at any moment goes on at the first trial without answer.
class StudySession {
 public:
  /// @param answers  empty: answers/participant-NNN.csv beside the study.
  /// @throws IoError, as read_study() and parse_answers(), and InvalidInput when the study has no such participant or
  /// the answers are another one's.
  StudySession(const std::filesystem::path& study, std::size_t participant, const std::filesystem::path& answers);

  const Study& study() const noexcept { return study_; }
  std::size_t participant() const noexcept { return participant_; }
  const std::filesystem::path& answers_file() const noexcept { return answers_file_; }
  /// Of a name in the study.
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  /// Of a last line without end, which was removed.
  std::size_t removed_bytes() const noexcept { return file_.removed_bytes(); }

  std::size_t trials() const noexcept { return order_.size(); }
  /// From 1; one more than trials() when all are answered.
  std::size_t next() const { return next_place(study_, participant_, answers_); }
  std::size_t answered() const;
  /// Number of a trial in the study. @pre place from 1 to trials().
  std::size_t trial_at(std::size_t place) const { return order_[place - 1]; }

  /// Writes an answer, which replaces one that was given before.
  /// @returns why it is none; empty when it was written. @throws IoError.
  std::string record(std::size_t place, const std::string& answer, double seconds);

 private:
  Study study_;
  std::filesystem::path folder_;
  std::size_t participant_;
  std::vector<std::size_t> order_;
  std::filesystem::path answers_file_;
  AppendFile file_;
  std::vector<StudyAnswer> answers_;
};

}  // namespace papilla::app
