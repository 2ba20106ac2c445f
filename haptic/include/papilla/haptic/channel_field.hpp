// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// What a channel of a map says about a place of a surface.
enum class Quantity { stiffness, static_friction, dynamic_friction, damping };
inline constexpr std::array k_quantities{Quantity::stiffness, Quantity::static_friction, Quantity::dynamic_friction,
                                         Quantity::damping};

/// "stiffness", "static_friction", "dynamic_friction", "damping".
std::string_view name_of(Quantity quantity) noexcept;
std::optional<Quantity> quantity(std::string_view name) noexcept;

/// Largest value that a tag may say of a quantity, in its SI unit: N/m, 1, 1, N·s/m. The least is 0.
double largest_value(Quantity quantity) noexcept;

/// From a sample v of 16 bits to the quantity: offset + scale · v / 65535, in N/m, N·s/m or 1.
struct MapChannel {
  Quantity quantity = Quantity::stiffness;
  double scale = 0;   ///< From black to white, of either sign.
  double offset = 0;  ///< Of black.
  double least() const noexcept { return scale < 0 ? offset + scale : offset; }
  double most() const noexcept { return scale < 0 ? offset : offset + scale; }
  friend bool operator==(const MapChannel&, const MapChannel&) = default;
};

/// How the samples of a ChannelField are read.
struct ChannelFieldOptions {
  std::array<std::optional<MapChannel>, 3> channels;  ///< Red, green, blue.
  UvTransform uv_transform;
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
};

/// Maps of stiffness, friction and damping over texture coordinates: three samples of 16 bits a texel, placed as those
/// of a HeightField, interpolated bilinearly, so that every value lies between those of four samples.
class ChannelField {
 public:
  using Texel = std::array<std::uint16_t, 3>;

  /// @param samples width × height texels, row by row.
  /// @throws InvalidInput when a size is zero, the number of samples differs from it, an option is not finite, a
  ///         channel can be negative, or a quantity has two channels.
  ChannelField(int width, int height, std::vector<Texel> samples, const ChannelFieldOptions& options);

  /// Writes what the maps say at uv over the constants. Where only one of the two frictions has a map, the other one
  /// follows in the ratio of the constants; dynamic friction is at most the static one.
  /// @returns the gradient of the stiffness by uv, N/m per unit; zero without a map of it.
  Vec2 apply(Vec2 uv, ContactConstants& constants) const noexcept;

  /// The largest value of a quantity on the map; nothing where it has none.
  std::optional<double> most(Quantity quantity) const noexcept;

 private:
  int width_, height_;
  std::vector<Texel> samples_;
  std::array<Wrap, 2> wrap_;
  /// By quantity: which channel it is, and value = base + step · v.
  struct Reading {
    int channel = -1;
    double base = 0, step = 0, most = 0;
  };
  std::array<Reading, k_quantities.size()> readings_;
  std::array<Vec2, 2> rows_;  ///< uv to texels.
  Vec2 shift_;
};

}  // namespace papilla
