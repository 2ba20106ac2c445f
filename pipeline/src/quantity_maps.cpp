// SPDX-License-Identifier: MIT
#include "papilla/pipeline/quantity_maps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/slope_limit.hpp"

namespace papilla {
namespace {

constexpr double k_constant = 1e-3;         // Of the mean: a map within is none.
constexpr double k_least_stiffness = 1e-3;  // Of the largest one: softer places are taken for that soft.
constexpr std::size_t k_most_maps = 3;

std::size_t count_of(const QuantityMaps& maps) {
  return static_cast<std::size_t>(maps.width) * static_cast<std::size_t>(maps.height);
}

void check(const QuantityMaps& maps) {
  const auto fail = [](const std::string& what) { throw InvalidInput("encode_quantity_maps: " + what); };
  if (maps.width <= 0 || maps.height <= 0) fail("the picture is empty");
  if (maps.maps.size() > k_most_maps) fail(std::to_string(maps.maps.size()) + " maps are more than three");
  for (const QuantityMap& map : maps.maps) {
    if (map.values.size() != count_of(maps))
      fail(std::to_string(map.values.size()) + " values are not " + std::to_string(maps.width) + " x " +
           std::to_string(maps.height));
    for (const float v : map.values)
      if (!(v >= 0) || !std::isfinite(v)) fail("a " + std::string(name_of(map.quantity)) + " is not >= 0");
  }
}

bool is_constant(const QuantityMap& map) {
  const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
  const double mean =
      std::accumulate(map.values.begin(), map.values.end(), 0.0) / static_cast<double>(map.values.size());
  return static_cast<double>(*high) - mean <= k_constant * mean &&
         mean - static_cast<double>(*low) <= k_constant * mean;
}

/// Half the texels in each direction, each the mean of four.
void halve(QuantityMaps& maps) {
  const int width = maps.width / 2, height = maps.height / 2;
  for (QuantityMap& map : maps.maps) {
    Values<float> coarse;
    coarse.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto at = [&](int x, int y) {
      return map
          .values[static_cast<std::size_t>(y) * static_cast<std::size_t>(maps.width) + static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < 2 * height; y += 2)
      for (int x = 0; x < 2 * width; x += 2)
        coarse.push_back(0.25F * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)));
    map.values = std::move(coarse);
  }
  maps.width = width, maps.height = height;
  maps.pitch_mm_x *= 2, maps.pitch_mm_y *= 2;
}

void smooth_stiffness(const QuantityMaps& maps, QuantityMap& map) {
  const float largest = *std::max_element(map.values.begin(), map.values.end());
  HeightMap logarithm{maps.width, maps.height, map.values, maps.pitch_mm_x, maps.pitch_mm_y, maps.periodic};
  for (float& v : logarithm.mm) v = std::log(std::max(v / largest, static_cast<float>(k_least_stiffness)));
  const SlopeLimitResult smooth = limit_slope(logarithm, {.max_slope = k_steepest_stiffness_per_mm});
  if (smooth.stop == StopReason::direct) return;
  for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = largest * std::exp(smooth.relief.mm[i]);
}

}  // namespace

std::optional<MapsTag> encode_quantity_maps(QuantityMaps maps) {
  check(maps);
  std::erase_if(maps.maps, is_constant);
  if (maps.maps.empty()) return std::nullopt;
  while (std::max(maps.pitch_mm_x, maps.pitch_mm_y) < 0.5 * k_map_texel_mm && maps.width % 2 == 0 &&
         maps.height % 2 == 0)
    halve(maps);
  for (QuantityMap& map : maps.maps)
    if (map.quantity == Quantity::stiffness && maps.pitch_mm_x > 0 && maps.pitch_mm_y > 0) smooth_stiffness(maps, map);

  EncodedMaps encoded{.png = {}, .width = maps.width, .height = maps.height, .bits = 8, .channels = {}};
  ColorImage picture{maps.width, maps.height, Values<unsigned char>(3 * count_of(maps), 0)};
  for (std::size_t c = 0; c < maps.maps.size(); ++c) {
    const Values<float>& values = maps.maps[c].values;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double black = static_cast<double>(*low), range = static_cast<double>(*high) - black;
    encoded.channels[c] = MapChannel{maps.maps[c].quantity, range, black};
    for (std::size_t i = 0; i < values.size(); ++i)
      picture.pixels[3 * i + c] = static_cast<unsigned char>(
          range > 0 ? std::lround(255 * (static_cast<double>(values[i]) - black) / range) : 0);
  }
  const std::vector<std::byte> png = encode_png(picture);
  encoded.png = png;
  return make_maps_tag(encoded);
}

std::vector<Quantity> scale_by_constants(std::optional<MapsTag>& maps, const MaterialTag& constants) {
  std::vector<Quantity> lost;
  if (!maps) return lost;
  const auto constant = [&](Quantity quantity) {
    switch (quantity) {
      case Quantity::stiffness: return constants.stiffness;
      case Quantity::static_friction: return constants.static_friction;
      case Quantity::dynamic_friction: return constants.dynamic_friction;
      case Quantity::damping: break;
    }
    return constants.damping;
  };
  bool any = false;
  for (std::optional<MapChannel>& channel : maps->channels) {
    if (!channel) continue;
    const double factor = constant(channel->quantity);
    channel->scale *= factor;
    channel->offset *= factor;
    if (factor > 0) {
      any = true;
      continue;
    }
    lost.push_back(channel->quantity);
    channel.reset();
  }
  if (!any) maps.reset();
  return lost;
}

}  // namespace papilla
