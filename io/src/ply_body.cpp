// SPDX-License-Identifier: MIT
#include "ply_body.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "papilla/core/error.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

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
