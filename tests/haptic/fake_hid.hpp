// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

#include "papilla/haptic/hid_transport.hpp"

namespace papilla::testing {

/// Input and output of a fake device; outlives the transport.
struct FakeWire {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::vector<std::byte>> input;              ///< Reports that read() returns.
  std::vector<std::vector<std::byte>> output, features;  ///< Written to the device, in order.
  std::vector<std::vector<std::byte>> answers;           ///< Of get_feature(), by number, in order.
  std::size_t fail_from = 1000000;                       ///< Writes from this one on fail.
  bool unplugged = false;
  std::function<std::vector<std::byte>()> hand;  ///< Creates a report when read() waits; empty: none.

  void send(std::vector<std::byte> report) {
    const std::lock_guard lock(mutex);
    input.push_back(std::move(report));
    changed.notify_all();
  }
  void unplug() {
    const std::lock_guard lock(mutex);
    unplugged = true;
    changed.notify_all();
  }
  std::vector<std::vector<std::byte>> written() {
    const std::lock_guard lock(mutex);
    return output;
  }
  /// Waits until `count` reports were written. @returns false after two seconds.
  bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(2), [&] { return output.size() >= count; });
  }
};

class FakeTransport final : public HidTransport {
 public:
  FakeTransport(FakeWire& wire, HidInfo info) : wire_(wire), info_(std::move(info)) {}
  const HidInfo& info() const noexcept override { return info_; }
  std::ptrdiff_t read(std::span<std::byte> report, int timeout_ms) noexcept override {
    std::unique_lock lock(wire_.mutex);
    if (wire_.hand && timeout_ms > 0 && wire_.input.empty())
      if (std::vector<std::byte> next = wire_.hand(); !next.empty()) wire_.input.push_back(std::move(next));
    wire_.changed.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                           [&] { return wire_.unplugged || !wire_.input.empty(); });
    if (wire_.unplugged) return -1;
    if (wire_.input.empty()) return 0;
    const std::vector<std::byte> first = std::move(wire_.input.front());
    wire_.input.pop_front();
    std::copy_n(first.begin(), std::min(first.size(), report.size()), report.begin());
    return static_cast<std::ptrdiff_t>(std::min(first.size(), report.size()));
  }
  bool write(std::span<const std::byte> report) noexcept override {
    const std::lock_guard lock(wire_.mutex);
    if (wire_.unplugged || wire_.output.size() >= wire_.fail_from) return false;
    wire_.output.emplace_back(report.begin(), report.end());
    wire_.changed.notify_all();
    return true;
  }
  bool set_feature(std::span<const std::byte> report) noexcept override {
    const std::lock_guard lock(wire_.mutex);
    wire_.features.emplace_back(report.begin(), report.end());
    return !wire_.unplugged;
  }
  bool get_feature(std::span<std::byte> report) noexcept override {
    const std::lock_guard lock(wire_.mutex);
    for (auto answer = wire_.answers.begin(); answer != wire_.answers.end(); ++answer)
      if (answer->front() == report[0]) {
        std::copy_n(answer->begin(), std::min(answer->size(), report.size()), report.begin());
        wire_.answers.erase(answer);
        return true;
      }
    return false;
  }

 private:
  FakeWire& wire_;
  HidInfo info_;
};

}  // namespace papilla::testing
