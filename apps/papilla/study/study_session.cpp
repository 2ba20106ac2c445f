// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/study_session.hpp"

#include <fmt/chrono.h>

#include <chrono>
#include <set>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

fs::path answers_path(const fs::path& folder, std::size_t participant, const fs::path& given) {
  if (!given.empty()) return given;
  make_folder(folder / "answers");
  return folder / "answers" / participant_file_name(participant);
}

const Study& with_participant(const Study& study, std::size_t participant, const fs::path& file) {
  if (participant < 1 || participant > study.participants.size())
    throw InvalidInput(
        fmt::format("{}: has participants 1 to {}, not {}", file.string(), study.participants.size(), participant));
  return study;
}

std::string now_utc() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

std::string participant_file_name(std::size_t participant) { return fmt::format("participant-{:03}.csv", participant); }

StudySession::StudySession(const fs::path& study, std::size_t participant, const fs::path& answers)
    : study_(read_study(study)),
      folder_(study.parent_path()),
      participant_(participant),
      order_(with_participant(study_, participant, study).order_of(participant)),
      answers_file_(answers_path(folder_, participant, answers)),
      file_(answers_file_) {
  if (file_.content().empty()) {
    file_.append(answers_header());
    return;
  }
  answers_ = parse_answers(study_, file_.content(), answers_file_.string());
  for (const StudyAnswer& answer : answers_)
    if (answer.participant != participant)
      throw InvalidInput(fmt::format("{}: has answers of participant {}, not {}", answers_file_.string(),
                                     answer.participant, participant));
}

std::size_t StudySession::answered() const {
  std::set<std::size_t> places;
  for (const StudyAnswer& answer : answers_) places.insert(answer.place);
  return places.size();
}

std::string StudySession::record(std::size_t place, const std::string& answer, double seconds) {
  if (place < 1 || place > trials()) return fmt::format("there is no trial {}", place);
  if (std::string why = why_no_answer(study_, trial_at(place), answer); !why.empty()) return why;
  constexpr double k_longest_s = 1e6;
  if (!(seconds >= 0 && seconds <= k_longest_s)) return "the time taken is no number of seconds";
  const StudyAnswer said{participant_, place, answer, seconds, now_utc()};
  file_.append(answer_line(study_, said));
  answers_.push_back(said);
  return "";
}

}  // namespace papilla::app
