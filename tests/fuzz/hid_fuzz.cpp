// SPDX-License-Identifier: MIT
#include <cmath>

#include "fuzz_input.hpp"
#include "hid_descriptor.hpp"
#include "papilla/haptic/force_protocol.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  // The first 64 bytes are an input report, the rest is the descriptor.
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  const std::size_t head = std::min<std::size_t>(64, size);
  HidInfo info;
  info.path = "fuzz";
  info.descriptor.assign(bytes.begin() + static_cast<std::ptrdiff_t>(head), bytes.end());
  fuzz::expect_result_or_refusal([&] {
    for (const HidField& field : parse_hid_descriptor(info.descriptor).fields)
      fuzz::require(field.count > 0 && field.bits > 0 && field.bits <= 64 && !field.usages.empty() &&
                        field.bit_offset + std::uint64_t{field.bits} * field.count <= 8 * 4096,
                    "a field lies within its report");
  });
  fuzz::expect_result_or_refusal([&] {
    const auto protocol = make_force_protocol(info);
    DeviceSample sample;
    protocol->decode(bytes.first(head), sample);
    fuzz::require(is_finite(sample.position), "a position is finite");
    HidReport report(4096);
    for (int i = 0; i < protocol->packets(); ++i)
      fuzz::require(protocol->encode(i, {1, NAN, -1e300}, 3, report) <= report.size(), "a packet fits");
    for (const HidReport& stop : protocol->stop_reports()) fuzz::require(!stop.empty(), "a report has bytes");
  });
  return 0;
}
