// SPDX-License-Identifier: MIT
#include "papilla/haptic/force_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hid_descriptor.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

// Usages of the vendor page on which the force report is found; docs/force-report.md has the layout.
constexpr std::uint32_t k_force_application = hid_usage(0xFF00, 0x50), k_force_out = hid_usage(0xFF00, 0x51),
                        k_force_in = hid_usage(0xFF00, 0x52), k_force_caps = hid_usage(0xFF00, 0x53);
constexpr std::size_t k_out_bytes = 10, k_in_bytes = 20, k_caps_bytes = 24;
constexpr std::uint8_t k_version = 1, k_actuators_on = 1, k_watchdog_ms = 20;

std::uint64_t read_le(std::span<const std::byte> bytes, std::size_t at, std::size_t count) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return value;
}

void write_le(std::span<std::byte> bytes, std::size_t at, std::size_t count, std::uint64_t value) noexcept {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xffU);
}

/// The force report of docs/force-report.md.
class ForceReport final : public ForceProtocol {
 public:
  ForceReport(const HidInfo& info, const HidDescriptor& descriptor) : path_(info.path) {
    out_ = find_report(descriptor, HidReportKind::output, k_force_out, k_out_bytes, "output (usage FF00:51)");
    in_ = find_report(descriptor, HidReportKind::input, k_force_in, k_in_bytes, "input (usage FF00:52)");
    features_ = find_report(descriptor, HidReportKind::feature, k_force_caps, k_caps_bytes, "feature (usage FF00:53)");
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
    const auto number = [&](std::size_t at, std::size_t count) { return static_cast<double>(read_le(c, at, count)); };
    if (read_le(c, 0, 1) != k_version)
      throw DeviceError(path_ + ": speaks version " + std::to_string(read_le(c, 0, 1)) + " of the force report, not 1");
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
      return metres_per_count_ * static_cast<double>(static_cast<std::int32_t>(read_le(bytes, at, 4)));
    };
    sample.sequence = static_cast<std::uint32_t>(read_le(bytes, 0, 2));
    sample.counted = true;
    sample.position = {axis(6), axis(10), axis(14)};
    sample.buttons = static_cast<std::uint32_t>(read_le(bytes, 18, 2));
    return true;
  }

  int packets() const noexcept override { return 1; }

  std::size_t encode(int, Vec3 force, std::uint16_t sequence, std::span<std::byte> bytes) const noexcept override {
    fill(bytes, force, sequence, k_actuators_on);
    return 1 + k_out_bytes;
  }

  std::vector<HidReport> stop_reports() const override {
    HidReport off(1 + k_out_bytes);
    fill(off, {}, 0, 0);
    return {off};
  }

 private:
  std::uint8_t find_report(const HidDescriptor& d, HidReportKind kind, std::uint32_t usage, std::size_t bytes,
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
    write_le(bytes, 1, 2, sequence);
    std::size_t at = 3;
    for (const double f : {force.x, force.y, force.z}) {
      const double counts = newtons_per_count_ > 0 && std::isfinite(f) ? f / newtons_per_count_ : 0;
      write_le(bytes, at, 2, static_cast<std::uint16_t>(std::lround(std::clamp(counts, -32767.0, 32767.0))));
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

constexpr std::uint32_t desktop(std::uint32_t id) { return hid_usage(0x01, id); }
constexpr std::uint32_t pid(std::uint32_t id) { return hid_usage(0x0F, id); }

// Usages of the page Physical Interface Device, by their names in the standard.
constexpr std::uint32_t k_set_effect = pid(0x21), k_block_index = pid(0x22), k_effect_type = pid(0x25),
                        k_constant_force = pid(0x26), k_duration = pid(0x50), k_sample_period = pid(0x51),
                        k_gain = pid(0x52), k_trigger_button = pid(0x53), k_axes_enable = pid(0x55),
                        k_direction_enable = pid(0x56), k_direction = pid(0x57), k_magnitude = pid(0x70),
                        k_set_constant = pid(0x73), k_operation_report = pid(0x77), k_operation = pid(0x78),
                        k_start = pid(0x79), k_stop = pid(0x7B), k_loop_count = pid(0x7C), k_gain_report = pid(0x7D),
                        k_device_gain = pid(0x7E), k_block_load = pid(0x89), k_load_status = pid(0x8B),
                        k_load_success = pid(0x8C), k_control_report = pid(0x96), k_enable = pid(0x97),
                        k_disable = pid(0x98), k_stop_all = pid(0x99), k_reset = pid(0x9A), k_create = pid(0xAB);
constexpr std::uint32_t k_buttons_page = 0x09;
constexpr std::uint32_t k_axis[3] = {desktop(0x30), desktop(0x31), desktop(0x32)};
constexpr std::uint32_t k_newton_unit = 0xE111, k_length_unit = 0x11;  // SI linear: g·cm/s², cm.
constexpr double k_frame_s = 1e-3;                                     // Frame of full-speed USB.

std::string hex(std::uint32_t usage) {
  char text[16];
  std::snprintf(text, sizeof text, "%02X:%02X", usage >> 16, usage & 0xffffU);
  return text;
}

/// One report of the descriptor, found by the collection of its fields.
class Report {
 public:
  Report(const HidDescriptor& descriptor, HidReportKind kind, std::uint32_t collection, const std::string& path)
      : collection_(collection), path_(path) {
    for (const HidField& f : descriptor.fields)
      if (f.kind == kind && f.in(collection) && (fields_.empty() || fields_.front()->report_id == f.report_id))
        fields_.push_back(&f);
    if (fields_.empty()) throw DeviceError(path + ": its descriptor has no report of usage " + hex(collection));
    id = fields_.front()->report_id;
    bytes = descriptor.report_bytes(kind, id);
  }

  HidReport blank() const {
    HidReport report(std::max<std::size_t>(1, bytes));
    report[0] = static_cast<std::byte>(id);
    return report;
  }

  const HidField* find(std::uint32_t usage, std::uint32_t within = 0) const {
    for (const HidField* f : fields_)
      if (f->index_of(usage) && (within == 0 || f->in(within))) return f;
    return nullptr;
  }

  const HidField& field(std::uint32_t usage) const {
    if (const HidField* f = find(usage)) return *f;
    throw DeviceError(path_ + ": its report of usage " + hex(collection_) + " has no " + hex(usage));
  }

  /// Sets the element of a usage to a value within its range.
  void set(HidReport& report, std::uint32_t usage, std::int64_t value) const {
    const HidField& f = field(usage);
    set_hid_value(f, *f.index_of(usage), std::clamp(value, f.logical_min, f.logical_max), report);
  }

  void set_if_present(HidReport& report, std::uint32_t usage, std::int64_t value) const {
    if (find(usage) != nullptr) set(report, usage, value);
  }

  /// The null state (off, or infinite): a value outside the logical range where the field has one, else the maximum.
  void set_null(HidReport& report, std::uint32_t usage) const {
    const HidField* f = find(usage);
    if (f == nullptr) return;
    const std::int64_t all = f->bits < 63 ? (std::int64_t{1} << f->bits) - 1 : -1;
    set_hid_value(*f, *f->index_of(usage), f->null_state ? all : f->logical_max, report);
  }

  /// Selects a usage: its index in an array field, or its bit.
  void select(HidReport& report, std::uint32_t usage) const { select(report, usage, field(usage)); }
  void select(HidReport& report, std::uint32_t usage, const HidField& f) const {
    const std::uint32_t index = *f.index_of(usage);
    if (f.variable)
      set_hid_value(f, index, 1, report);
    else
      set_hid_value(f, 0, f.logical_min + index, report);
  }

  std::uint8_t id = 0;
  std::size_t bytes = 0;

 private:
  std::uint32_t collection_;
  std::string path_;
  std::vector<const HidField*> fields_;
};

/// USB HID PID with one constant-force effect per axis.
class Pid final : public ForceProtocol {
 public:
  Pid(const HidInfo& info, HidDescriptor descriptor, const HidDeviceOptions& options)
      : path_(info.path),
        descriptor_(std::move(descriptor)),
        create_(descriptor_, HidReportKind::feature, k_create, path_),
        load_(descriptor_, HidReportKind::feature, k_block_load, path_),
        set_effect_(descriptor_, HidReportKind::output, k_set_effect, path_),
        constant_(descriptor_, HidReportKind::output, k_set_constant, path_),
        operation_(descriptor_, HidReportKind::output, k_operation_report, path_),
        gain_(descriptor_, HidReportKind::output, k_gain_report, path_),
        control_(descriptor_, HidReportKind::output, k_control_report, path_) {
    if (!descriptor_.numbered) throw DeviceError(path_ + ": its reports have no numbers");
    find_positions(options);
    // Every field that start() and the tick use must exist.
    for (const std::uint32_t usage : {k_block_index, k_magnitude}) constant_.field(usage);
    for (const std::uint32_t usage : {k_block_index, k_start, k_stop}) operation_.field(usage);
    for (const std::uint32_t usage : {k_enable, k_disable}) control_.field(usage);
    set_effect_.field(k_block_index);
    gain_.field(k_device_gain);
    load_.field(k_block_index);
    create_.field(k_constant_force);
    magnitude_ = constant_.find(k_magnitude);
    const double unit = std::pow(10, magnitude_->unit_exponent) * 1e-5;
    const bool in_newtons = magnitude_->unit == k_newton_unit && magnitude_->physical_max > 0;
    caps_.max_force_n = in_newtons ? unit * static_cast<double>(magnitude_->physical_max) : options.max_force_n;
    if (!(caps_.max_force_n > 0) || magnitude_->logical_max <= 0)
      throw DeviceError(path_ + ": its magnitude has no positive range");
    caps_.name = "hid:" + (info.name.empty() ? info.path : info.name);
    caps_.dynamics = options.dynamics;
    caps_.dynamics.delay_s += k_frame_s * (axes() - 1);
  }

  std::string name() const override { return "HID PID, " + std::to_string(axes()) + " axes"; }
  DeviceCaps caps() const override { return caps_; }

  void start(HidTransport& transport) override {
    const auto require = [&](bool done, const char* what) {
      if (!done) throw DeviceError(path_ + ": refuses " + what);
    };
    if (control_.find(k_reset) != nullptr)
      require(transport.write(control_report(k_reset)), "PID Device Control, reset");
    for (Axis& axis : axes_) {
      HidReport create = create_.blank();
      create_.select(create, k_constant_force);
      require(transport.set_feature(create), "Create New Effect");
      HidReport load = load_.blank();
      require(transport.get_feature(load), "PID Block Load");
      const HidField& index = load_.field(k_block_index);
      axis.block = hid_value(index, *index.index_of(k_block_index), load);
      if (!load_succeeded(load) || axis.block <= 0)
        throw DeviceError(path_ + ": has no room for an effect on axis " + std::to_string(&axis - axes_.data()));
      require(transport.write(effect_report(axis)), "Set Effect");
    }
    require(transport.write(control_report(k_enable)), "PID Device Control, enable actuators");
    HidReport gain = gain_.blank();
    gain_.set(gain, k_device_gain, gain_.field(k_device_gain).logical_max);
    require(transport.write(gain), "Device Gain");
    for (const Axis& axis : axes_) {
      require(transport.write(force_report(axis, 0)), "Set Constant Force");
      require(transport.write(operation_report(axis, k_start)), "Effect Operation, start");
    }
  }

  bool decode(std::span<const std::byte> bytes, DeviceSample& sample) const noexcept override {
    const std::uint8_t id = bytes.empty() ? 0 : std::to_integer<std::uint8_t>(bytes[0]);
    bool found = false;
    for (const Axis& axis : axes_) {
      const HidField& f = *axis.position;
      if (f.report_id != id) continue;
      if (bytes.size() < descriptor_.report_bytes(HidReportKind::input, id)) return false;
      const auto value = static_cast<double>(hid_value(f, axis.element, bytes));
      component(sample.position, axis.number) = axis.centre_m + axis.metres_per_count * value;
      found = true;
    }
    if (found && buttons_ != nullptr && buttons_->report_id == id) {
      sample.buttons = 0;
      for (std::uint32_t i = 0; i < std::min(buttons_->count, 32U); ++i)
        if (hid_value(*buttons_, i, bytes) != 0) sample.buttons |= 1U << i;
    }
    return found;
  }

  int packets() const noexcept override { return axes(); }

  std::size_t encode(int packet, Vec3 force, std::uint16_t, std::span<std::byte> bytes) const noexcept override {
    const Axis& axis = axes_[static_cast<std::size_t>(packet)];
    std::fill(bytes.begin(), bytes.end(), std::byte{0});
    if (bytes.size() < constant_.bytes) return 0;
    fill_force(axis, component(force, axis.number), bytes);
    return constant_.bytes;
  }

  std::vector<HidReport> stop_reports() const override {
    std::vector<HidReport> reports;
    for (const Axis& axis : axes_) reports.push_back(force_report(axis, 0));
    for (const Axis& axis : axes_) reports.push_back(operation_report(axis, k_stop));
    if (control_.find(k_stop_all) != nullptr) reports.push_back(control_report(k_stop_all));
    reports.push_back(control_report(k_disable));
    return reports;
  }

 private:
  struct Axis {
    int number = 0;  // 0 x, 1 y, 2 z.
    const HidField* position = nullptr;
    std::uint32_t element = 0;
    double metres_per_count = 0, centre_m = 0;
    std::int64_t block = 0;
  };

  int axes() const noexcept { return static_cast<int>(axes_.size()); }
  static double& component(Vec3& v, int i) noexcept { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

  void find_positions(const HidDeviceOptions& options) {
    for (int i = 0; i < 3; ++i)
      for (const HidField& f : descriptor_.fields) {
        const auto element = f.index_of(k_axis[i]);
        if (f.kind != HidReportKind::input || !f.variable || !element || f.logical_max <= f.logical_min) continue;
        Axis axis{i, &f, *element, 0, 0, 0};
        const auto counts = static_cast<double>(f.logical_max) - static_cast<double>(f.logical_min);
        const bool in_metres = f.unit == k_length_unit && f.physical_max > f.physical_min;
        const double range = in_metres ? 1e-2 * std::pow(10, f.unit_exponent) *
                                             (static_cast<double>(f.physical_max) - static_cast<double>(f.physical_min))
                                       : 2 * options.workspace_radius_m;
        axis.metres_per_count = range / counts;
        axis.centre_m =
            -axis.metres_per_count * 0.5 * (static_cast<double>(f.logical_max) + static_cast<double>(f.logical_min));
        caps_.workspace_radius_m = std::max(caps_.workspace_radius_m, 0.5 * range);
        axes_.push_back(axis);
        break;
      }
    if (axes_.empty()) throw DeviceError(path_ + ": its descriptor has no position 01:30, 01:31 or 01:32");
    for (const HidField& f : descriptor_.fields)
      if (buttons_ == nullptr && f.kind == HidReportKind::input && f.variable &&
          f.usages.front() >> 16 == k_buttons_page)
        buttons_ = &f;
  }

  /// Whether Block Load succeeded; devices without a status return an index > 0.
  bool load_succeeded(const HidReport& load) const {
    const HidField* f = load_.find(k_load_success, k_load_status);
    if (f == nullptr) f = load_.find(k_load_success);
    if (f == nullptr) return true;
    const std::uint32_t success = *f->index_of(k_load_success);
    return f->variable ? hid_value(*f, success, load) != 0
                       : hid_value(*f, 0, load) == f->logical_min + std::int64_t{success};
  }

  HidReport control_report(std::uint32_t usage) const {
    HidReport report = control_.blank();
    control_.select(report, usage);
    return report;
  }

  HidReport operation_report(const Axis& axis, std::uint32_t usage) const {
    HidReport report = operation_.blank();
    operation_.set(report, k_block_index, axis.block);
    operation_.select(report, usage);
    operation_.set_if_present(report, k_loop_count, 1);
    return report;
  }

  HidReport force_report(const Axis& axis, double force_n) const {
    HidReport report = constant_.blank();
    fill_force(axis, force_n, report);
    return report;
  }

  void fill_force(const Axis& axis, double force_n, std::span<std::byte> report) const noexcept {
    report[0] = static_cast<std::byte>(constant_.id);
    const HidField& block = *constant_.find(k_block_index);
    set_hid_value(block, *block.index_of(k_block_index), axis.block, report);
    set_hid_value(*magnitude_, *magnitude_->index_of(k_magnitude), counts(force_n), report);
  }

  std::int64_t counts(double force_n) const noexcept {
    if (!std::isfinite(force_n)) return 0;
    const auto most = static_cast<double>(magnitude_->logical_max);
    return std::llround(std::clamp(force_n / caps_.max_force_n, -1.0, 1.0) * most);
  }

  /// Set Effect: a constant force of infinite duration on one axis, named by its bit, else by its direction.
  HidReport effect_report(const Axis& axis) const {
    HidReport report = set_effect_.blank();
    set_effect_.set(report, k_block_index, axis.block);
    if (const HidField* type = set_effect_.find(k_constant_force, k_effect_type))
      set_effect_.select(report, k_constant_force, *type);
    else
      set_effect_.select(report, k_constant_force);
    set_effect_.set_null(report, k_duration);
    set_effect_.set_if_present(report, k_sample_period, 0);
    if (const HidField* gain = set_effect_.find(k_gain)) set_effect_.set(report, k_gain, gain->logical_max);
    set_effect_.set_null(report, k_trigger_button);
    const std::uint32_t usage = k_axis[axis.number];
    if (const HidField* enable = set_effect_.find(usage, k_axes_enable)) {
      set_effect_.select(report, usage, *enable);
    } else {
      set_effect_.set_if_present(report, k_direction_enable, 1);
      set_direction(report, axis.number);
    }
    return report;
  }

  /// Polar direction in the first ordinal: +x is a quarter turn from north, +y half a turn.
  void set_direction(HidReport& report, int axis) const {
    const HidField* direction = set_effect_.find(hid_usage(0x0A, 1), k_direction);
    if (direction == nullptr || axis > 1) return;
    const auto range = static_cast<double>(direction->logical_max - direction->logical_min + 1);
    set_hid_value(*direction, *direction->index_of(hid_usage(0x0A, 1)),
                  direction->logical_min + std::llround(range * (axis == 0 ? 0.25 : 0.5)), report);
  }

  std::string path_;
  HidDescriptor descriptor_;
  Report create_, load_, set_effect_, constant_, operation_, gain_, control_;
  const HidField* magnitude_ = nullptr;
  const HidField* buttons_ = nullptr;
  std::vector<Axis> axes_;
  DeviceCaps caps_;
};

}  // namespace

std::unique_ptr<ForceProtocol> make_force_protocol(const HidInfo& info, const HidDeviceOptions& options) {
  if (info.descriptor.empty()) throw DeviceError(info.path + ": its report descriptor can't be read");
  HidDescriptor descriptor = parse_hid_descriptor(info.descriptor);
  if (descriptor.has_application(k_force_application)) return std::make_unique<ForceReport>(info, descriptor);
  return std::make_unique<Pid>(info, std::move(descriptor), options);
}

}  // namespace papilla
