// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "json/json.hpp"
#include "studio/studio_socket.hpp"
#include "studio/tls_files.hpp"

namespace papilla::app {

/// What pages are told and say by the WebSocket, and whether any is left. Thread-safe.
class StudioEvents {
 public:
  /// @throws as StudioSocket.
  explicit StudioEvents(const std::optional<TlsFiles>& tls) : socket_(tls) {}

  int port() const noexcept { return socket_.port(); }
  /// Begins to serve. Once. @param admits as of SocketHandlers.
  void start(decltype(SocketHandlers::admits) admits);
  /// Who gets the messages of pages, from the socket's thread; empty: nobody. None comes any more to whom it was
  /// before.
  void hear(std::function<void(const std::string& text)> message);

  void tell(const Json& event);
  /// Not more often than pages draw: what comes too soon is left out.
  void tell_progress(const Json& event);
  /// There were pages, and the last one was closed longer ago than that.
  bool are_gone_for(double seconds) const;

 private:
  using Clock = std::chrono::steady_clock;

  /// A page that came is told {"event": "open"}: what was told before it did not hear.
  void note_clients(std::size_t clients);

  mutable std::mutex mutex_;
  std::size_t clients_ = 0;
  bool had_client_ = false;
  Clock::time_point left_at_, told_at_;
  std::mutex message_mutex_;
  std::function<void(const std::string& text)> message_;
  StudioSocket socket_;  ///< Ends first: it calls the others.
};

}  // namespace papilla::app
