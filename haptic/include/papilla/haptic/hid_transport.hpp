// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// A HID device as the system lists it.
struct HidInfo {
  std::string path;  ///< Device file.
  std::uint16_t vendor = 0, product = 0;
  std::string serial, name;           ///< UTF-8, may be empty.
  std::vector<std::byte> descriptor;  ///< Report descriptor; empty when it can't be read.
};

/// Sends and receives the reports of one HID device. Reports begin with the byte of their number; for devices without
/// numbers it is 0 when sent, and left out by read().
class HidTransport {
 public:
  HidTransport() = default;
  HidTransport(const HidTransport&) = delete;
  HidTransport& operator=(const HidTransport&) = delete;
  virtual ~HidTransport() = default;

  virtual const HidInfo& info() const noexcept = 0;
  /// The next input report. @returns its bytes, 0 when none came within the time, -1 when the device is lost.
  /// @param timeout_ms 0: no waiting.
  virtual std::ptrdiff_t read(std::span<std::byte> report, int timeout_ms) noexcept = 0;
  /// Sends an output report; may block for a frame of the bus. Another thread may be in read().
  virtual bool write(std::span<const std::byte> report) noexcept = 0;
  virtual bool set_feature(std::span<const std::byte> report) noexcept = 0;
  /// @param report its first byte is the number of the report.
  virtual bool get_feature(std::span<std::byte> report) noexcept = 0;
};

/// Selects devices by vendor, product and serial number, each only when given.
struct HidFilter {
  std::optional<std::uint16_t> vendor, product;
  std::string serial;
  bool matches(const HidInfo& info) const noexcept;
};

/// "", "VID:PID" or "VID:PID:SERIAL", numbers in hexadecimal.
/// @throws InvalidInput naming the text.
HidFilter parse_hid_filter(std::string_view text);

/// All HID devices, over hidapi, in the order of their paths.
std::vector<HidInfo> list_hid_devices();

/// Opens a device over hidapi. @throws DeviceError naming it and the reason.
std::unique_ptr<HidTransport> open_hid(const HidInfo& info);

}  // namespace papilla
