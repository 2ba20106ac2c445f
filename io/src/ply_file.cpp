// SPDX-License-Identifier: MIT
#include "ply_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "papilla/core/error.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_max_properties = 1000;  ///< Of all elements together.

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  PlyHeader parse() {
    if (next_line() != "ply") fail("is no PLY file: the first line is not 'ply'");
    bool has_format = false;
    for (std::string_view line = next_line();; line = next_line()) {
      const std::string_view keyword = next_word(line);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        const std::string_view name = next_word(line);
        header_.format = format(name, next_word(line));
        has_format = true;
      } else if (keyword == "element") {
        add_element(line);
      } else if (keyword == "property") {
        add_property(line);
      } else if (keyword == "comment") {
        add_comment(line);
      } else if (keyword != "obj_info" && !keyword.empty()) {
        fail("unknown keyword '" + printable(keyword) + "'");
      }
    }
    if (!has_format) fail("the header names no format");
    header_.size = at_;
    for (const PlyElement& element : header_.elements) check_count(element);
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(file_ + ": line " + std::to_string(line_) + ": " + reason);
  }

  /// Lines end with LF, CR LF or, in old files, CR. The bytes behind "end_header" may begin with any number.
  std::string_view next_line() {
    ++line_;
    const std::size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    if (end == bytes_.size()) fail("the header is truncated: 'end_header' expected");
    const std::string_view line = bytes_.substr(at_, end - at_);
    if (line_ == 1) line_end_ = bytes_.substr(end, 2) == "\r\n" ? 2 : 1;
    at_ = end + (bytes_.substr(end, 2) == "\r\n" ? line_end_ : 1);
    return line;
  }

  PlyFormat format(std::string_view name, std::string_view version) const {
    if (version != "1.0") fail("version '" + printable(version) + "' is not supported (1.0 is)");
    if (name == "ascii") return PlyFormat::ascii;
    if (name == "binary_little_endian") return PlyFormat::little_endian;
    if (name == "binary_big_endian") return PlyFormat::big_endian;
    fail("unknown format '" + printable(name) + "'");
  }

  PlyType type(std::string_view name) const {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> k_names = {{{"char", PlyType::int8},
                                                                                      {"int8", PlyType::int8},
                                                                                      {"uchar", PlyType::uint8},
                                                                                      {"uint8", PlyType::uint8},
                                                                                      {"short", PlyType::int16},
                                                                                      {"int16", PlyType::int16},
                                                                                      {"ushort", PlyType::uint16},
                                                                                      {"uint16", PlyType::uint16},
                                                                                      {"int", PlyType::int32},
                                                                                      {"int32", PlyType::int32},
                                                                                      {"uint", PlyType::uint32},
                                                                                      {"uint32", PlyType::uint32},
                                                                                      {"float", PlyType::float32},
                                                                                      {"float32", PlyType::float32},
                                                                                      {"double", PlyType::float64},
                                                                                      {"float64", PlyType::float64}}};
    const auto known =
        std::find_if(k_names.begin(), k_names.end(), [&](const auto& entry) { return entry.first == name; });
    if (known == k_names.end()) fail("unknown type '" + printable(name) + "'");
    return known->second;
  }

  void add_element(std::string_view line) {
    PlyElement element;
    element.name = std::string(next_word(line));
    const std::string_view count = next_word(line);
    if (!parse_number(count, element.count)) fail("'" + printable(count) + "' is not a number of elements");
    header_.elements.push_back(std::move(element));
    if (header_.elements.size() > k_max_properties) fail("more than 1000 elements");
  }

  void add_property(std::string_view line) {
    if (header_.elements.empty()) fail("a property stands before the first element");
    if (++properties_ > k_max_properties) fail("more than 1000 properties");
    PlyProperty property;
    std::string_view word = next_word(line);
    if (word == "list") {
      property.is_list = true;
      property.count_type = type(next_word(line));
      if (!is_integer(property.count_type)) fail("the length of a list is not an integer");
      word = next_word(line);
    }
    property.type = type(word);
    property.name = std::string(next_word(line));
    if (property.name.empty()) fail("a property has no name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  void add_comment(std::string_view line) {
    if (next_word(line) == "TextureFile") header_.texture_files.push_back({std::string(trimmed(line)), line_});
  }

  /// Refuses counts that the file's bytes could not hold.
  void check_count(const PlyElement& element) const {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least +=
          header_.format == PlyFormat::ascii ? 2 : ply_size(property.is_list ? property.count_type : property.type);
    // The last number of a text needs no white space behind it.
    const std::uint64_t left = bytes_.size() - header_.size + (header_.format == PlyFormat::ascii ? 1 : 0);
    if (least > 0 && element.count > left / least)
      throw InvalidInput(file_ + ": truncated: " + std::to_string(element.count) + " elements '" +
                         printable(element.name) + "' promised, " + std::to_string(left) + " bytes found");
  }

  std::string_view bytes_;
  const std::string& file_;
  PlyHeader header_;
  std::size_t at_ = 0, line_ = 0, line_end_ = 1, properties_ = 0;
};

