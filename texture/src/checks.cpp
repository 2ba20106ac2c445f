// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla::texture_detail {
namespace {

void require_samples(std::span<const float> samples, int width, int height, const char* function) {
  const std::string name(function);
  if (width < 1 || height < 1)
    throw InvalidInput(name + ": the picture is empty (" + std::to_string(width) + " x " + std::to_string(height) +
                       ")");
  const std::size_t expected = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (samples.size() != expected)
    throw InvalidInput(name + ": " + std::to_string(samples.size()) + " samples for " + std::to_string(width) + " x " +
                       std::to_string(height) + " pixels");
  const auto bad = std::find_if(samples.begin(), samples.end(), [](float v) { return !std::isfinite(v); });
  if (bad == samples.end()) return;
  const auto index = static_cast<std::size_t>(bad - samples.begin());
  const auto columns = static_cast<std::size_t>(width);
  throw InvalidInput(name + ": sample [" + std::to_string(index % columns) + ", " + std::to_string(index / columns) +
                     "] is not a finite number");
}

}  // namespace

void require_image(const GreyImage& image, const char* function, int least_side) {
  require_samples(image.pixels, image.width, image.height, function);
  if (std::min(image.width, image.height) < least_side)
    throw InvalidInput(std::string(function) + ": the picture is " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " pixels, at least " + std::to_string(least_side) +
                       " a side are needed");
}

void require_height_map(const HeightMap& map, const char* function, bool needs_pitch) {
  require_samples(map.mm, map.width, map.height, function);
  if (needs_pitch && (!is_positive(map.pitch_mm_x) || !is_positive(map.pitch_mm_y)))
    throw InvalidInput(std::string(function) + ": the pitch " + std::to_string(map.pitch_mm_x) + " x " +
                       std::to_string(map.pitch_mm_y) + " mm is not positive");
}

Vec3 require_light(Vec3 light, const char* function) {
  const Vec3 unit = normalized(light);
  if (!is_finite(light) || !is_finite(unit) || !(unit.z > 0))
    throw InvalidInput(std::string(function) + ": the light (" + std::to_string(light.x) + ", " +
                       std::to_string(light.y) + ", " + std::to_string(light.z) + ") does not come from the front");
  return unit;
}

std::size_t index_of_name(std::string_view name, std::span<const std::string_view> names, const char* function) {
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    known += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + std::string(names[i]);
  }
  throw InvalidInput(std::string(function) + ": '" + std::string(name) + "' is not " + known);
}

std::vector<std::uint8_t> whole_bytes(const GreyImage& image) {
  std::vector<std::uint8_t> bytes(image.pixels.size());
  constexpr double k_rounding = 1e-4;
  double worst = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const double value = 255 * static_cast<double>(image.pixels[i]);
    if (!(value > -0.5 && value < 255.5)) return {};
    bytes[i] = static_cast<std::uint8_t>(value + 0.5);
    worst = std::max(worst, std::abs(value - bytes[i]));
  }
  if (worst > k_rounding) return {};
  return bytes;
}

std::vector<std::uint8_t> stretched_bytes(const GreyImage& image) {
  std::vector<std::uint8_t> bytes(image.pixels.size(), 0);
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  const double offset = static_cast<double>(*low), range = static_cast<double>(*high) - offset;
  if (!(range > 0)) return bytes;
  std::transform(image.pixels.begin(), image.pixels.end(), bytes.begin(), [&](float value) {
    return static_cast<std::uint8_t>(std::lround(255 * (static_cast<double>(value) - offset) / range));
  });
  return bytes;
}

}  // namespace papilla::texture_detail
