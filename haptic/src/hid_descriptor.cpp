// SPDX-License-Identifier: MIT
#include "hid_descriptor.hpp"

#include <algorithm>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_longest = 4096;  // The kernel's limit, for descriptors and for reports.
constexpr std::size_t k_deepest = 32;
constexpr std::size_t k_most_usages = 65536;

struct Globals {
  std::uint32_t page = 0, report_size = 0, report_count = 0, unit = 0;
  std::int64_t logical_min = 0, logical_max = 0, physical_min = 0, physical_max = 0;
  std::uint32_t logical_max_unsigned = 0, physical_max_unsigned = 0;
  int unit_exponent = 0;
  std::uint8_t report_id = 0;
};

struct Item {
  std::size_t at = 0;
  std::uint32_t type = 0, tag = 0, size = 0, data = 0;
  std::int64_t number() const noexcept {
    if (size == 1) return static_cast<std::int8_t>(data);
    if (size == 2) return static_cast<std::int16_t>(data);
    return static_cast<std::int32_t>(data);
  }
};

class Parser {
 public:
  explicit Parser(std::span<const std::byte> bytes) : bytes_(bytes) {
    if (bytes.size() > k_longest) fail(k_longest, "is longer than 4096 bytes");
  }

  HidDescriptor parse() {
    for (Item item; next(item);) {
      if (item.type == 0)
        main_item(item);
      else if (item.type == 1)
        global_item(item);
      else if (item.type == 2)
        local_item(item);
    }
    if (!collections_.empty()) fail(bytes_.size(), "ends within a collection");
    return std::move(result_);
  }

 private:
  [[noreturn]] static void fail(std::size_t at, const std::string& what) {
    throw InvalidInput("HID report descriptor: byte " + std::to_string(at) + ": " + what);
  }

  std::uint32_t byte_at(std::size_t i) const { return std::to_integer<std::uint32_t>(bytes_[i]); }

  /// The next short item; false at the end.
  bool next(Item& item) {
    while (at_ < bytes_.size()) {
      const std::uint32_t prefix = byte_at(at_);
      const bool is_long = prefix == 0xFE;
      if (is_long && at_ + 2 >= bytes_.size()) fail(at_, "is cut within an item");
      const std::uint32_t size = is_long ? 2 + byte_at(at_ + 1) : ((prefix & 3U) == 3 ? 4 : prefix & 3U);
      if (at_ + 1 + size > bytes_.size()) fail(at_, "is cut within an item");
      item = {at_, prefix >> 2 & 3U, prefix >> 4, size, 0};
      at_ += 1 + size;
      if (is_long) continue;
      for (std::uint32_t i = 0; i < size; ++i) item.data |= byte_at(item.at + 1 + i) << (8 * i);
      return true;
    }
    return false;
  }

  void main_item(const Item& item) {
    switch (item.tag) {
      case 8: field(item, HidReportKind::input); break;
      case 9: field(item, HidReportKind::output); break;
      case 11: field(item, HidReportKind::feature); break;
      case 10: {
        if (collections_.size() == k_deepest) fail(item.at, "nests collections too deep");
        const std::uint32_t usage = usages_.empty() ? 0 : usages_.front();
        if (collections_.empty()) result_.applications.push_back(usage);
        collections_.push_back(usage);
        break;
      }
      case 12:
        if (collections_.empty()) fail(item.at, "ends a collection that was not begun");
        collections_.pop_back();
        break;
      default: break;
    }
    usages_.clear();
    range_begin_.reset();
  }

  void global_item(const Item& item) {
    Globals& g = globals_;
    switch (item.tag) {
      case 0: g.page = item.data & 0xffffU; break;
      case 1: g.logical_min = item.number(); break;
      case 2:
        g.logical_max = item.number();
        g.logical_max_unsigned = item.data;
        break;
      case 3: g.physical_min = item.number(); break;
      case 4:
        g.physical_max = item.number();
        g.physical_max_unsigned = item.data;
        break;
      case 5: {
        const auto exponent = static_cast<int>(item.number());
        // Devices write a nibble in two's complement or a plain number.
        g.unit_exponent =
            exponent >= 0 && exponent <= 15 ? (exponent > 7 ? exponent - 16 : exponent) : std::clamp(exponent, -8, 7);
        break;
      }
      case 6: g.unit = item.data; break;
      case 7: g.report_size = item.data; break;
      case 8:
        if (item.data == 0 || item.data > 255) fail(item.at, "has a report number that is not 1 to 255");
        g.report_id = static_cast<std::uint8_t>(item.data);
        result_.numbered = true;
        break;
      case 9: g.report_count = item.data; break;
      case 10:
        if (pushed_.size() == k_deepest) fail(item.at, "pushes too deep");
        pushed_.push_back(g);
        break;
      case 11:
        if (pushed_.empty()) fail(item.at, "pops what was not pushed");
        g = pushed_.back();
        pushed_.pop_back();
        break;
      default: break;
    }
  }

  std::uint32_t full_usage(const Item& item) const {
    return item.size == 4 ? item.data : hid_usage(globals_.page, item.data & 0xffffU);
  }

  void add_usage(std::size_t at, std::uint32_t usage) {
    if (++usage_count_ > k_most_usages) fail(at, "has too many usages");
    usages_.push_back(usage);
  }

