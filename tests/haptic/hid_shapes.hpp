// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace papilla::testing {

/// Builds report descriptors from items.
class DescriptorBuilder {
 public:
  /// A short item: the prefix without its size, and a value of 0, 1, 2 or 4 bytes.
  DescriptorBuilder& item(unsigned prefix, std::int64_t value, int size) {
    bytes.push_back(static_cast<std::byte>(prefix | (size == 4 ? 3U : static_cast<unsigned>(size))));
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
    return *this;
  }
  DescriptorBuilder& page(int value) { return item(0x04, value, 2); }
  DescriptorBuilder& usage(int value) { return item(0x08, value, 1); }
  DescriptorBuilder& begin(int usage_id, int kind = 2) { return usage(usage_id).item(0xA0, kind, 1); }
  DescriptorBuilder& end() { return item(0xC0, 0, 0); }
  DescriptorBuilder& id(int value) { return item(0x84, value, 1); }
  DescriptorBuilder& logical(std::int64_t low, std::int64_t high) { return item(0x14, low, 4).item(0x24, high, 4); }
  DescriptorBuilder& physical(std::int64_t low, std::int64_t high) { return item(0x34, low, 4).item(0x44, high, 4); }
  DescriptorBuilder& unit(std::int64_t code, int exponent) { return item(0x64, code, 4).item(0x54, exponent, 1); }
  DescriptorBuilder& size(int bits, int count) { return item(0x74, bits, 1).item(0x94, count, 1); }
  DescriptorBuilder& input(int flags) { return item(0x80, flags, 1); }
  DescriptorBuilder& output(int flags) { return item(0x90, flags, 1); }
  DescriptorBuilder& feature(int flags) { return item(0xB0, flags, 1); }

  std::vector<std::byte> bytes;
};

struct PidShape {
  int axes = 3;
  bool control_as_bits = false;  ///< Bits instead of an array, as in some firmware.
  bool disable_first = false;    ///< "Disable" before "enable", as in other firmware.
  int first_id = 5;              ///< Report numbers begin here.
  bool newtons = false;          ///< The magnitude has physical units.
};

/// A joystick with positions and the PID reports that a constant force needs.
inline std::vector<std::byte> pid_descriptor(const PidShape& shape = {}) {
  constexpr int variable = 2, array = 0;
  DescriptorBuilder d;
  int id = shape.first_id;
  d.page(1).begin(4, 1).id(id++).page(1);
  for (int i = 0; i < shape.axes; ++i) d.usage(0x30 + i);
  d.logical(-32768, 32767).size(16, shape.axes).input(variable);
  d.page(9).item(0x18, 1, 1).item(0x28, 8, 1).logical(0, 1).size(1, 8).input(variable);
  d.page(0x0F);
  // Set Effect.
  d.begin(0x21).id(id++).usage(0x22).logical(1, 40).size(8, 1).output(variable);
  d.begin(0x25).usage(0x27).usage(0x26).logical(1, 2).size(8, 1).output(array).end();
  d.usage(0x50).logical(0, 32767).size(16, 1).output(variable);
  d.usage(0x52).logical(0, 255).size(8, 1).output(variable);
  d.usage(0x53).logical(1, 8).size(8, 1).output(variable | 0x40);
  d.begin(0x55).page(1);
  for (int i = 0; i < shape.axes; ++i) d.usage(0x30 + i);
  d.logical(0, 1).size(1, shape.axes).output(variable).size(8 - shape.axes, 1).output(3).page(0x0F).end().end();
  // Set Constant Force.
  d.begin(0x73).id(id++).usage(0x22).logical(1, 40).size(8, 1).output(variable);
  d.usage(0x70).logical(-10000, 10000).size(16, 1);
  if (shape.newtons) d.physical(-5, 5).unit(0xE111, 5);
  d.output(variable).physical(0, 0).unit(0, 0).end();
  // Effect Operation.
  d.begin(0x77).id(id++).usage(0x22).logical(1, 40).size(8, 1).output(variable);
  d.begin(0x78).usage(0x79).usage(0x7A).usage(0x7B).logical(1, 3).size(8, 1).output(array).end();
  d.usage(0x7C).logical(0, 255).size(8, 1).output(variable).end();
  // Device Gain, Device Control.
  d.begin(0x7D).id(id++).usage(0x7E).logical(0, 255).size(8, 1).output(variable).end();
  d.begin(0x96).id(id++);
  if (shape.disable_first)
    d.usage(0x98).usage(0x97);
  else
    d.usage(0x97).usage(0x98);
  d.usage(0x99).usage(0x9A);
  if (shape.control_as_bits)
    d.logical(0, 1).size(1, 4).output(variable).size(4, 1).output(3);
  else
    d.logical(1, 4).size(8, 1).output(array);
  d.end();
  // Create New Effect, Block Load.
  d.begin(0xAB).id(id++).begin(0x25).usage(0x27).usage(0x26).logical(1, 2).size(8, 1).feature(array).end().end();
  d.begin(0x89).id(id++).usage(0x22).logical(1, 40).size(8, 1).feature(variable);
  d.begin(0x8B).usage(0x8C).usage(0x8D).usage(0x8E).logical(1, 3).size(8, 1).feature(array).end().end();
  d.end();
  return d.bytes;
}

/// The force report of docs/force-report.md.
inline std::vector<std::byte> force_report_descriptor() {
  DescriptorBuilder d;
  d.page(0xFF00).begin(0x50, 1).logical(0, 255);
  d.id(1).usage(0x51).size(8, 10).output(2);
  d.id(2).usage(0x52).size(8, 20).input(2);
  d.id(3).usage(0x53).size(8, 24).feature(2).end();
  return d.bytes;
}

}  // namespace papilla::testing
