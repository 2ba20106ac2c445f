// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace papilla::app {

/// A player that is listened to over its local socket (docs/live.md), for any number of readers. Connects again
/// whenever there is a player; one thread.
class PlayerLink {
 public:
  /// @throws InvalidInput when the path is no socket's, as live_address().
  explicit PlayerLink(std::string path);
  ~PlayerLink();
  PlayerLink(const PlayerLink&) = delete;
  PlayerLink& operator=(const PlayerLink&) = delete;

  /// The greeting of the player that plays now, waited for until `patience` is over; empty when there is none.
  std::string greeting(std::chrono::milliseconds patience);

  /// What is newer than `seen`, as server-sent events: `state` (the greeting with "state": "playing", or
  /// {"state": "waiting"} before the first player, {"state": "ended"} after one) and `sample`, the newest line; nothing
  /// when nothing is newer.
  /// @param seen 0 at first; moved on.
  std::string events(std::uint64_t& seen);

 private:
  void follow(const std::stop_token& end);
  void read_lines(int connection, const std::stop_token& end);
  void take(const std::string& line);
  void enter(const char* state, std::string greeting);

  std::string path_;
  std::mutex mutex_;
  std::condition_variable greeted_;
  std::uint64_t turn_ = 1, state_turn_ = 1, sample_turn_ = 0;
  std::string state_, greeting_, sample_;
  std::jthread thread_;
};

}  // namespace papilla::app
