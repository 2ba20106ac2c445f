// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/latest_slot.hpp"

namespace papilla::player {

/// Tells whoever connects to a local socket where probe and proxy are and what force acts, k_live_hz times a second,
/// one JSON object a line (docs/live.md), from a thread of its own: the loop only stores into a slot.
///
/// A listener that does not read fast enough misses samples; it never holds up the others or the loop. The socket is
/// the user's alone (mode 0600) and is removed at the end.
class LivePublisher {
 public:
  static constexpr int k_live_hz = 60;
  static constexpr std::size_t k_most_listeners = 64;

  /// @param greeting the first line that every listener gets, without line end.
  /// @throws IoError when the socket can't be made, or another player listens there; InvalidInput as live_address().
  LivePublisher(std::string path, std::string greeting);
  ~LivePublisher();
  LivePublisher(const LivePublisher&) = delete;
  LivePublisher& operator=(const LivePublisher&) = delete;

  /// The loop's sink; see LoopOptions::latest.
  LatestSlot<RecordRow>& slot() noexcept { return slot_; }

 private:
  /// A connection and what it has not yet taken of the line that it is being sent.
  struct Listener {
    int connection = -1;
    std::string rest;
  };

  void serve(const std::stop_token& end);
  void accept_new();
  /// Sends what is left of older lines, and the text to those who have taken all of them.
  void publish(const std::string& text);

  std::string path_, greeting_;
  int socket_ = -1;
  std::vector<Listener> listeners_;
  LatestSlot<RecordRow> slot_;
  std::jthread thread_;
};

/// One sample as a line, without line end.
std::string live_line(std::uint64_t tick, const RecordRow& row);

}  // namespace papilla::player
