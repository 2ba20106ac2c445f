// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/player_link.hpp"

#include <poll.h>

#include <array>

#include "live_socket.hpp"
#include "papilla/core/error.hpp"
#include "verb.hpp"

namespace papilla::app {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds k_retry{250};
constexpr std::size_t k_longest_line = 65536;

/// -1, too, when somebody took the folder away after the start.
int connect_if_possible(const std::string& path) {
  try {
    return connect_live(path);
  } catch (const InvalidInput&) {
    return -1;
  }
}

std::string event(const char* name, const std::string& data) {
  return std::string("event: ") + name + "\ndata: " + data + "\n\n";
}

}  // namespace

PlayerLink::PlayerLink(std::string path) : path_(std::move(path)), state_(R"({"state":"waiting"})") {
  live_address(path_);
  thread_ = std::jthread([this](const std::stop_token& end) { follow(end); });
}

PlayerLink::~PlayerLink() = default;

std::string PlayerLink::greeting(milliseconds patience) {
  std::unique_lock lock(mutex_);
  greeted_.wait_for(lock, patience, [&] { return !greeting_.empty(); });
  return greeting_;
}

std::string PlayerLink::events(std::uint64_t& seen) {
  const std::lock_guard lock(mutex_);
  std::string text;
  if (state_turn_ > seen) text += event("state", state_);
  if (sample_turn_ > seen) text += event("sample", sample_);
  seen = turn_;
  return text;
}

void PlayerLink::follow(const std::stop_token& end) {
  std::mutex alone;
  std::condition_variable_any wake;
  while (!end.stop_requested()) {
    if (const int connection = connect_if_possible(path_); connection >= 0) {
      read_lines(connection, end);
      ::close(connection);
      if (!greeting_.empty()) enter(R"({"state":"ended"})", "");
    }
    std::unique_lock lock(alone);
    wake.wait_for(lock, end, k_retry, [] { return false; });
  }
}

void PlayerLink::read_lines(int connection, const std::stop_token& end) {
  std::string text;
  std::array<char, 4096> buffer;
  while (!end.stop_requested()) {
    pollfd waiting{connection, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(k_retry.count())) <= 0) continue;
    const ssize_t got = ::recv(connection, buffer.data(), buffer.size(), 0);
    if (got <= 0) return;
    text.append(buffer.data(), static_cast<std::size_t>(got));
    for (std::size_t stop = text.find('\n'); stop != std::string::npos; stop = text.find('\n')) {
      take(text.substr(0, stop));
      text.erase(0, stop + 1);
    }
    if (text.size() > k_longest_line) return;
  }
}

/// A greeting, a sample, or the end; anything else is not for us.
void PlayerLink::take(const std::string& line) {
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return;
  if (json.contains("papilla_live")) {
    json["state"] = "playing";
    enter(json.dump(-1, ' ', false, Json::error_handler_t::replace).c_str(), line);
  } else if (json.contains("probe")) {
    const std::lock_guard lock(mutex_);
    sample_ = json.dump();
    sample_turn_ = ++turn_;
  }
}

void PlayerLink::enter(const char* state, std::string greeting) {
  const std::lock_guard lock(mutex_);
  state_ = state;
  greeting_ = std::move(greeting);
  state_turn_ = ++turn_;
  sample_turn_ = 0;  // Of the state before: nobody who comes now shall take it for what happens.
  greeted_.notify_all();
}

}  // namespace papilla::app
