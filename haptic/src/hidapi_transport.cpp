// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "papilla/core/error.hpp"
#include "papilla/haptic/hid_transport.hpp"

namespace papilla {
namespace {

/// The report descriptor, for which hidapi 0.13 has no call.
std::vector<std::byte> read_descriptor(const char* path) {
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  int size = 0;
  hidraw_report_descriptor descriptor{};
  std::vector<std::byte> bytes;
  if (::ioctl(file, HIDIOCGRDESCSIZE, &size) >= 0 && size > 0 && size <= HID_MAX_DESCRIPTOR_SIZE) {
    descriptor.size = static_cast<std::uint32_t>(size);
    if (::ioctl(file, HIDIOCGRDESC, &descriptor) >= 0) {
      const auto* first = reinterpret_cast<const std::byte*>(descriptor.value);
      bytes.assign(first, first + size);
    }
  }
  ::close(file);
  return bytes;
}

std::string utf8(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != 0; ++text) {
    const auto c = static_cast<std::uint32_t>(*text);
    const auto append = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (c < 0x80) {
      append(c);
    } else if (c < 0x800) {
      append(0xC0 | c >> 6);
      append(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
      append(0xE0 | c >> 12);
      append(0x80 | (c >> 6 & 0x3F));
      append(0x80 | (c & 0x3F));
    }
  }
  return out;
}

class HidapiTransport final : public HidTransport {
 public:
  explicit HidapiTransport(const HidInfo& info) : info_(info), device_(hid_open_path(info.path.c_str())) {
    if (device_ == nullptr)
      throw DeviceError(info.path + ": can't be opened (" + std::strerror(errno) + "; a udev rule may be missing)");
  }
  ~HidapiTransport() override { hid_close(device_); }

  const HidInfo& info() const noexcept override { return info_; }
  std::ptrdiff_t read(std::span<std::byte> report, int timeout_ms) noexcept override {
    return hid_read_timeout(device_, bytes(report), report.size(), timeout_ms);
  }
  bool write(std::span<const std::byte> report) noexcept override {
    return hid_write(device_, bytes(report), report.size()) == static_cast<int>(report.size());
  }
  bool set_feature(std::span<const std::byte> report) noexcept override {
    return hid_send_feature_report(device_, bytes(report), report.size()) >= 0;
  }
  bool get_feature(std::span<std::byte> report) noexcept override {
    return hid_get_feature_report(device_, bytes(report), report.size()) > 0;
  }

 private:
  static unsigned char* bytes(std::span<std::byte> s) noexcept { return reinterpret_cast<unsigned char*>(s.data()); }
  static const unsigned char* bytes(std::span<const std::byte> s) noexcept {
    return reinterpret_cast<const unsigned char*>(s.data());
  }
  HidInfo info_;
  hid_device* device_;
};

}  // namespace

bool HidFilter::matches(const HidInfo& info) const noexcept {
  return (!vendor || *vendor == info.vendor) && (!product || *product == info.product) &&
         (serial.empty() || serial == info.serial);
}

HidFilter parse_hid_filter(std::string_view text) {
  HidFilter filter;
  if (text.empty()) return filter;
  const auto number = [&](std::string_view digits) {
    std::uint16_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || end != digits.data() + digits.size())
      throw InvalidInput("hid:" + std::string(text) + ": is not VID:PID or VID:PID:SERIAL with hexadecimal numbers");
    return value;
  };
  const std::size_t first = text.find(':');
  const std::size_t second = first == std::string_view::npos ? first : text.find(':', first + 1);
  filter.vendor = number(text.substr(0, first));
  filter.product = number(first == std::string_view::npos ? "" : text.substr(first + 1, second - first - 1));
  if (second != std::string_view::npos) filter.serial = text.substr(second + 1);
  return filter;
}

std::vector<HidInfo> list_hid_devices() {
  std::vector<HidInfo> devices;
  hid_device_info* const list = hid_enumerate(0, 0);
  for (const hid_device_info* i = list; i != nullptr; i = i->next) {
    const bool known = std::any_of(devices.begin(), devices.end(), [&](const HidInfo& d) { return d.path == i->path; });
    // hidapi lists each outermost collection; here each device is listed once.
    if (!known)
      devices.push_back({i->path, i->vendor_id, i->product_id, utf8(i->serial_number), utf8(i->product_string),
                         read_descriptor(i->path)});
  }
  hid_free_enumeration(list);
  std::sort(devices.begin(), devices.end(), [](const HidInfo& a, const HidInfo& b) { return a.path < b.path; });
  return devices;
}

std::unique_ptr<HidTransport> open_hid(const HidInfo& info) { return std::make_unique<HidapiTransport>(info); }

}  // namespace papilla
