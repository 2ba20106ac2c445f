// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "papilla/core/deadline.hpp"
#include "study/stimulus_player.hpp"
#include "study/study_session.hpp"

namespace papilla::app {

/// The page that asks, with all texts of one participant: for keyboard, pointer and screen readers. Whatever tells a
/// stimulus from another stays with the server, but its picture.
std::string session_page(const StudySession& session, const StimulusPlayer& player);

/// Asks on a page that is served on this machine only, until all trials are answered, SIGINT, SIGTERM or the deadline.
/// @param ready is called with the page's address as soon as it can be opened. @returns the address.
/// @throws IoError when the port is taken.
std::string run_on_page(StudySession& session, StimulusPlayer& player, int port, const Deadline& deadline,
                        const std::function<void(const std::string&)>& ready);

}  // namespace papilla::app
