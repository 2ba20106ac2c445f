// SPDX-License-Identifier: MIT
#include "papilla/pipeline/hex_colour.hpp"

#include <fmt/core.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"

namespace papilla {

std::string hex_colour(const std::array<double, 4>& linear) {
  const auto byte = [](double c) { return static_cast<int>(std::lround(255 * srgb_from_linear(c))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(linear[0]), byte(linear[1]), byte(linear[2]));
}

std::array<double, 4> linear_colour(const std::string& hex) {
  if (hex.size() != 7 || hex[0] != '#') throw InvalidInput("linear_colour: '" + hex + "' is no colour such as #20a0ff");
  const auto channel = [&](std::size_t at) {
    return linear_from_srgb(std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0);
  };
  return {channel(1), channel(3), channel(5), 1};
}

}  // namespace papilla
