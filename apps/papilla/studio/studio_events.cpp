// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_events.hpp"

#include <utility>

namespace papilla::app {
namespace {

constexpr std::chrono::milliseconds k_picture{50};

}  // namespace

void StudioEvents::start(decltype(SocketHandlers::admits) admits) {
  socket_.start({std::move(admits),
                 [this](const std::string& text) {
                   const std::scoped_lock lock(message_mutex_);
                   if (message_) message_(text);
                 },
                 [this](std::size_t clients) { note_clients(clients); }});
}

void StudioEvents::hear(std::function<void(const std::string& text)> message) {
  const std::scoped_lock lock(message_mutex_);
  message_ = std::move(message);
}

void StudioEvents::tell(const Json& event) { socket_.send(event.dump(-1, ' ', false, Json::error_handler_t::replace)); }

void StudioEvents::tell_progress(const Json& event) {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  if (now - told_at_ < k_picture) return;
  told_at_ = now;
  tell(event);
}

void StudioEvents::note_clients(std::size_t clients) {
  bool is_new = false;
  {
    const std::scoped_lock lock(mutex_);
    is_new = clients > clients_;
    clients_ = clients;
    had_client_ = had_client_ || clients > 0;
    left_at_ = Clock::now();
  }
  if (is_new) tell({{"event", "open"}});
}

bool StudioEvents::are_gone_for(double seconds) const {
  const std::scoped_lock lock(mutex_);
  return had_client_ && clients_ == 0 && Clock::now() - left_at_ > std::chrono::duration<double>(seconds);
}

}  // namespace papilla::app
