// SPDX-License-Identifier: MIT
#include "live_publisher.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "live_socket.hpp"

namespace papilla::player {
namespace {

constexpr int k_backlog = LivePublisher::k_most_clients;
/// Send buffer of a client, about twenty samples: a slow client skips samples instead of seeing old ones.
constexpr int k_waiting_bytes = 8192;

constexpr auto k_turn = std::chrono::microseconds(1000000 / LivePublisher::k_live_hz);
/// After how many turns in which it took nothing a client is dropped: 5 s.
constexpr int k_longest_stall = 5 * LivePublisher::k_live_hz;

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
    std::this_thread::sleep_for(k_turn);
    // So few in a turn that a flood of connections does not hold up the samples.
    for (int i = 0; i < k_backlog && accept_one(); ++i) {
    }
    RecordRow row;
    const std::uint64_t tick = slot_.load(row);
    publish(tick == last ? std::string() : live_line(tick, row) + '\n');
    last = tick;
  }
  publish("{\"end\":true}\n");
}

bool LivePublisher::accept_one() {
  const int connection = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) return false;
  ::setsockopt(connection, SOL_SOCKET, SO_SNDBUF, &k_waiting_bytes, sizeof k_waiting_bytes);
  Client client{connection, greeting_ + '\n'};
  if (app::is_of_this_user(connection) && make_room() && send_now(connection, client.rest))
    clients_.push_back(std::move(client));
  else
    ::close(connection);
  return true;
}

bool LivePublisher::make_room() {
  if (clients_.size() < k_most_clients) return true;
  const auto slowest = std::ranges::max_element(clients_, {}, &Client::stalled_turns);
  if (slowest->stalled_turns == 0) return false;
  ::close(slowest->connection);
  clients_.erase(slowest);
  return true;
}

void LivePublisher::publish(const std::string& text) {
  std::erase_if(clients_, [&](Client& client) {
    if (client.rest.empty()) client.rest = text;
    const std::size_t waiting = client.rest.size();
    const bool open = send_now(client.connection, client.rest);
    client.stalled_turns = client.rest.size() < waiting || waiting == 0 ? 0 : client.stalled_turns + 1;
    if (open && client.stalled_turns < k_longest_stall) return false;
    ::close(client.connection);
    return true;
  });
}

}  // namespace papilla::player
