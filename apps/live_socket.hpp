// SPDX-License-Identifier: MIT
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "papilla/core/error.hpp"
#include "user_folder.hpp"

/// The local socket over which a player tells what it does; docs/live.md says what goes over it.
namespace papilla::app {

/// player.sock in the user's folder, which is made when it is missing. @throws InvalidInput as make_user_folder().
inline std::string default_live_socket() { return make_user_folder() + "/player.sock"; }

inline std::string folder_of_socket(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// @throws InvalidInput when the path does not fit into an address of the system (107 bytes), or its folder is not one
///         of this user alone.
inline sockaddr_un live_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw InvalidInput(path + ": a socket's path has 1 to " + std::to_string(sizeof address.sun_path - 1) + " bytes");
  require_folder_of_user(folder_of_socket(path));
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

/// Whether the other end of a local connection is a process of this user.
inline bool is_of_this_user(int connection) {
  ucred other{};
  socklen_t size = sizeof other;
  return ::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &other, &size) == 0 && other.uid == ::geteuid();
}

/// A connection to a player of this user, or -1 when none listens there.
/// @throws InvalidInput as live_address().
inline int connect_live(const std::string& path) {
  const sockaddr_un address = live_address(path);
  const int connection = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connection < 0) return -1;
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      is_of_this_user(connection))
    return connection;
  ::close(connection);
  return -1;
}

}  // namespace papilla::app
