// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/follow.hpp"

#include <httplib.h>
#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <thread>

#include "live/player_link.hpp"
#include "live_socket.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

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

constexpr std::size_t k_threads = 32;  ///< One a page that is open.
constexpr std::chrono::milliseconds k_heartbeat{500};

struct PageServer::Server {
  httplib::Server http;
  std::string html;
  std::atomic<bool> over{false};
  std::thread thread;

  /// Sends events until the page is closed or the server ends.
  void stream(httplib::Response& response, PlayerLink& player) {
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream", [this, &player, seen = std::uint64_t{0}](std::size_t, httplib::DataSink& sink) mutable {
          if (over) {
            sink.done();
            return true;
          }
          const std::string text = player.events(seen, k_heartbeat);
          return sink.write(text.data(), text.size());
        });
  }
};

PageServer::PageServer(std::string html, PlayerLink& player, int port) : server_(std::make_unique<Server>()) {
  httplib::Server& http = server_->http;
  server_->html = std::move(html);
  http.new_task_queue = [] { return new httplib::ThreadPool(k_threads); };
  http.set_keep_alive_max_count(1);  // A connection that is kept for later would hold up the end.
  http.set_tcp_nodelay(true);
  const int bound = port == 0 ? http.bind_to_any_port("127.0.0.1") : http.bind_to_port("127.0.0.1", port) ? port : -1;
  if (bound <= 0) throw IoError("127.0.0.1:" + std::to_string(port) + ": the port can't be used");
  const std::string host = "127.0.0.1:" + std::to_string(bound), other_name = "localhost:" + std::to_string(bound);
  url_ = "http://" + host + "/";
  http.set_pre_routing_handler([host, other_name](const httplib::Request& request, httplib::Response& response) {
    const std::string named = request.get_header_value("Host");
    if (named == host || named == other_name) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
  http.Get("/", [this](const httplib::Request&, httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_content(server_->html, "text/html; charset=utf-8");
  });
  http.Get("/live", [this, &player](const httplib::Request&, httplib::Response& response) {
    server_->stream(response, player);
  });
  server_->thread = std::thread([this] { server_->http.listen_after_bind(); });
  while (!http.is_running())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // Or stop() would not be heard.
}

PageServer::~PageServer() {
  server_->over = true;
  server_->http.stop();
  server_->thread.join();
}

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

}  // namespace

Json follow_player(const FollowOptions& options, const std::function<PageContent(const std::string&)>& make_page,
                   const std::function<void(const std::string&)>& ready) {
  const std::string socket = options.socket.empty() ? default_live_socket() : options.socket;
  PlayerLink player(socket);
  const std::string file = options.file.empty() ? file_of_player(player, socket) : options.file;
  PageContent content = make_page(file);
  content.live = true;
  const PageServer server(page_html(content), player, options.port);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  ready(server.url());
  while (!g_stop) std::this_thread::sleep_for(k_look);
  return {{"url", server.url()}, {"file", file}, {"socket", socket}};
}

}  // namespace papilla::app
