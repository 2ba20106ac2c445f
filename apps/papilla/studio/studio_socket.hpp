// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/tls_files.hpp"

namespace papilla::app {

/// What a StudioSocket asks and tells, in its own thread: none of it may wait.
struct SocketHandlers {
  /// Whether a request for a socket is served. Of each field all values that it has.
  std::function<bool(const std::string& target, const std::string& host, const std::string& origin)> admits;
  std::function<void(const std::string& text)> message;
  std::function<void(std::size_t clients)> changed;  ///< The number of connections.
};

/// A WebSocket server (RFC 6455) on a free port of 127.0.0.1, or with TLS of every address of this machine.
///
/// Requests that are not admitted are answered by 403. Messages above 64 KiB close their connection. A client that
/// takes nothing of what it is sent is skipped by send_newest() and loses its connection when 64 MiB wait for it.
class StudioSocket {
 public:
  /// @throws std::runtime_error when no port is free or a file is of no use.
  explicit StudioSocket(const std::optional<TlsFiles>& tls = {});
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
  template <class Config>
  class ServerOf;
  std::unique_ptr<Server> server_;
};

}  // namespace papilla::app
