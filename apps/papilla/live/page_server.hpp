// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "live/player_link.hpp"

namespace papilla::app {

/// Serves one page and the events of a player on 127.0.0.1, to nobody but this machine: `/` is the page, `/live` the
/// stream of server-sent events. A request that names another host in its Host header, as a page from elsewhere whose
/// name was bent to 127.0.0.1 would, is refused. About 30 pages may be open at once.
class PageServer {
 public:
  /// @param port 0 takes any that is free.
  /// @throws IoError when the port is taken.
  PageServer(std::string html, PlayerLink& player, int port);
  ~PageServer();  ///< Ends the streams and the threads.
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  const std::string& url() const noexcept { return url_; }

 private:
  struct Server;
  std::unique_ptr<Server> server_;
  std::string url_;
};

}  // namespace papilla::app
