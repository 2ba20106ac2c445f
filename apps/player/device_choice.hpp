// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "papilla/haptic/device.hpp"
#include "papilla/haptic/hid_transport.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "sentinel.hpp"

namespace papilla::player {

/// What --device names: sim, sim:PRESET, hid, hid:VID:PID or hid:VID:PID:SERIAL.
struct DeviceChoice {
  const DevicePreset* preset = nullptr;  ///< Of the simulated device; null for a real one.
  HidFilter filter;
};

/// @throws app::UsageError for another form, a wrong number, an unknown preset.
DeviceChoice parse_device(const std::string& text);

/// A force device on the bus and the process that switches it off when this one dies.
class OpenedDevice {
 public:
  /// The first device that matches and speaks a protocol of ours.
  /// @throws DeviceError naming what is missing; the reasons of all that matched but can't be used.
  OpenedDevice(const HidFilter& filter, Vec3 origin);

  HapticDevice& device() noexcept { return *device_; }
  bool watched() const noexcept { return sentinel_->watched(); }

 private:
  std::unique_ptr<Sentinel> sentinel_;  // Says farewell after the device is off.
  std::unique_ptr<HapticDevice> device_;
};

/// --list-devices: the presets and what is on the bus, with the protocol or the reason why there is none.
nlohmann::ordered_json device_list();
std::string device_list_text(const nlohmann::ordered_json& list);

}  // namespace papilla::player
