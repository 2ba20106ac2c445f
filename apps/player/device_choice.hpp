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

/// A parsed --device: sim, sim:PRESET, hid, hid:VID:PID or hid:VID:PID:SERIAL.
struct DeviceChoice {
  const DevicePreset* preset = nullptr;  ///< Of a simulated device; null for a real one.
  HidFilter filter;
};

/// @throws app::UsageError for another form, a wrong number, an unknown preset.
DeviceChoice parse_device(const std::string& text);

/// An opened force device and the process that switches it off when this one dies.
class OpenedDevice {
 public:
  /// The first matching device with a known protocol.
  /// @throws DeviceError with the reasons why the matching devices can't be used.
  OpenedDevice(const HidFilter& filter, Vec3 origin);

  HapticDevice& device() noexcept { return *device_; }
  bool watched() const noexcept { return sentinel_->watched(); }

 private:
  std::unique_ptr<Sentinel> sentinel_;  // Destroyed last: released after the device is off.
  std::unique_ptr<HapticDevice> device_;
};

/// --list-devices: the presets and the HID devices, with their protocol or the reason why there is none.
nlohmann::ordered_json device_list();
std::string device_list_text(const nlohmann::ordered_json& list);

}  // namespace papilla::player
