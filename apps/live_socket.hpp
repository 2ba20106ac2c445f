// SPDX-License-Identifier: MIT
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "papilla/core/error.hpp"

/// The local socket over which a player tells what it does; docs/live.md says what goes over it.
namespace papilla::app {

/// $XDG_RUNTIME_DIR/papilla-player.sock, or /tmp/papilla-player-UID.sock where there is no such folder.
inline std::string default_live_socket() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder && *folder) return std::string(folder) + "/papilla-player.sock";
  return "/tmp/papilla-player-" + std::to_string(::getuid()) + ".sock";
}

/// @throws InvalidInput when the path does not fit into an address of the system (107 bytes).
inline sockaddr_un live_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw InvalidInput(path + ": a socket's path has 1 to " + std::to_string(sizeof address.sun_path - 1) + " bytes");
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

/// A connection to the socket, or -1 when nobody listens there.
/// @throws InvalidInput as live_address().
inline int connect_live(const std::string& path) {
  const sockaddr_un address = live_address(path);
  const int connection = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connection < 0) return -1;
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return connection;
  ::close(connection);
  return -1;
}

}  // namespace papilla::app