  void local_item(const Item& item) {
    if (item.tag == 0) add_usage(item.at, full_usage(item));
    if (item.tag == 1) range_begin_ = full_usage(item);
    if (item.tag == 2 && range_begin_) {
      const std::uint32_t end = full_usage(item);
      if (end < *range_begin_ || end - *range_begin_ >= k_most_usages) fail(item.at, "has an impossible usage range");
      for (std::uint32_t usage = *range_begin_; usage <= end && usage >= *range_begin_; ++usage)
        add_usage(item.at, usage);
      range_begin_.reset();
    }
  }

  std::uint32_t& bits_of_report(HidReportKind kind) {
    for (HidDescriptor::Size& size : result_.sizes)
      if (size.kind == kind && size.report_id == globals_.report_id) return size.bits;
    result_.sizes.push_back({kind, globals_.report_id, 0});
    return result_.sizes.back().bits;
  }

  void field(const Item& item, HidReportKind kind) {
    const Globals& g = globals_;
    std::uint32_t& used = bits_of_report(kind);
    const std::uint64_t total = std::uint64_t{g.report_size} * g.report_count;
    if (used + total > 8 * k_longest) fail(item.at, "makes a report longer than 4096 bytes");
    const std::uint32_t offset = used;
    used += static_cast<std::uint32_t>(total);
    const bool constant = (item.data & 1U) != 0;
    if (total == 0 || usages_.empty() || constant) return;
    if (g.report_size > 64) fail(item.at, "has an element of more than 64 bits");
    HidField f;
    f.kind = kind;
    f.report_id = g.report_id;
    f.bit_offset = offset;
    f.bits = g.report_size;
    f.count = g.report_count;
    f.logical_min = g.logical_min;
    f.logical_max = upper(g.logical_min, g.logical_max, g.logical_max_unsigned);
    if (f.logical_max < f.logical_min) fail(item.at, "has a logical maximum below its minimum");
    f.physical_min = g.physical_min;
    f.physical_max = upper(g.physical_min, g.physical_max, g.physical_max_unsigned);
    f.unit_exponent = g.unit_exponent;
    f.unit = g.unit;
    f.variable = (item.data & 2U) != 0;
    f.null_state = (item.data & 0x40U) != 0;
    f.usages = usages_;
    if (f.variable) {
      // The last usage applies to all further elements.
      if (g.report_count > k_most_usages - std::min(usage_count_, k_most_usages)) fail(item.at, "has too many usages");
      usage_count_ += g.report_count;
      f.usages.resize(g.report_count, usages_.back());
    }
    f.collections = collections_;
    result_.fields.push_back(std::move(f));
  }

  /// A maximum below a non-negative minimum was meant as unsigned, as 25 FF often is.
  static std::int64_t upper(std::int64_t low, std::int64_t high, std::uint32_t unsigned_high) {
    return high < low && low >= 0 ? static_cast<std::int64_t>(unsigned_high) : high;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0, usage_count_ = 0;
  Globals globals_;
  std::vector<Globals> pushed_;
  std::vector<std::uint32_t> collections_, usages_;
  std::optional<std::uint32_t> range_begin_;
  HidDescriptor result_;
};

/// First bit of an element in a report that starts with its number.
std::size_t first_bit(const HidField& field, std::uint32_t element) noexcept {
  return (field.report_id != 0 ? 8U : 0U) + field.bit_offset + std::size_t{element} * field.bits;
}

bool fits(const HidField& field, std::uint32_t element, std::size_t bytes) noexcept {
  return element < field.count && field.bits <= 64 && first_bit(field, element) + field.bits <= 8 * bytes;
}

}  // namespace

bool HidField::in(std::uint32_t collection) const noexcept {
  return std::find(collections.begin(), collections.end(), collection) != collections.end();
}

std::optional<std::uint32_t> HidField::index_of(std::uint32_t usage) const noexcept {
  const auto found = std::find(usages.begin(), usages.end(), usage);
  if (found == usages.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - usages.begin());
}

std::size_t HidDescriptor::report_bytes(HidReportKind kind, std::uint8_t report_id) const noexcept {
  for (const Size& size : sizes)
    if (size.kind == kind && size.report_id == report_id) return (size.bits + 7) / 8 + (numbered ? 1 : 0);
  return 0;
}

bool HidDescriptor::has_application(std::uint32_t usage) const noexcept {
  return std::find(applications.begin(), applications.end(), usage) != applications.end();
}

HidDescriptor parse_hid_descriptor(std::span<const std::byte> bytes) { return Parser(bytes).parse(); }

std::int64_t hid_value(const HidField& field, std::uint32_t element, std::span<const std::byte> report) noexcept {
  if (!fits(field, element, report.size())) return 0;
  const std::size_t first = first_bit(field, element);
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < field.bits; ++i) {
    const std::size_t bit = first + i;
    if ((std::to_integer<unsigned>(report[bit / 8]) >> (bit % 8) & 1U) != 0) value |= std::uint64_t{1} << i;
  }
  const bool negative = field.logical_min < 0 && field.bits < 64 && (value >> (field.bits - 1) & 1U) != 0;
  if (negative) value |= ~std::uint64_t{0} << field.bits;
  return static_cast<std::int64_t>(value);
}

void set_hid_value(const HidField& field, std::uint32_t element, std::int64_t value,
                   std::span<std::byte> report) noexcept {
  if (!fits(field, element, report.size())) return;
  const std::size_t first = first_bit(field, element);
  for (std::uint32_t i = 0; i < field.bits; ++i) {
    const std::size_t bit = first + i;
    const auto mask = static_cast<std::byte>(1U << (bit % 8));
    const bool set = (static_cast<std::uint64_t>(value) >> i & 1U) != 0;
    report[bit / 8] = set ? report[bit / 8] | mask : report[bit / 8] & ~mask;
  }
}

}  // namespace papilla