static_assert(std::endian::native == std::endian::little, "little endian numbers are read in place");

template <class T>
double load(std::array<char, 8> raw) {
  T value;
  std::memcpy(&value, raw.data(), sizeof value);
  return static_cast<double>(value);
}

double load(std::array<char, 8> raw, PlyType type) {
  switch (type) {
    case PlyType::int8: return load<std::int8_t>(raw);
    case PlyType::uint8: return load<std::uint8_t>(raw);
    case PlyType::int16: return load<std::int16_t>(raw);
    case PlyType::uint16: return load<std::uint16_t>(raw);
    case PlyType::int32: return load<std::int32_t>(raw);
    case PlyType::uint32: return load<std::uint32_t>(raw);
    case PlyType::float32: return load<float>(raw);
    default: return load<double>(raw);
  }
}

}  // namespace

std::size_t ply_size(PlyType type) noexcept {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8: return 1;
    case PlyType::int16:
    case PlyType::uint16: return 2;
    case PlyType::float64: return 8;
    default: return 4;
  }
}

bool is_integer(PlyType type) noexcept { return type != PlyType::float32 && type != PlyType::float64; }

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
  return HeaderParser(bytes, file).parse();
}

void PlyBody::fail(const std::string& reason) const {
  const std::string_view before = bytes_.substr(0, at_);
  const std::string place = format_ == PlyFormat::ascii
                                ? "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1)
                                : "byte " + std::to_string(at_);
  throw InvalidInput(file_ + ": " + place + ": " + reason);
}

double PlyBody::number(PlyType type) {
  if (format_ == PlyFormat::ascii) {
    std::string_view rest = bytes_.substr(at_);
    const std::string_view word = next_word(rest);
    double value = 0;
    if (word.empty()) fail("truncated: a number expected");
    if (!parse_number(word, value)) fail("'" + printable(word) + "' is not a number");
    at_ = bytes_.size() - rest.size();
    return value;
  }
  const std::size_t size = ply_size(type);
  if (bytes_.size() - at_ < size) fail("truncated: a number of " + std::to_string(size) + " bytes expected");
  std::array<char, 8> raw{};
  std::memcpy(raw.data(), bytes_.data() + at_, size);
  if (format_ == PlyFormat::big_endian) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
  at_ += size;
  return load(raw, type);
}

std::size_t PlyBody::list_length(const PlyProperty& property) {
  const double length = number(property.count_type);
  const std::size_t least = format_ == PlyFormat::ascii ? 2 : ply_size(property.type);
  const std::size_t left = bytes_.size() - at_;
  if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>((left + 1) / least))
    fail("a list of " + fmt::format("{}", length) + " entries, " + std::to_string(left) + " bytes found");
  return static_cast<std::size_t>(length);
}

void PlyBody::list(const PlyProperty& property, std::vector<double>& values) {
  values.resize(list_length(property));
  for (double& value : values) value = number(property.type);
}

void PlyBody::skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  std::vector<double> unused;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties)
      if (property.is_list)
        list(property, unused);
      else
        number(property.type);
}

}  // namespace papilla
