// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace papilla {

enum class HidReportKind { input, output, feature };

/// Usage page in the upper, usage in the lower 16 bits.
constexpr std::uint32_t hid_usage(std::uint32_t page, std::uint32_t id) noexcept { return page << 16 | id; }

/// One main item of a report descriptor: `count` elements of `bits` bits each, side by side in one report.
struct HidField {
  HidReportKind kind = HidReportKind::input;
  std::uint8_t report_id = 0;    ///< 0: reports are not numbered.
  std::uint32_t bit_offset = 0;  ///< From the start of the report, without the byte of its number.
  std::uint32_t bits = 0;        ///< Of one element, 1 to 64.
  std::uint32_t count = 0;
  std::int64_t logical_min = 0, logical_max = 0;
  std::int64_t physical_min = 0, physical_max = 0;  ///< Both 0: as the logical range.
  int unit_exponent = 0;                            ///< Power of ten of the unit.
  std::uint32_t unit = 0;                           ///< As in the descriptor; 0: none.
  bool variable = false;                            ///< False: an array, whose elements are indices of usages.
  bool null_state = false;                          ///< Values outside the logical range mean "none".
  std::vector<std::uint32_t> usages;                ///< Per element; of an array: per value.
  std::vector<std::uint32_t> collections;           ///< Usages of the collections around it, outermost first.

  bool in(std::uint32_t collection) const noexcept;
  /// Index of a usage: of its element (variable), or of its value above logical_min (array).
  std::optional<std::uint32_t> index_of(std::uint32_t usage) const noexcept;
};

/// The fields of a HID report descriptor, without padding.
struct HidDescriptor {
  std::vector<HidField> fields;             ///< In the order of the descriptor.
  std::vector<std::uint32_t> applications;  ///< Usages of the outermost collections.
  bool numbered = false;                    ///< Reports begin with the byte of their number.

  /// Length of a report in bytes, with the byte of its number when numbered; 0 when there is none.
  std::size_t report_bytes(HidReportKind kind, std::uint8_t report_id) const noexcept;
  bool has_application(std::uint32_t usage) const noexcept;

  struct Size {
    HidReportKind kind;
    std::uint8_t report_id;
    std::uint32_t bits;
  };
  std::vector<Size> sizes;  ///< One per report, padding counted.
};

/// Parses a report descriptor [USB HID 1.11, 6.2.2]: short and long items, push and pop, usage ranges, collections,
/// report numbers.
/// Cost: linear. Every input is refused or gives fields inside their reports.
/// @throws InvalidInput naming the byte when it is truncated, longer than 4096 bytes, nests or pushes deeper than 32,
///         pops or closes more than was opened, has a report of more than 4096 bytes, an element of more than 64 bits,
///         or more than 65536 usages.
HidDescriptor parse_hid_descriptor(std::span<const std::byte> bytes);

/// The value of an element, signed when the logical minimum is negative; 0 outside the report.
/// @param report with the byte of the number when the descriptor is numbered.
std::int64_t hid_value(const HidField& field, std::uint32_t element, std::span<const std::byte> report) noexcept;

/// Stores the lower bits of `value` in a report; does nothing outside it.
void set_hid_value(const HidField& field, std::uint32_t element, std::int64_t value,
                   std::span<std::byte> report) noexcept;

}  // namespace papilla
