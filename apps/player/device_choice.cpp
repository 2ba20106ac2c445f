// SPDX-License-Identifier: MIT
#include "device_choice.hpp"

#include <fmt/core.h>

#include "exit_code.hpp"
#include "papilla/haptic/force_protocol.hpp"
#include "papilla/haptic/hid_device.hpp"
#include "shown_format.hpp"

namespace papilla::player {
namespace {

using Json = nlohmann::ordered_json;

/// Opens the device again: the handle of the other process is gone.
void switch_off(const HidInfo& info, const std::vector<HidReport>& reports) {
  const auto transport = open_hid(info);
  for (const HidReport& report : reports) transport->write(report);
}

}  // namespace

DeviceChoice parse_device(const std::string& text) try {
  if (text == "sim") return {&device_presets().front(), {}};
  if (text.starts_with("sim:")) return {&device_preset(text.substr(4)), {}};
  if (text == "hid") return {};
  if (text.starts_with("hid:")) return {nullptr, parse_hid_filter(text.substr(4))};
  throw InvalidInput("--device " + text + ": is not sim, sim:PRESET, hid or hid:VID:PID[:SERIAL]");
} catch (const Error& error) {
  throw app::UsageError(error.what());
}

OpenedDevice::OpenedDevice(const HidFilter& filter, Vec3 origin) {
  std::string reasons;
  for (const HidInfo& info : list_hid_devices()) {
    if (!filter.matches(info)) continue;
    try {
      auto protocol = make_force_protocol(info);
      auto transport = open_hid(info);
      device_ = std::make_unique<HidDevice>(
          std::move(transport), std::move(protocol), origin, [&](const std::vector<HidReport>& off) {
            sentinel_ = std::make_unique<Sentinel>([&info, &off] { switch_off(info, off); });
          });
      return;
    } catch (const Error& error) {
      reasons += std::string(reasons.empty() ? "" : "; ") + error.what();
    }
  }
  throw DeviceError("no force device" + (reasons.empty() ? " is connected that matches" : ": " + reasons));
}

Json device_list() {
  Json simulated = Json::array(), connected = Json::array();
  for (const DevicePreset& preset : device_presets())
    simulated.push_back({{"device", "sim:" + std::string(preset.name)},
                         {"name", preset.title},
                         {"max_force_n", preset.max_force_n.value},
                         {"workspace_radius_m", preset.workspace_radius_m.value}});
  for (const HidInfo& info : list_hid_devices()) {
    Json entry = {{"device", fmt::format("hid:{:04x}:{:04x}{}{}", info.vendor, info.product,
                                         info.serial.empty() ? "" : ":", info.serial)},
                  {"name", info.name},
                  {"path", info.path}};
    try {
      entry["protocol"] = make_force_protocol(info)->name();
    } catch (const Error& error) {
      entry["unusable"] = error.what();
    }
    connected.push_back(std::move(entry));
  }
  return {{"connected", connected}, {"simulated", simulated}};
}

std::string device_list_text(const Json& list) {
  std::string text = "connected:\n";
  if (list["connected"].empty()) text += "  none\n";
  for (const Json& d : list["connected"])
    text += app::shown_format("  {}  {}  {}\n", d["device"].get<std::string>(), d["name"].get<std::string>(),
                              d.contains("protocol") ? d["protocol"].get<std::string>()
                                                     : "can't be used: " + d["unusable"].get<std::string>());
  text += "simulated:\n";
  for (const Json& d : list["simulated"])
    text += app::shown_format("  {:<14} {}, {} N\n", d["device"].get<std::string>(), d["name"].get<std::string>(),
                              d["max_force_n"].get<double>());
  return text;
}

}  // namespace papilla::player
