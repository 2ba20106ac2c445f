// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/haptic/force_protocol.hpp"

namespace papilla {

/// Usages of the vendor page on which the force report is found; docs/force-report.md has the layout.
inline constexpr std::uint32_t k_force_application = hid_usage(0xFF00, 0x50), k_force_out = hid_usage(0xFF00, 0x51),
                               k_force_in = hid_usage(0xFF00, 0x52), k_force_caps = hid_usage(0xFF00, 0x53);

/// @throws DeviceError when a report is missing or too short.
std::unique_ptr<ForceProtocol> make_force_report(const HidInfo& info, const HidDescriptor& descriptor);

/// @throws DeviceError naming the missing usage.
std::unique_ptr<ForceProtocol> make_pid(const HidInfo& info, HidDescriptor descriptor, const HidDeviceOptions& options);

}  // namespace papilla
