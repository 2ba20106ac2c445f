// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "papilla/core/vec.hpp"

namespace papilla {

/// The triangles that a probe can touch as long as it stays within a ball, kept from tick to tick so that the tree is
/// not walked for every sweep. Filled by ContactSurface::gather(), read by ContactSurface::sweep().
///
/// Each triangle has a prism around it and its relief, in single precision and rounded outwards: its plane, a plane
/// through each edge, and a cylinder around its middle, which is tighter beyond a corner. The distance to it is convex
/// along a straight way, so its value and slope at the start tell, on the safe side, when a way can touch the triangle
/// and whether it can go deep enough into it. The numbers of sixteen lie side by side in memory, so that a processor
/// takes several at once. Fixed size, 73 KiB; noexcept, no allocation.
class Neighbourhood {
 public:
  static constexpr std::uint32_t k_capacity = 1024;  ///< Triangles.
  static constexpr std::uint32_t k_clusters = 64;
  static constexpr std::uint32_t k_lanes = 16;  ///< Triangles in a block.
  using Blocks = std::array<std::uint32_t, k_capacity / k_lanes>;

  /// Nothing is known any more.
  void clear() noexcept { begin({}, -1); }
  /// Starts anew: all that comes within reach_m of `centre` is about to be added. Positions are those of the surface.
  void begin(Vec3 centre, double reach_m) noexcept;
  /// @returns false, and adds nothing, when there is no room.
  bool add_cluster(std::uint32_t cluster) noexcept;
  /// @param place what place() will say of it. @param top how far its relief can stand out.
  /// @returns false, and adds nothing, when there is no room.
  bool add(const std::array<float, 3>& a, const std::array<float, 3>& b, const std::array<float, 3>& c, float top,
           std::uint32_t place) noexcept;
  /// Call it once, when all is added.
  void finish() noexcept;

  /// Leaves the clusters alone.
  void forget_triangles() noexcept { count_ = 0; }

  /// Numbers of the clusters of ContactSurface that come that near.
  std::span<const std::uint32_t> clusters() const noexcept { return {cluster_.data(), cluster_count_}; }
  std::uint32_t triangles() const noexcept { return count_; }
  /// Clusters are known, but their triangles are too many.
  bool is_crowded() const noexcept { return count_ == 0 && cluster_count_ > 0; }
  Vec3 centre() const noexcept { return centre_; }
  double reach_m() const noexcept { return reach_; }
  std::uint32_t place(std::uint32_t i) const noexcept { return place_[i]; }
  /// How far a probe may go from `from` in any direction so that all that it can touch is known; negative: not at all.
  double margin(Vec3 from) const noexcept { return reach_ - norm(from - centre_); }

  /// Notes how far the triangles are from `centre`, by blocks.
  void focus(Vec3 centre) noexcept;
  /// How far `from` is from the centre of the focus.
  double off_focus(Vec3 from) const noexcept { return norm(from - focus_centre_); }
  /// Numbers of the blocks that have triangles within `distance` of `from`, and maybe some more.
  std::uint32_t blocks(Vec3 from, double distance, Blocks& numbers) const noexcept;

  /// For the triangles of a block, side by side: no t before earliest[i] brings from + t·way nearer than `contact` to
  /// triangle i; 2 when no t up to 1 brings it `deep` nearer than that.
  void near_way(std::uint32_t block, Vec3 from, Vec3 way, double contact, double deep,
                std::array<float, k_lanes>& earliest) const noexcept;

 private:
  using Lanes = std::array<float, k_lanes>;
  struct Corners {
    std::array<Lanes, 9> x{};  // a.x, a.y, a.z, b.x, ...
    Lanes top{};
  };
  /// |n·x − middle| <= thick, m[k]·x <= beyond[k], and across n no farther than `radius` from `hub`; n and m unit
  /// vectors, m[k] orthogonal to n. One block of memory, that is read from end to end.
  struct alignas(64) Prisms {
    std::array<Lanes, 3> n{}, beyond{};
    std::array<Lanes, 9> m{};
    Lanes middle{}, thick{};
    std::array<Lanes, 3> hub{};
    Lanes radius{};
  };
  struct Loops;
  std::uint32_t block_count() const noexcept { return (count_ + k_lanes - 1) / k_lanes; }
  Vec3 in_frame(Vec3 p) const noexcept;

  Vec3 centre_;                   // Of the ball.
  std::array<float, 3> frame_{};  // Near it: the origin of the coordinates below.
  double reach_ = -1;             // Radius of the ball for the probe's centre.
  std::uint32_t count_ = 0, cluster_count_ = 0;
  Vec3 focus_centre_;
  std::array<float, k_capacity / k_lanes> least_{};  // Distance of each block from there, rounded down.
  Corners corners_{};                                // Of the last block, until it is full.
  std::array<Prisms, k_capacity / k_lanes> prisms_{};
  std::array<std::uint32_t, k_capacity> place_{};
  std::array<std::uint32_t, k_clusters> cluster_{};
};

}  // namespace papilla
