// SPDX-License-Identifier: MIT
#include "papilla/haptic/hid_device.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/haptic/loop_clock.hpp"

namespace papilla {
namespace {

static_assert(std::atomic<double>::is_always_lock_free, "the slot must not lock");

constexpr int k_most_drained = 64;  // More than a device queues; bounds the time of a flood.

double now_s() noexcept { return LoopClock().now_s(); }

void send_all(HidTransport& transport, const std::vector<HidReport>& reports) noexcept {
  for (const HidReport& report : reports) transport.write(report);
}

}  // namespace

HidDevice::HidDevice(std::unique_ptr<HidTransport> transport, std::unique_ptr<ForceProtocol> protocol, Vec3 origin,
                     const std::function<void(const std::vector<HidReport>&)>& started)
    : transport_(std::move(transport)), protocol_(std::move(protocol)), origin_(origin) {
  try {
    protocol_->start(*transport_);
    stop_reports_ = protocol_->stop_reports();
    if (started) started(stop_reports_);
  } catch (...) {
    send_all(*transport_, protocol_->stop_reports());
    throw;
  }
  caps_ = protocol_->caps();
  arrived_s_ = now_s();
  writer_ = std::thread([this] { write_forces(); });
}

HidDevice::~HidDevice() { stop(); }

/// Decodes input_; keeps the position and returns true when it is fresh.
bool HidDevice::accept_report(std::ptrdiff_t bytes) noexcept {
  if (bytes < 0) lost_.store(true, std::memory_order_relaxed);
  if (bytes <= 0) return false;
  DeviceSample sample = sample_;
  const std::size_t size = std::min(static_cast<std::size_t>(bytes), input_.size());
  if (!protocol_->decode(std::span(input_).first(size), sample)) return false;
  if (has_sample_ && sample.counted && sample.sequence == sample_.sequence) return false;
  sample_ = sample;
  has_sample_ = true;
  arrived_s_ = now_s();
  return true;
}

double HidDevice::wait(double longest_s) noexcept {
  const double until = now_s() + longest_s;
  bool fresh = false;
  while (!fresh && !lost_.load(std::memory_order_relaxed)) {
    const double left = until - now_s();
    if (left <= 0) return 0;
    fresh = accept_report(transport_->read(input_, std::max(1, static_cast<int>(std::ceil(left * 1e3)))));
  }
  for (int i = 0; i < k_most_drained && fresh; ++i) {
    const std::ptrdiff_t bytes = transport_->read(input_, 0);
    if (bytes <= 0) {
      accept_report(bytes);
      break;
    }
    if (accept_report(bytes)) ++stale_;
  }
  return now_s() - arrived_s_;
}

bool HidDevice::read(DeviceState& state) noexcept {
  state.position = origin_ + sample_.position;
  state.buttons = sample_.buttons;
  state.age_s = now_s() - arrived_s_;
  return has_sample_ && !lost_.load(std::memory_order_relaxed);
}

bool HidDevice::write(Vec3 force_n) noexcept {
  version_.fetch_add(1, std::memory_order_acq_rel);
  force_[0].store(force_n.x, std::memory_order_relaxed);
  force_[1].store(force_n.y, std::memory_order_relaxed);
  force_[2].store(force_n.z, std::memory_order_relaxed);
  version_.fetch_add(1, std::memory_order_release);
  version_.notify_one();
  return !lost_.load(std::memory_order_relaxed);
}

/// A consistent copy of the slot: read again while the loop writes it.
Vec3 HidDevice::newest_force() const noexcept {
  for (;;) {
    const std::uint32_t before = version_.load(std::memory_order_acquire);
    const Vec3 force{force_[0].load(std::memory_order_relaxed), force_[1].load(std::memory_order_relaxed),
                     force_[2].load(std::memory_order_relaxed)};
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) return force;
  }
}

/// The writer thread: sends the newest force, packet by packet, until the end.
void HidDevice::write_forces() noexcept {
  std::array<std::byte, 4096> report{};
  std::uint32_t sent = 0;
  std::uint16_t sequence = 0;
  while (!ending_.load(std::memory_order_acquire)) {
    const std::uint32_t version = version_.load(std::memory_order_acquire);
    if (version == sent) {
      version_.wait(sent);
      continue;
    }
    sent = version;
    ++sequence;
    for (int packet = 0; packet < protocol_->packets() && !ending_.load(std::memory_order_acquire); ++packet) {
      const std::size_t size = protocol_->encode(packet, newest_force(), sequence, report);
      if (!transport_->write(std::span(report).first(size))) lost_.store(true, std::memory_order_relaxed);
    }
  }
  send_all(*transport_, stop_reports_);
}

void HidDevice::stop() noexcept {
  if (!writer_.joinable()) return;
  ending_.store(true, std::memory_order_release);
  version_.fetch_add(2, std::memory_order_release);
  version_.notify_one();
  writer_.join();
}

}  // namespace papilla
