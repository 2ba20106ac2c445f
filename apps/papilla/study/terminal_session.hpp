// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "study/stimulus_player.hpp"
#include "study/study_session.hpp"

namespace papilla::app {

/// Asks on the terminal: questions on standard error, answers from standard input, a line each. Ends when all trials
/// are answered, at the end of the input, or when the participant stops.
void run_in_terminal(StudySession& session, StimulusPlayer& player);

}  // namespace papilla::app
