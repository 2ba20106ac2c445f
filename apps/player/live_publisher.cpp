// SPDX-License-Identifier: MIT
#include "live_publisher.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "live_socket.hpp"

namespace papilla::player {
namespace {

constexpr int k_backlog = 8;
/// Send buffer of a client, about twenty samples: a slow client skips samples instead of seeing old ones.
constexpr int k_waiting_bytes = 8192;

/// Sends without blocking and leaves the rest in `rest`. @returns false when the connection is closed.
bool send_now(int connection, std::string& rest) {
  while (!rest.empty()) {
    const ssize_t sent = ::send(connection, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    rest.erase(0, static_cast<std::size_t>(sent));
  }
  return true;
}

/// Removes the socket of a player that was killed. @throws IoError for another kind of file and for a running player.
void remove_stale_socket(const std::string& path) {
  struct stat about {};
  if (::lstat(path.c_str(), &about) != 0) return;
  if (!S_ISSOCK(about.st_mode)) throw IoError(path + ": is there and is no socket");
  if (const int other = app::connect_live(path); other >= 0) {
    ::close(other);
    throw IoError(path + ": another player listens there");
  }
  ::unlink(path.c_str());
}

int listen_at(const std::string& path) {
  const sockaddr_un address = app::live_address(path);
  remove_stale_socket(path);
  const int made = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const mode_t before = ::umask(0177);
  const bool bound = made >= 0 && ::bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int why = errno;
  ::umask(before);
  if (bound && ::listen(made, k_backlog) == 0) return made;
  if (made >= 0) ::close(made);
  throw IoError(path + ": " + std::strerror(bound ? errno : why));
}

std::string vector_json(Vec3 v) { return fmt::format("[{:.7g},{:.7g},{:.7g}]", v.x, v.y, v.z); }

}  // namespace

std::string live_line(std::uint64_t tick, const RecordRow& row) {
  // JSON has no NaN.
  const auto vector = [](Vec3 v) { return is_finite(v) ? vector_json(v) : std::string("null"); };
  return fmt::format(R"({{"tick":{},"t":{:.6g},"probe":{},"proxy":{},"force":{},"contact":{}}})", tick, row.t,
                     vector(row.probe), vector(row.proxy), vector(row.force), row.in_contact);
}

LivePublisher::LivePublisher(std::string path, std::string greeting)
    : path_(std::move(path)), greeting_(std::move(greeting)), socket_(listen_at(path_)) {
  thread_ = std::jthread([this](const std::stop_token& end) { serve(end); });
}

LivePublisher::~LivePublisher() {
  thread_.request_stop();
  thread_.join();
  for (Client& client : clients_) ::close(client.connection);
  ::close(socket_);
  ::unlink(path_.c_str());
}

void LivePublisher::serve(const std::stop_token& end) {
  std::uint64_t last = 0;
  while (!end.stop_requested()) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, 1000 / k_live_hz) > 0) {
      accept_new();
      continue;
    }
    RecordRow row;
    const std::uint64_t tick = slot_.load(row);
    publish(tick == last ? std::string() : live_line(tick, row) + '\n');
    last = tick;
  }
  publish("{\"end\":true}\n");
}

void LivePublisher::accept_new() {
  const int connection = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) return;
  ::setsockopt(connection, SOL_SOCKET, SO_SNDBUF, &k_waiting_bytes, sizeof k_waiting_bytes);
  Client client{connection, greeting_ + '\n'};
  if (clients_.size() < k_most_clients && send_now(connection, client.rest))
    clients_.push_back(std::move(client));
  else
    ::close(connection);
}

void LivePublisher::publish(const std::string& text) {
  std::erase_if(clients_, [&](Client& client) {
    if (client.rest.empty()) client.rest = text;
    if (send_now(client.connection, client.rest)) return false;
    ::close(client.connection);
    return true;
  });
}

}  // namespace papilla::player
