// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/latest_slot.hpp"

namespace papilla::player {

/// Sends probe, proxy and force to every client of a local socket, k_live_hz times a second, one JSON object a line
/// (docs/live.md). It runs in its own thread; the loop only stores into a slot.
///
/// A client that reads too slowly misses samples and never blocks the others or the loop; one that takes nothing for
/// five seconds is dropped, and sooner when another needs its place. The socket has mode 0600, lies in a folder of the
/// user and takes clients of the same user only. It is removed at the end.
class LivePublisher {
 public:
  static constexpr int k_live_hz = 60;
  static constexpr std::size_t k_most_clients = 64;

  /// @param greeting first line for every client, without line end.
  /// @throws IoError when the socket can't be created or another player uses it; InvalidInput as live_address().
  LivePublisher(std::string path, std::string greeting);
  ~LivePublisher();
  LivePublisher(const LivePublisher&) = delete;
  LivePublisher& operator=(const LivePublisher&) = delete;

  /// For LoopOptions::latest.
  LatestSlot<RecordRow>& slot() noexcept { return slot_; }

 private:
  /// A connection and the unsent rest of its current line.
  struct Client {
    int connection = -1;
    std::string rest;
    int stalled_turns = 0;  ///< In which it took nothing of the rest.
  };

  void serve(const std::stop_token& end);
  /// @returns false when nobody waits.
  bool accept_one();
  /// @returns false when all places are taken by clients that read.
  bool make_room();
  /// Sends the rest of older lines, and `text` to clients without one.
  void publish(const std::string& text);

  std::string path_, greeting_;
  int socket_ = -1;
  std::vector<Client> clients_;
  LatestSlot<RecordRow> slot_;
  std::jthread thread_;
};

/// A sample as one line of JSON, without line end.
std::string live_line(std::uint64_t tick, const RecordRow& row);

}  // namespace papilla::player
