// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/bvh.hpp"

namespace papilla {

/// What a probe can touch as long as it stays within a ball, kept from tick to tick so that the tree is not walked for
/// every sweep. Filled by ContactSurface::gather(), read and completed by ContactSurface::sweep().
///
/// Triangles come in blocks of sixteen that lie together. Of all blocks around the ball the boxes are known. The
/// triangles of a block are taken in when a way comes near its box for the first time, and stay, also when the ball is
/// moved on, until newer ones need the room: a probe on its way meets a new block now and then, so that the work comes
/// in small pieces and none of it in vain. From then on its box is one of its own direction: blocks are flat.
///
/// Each triangle has a prism around it and its relief, in single precision and rounded outwards: its plane, a plane
/// through each edge, and the two ends of its longest edge, which are tighter beyond a sharp corner. The distance to it
/// is convex along a straight way, so its values and slopes tell, on the safe side, when a way can touch the
/// triangle and whether it can go deep enough into it. The numbers of sixteen lie side by side in memory, so that a
/// processor takes several at once. Fixed size, 220 KiB; noexcept, no allocation.
class Neighbourhood {
 public:
  static constexpr std::uint32_t k_lanes = 16;    ///< Triangles in a block.
  static constexpr std::uint32_t k_blocks = 512;  ///< Boxes.
  static constexpr std::uint32_t k_made = 128;    ///< Blocks with prisms.
  static constexpr std::uint32_t k_together = 8;  ///< Blocks that near_way() looks at at once.
  using Lanes = std::array<float, k_lanes>;
  using Numbers = std::array<std::uint16_t, k_blocks>;
  using Distances = std::array<float, k_blocks>;
  /// Triangles of a block around an origin.
  struct Corners {
    std::array<Lanes, 9> x;  ///< a.x, a.y, a.z, b.x, ...
    Lanes top;               ///< How far the relief can stand out.
  };

  Neighbourhood() noexcept { clear(); }
  /// Nothing is known any more. Needed before it is used with another surface.
  void clear() noexcept;
  /// The same, but prisms stay.
  void forget_place() noexcept { begin({}, -1); }
  /// Starts anew: all that comes within reach_m of `centre` is about to be added. Positions are those of the surface.
  void begin(Vec3 centre, double reach_m) noexcept;
  bool full() const noexcept { return count_ == k_blocks; }
  /// @param block its number, the same for ever. Not when full().
  void add(std::uint32_t block, const Box3f& box) noexcept;
  /// Adds a block whose prisms are made, in the box that is known of it. @returns false, and adds nothing, of others.
  bool add_made(std::uint32_t block) noexcept;

  std::uint32_t blocks() const noexcept { return count_; }
  std::uint32_t block(std::uint32_t i) const noexcept { return block_[i]; }
  /// How far a probe may go from `from` in any direction so that all that it can touch is known; negative: not at all.
  double margin(Vec3 from) const noexcept { return reach_ - norm(from - centre_); }

  /// Which blocks have boxes within `distance` > 0 of the points from + t·way, t ∈ [0, 1], and some more.
  /// @returns how many.
  std::uint32_t along(Vec3 from, Vec3 way, double distance, Numbers& found) const noexcept;

  /// Which blocks have boxes nearer to x than `distance`, in least[i] how far the box of found[i] is at least.
  /// @returns how many.
  std::uint32_t around(Vec3 x, double distance, Numbers& found, Distances& least) const noexcept;

  bool is_made(std::uint32_t i) const noexcept { return made_[slot(i)] == block_[i]; }
  /// Makes the prisms of block i. @param origin what the corners are relative to, near them. All lanes are filled.
  void make(std::uint32_t i, const std::array<float, 3>& origin, const Corners& corners) noexcept;

  /// How far `from` is at least from each triangle of a block that is made.
  /// @returns a bit for each that may be nearer than `distance`.
  std::uint32_t distances(std::uint32_t i, Vec3 from, double distance, Lanes& least) const noexcept;

  /// What a way meets in each of a few blocks: a bit for each triangle that may be met, and from when on at the
  /// earliest.
  struct Meetings {
    std::array<std::uint16_t, k_together> block;
    std::uint32_t count = 0;
    std::array<std::uint32_t, k_together> met;
    std::array<Lanes, k_together> earliest;
  };
  /// For the triangles of the given blocks, all of them made: no t from `since` on and before earliest[k] brings
  /// from + t·way nearer than `contact` to triangle k; 2 when none up to 1 brings it `deep` nearer than that. Met are
  /// those with earliest[k] up to `until`, and maybe some more. The arithmetic of a block is a long chain; those of
  /// several overlap.
  void near_way(Vec3 from, Vec3 way, double contact, double deep, double since, double until,
                Meetings& meetings) const noexcept;

 private:
  static constexpr std::uint32_t k_no_block = 0xffffffffU;
  static constexpr std::uint32_t k_remembered = 1024;  // Enough that two blocks of a place seldom meet.
  /// |n·x − middle| <= thick, m[k]·x <= beyond[k], |e·x − halfway| <= half; n, m and e unit vectors, m[k] and e
  /// orthogonal to n. One block of memory, that is read from end to end.
  struct alignas(64) Prisms {
    std::array<Lanes, 3> n{}, beyond{};
    std::array<Lanes, 9> m{};
    Lanes middle{}, thick{};
    std::array<Lanes, 3> e{};
    Lanes halfway{}, half{};
  };
  /// |axis_k · (x − centre)| <= half_k. Along the frame's axes, until the prisms are made and tell better ones: blocks
  /// are flat.
  struct Box {
    std::array<float, 3> centre{}, half{};
    std::array<float, 9> axis{1, 0, 0, 0, 1, 0, 0, 0, 1};
  };
  struct alignas(64) Boxes {
    std::array<Lanes, 3> centre{}, half{};
    std::array<Lanes, 9> axis{};
  };
  struct Loops;

  /// Where the prisms of block i stand, if they are made.
  std::uint32_t slot(std::uint32_t i) const noexcept { return slots_[block_[i] % k_remembered]; }
  void set_box(std::uint32_t i, const Box& box) noexcept;

  Vec3 centre_;        // Of the ball.
  double reach_ = -1;  // Radius of the ball for the probe's centre.
  std::uint32_t count_ = 0;
  std::array<Boxes, k_blocks / k_lanes> boxes_{};
  std::array<std::uint32_t, k_blocks> block_{};

  std::uint32_t next_ = 0;                           // The slot to be used next: the oldest.
  std::array<std::uint32_t, k_made> made_{};         // Block in each slot.
  std::array<std::uint16_t, k_remembered> slots_{};  // By the last digits of a block; of several the last made.
  std::array<std::array<float, 3>, k_made> origin_{};
  std::array<Prisms, k_made> prisms_{};
  std::array<Box, k_made> made_box_{};
};

}  // namespace papilla
