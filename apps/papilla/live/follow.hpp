// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "page/page_file.hpp"
#include "papilla/core/deadline.hpp"
#include "verb.hpp"

namespace papilla::app {

struct FollowOptions {
  std::string socket;  ///< Of the player; empty: the default.
  std::string file;    ///< That the page shows; empty: what the player plays.
  int port = 0;        ///< Of the page; 0: any that is free.
  Deadline deadline;   ///< The page is no longer served then.
};

/// Serves a page that follows a player until SIGINT, SIGTERM or the deadline.
/// @param make_page the content of the page of a file.
/// @param ready is called with the page's address as soon as it can be opened.
/// @returns `url`, `file` and `socket`.
/// @throws InvalidInput when no file is given and no player is there to name one.
Json follow_player(const FollowOptions& options, const std::function<PageContent(const std::string&)>& make_page,
                   const std::function<void(const std::string&)>& ready);

}  // namespace papilla::app
