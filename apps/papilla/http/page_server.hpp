// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace papilla::app {

/// A body that any number of connections send at the same time.
using SharedText = std::shared_ptr<const std::string>;

struct PageAnswer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  SharedText body;  ///< May be null: none.
};

/// What a page server serves, by path ("/"). The functions run in the server's one thread: they must not wait. Where
/// `get` or `post` throws, the answer is status 500; streams must not throw.
struct PageRoutes {
  std::map<std::string, std::function<PageAnswer()>> get;
  std::map<std::string, std::function<PageAnswer(const std::string& body)>> post;
  /// Streams of server-sent events. The function returns what is newer than `seen` (0 at first) as text of the stream
  /// and moves `seen` on, or returns nothing. It is asked 60 times a second for every client that has taken what it
  /// was sent before: a slow client gets the newest state, never a queue.
  std::map<std::string, std::function<std::string(std::uint64_t& seen)>> streams;
};

/// After which time, size or number a client is refused or dropped.
struct PageLimits {
  std::chrono::milliseconds request{10000};  ///< From the connection to the end of the header; the same for the body.
  std::chrono::milliseconds stall{10000};    ///< In which a client takes nothing of what it is sent.
  std::size_t header_bytes = 16384;          ///< 400 above. Cookies of other servers of this machine count, too.
  std::size_t body_bytes = 65536;            ///< 413 above, before it is read.
  std::size_t clients = 2048;    ///< With the right token, at the same time; 503 above. Less where files are limited.
  std::size_t strangers = 2048;  ///< Connections that showed no token yet; one more drops the oldest of them.
};

/// An HTTP server for pages of the user who started this program, on 127.0.0.1 only.
///
/// A request is served when its query has the server's token, it names this server by one Host header, and Origin and
/// Referer are this server's where they are given; any other is answered by 403 and nothing else, whatever it asks
/// for. Host and Origin keep pages from elsewhere out, whose name was bent to 127.0.0.1; the token keeps other users of
/// the machine out. Pages are told to load nothing from elsewhere and can't be framed.
///
/// One thread serves all connections by an event loop, each for one request: a client that is slow or silent costs a
/// file descriptor until PageLimits end it, and no other client waits for it.
class PageServer {
 public:
  /// @param port 0 takes any that is free.
  /// @throws IoError when the port is taken.
  PageServer(PageRoutes routes, int port, const PageLimits& limits = {});
  ~PageServer();  ///< Ends all connections and the thread.
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// http://127.0.0.1:PORT/?token=TOKEN, with 128 random bits in TOKEN.
  const std::string& url() const noexcept { return url_; }

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
  std::string url_;
};

}  // namespace papilla::app
