// SPDX-License-Identifier: MIT
#include "force_report.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_out_bytes = 10, k_in_bytes = 20, k_caps_bytes = 24;
constexpr std::uint8_t k_version = 1;
constexpr std::uint8_t k_enable = 1;
constexpr std::uint8_t k_watchdog_ms = 20;

std::uint64_t little(std::span<const std::byte> bytes, std::size_t at, std::size_t count) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return value;
}

void put_little(std::span<std::byte> bytes, std::size_t at, std::size_t count, std::uint64_t value) noexcept {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xffU);
}

class ForceReport final : public ForceProtocol {
 public:
  ForceReport(const HidInfo& info, const HidDescriptor& descriptor) : path_(info.path) {
    out_ = report(descriptor, HidReportKind::output, k_force_out, k_out_bytes, "output (usage FF00:51)");
    in_ = report(descriptor, HidReportKind::input, k_force_in, k_in_bytes, "input (usage FF00:52)");
    features_ = report(descriptor, HidReportKind::feature, k_force_caps, k_caps_bytes, "feature (usage FF00:53)");
    numbered_ = descriptor.numbered;
    caps_.name = "hid:" + (info.name.empty() ? info.path : info.name);
  }

  std::string name() const override { return "force report"; }
  DeviceCaps caps() const override { return caps_; }

  void start(HidTransport& transport) override {
    std::array<std::byte, 1 + k_caps_bytes> bytes{};
    bytes[0] = static_cast<std::byte>(features_);
    if (!transport.get_feature(bytes)) throw DeviceError(path_ + ": does not answer for its feature report");
    const std::span<const std::byte> c = std::span(bytes).subspan(1);
    const auto number = [&](std::size_t at, std::size_t count) { return static_cast<double>(little(c, at, count)); };
    if (little(c, 0, 1) != k_version)
      throw DeviceError(path_ + ": speaks version " + std::to_string(little(c, 0, 1)) + " of the force report, not 1");
    newtons_per_count_ = 1e-3 * number(4, 2) / 32767;
    metres_per_count_ = 1e-9 * number(6, 4);
    caps_.max_force_n = 1e-3 * number(4, 2);
    caps_.workspace_radius_m = 1e-3 * number(10, 2);
    caps_.dynamics = {1e-3 * number(12, 2), 1e-3 * number(14, 2), 1e-3 * number(16, 2), 1e-9 * number(18, 4),
                      1e-6 * number(22, 2)};
    if (!(newtons_per_count_ > 0) || !(metres_per_count_ > 0) || !(caps_.dynamics.mass_kg > 0))
      throw DeviceError(path_ + ": its feature report has no force, step or mass");
  }

  bool decode(std::span<const std::byte> bytes, DeviceSample& sample) const noexcept override {
    if (numbered_) {
      if (bytes.empty() || std::to_integer<unsigned>(bytes[0]) != in_) return false;
      bytes = bytes.subspan(1);
    }
    if (bytes.size() < k_in_bytes) return false;
    const auto axis = [&](std::size_t at) {
      return metres_per_count_ * static_cast<double>(static_cast<std::int32_t>(little(bytes, at, 4)));
    };
    sample.sequence = static_cast<std::uint32_t>(little(bytes, 0, 2));
    sample.counted = true;
    sample.position = {axis(6), axis(10), axis(14)};
    sample.buttons = static_cast<std::uint32_t>(little(bytes, 18, 2));
    return true;
  }

  int packets() const noexcept override { return 1; }

  std::size_t encode(int, Vec3 force, std::uint16_t sequence, std::span<std::byte> bytes) const noexcept override {
    fill(bytes, force, sequence, k_enable);
    return 1 + k_out_bytes;
  }

  std::vector<HidReport> stop_reports() const override {
    HidReport off(1 + k_out_bytes);
    fill(off, {}, 0, 0);
    return {off};
  }

 private:
  std::uint8_t report(const HidDescriptor& d, HidReportKind kind, std::uint32_t usage, std::size_t bytes,
                      const std::string& what) const {
    for (const HidField& f : d.fields) {
      if (f.kind != kind || !(f.in(usage) || f.index_of(usage))) continue;
      if (d.report_bytes(kind, f.report_id) == bytes + (d.numbered ? 1 : 0)) return f.report_id;
      throw DeviceError(path_ + ": its " + what + " report has not " + std::to_string(bytes) + " bytes");
    }
    throw DeviceError(path_ + ": has no " + what + " report");
  }

  void fill(std::span<std::byte> bytes, Vec3 force, std::uint16_t sequence, std::uint8_t flags) const noexcept {
    bytes[0] = static_cast<std::byte>(out_);
    put_little(bytes, 1, 2, sequence);
    std::size_t at = 3;
    for (const double f : {force.x, force.y, force.z}) {
      const double counts = newtons_per_count_ > 0 && std::isfinite(f) ? f / newtons_per_count_ : 0;
      put_little(bytes, at, 2, static_cast<std::uint16_t>(std::lround(std::clamp(counts, -32767.0, 32767.0))));
      at += 2;
    }
    bytes[9] = static_cast<std::byte>(flags);
    bytes[10] = static_cast<std::byte>(k_watchdog_ms);
  }

  std::string path_;
  std::uint8_t out_ = 0, in_ = 0, features_ = 0;
  bool numbered_ = false;
  double newtons_per_count_ = 0, metres_per_count_ = 0;
  DeviceCaps caps_;
};

}  // namespace

std::unique_ptr<ForceProtocol> make_force_report(const HidInfo& info, const HidDescriptor& descriptor) {
  return std::make_unique<ForceReport>(info, descriptor);
}

std::unique_ptr<ForceProtocol> make_force_protocol(const HidInfo& info, const HidDeviceOptions& options) {
  if (info.descriptor.empty()) throw DeviceError(info.path + ": its report descriptor can't be read");
  HidDescriptor descriptor = parse_hid_descriptor(info.descriptor);
  if (descriptor.has_application(k_force_application)) return make_force_report(info, descriptor);
  return make_pid(info, std::move(descriptor), options);
}

}  // namespace papilla
