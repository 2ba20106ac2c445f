// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "bvh.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {

/// A cache of the triangles that a probe can touch inside a ball, kept from tick to tick, so that sweeps do not search
/// the tree. Filled by ContactTriangles::gather() and read by ContactTriangles::sweep(), which adds the prisms.
///
/// Triangles come in blocks of sixteen neighbours. The boxes of all blocks near the ball are stored. The prisms of a
/// block are made when a segment comes near its box for the first time, and stay in a ring buffer when the ball moves:
/// a moving probe needs a new block now and then, so the work is spread over the ticks. A block with prisms has an
/// oriented box, which is tighter because blocks are flat.
///
/// The prism of a triangle encloses it and its relief, in single precision and rounded outwards: its plane, a plane
/// through each edge, and the two ends of its longest edge, which are tighter beyond a sharp corner. The distance to a
/// prism is convex along a segment, so its values and slopes bound from below when the segment can touch the triangle,
/// and tell when it can never enter deep enough. The data of sixteen triangles is interleaved for SIMD.
/// Fixed size, 220 KiB; noexcept, no allocation.
class Neighbourhood {
 public:
  static constexpr std::uint32_t k_lanes = 16;    ///< Triangles in a block.
  static constexpr std::uint32_t k_blocks = 512;  ///< Boxes.
  static constexpr std::uint32_t k_made = 128;    ///< Blocks with prisms.
  static constexpr std::uint32_t k_together = 8;  ///< Blocks per call of bound_contacts().
  using Lanes = std::array<float, k_lanes>;
  using Numbers = std::array<std::uint16_t, k_blocks>;
  using Distances = std::array<float, k_blocks>;
  /// Triangles of a block relative to an origin.
  struct Corners {
    std::array<Lanes, 9> x;  ///< a.x, a.y, a.z, b.x, ...
    Lanes top;               ///< Upper bound of the relief.
  };

  Neighbourhood() noexcept { clear(); }
  /// Drops boxes and prisms. Needed before use with another surface.
  void clear() noexcept;
  /// Drops the boxes; prisms stay.
  void clear_boxes() noexcept { begin({}, -1); }
  /// Drops the boxes and sets the ball, before its blocks are added. Positions are relative to the surface's origin.
  void begin(Vec3 centre, double reach_m) noexcept;
  bool full() const noexcept { return count_ == k_blocks; }
  /// @param block its index in the clusters. Precondition: !full().
  void add(std::uint32_t block, const Box3f& box) noexcept;
  /// Adds a block that has prisms, with its oriented box. @returns false, and adds nothing, when it has none.
  bool add_known(std::uint32_t block) noexcept;

  std::uint32_t blocks() const noexcept { return count_; }
  std::uint32_t block(std::uint32_t i) const noexcept { return block_[i]; }
  /// How far a probe at `from` may move in any direction inside the ball; negative when it is outside.
  double margin(Vec3 from) const noexcept { return reach_ - norm(from - centre_); }

  /// Blocks whose boxes may be within `distance` > 0 of the segment from + t·way, t ∈ [0, 1].
  /// @returns their number.
  std::uint32_t along(Vec3 from, Vec3 way, double distance, Numbers& found) const noexcept;

  /// Blocks whose boxes may be nearer to x than `distance`; least[i] is a lower bound of the distance of found[i].
  /// @returns their number.
  std::uint32_t around(Vec3 x, double distance, Numbers& found, Distances& least) const noexcept;

  bool has_prisms(std::uint32_t i) const noexcept { return made_[slot(i)] == block_[i]; }
  /// Makes the prisms of block i. @param origin of the corners, near them. All lanes are filled.
  void make(std::uint32_t i, const std::array<float, 3>& origin, const Corners& corners) noexcept;

  /// Lower bounds of the distance of `from` to the triangles of a block with prisms.
  /// @returns a bit for each triangle that may be nearer than `distance`.
  std::uint32_t distances(std::uint32_t i, Vec3 from, double distance, Lanes& least) const noexcept;

  /// Lower bounds of the contact parameters in a few blocks, and a bit for each triangle that may be touched.
  struct ContactBounds {
    std::array<std::uint16_t, k_together> block;
    std::uint32_t count = 0;
    std::array<std::uint32_t, k_together> met;
    std::array<Lanes, k_together> earliest;
  };
  /// Bounds the contacts with the triangles of the given blocks, which must have prisms: for no t in [since,
  /// earliest[k]) is from + t·way nearer than `contact` to triangle k. earliest[k] is 2 when it is shown that no t up
  /// to 1 is nearer than `contact` − `deep`, which is looked into closely where several may be touched. The bits in
  /// `met` include every triangle with earliest[k] ≤ `until`. Several blocks are taken at once because their dependency
  /// chains overlap.
  void bound_contacts(Vec3 from, Vec3 way, double contact, double deep, double since, double until,
                      ContactBounds& bounds) const noexcept;

 private:
  static constexpr std::uint32_t k_no_block = 0xffffffffU;
  static constexpr std::uint32_t k_remembered = 1024;  // Enough that blocks of one neighbourhood seldom collide.
  /// |n·x − middle| <= thick, m[k]·x <= beyond[k], |e·x − halfway| <= half; n, m and e unit vectors, m[k] and e
  /// orthogonal to n. Contiguous, read from end to end.
  struct alignas(64) Prisms {
    std::array<Lanes, 3> n{}, beyond{};
    std::array<Lanes, 9> m{};
    Lanes middle{}, thick{};
    std::array<Lanes, 3> e{};
    Lanes halfway{}, half{};
  };
  /// |axis_k · (x − centre)| <= half_k. Axis-aligned until the prisms are made, then oriented.
  struct Box {
    std::array<float, 3> centre{}, half{};
    std::array<float, 9> axis{1, 0, 0, 0, 1, 0, 0, 0, 1};
  };
  struct alignas(64) Boxes {
    std::array<Lanes, 3> centre{}, half{};
    std::array<Lanes, 9> axis{};
  };
  struct Loops;

  /// Index of the prisms of block i, if there are any.
  std::uint32_t slot(std::uint32_t i) const noexcept { return slots_[block_[i] % k_remembered]; }
  void set_box(std::uint32_t i, const Box& box) noexcept;

  Vec3 centre_;        // Of the ball.
  double reach_ = -1;  // Radius of the ball of the probe's centre.
  std::uint32_t count_ = 0;
  std::array<Boxes, k_blocks / k_lanes> boxes_{};
  std::array<std::uint32_t, k_blocks> block_{};

  std::uint32_t next_ = 0;                           // Ring buffer: the oldest slot is used next.
  std::array<std::uint32_t, k_made> made_{};         // Block in each slot.
  std::array<std::uint16_t, k_remembered> slots_{};  // By block % k_remembered; the newest on collision.
  std::array<std::array<float, 3>, k_made> origin_{};
  std::array<Prisms, k_made> prisms_{};
  std::array<Box, k_made> made_box_{};
};

}  // namespace papilla
