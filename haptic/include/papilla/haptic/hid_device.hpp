// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "papilla/haptic/device.hpp"
#include "papilla/haptic/force_protocol.hpp"
#include "papilla/haptic/hid_transport.hpp"

namespace papilla {

/// A force device over HID. Its frames are the clock of the loop: wait() blocks in the transport's read() until a
/// position arrives and drains older ones. write() stores the force in a lock-free slot; a thread of the device sends
/// the newest, because a write to USB blocks up to a frame.
///
/// stop() and the destructor end that thread with the protocol's stop reports: zero force, actuators off. read()
/// returns false when the device is gone, and a growing age_s when it is silent or repeats a numbered position.
class HidDevice final : public HapticDevice {
 public:
  /// Starts the protocol, calls `started` with the stop reports (before there is a thread, so that it may fork a
  /// process that outlives this one), then starts the writer.
  /// @param origin centre of the workspace in the scene.
  /// @throws DeviceError as ForceProtocol::start(); forces are off then.
  HidDevice(std::unique_ptr<HidTransport> transport, std::unique_ptr<ForceProtocol> protocol, Vec3 origin,
            const std::function<void(const std::vector<HidReport>&)>& started = {});
  ~HidDevice() override;

  const DeviceCaps& caps() const noexcept override { return caps_; }
  bool is_clock() const noexcept override { return true; }
  double wait(double longest_s) noexcept override;
  bool read(DeviceState& state) noexcept override;
  bool write(Vec3 force_n) noexcept override;
  void stop() noexcept override;

  std::uint64_t stale_reports() const noexcept { return stale_; }  ///< Positions drained because a newer one was there.

 private:
  bool accept_report(std::ptrdiff_t bytes) noexcept;
  Vec3 newest_force() const noexcept;
  void write_forces() noexcept;

  std::unique_ptr<HidTransport> transport_;
  std::unique_ptr<ForceProtocol> protocol_;
  DeviceCaps caps_;
  std::vector<HidReport> stop_reports_;
  Vec3 origin_;
  std::array<std::byte, 4096> input_{};
  DeviceSample sample_;
  double arrived_s_ = 0;
  bool has_sample_ = false;
  std::uint64_t stale_ = 0;
  std::atomic<bool> lost_{false}, ending_{false};
  std::array<std::atomic<double>, 3> force_{};
  std::atomic<std::uint32_t> version_{0};  // Of force_; odd while it is written.
  std::thread writer_;
};

}  // namespace papilla
