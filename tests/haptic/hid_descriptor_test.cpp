// SPDX-License-Identifier: MIT
#include "hid_descriptor.hpp"

#include <gtest/gtest.h>

#include <random>

#include "haptic/hid_shapes.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using testing::DescriptorBuilder;

const HidField& field_of(const HidDescriptor& d, std::uint32_t usage) {
  for (const HidField& f : d.fields)
    if (f.index_of(usage)) return f;
  throw InvalidInput("no such usage");
}

TEST(HidDescriptor, ReadsPlaceRangeAndCollections) {
  const HidDescriptor d = parse_hid_descriptor(testing::pid_descriptor());
  EXPECT_TRUE(d.numbered);
  EXPECT_TRUE(d.has_application(hid_usage(1, 4)));
  const HidField& y = field_of(d, hid_usage(1, 0x31));
  EXPECT_EQ(y.kind, HidReportKind::input);
  EXPECT_EQ(y.report_id, 5);
  EXPECT_EQ(y.bits, 16U);
  EXPECT_EQ(y.count, 3U);
  EXPECT_EQ(y.logical_min, -32768);
  EXPECT_EQ(y.logical_max, 32767);
  EXPECT_EQ(d.report_bytes(HidReportKind::input, 5), 1U + 6 + 1);
  const HidField& magnitude = field_of(d, hid_usage(0x0F, 0x70));
  EXPECT_EQ(magnitude.bit_offset, 8U);
  EXPECT_TRUE(magnitude.in(hid_usage(0x0F, 0x73)));
  EXPECT_FALSE(magnitude.in(hid_usage(0x0F, 0x21)));
  EXPECT_EQ(field_of(d, hid_usage(0x09, 8)).index_of(hid_usage(0x09, 8)), 7U);
  // One byte of padding counts for the length but is no field.
  EXPECT_EQ(d.report_bytes(HidReportKind::output, 6), 1U + 7);
}

TEST(HidDescriptor, ValuesComeBackWithTheirSign) {
  std::mt19937 random(1);
  for (const int bits : {1, 3, 7, 8, 12, 16, 24, 32, 48, 63}) {
    HidField f;
    f.report_id = 9;
    f.bit_offset = 5;
    f.bits = static_cast<std::uint32_t>(bits);
    f.count = 3;
    f.logical_min = -1;
    std::vector<std::byte> report(40, std::byte{0x5a});
    const std::vector<std::byte> before = report;
    for (int i = 0; i < 50; ++i) {
      const std::int64_t value = static_cast<std::int64_t>(random()) << 20 >> (63 - bits + 1 > 40 ? 40 : 0);
      const std::int64_t most = (std::int64_t{1} << (bits - 1)) - 1;
      const std::int64_t wanted = bits == 1 ? -(value & 1) : value % (most + 1) - (value & 1 ? most : 0);
      set_hid_value(f, 1, wanted, report);
      EXPECT_EQ(hid_value(f, 1, report), wanted) << bits;
      EXPECT_EQ(hid_value(f, 0, report), hid_value(f, 0, before)) << bits;
      EXPECT_EQ(hid_value(f, 2, report), hid_value(f, 2, before)) << bits;
    }
    EXPECT_EQ(hid_value(f, 3, report), 0);
    EXPECT_EQ(hid_value(f, 0, std::span(report).first(1)), 0);
  }
}

TEST(HidDescriptor, PushPopLongItemsAndUnsignedMaxima) {
  DescriptorBuilder d;
  d.page(1).begin(4, 1).item(0x14, 0, 1).item(0x24, 255, 1).size(8, 1);
  d.item(0xA4, 0, 0).page(9).item(0xB4, 0, 0);
  for (const int b : {0xFE, 2, 0x10, 1, 2}) d.bytes.push_back(static_cast<std::byte>(b));  // A long item.
  d.usage(0x30).input(2).end();
  const HidDescriptor parsed = parse_hid_descriptor(d.bytes);
  ASSERT_EQ(parsed.fields.size(), 1U);
  EXPECT_EQ(parsed.fields[0].usages, std::vector<std::uint32_t>{hid_usage(1, 0x30)});
  EXPECT_EQ(parsed.fields[0].logical_max, 255);
  EXPECT_FALSE(parsed.numbered);
}

TEST(HidDescriptor, RefusesWhatIsDamaged) {
  const auto refused = [](DescriptorBuilder d) { EXPECT_THROW(parse_hid_descriptor(d.bytes), InvalidInput); };
  refused(DescriptorBuilder().end());
  refused(DescriptorBuilder().begin(4, 1));
  refused(DescriptorBuilder().item(0xB4, 0, 0));
  refused(DescriptorBuilder().id(0));
  refused(DescriptorBuilder().usage(1).item(0x74, 200, 1).item(0x94, 65535, 2).input(2));
  refused(DescriptorBuilder().usage(1).size(72, 1).input(2));
  refused(DescriptorBuilder().item(0x18, 9, 1).item(0x28, 3, 1));
  refused(DescriptorBuilder().usage(1).logical(-1, -2).size(8, 1).input(2));
  DescriptorBuilder deep;
  for (int i = 0; i < 40; ++i) deep.begin(1);
  refused(deep);
  EXPECT_THROW(parse_hid_descriptor(std::vector<std::byte>(5000)), InvalidInput);
  std::vector<std::byte> whole = testing::pid_descriptor();
  for (std::size_t cut = 6; cut < whole.size(); ++cut)
    EXPECT_THROW(parse_hid_descriptor(std::span(whole).first(cut)), InvalidInput) << cut;
}

}  // namespace
}  // namespace papilla
