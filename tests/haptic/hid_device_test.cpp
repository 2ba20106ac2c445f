// SPDX-License-Identifier: MIT
#include "papilla/haptic/hid_device.hpp"

#include <gtest/gtest.h>

#include "haptic/contact_shapes.hpp"
#include "haptic/fake_hid.hpp"
#include "haptic/hid_shapes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_loop.hpp"

namespace papilla {
namespace {

using testing::FakeTransport;
using testing::FakeWire;
using testing::PidShape;

HidReport report(std::initializer_list<int> bytes) {
  HidReport r;
  for (const int b : bytes) r.push_back(static_cast<std::byte>(b));
  return r;
}

HidInfo pid_info(const PidShape& shape = {}) { return {"fake", 1, 2, "", "fake", testing::pid_descriptor(shape)}; }
HidInfo force_info() { return {"fake", 1, 2, "", "fake", testing::force_report_descriptor()}; }

/// Block Load of a device whose report numbers begin at `first`: effects 7, 8, 9.
void answer_loads(FakeWire& wire, int first, int status = 1) {
  for (int i = 0; i < 3; ++i) wire.answers.push_back(report({first + 7, 7 + i, status}));
}

HidReport caps_report() {
  // Version 1, 1000 Hz, 4000 mN, 10000 nm a count, 80 mm, 50 g, 700 mN·s/m, 200 mN, 30000 nm, 500 µs.
  return report(
      {3, 1, 0, 0xE8, 3, 0xA0, 0x0F, 0x10, 0x27, 0, 0, 80, 0, 50, 0, 0xBC, 2, 200, 0, 0x30, 0x75, 0, 0, 0xF4, 1});
}

TEST(Pid, StartsInTheOrderOfTheStandardWithTheNumbersOfTheDescriptor) {
  for (const int first : {5, 101}) {
    FakeWire wire;
    answer_loads(wire, first);
    FakeTransport transport(wire, pid_info({.first_id = first}));
    const auto protocol = make_force_protocol(transport.info());
    EXPECT_EQ(protocol->name(), "HID PID, 3 axes");
    protocol->start(transport);
    // Create New Effect: constant force is the second of the types.
    EXPECT_EQ(wire.features, std::vector<HidReport>(3, report({first + 6, 2})));
    const std::vector<HidReport> expected = {
        report({first + 5, 4}),                                // Reset.
        report({first + 1, 7, 2, 0xFF, 0x7F, 0xFF, 0xFF, 1}),  // Set Effect: no end, full gain, no button, x.
        report({first + 1, 8, 2, 0xFF, 0x7F, 0xFF, 0xFF, 2}),  // y.
        report({first + 1, 9, 2, 0xFF, 0x7F, 0xFF, 0xFF, 4}),  // z.
        report({first + 5, 1}),                                // Enable actuators.
        report({first + 4, 255}),                              // Device gain.
        report({first + 2, 7, 0, 0}),
        report({first + 3, 7, 1, 1}),  // No force, start.
        report({first + 2, 8, 0, 0}),
        report({first + 3, 8, 1, 1}),
        report({first + 2, 9, 0, 0}),
        report({first + 3, 9, 1, 1})};
    EXPECT_EQ(wire.output, expected);
  }
}

TEST(Pid, ControlCodesAreTheDescriptors) {
  const auto last_stop = [](const PidShape& shape) {
    FakeWire wire;
    answer_loads(wire, 5);
    FakeTransport transport(wire, pid_info(shape));
    const auto protocol = make_force_protocol(transport.info());
    protocol->start(transport);
    return protocol->stop_reports().back();
  };
  EXPECT_EQ(last_stop({}), report({10, 2}));
  EXPECT_EQ(last_stop({.disable_first = true}), report({10, 1}));
  EXPECT_EQ(last_stop({.control_as_bits = true}), report({10, 2}));
  EXPECT_EQ(last_stop({.control_as_bits = true, .disable_first = true}), report({10, 1}));
}

TEST(Pid, ForcesAndPositionsAreScaledByTheRanges) {
  FakeWire wire;
  answer_loads(wire, 5);
  FakeTransport transport(wire, pid_info());
  const auto protocol = make_force_protocol(transport.info(), {.max_force_n = 4, .workspace_radius_m = 0.1});
  protocol->start(transport);
  HidReport bytes(64);
  EXPECT_EQ(protocol->packets(), 3);
  EXPECT_EQ(protocol->encode(1, {0, -2, 0}, 0, bytes), 4U);
  bytes.resize(4);
  EXPECT_EQ(bytes, report({7, 8, 0x78, 0xEC}));  // -5000 of 10000.
  bytes.resize(64);
  protocol->encode(0, {99, 0, 0}, 0, bytes);
  bytes.resize(4);
  EXPECT_EQ(bytes, report({7, 7, 0x10, 0x27}));
  bytes.resize(64);
  protocol->encode(0, {std::nan(""), 0, 0}, 0, bytes);
  bytes.resize(4);
  EXPECT_EQ(bytes, report({7, 7, 0, 0}));

  DeviceSample sample;
  EXPECT_TRUE(protocol->decode(report({5, 0xFF, 0x7F, 0, 0x80, 0, 0, 0x81}), sample));
  EXPECT_NEAR(sample.position.x, 0.1, 1e-9);
  EXPECT_NEAR(sample.position.y, -0.1, 1e-9);
  EXPECT_NEAR(sample.position.z, 0, 2e-6);
  EXPECT_EQ(sample.buttons, 0x81U);
  EXPECT_FALSE(protocol->decode(report({5, 1, 2}), sample));
  EXPECT_FALSE(protocol->decode(report({6, 1, 2, 3, 4, 5, 6, 7}), sample));
  EXPECT_FALSE(protocol->decode({}, sample));
}

TEST(Pid, TakesTheForceFromPhysicalUnits) {
  EXPECT_DOUBLE_EQ(make_force_protocol(pid_info({.newtons = true}))->caps().max_force_n, 5);
  EXPECT_DOUBLE_EQ(make_force_protocol(pid_info())->caps().max_force_n, 3.3);
  EXPECT_DOUBLE_EQ(make_force_protocol(pid_info({.axes = 2}))->caps().dynamics.delay_s, 2e-3);
}

TEST(Pid, RefusesDevicesThatLackSomething) {
  HidInfo info = pid_info();
  testing::DescriptorBuilder joystick;
  joystick.page(1).begin(4, 1).id(1).usage(0x30).logical(0, 255).size(8, 1).input(2).end();
  info.descriptor = joystick.bytes;
  EXPECT_THROW(make_force_protocol(info), DeviceError);
  info.descriptor.clear();
  EXPECT_THROW(make_force_protocol(info), DeviceError);
  FakeWire full;
  answer_loads(full, 5, 2);
  FakeTransport transport(full, pid_info());
  EXPECT_THROW(make_force_protocol(transport.info())->start(transport), DeviceError);
  FakeWire silent;
  FakeTransport mute(silent, pid_info());
  EXPECT_THROW(make_force_protocol(mute.info())->start(mute), DeviceError);
}

TEST(ForceReport, HasTheDocumentedBytes) {
  FakeWire wire;
  wire.answers.push_back(caps_report());
  FakeTransport transport(wire, force_info());
  const auto protocol = make_force_protocol(transport.info());
  EXPECT_EQ(protocol->name(), "force report");
  protocol->start(transport);
  const DeviceCaps caps = protocol->caps();
  EXPECT_DOUBLE_EQ(caps.max_force_n, 4);
  EXPECT_DOUBLE_EQ(caps.workspace_radius_m, 0.08);
  EXPECT_DOUBLE_EQ(caps.dynamics.mass_kg, 0.05);
  EXPECT_DOUBLE_EQ(caps.dynamics.damping, 0.7);
  EXPECT_DOUBLE_EQ(caps.dynamics.friction_n, 0.2);
  EXPECT_DOUBLE_EQ(caps.dynamics.encoder_step_m, 30e-6);
  EXPECT_DOUBLE_EQ(caps.dynamics.delay_s, 5e-4);
  HidReport bytes(64);
  ASSERT_EQ(protocol->encode(0, {4, -4, 0}, 0x1234, bytes), 11U);
  bytes.resize(11);
  EXPECT_EQ(bytes, report({1, 0x34, 0x12, 0xFF, 0x7F, 0x01, 0x80, 0, 0, 1, 20}));
  EXPECT_EQ(protocol->stop_reports(), std::vector<HidReport>{report({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20})});
  DeviceSample sample;
  ASSERT_TRUE(
      protocol->decode(report({2, 5, 0, 0, 0, 0, 0, 0xE8, 3, 0, 0, 0x18, 0xFC, 0xFF, 0xFF, 1, 0, 0, 0, 3, 0}), sample));
  EXPECT_NEAR(sample.position.x, 0.01, 1e-12);
  EXPECT_NEAR(sample.position.y, -0.01, 1e-12);
  EXPECT_NEAR(sample.position.z, 1e-5, 1e-12);
  EXPECT_EQ(sample.sequence, 5U);
  EXPECT_EQ(sample.buttons, 3U);
}

TEST(ForceReport, DescriptorOfTheDocumentationIsAccepted) {
  HidInfo info = force_info();
  info.descriptor = report({0x06, 0x00, 0xFF, 0x09, 0x50, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x85, 0x01, 0x09,
                            0x51, 0x75, 0x08, 0x95, 0x0A, 0x91, 0x02, 0x85, 0x02, 0x09, 0x52, 0x75, 0x08, 0x95, 0x14,
                            0x81, 0x02, 0x85, 0x03, 0x09, 0x53, 0x75, 0x08, 0x95, 0x18, 0xB1, 0x02, 0xC0});
  EXPECT_EQ(make_force_protocol(info)->name(), "force report");
}

TEST(ForceReport, RefusesOtherVersionsAndLengths) {
  FakeWire wire;
  HidReport caps = caps_report();
  caps[1] = std::byte{2};
  wire.answers.push_back(caps);
  FakeTransport transport(wire, force_info());
  EXPECT_THROW(make_force_protocol(transport.info())->start(transport), DeviceError);
  HidInfo info = force_info();
  for (std::byte& b : info.descriptor)
    if (b == std::byte{20}) b = std::byte{19};
  EXPECT_THROW(make_force_protocol(info), DeviceError);
}

HidReport position(int sequence, int z_counts) {
  HidReport r(21);
  r[0] = std::byte{2};
  r[1] = static_cast<std::byte>(sequence & 0xff);
  r[2] = static_cast<std::byte>(sequence >> 8);
  for (int i = 0; i < 4; ++i) r[static_cast<std::size_t>(15 + i)] = static_cast<std::byte>(z_counts >> (8 * i) & 0xff);
  return r;
}

std::unique_ptr<HidDevice> force_device(FakeWire& wire) {
  wire.answers.push_back(caps_report());
  auto transport = std::make_unique<FakeTransport>(wire, force_info());
  auto protocol = make_force_protocol(transport->info());
  return std::make_unique<HidDevice>(std::move(transport), std::move(protocol), Vec3{0, 0, 1});
}

TEST(HidDevice, TakesTheNewestPositionAndSendsTheNewestForce) {
  FakeWire wire;
  auto device = force_device(wire);
  for (int i = 1; i <= 5; ++i) wire.send(position(i, 100 * i));
  device->wait(0.1);
  DeviceState state;
  ASSERT_TRUE(device->read(state));
  EXPECT_NEAR(state.position.z, 1 + 5e-3, 1e-12);
  EXPECT_EQ(device->stale_reports(), 4U);
  EXPECT_TRUE(device->write({0, 0, 2}));
  ASSERT_TRUE(wire.wait_for(1));
  EXPECT_EQ(wire.written()[0], report({1, 1, 0, 0, 0, 0, 0, 0, 0x40, 1, 20}));
  device->stop();
  device->stop();
  EXPECT_EQ(wire.written().back(), report({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20}));
}

TEST(HidDevice, ARepeatedPositionAges) {
  FakeWire wire;
  auto device = force_device(wire);
  wire.send(position(1, 0));
  device->wait(0.1);
  DeviceState state;
  device->read(state);
  EXPECT_LT(state.age_s, 0.01);
  wire.send(position(1, 50));
  device->wait(0.03);
  ASSERT_TRUE(device->read(state));
  EXPECT_GE(state.age_s, 0.03);
  EXPECT_NEAR(state.position.z, 1, 1e-12);
}

TEST(HidDevice, UnpluggedIsLost) {
  FakeWire wire;
  auto device = force_device(wire);
  wire.send(position(1, 0));
  device->wait(0.1);
  wire.unplug();
  device->wait(0.1);
  DeviceState state;
  EXPECT_FALSE(device->read(state));
  EXPECT_FALSE(device->write({1, 0, 0}));
}

TEST(HidDevice, AFailingStartLeavesNoForce) {
  FakeWire wire;
  answer_loads(wire, 5);
  wire.fail_from = 5;
  auto transport = std::make_unique<FakeTransport>(wire, pid_info());
  auto protocol = make_force_protocol(transport->info());
  EXPECT_THROW(HidDevice(std::move(transport), std::move(protocol), {}), DeviceError);
}

/// Runs the whole loop with a hand that presses on a plate and becomes silent after some frames.
LoopResult play(FakeWire& wire, HidDevice& device, int silent_from, std::uint64_t ticks) {
  int frame = 0;
  wire.hand = [&]() -> HidReport {
    ++frame;
    return frame > silent_from ? HidReport{} : position(frame, std::max({500 - 10 * frame, 50 - frame, -100}));
  };
  ContactMaterial material;
  material.stiffness = 300;
  ContactMesh mesh = testing::plate(4, 4, 0.1, 0.1);
  for (Vec3& p : mesh.positions) p = p + Vec3{-0.05, -0.05, 1};
  const ContactSurface surface(mesh, {material}, {}, 0);
  LoopOptions options;
  options.ticks = ticks;
  return run_haptic_loop(device, surface, options);
}

TEST(HidDevice, PacesTheLoopAndEndsWithoutForce) {
  FakeWire wire;
  auto device = force_device(wire);
  const LoopResult result = play(wire, *device, 1000, 150);
  EXPECT_EQ(result.ticks, 150U);
  EXPECT_FALSE(result.device_lost);
  EXPECT_EQ(result.fault, ForceGuard::Fault::none);
  EXPECT_GT(result.max_force_n, 0.1);
  EXPECT_EQ(result.lost_contact_ticks, 0U);
  EXPECT_EQ(wire.written().back(), report({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20}));
}

TEST(HidDevice, SilenceIsAFaultWithoutForce) {
  FakeWire wire;
  auto device = force_device(wire);
  const LoopResult result = play(wire, *device, 100, 1000);
  EXPECT_EQ(result.ticks, 101U);
  EXPECT_EQ(result.fault, ForceGuard::Fault::stale_input);
  EXPECT_EQ(wire.written().back(), report({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20}));
}

TEST(HidFilter, ReadsNumbersAndSerials) {
  const HidFilter filter = parse_hid_filter("1209:00ff:A-1");
  EXPECT_EQ(filter.vendor, 0x1209);
  EXPECT_EQ(filter.product, 0xff);
  EXPECT_TRUE(filter.matches({"", 0x1209, 0xff, "A-1", "", {}}));
  EXPECT_FALSE(filter.matches({"", 0x1209, 0xff, "A-2", "", {}}));
  EXPECT_TRUE(parse_hid_filter("").matches({"", 1, 2, "x", "", {}}));
  for (const char* odd : {"1", "1:", "x:1", "1:2x", "12345:1", ":"}) EXPECT_THROW(parse_hid_filter(odd), InvalidInput);
}

}  // namespace
}  // namespace papilla
