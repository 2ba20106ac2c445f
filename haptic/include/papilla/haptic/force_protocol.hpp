// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "papilla/haptic/device.hpp"
#include "papilla/haptic/hid_transport.hpp"

namespace papilla {

/// Properties that HID descriptors often lack. Each is used only where the device reports none.
struct HidDeviceOptions {
  double max_force_n = 3.3;           ///< Force of the largest magnitude.
  double workspace_radius_m = 0.075;  ///< Half the range of a position without a unit.
  /// Assumed: a Touch on full-speed USB.
  DeviceDynamics dynamics{0.045, 0.6, 0.26, 55e-6, 1e-3};
};

/// A position as a device reports it, in its own frame.
struct DeviceSample {
  Vec3 position;  ///< m, around the middle of the workspace.
  std::uint32_t buttons = 0;
  std::uint32_t sequence = 0;  ///< Changes with every fresh position, when `counted`.
  bool counted = false;        ///< The device numbers its positions.
};

using HidReport = std::vector<std::byte>;

/// Encodes forces into reports and decodes positions from them.
class ForceProtocol {
 public:
  ForceProtocol() = default;
  ForceProtocol(const ForceProtocol&) = delete;
  ForceProtocol& operator=(const ForceProtocol&) = delete;
  virtual ~ForceProtocol() = default;

  /// "HID PID, 2 axes" or "force report".
  virtual std::string name() const = 0;
  /// Of the device, known after start().
  virtual DeviceCaps caps() const = 0;
  /// Prepares the device for forces. @throws DeviceError naming the report that failed.
  virtual void start(HidTransport& transport) = 0;
  /// @returns false for a report that holds no position.
  virtual bool decode(std::span<const std::byte> report, DeviceSample& sample) const noexcept = 0;
  /// Number of reports that carry one force.
  virtual int packets() const noexcept = 0;
  /// Writes packet number `packet` of a force into `report`. @returns the packet's length; noexcept, no allocation.
  virtual std::size_t encode(int packet, Vec3 force_n, std::uint16_t sequence,
                             std::span<std::byte> report) const noexcept = 0;
  /// The reports that set zero force and switch the actuators off, in order. Valid after start().
  virtual std::vector<HidReport> stop_reports() const = 0;
};

/// The protocol of a device: the force report of docs/force-report.md when its descriptor has that collection, else USB
/// HID PID (Physical Interface Devices 1.0): one constant-force effect per axis, all numbers of reports, ranges and
/// control codes from the descriptor.
///
/// PID start: Create New Effect, Block Load, Set Effect for each axis X, Y, Z that the device reports, then Enable
/// Actuators, Device Gain at its largest, Start. A force is one Set Constant Force per axis: on full-speed USB n axes
/// are each updated every n ms, which the delay of the caps includes.
/// @throws DeviceError naming the usage that the descriptor lacks; InvalidInput when the descriptor is damaged.
std::unique_ptr<ForceProtocol> make_force_protocol(const HidInfo& info, const HidDeviceOptions& options = {});

}  // namespace papilla
