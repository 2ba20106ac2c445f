// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "fuzz_input.hpp"
#include "hid_descriptor.hpp"
#include "json_mutator.hpp"
#include "papilla/haptic/force_protocol.hpp"

namespace {

constexpr std::size_t k_head = 64;  ///< Bytes of an input report, before the descriptor.

/// The short items of a descriptor: prefix and data [USB HID 1.11, 6.2.2.2].
std::vector<std::string> items_of(std::string_view descriptor) {
  std::vector<std::string> items;
  while (!descriptor.empty()) {
    const std::size_t code = static_cast<unsigned char>(descriptor[0]) & 3U;
    items.emplace_back(descriptor.substr(0, 1 + (code == 3 ? 4 : code)));
    descriptor.remove_prefix(items.back().size());
  }
  return items;
}

/// Takes away ends of collections that were not begun, and adds those that are missing.
void close_collections(std::vector<std::string>& items) {
  constexpr char k_begin = '\xA1', k_end = '\xC0';
  int depth = 0;
  std::erase_if(items, [&](const std::string& item) {
    if (item[0] == k_begin) ++depth;
    return item[0] == k_end && depth-- <= 0 && ++depth == 0;
  });
  for (; depth > 0; --depth) items.emplace_back(1, k_end);
}

void mutate_items(std::vector<std::string>& items, papilla::fuzz::Random& random) {
  const std::size_t at = random.below(items.size());
  const auto place = items.begin() + static_cast<std::ptrdiff_t>(at);
  std::string& item = items[at];
  switch (random.below(8)) {
    case 0: items.insert(place, std::string(random.of(items))); break;
    case 1: items.erase(place); break;
    case 2: std::swap(item, items[random.below(items.size())]); break;
    case 3: item[0] = static_cast<char>(random.below(256)); break;
    default: {
      if (item.size() < 2) break;
      char& byte = item[1 + random.below(item.size() - 1)];
      byte = static_cast<char>(random.chance(0.6) ? random.below(33) : random.below(256));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  const std::size_t head = std::min(k_head, size);
  HidInfo info;
  info.path = "fuzz";
  info.descriptor.assign(bytes.begin() + static_cast<std::ptrdiff_t>(head), bytes.end());
  fuzz::expect_read([&] {
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

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace papilla::fuzz;
  Random random(seed);
  if (size <= k_head || random.chance(0.1)) return mutate_bytes(data, size, max_size, random);
  std::string bytes(text_of(data, size));
  if (random.chance(0.3)) bytes[random.below(k_head)] = static_cast<char>(random.below(256));
  std::vector<std::string> items = items_of(std::string_view(bytes).substr(k_head));
  for (std::size_t left = 1 + random.below(4); left > 0 && !items.empty(); --left) mutate_items(items, random);
  if (random.chance(0.9)) close_collections(items);
  bytes.resize(k_head);
  for (const std::string& item : items) bytes += item;
  return store(bytes, data, size, max_size);
}
