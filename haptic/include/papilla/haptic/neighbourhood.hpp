// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "papilla/core/vec.hpp"

namespace papilla {

/// The triangles that a probe can touch as long as it stays within a ball, kept from tick to tick so that the tree is
/// not walked for every sweep. Filled by ContactSurface::gather(), read by ContactSurface::sweep().
///
/// Each triangle has a prism around it and its relief, in single precision and rounded outwards: its plane and a plane
/// through each edge. The distance to it is convex along a straight way, so its value and slope at the start tell, on
/// the safe side, that a short way can't touch the triangle. The numbers lie side by side in memory, so that a
/// processor takes several at once. Fixed size, 108 KiB; noexcept, no allocation.
class Neighbourhood {
 public:
  static constexpr std::uint32_t k_capacity = 1024;
  using Mask = std::array<std::int32_t, k_capacity>;

  /// Nothing is known any more.
  void clear() noexcept { reach_ = -1, count_ = 0; }
  /// Starts anew: all that comes within reach_m of `centre` is about to be added. Positions are those of the surface.
  void begin(Vec3 centre, double reach_m) noexcept;
  bool full(std::uint32_t more) const noexcept { return count_ + more > k_capacity; }
  /// @param place what place() will say of it. @param top how far its relief can stand out. There must be room.
  void add(const std::array<float, 3>& a, const std::array<float, 3>& b, const std::array<float, 3>& c, float top,
           std::uint32_t place) noexcept;
  /// Makes the prisms of what was added; call it once, at the end.
  void finish() noexcept;

  std::uint32_t count() const noexcept { return count_; }
  std::uint32_t place(std::uint32_t i) const noexcept { return place_[i]; }
  /// How far a probe may go from `from` in any direction so that all that it can touch is known; negative: not at all.
  double margin(Vec3 from) const noexcept { return reach_ - norm(from - centre_); }

  /// mask[i] != 0 for each triangle that may come nearer than `contact` to the way from..from + way.
  void near_way(Vec3 from, Vec3 way, double contact, Mask& mask) const noexcept;

 private:
  using Floats = std::array<float, k_capacity>;

  Vec3 centre_;                   // Of the ball.
  std::array<float, 3> frame_{};  // Near it: the origin of the coordinates below.
  double reach_ = -1;             // Radius of the ball for the probe's centre.
  std::uint32_t count_ = 0;
  std::array<Floats, 9> corner_{};  // a.x, a.y, a.z, b.x, ...
  Floats top_{};
  // |n·x − middle| <= thick and m[k]·x <= beyond[k]; n and m unit vectors, m[k] orthogonal to n.
  std::array<Floats, 3> n_{}, beyond_{};
  std::array<Floats, 9> m_{};
  Floats middle_{}, thick_{};
  std::array<std::uint32_t, k_capacity> place_{};
};

}  // namespace papilla
