// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/follow.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "http/page_server.hpp"
#include "live/player_link.hpp"
#include "live_socket.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_patience{5000}, k_look{50};

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

std::string file_of_player(PlayerLink& player, const std::string& socket) {
  const std::string greeting = player.greeting(k_patience);
  if (greeting.empty())
    throw InvalidInput(socket + ": no player listens there (papilla-player FILE --live), and no FILE is given");
  const Json file = Json::parse(greeting).value("file", Json());
  if (!file.is_string()) throw InvalidInput(socket + ": the player there names no file");
  return file.get<std::string>();
}

/// The page at /, and what the player does at /live.
PageRoutes routes_of(std::string html, PlayerLink& player) {
  const auto page = std::make_shared<const std::string>(std::move(html));
  PageRoutes routes;
  routes.get["/"] = [page] { return PageAnswer{200, "text/html; charset=utf-8", page}; };
  routes.streams["/live"] = [&player](std::uint64_t& seen) { return player.events(seen); };
  return routes;
}

}  // namespace

Json follow_player(const FollowOptions& options, const std::function<PageContent(const std::string&)>& make_page,
                   const std::function<void(const std::string&)>& ready) {
  const std::string socket = options.socket.empty() ? default_live_socket() : options.socket;
  PlayerLink player(socket);
  const std::string file = options.file.empty() ? file_of_player(player, socket) : options.file;
  PageContent content = make_page(file);
  content.live = true;
  const PageServer server(routes_of(page_html(content), player), options.port);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  ready(server.url());
  while (!g_stop && !options.deadline.passed()) std::this_thread::sleep_for(k_look);
  return {{"url", server.url()}, {"file", file}, {"socket", socket}};
}

}  // namespace papilla::app
