// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace papilla::app {

/// What a StudioSocket asks and tells, in its own thread: none of it may wait.
struct SocketHandlers {
  /// Whether a request for a socket is served. Of each field all values that it has.
  std::function<bool(const std::string& target, const std::string& host, const std::string& origin)> admits;
  std::function<void(const std::string& text)> message;
  std::function<void(std::size_t clients)> changed;  ///< The number of connections.
};

/// A WebSocket server (RFC 6455) on a free port of 127.0.0.1.
///
/// Requests that are not admitted are answered by 403. Messages above 64 KiB close their connection. A client that
/// takes nothing of what it is sent is skipped by send_newest() and loses its connection when 64 MiB wait for it.
class StudioSocket {
 public:
  /// @throws std::runtime_error when no port is free.
  StudioSocket();
  ~StudioSocket();  ///< Closes all connections and ends the thread.
  StudioSocket(const StudioSocket&) = delete;
  StudioSocket& operator=(const StudioSocket&) = delete;

  int port() const noexcept;
  /// Begins to serve, in a thread of its own. Once.
  void start(SocketHandlers handlers);
  /// To all connections. From any thread.
  void send(const std::string& text);
  /// The same for bytes that only matter while they are new.
  void send_newest(const std::string& bytes);
  std::size_t clients() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace papilla::app
