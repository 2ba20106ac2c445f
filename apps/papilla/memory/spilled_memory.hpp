// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace papilla::app {

/// When memory is spilled, and where to.
struct SpillLimits {
  std::size_t begin_bytes;       ///< Resident memory from which on blocks are taken from the file.
  std::size_t resident_bytes;    ///< Above it, pages of the file leave the process.
  std::size_t least_block;       ///< Smaller blocks stay in memory.
  const char* folder = nullptr;  ///< Of the file; null: $TMPDIR, or /var/tmp.
};

/// Blocks of memory that lie in a file without a name, for scenes larger than what a process shall take.
///
/// The file is mapped into memory: pages that were not looked at lately are taken out of the process when its resident
/// memory passes the limit, and come back, from the system's cache or the disk, when they are touched. So the data is
/// where it was, and the system, not this process, decides what of it stays in memory. The disk's space is reserved
/// before a block is handed out, so that a full disk means no block rather than a fault.
///
/// Nothing is done, and no file made, before the resident memory of the process passes the first limit. A block costs
/// O(log n) under one lock, pages cost a fault each when they come back. In a child process that was forked, blocks
/// stay readable and become private; none is handed out there.
class SpilledMemory {
 public:
  constexpr explicit SpilledMemory(const SpillLimits& limits) : limits_(limits) {}
  SpilledMemory(const SpilledMemory&) = delete;
  SpilledMemory& operator=(const SpilledMemory&) = delete;

  /// A block of 16-byte alignment; null when memory is not short, the size too small, or the disk has no space for it.
  void* take(std::size_t size) noexcept {
    if (size < limits_.least_block) return nullptr;
    if (!active_.load(std::memory_order_relaxed) && !becomes_active(size)) return nullptr;
    return take_from_file(size);
  }

  bool owns(const void* block) const noexcept {
    const auto start = reinterpret_cast<std::uintptr_t>(base_.load(std::memory_order_relaxed));
    return start != 0 && reinterpret_cast<std::uintptr_t>(block) - start < reserved_.load(std::memory_order_relaxed);
  }

  /// @param block  of take().
  void give(void* block) noexcept;

  /// Bytes of the disk that the file has now.
  std::size_t file_bytes() const noexcept;

 private:
  static constexpr std::size_t k_segment = std::size_t{64} << 20;
  static constexpr std::size_t k_segments = 4096;
  static constexpr std::size_t k_reserved = k_segment * k_segments;

  /// A heap, or the first of `run` segments of one block; run 0: unused.
  struct Segment {
    std::uint16_t run = 0;
    bool is_heap = false;
    std::size_t refused = SIZE_MAX;  ///< A heap has no place for blocks of this size.
  };

  bool becomes_active(std::size_t size) noexcept;
  bool open_file() noexcept;
  void* take_from_file(std::size_t size) noexcept;
  void* take_from_heaps(std::size_t size) noexcept;
  std::size_t unused_run(std::size_t run) const noexcept;
  bool map(std::size_t first, std::size_t run, bool is_heap) noexcept;
  void unmap(std::size_t first) noexcept;
  std::byte* at(std::size_t segment) const noexcept {
    return base_.load(std::memory_order_relaxed) + segment * k_segment;
  }
  void watch() noexcept;
  void trim() noexcept;
  void make_private() noexcept;
  static void before_fork() noexcept;
  static void after_fork_in_parent() noexcept;
  static void after_fork_in_child() noexcept;

  SpillLimits limits_;
  std::atomic<bool> active_{false}, never_{false};
  std::atomic<std::size_t> unchecked_bytes_{0};
  std::atomic<std::byte*> base_{nullptr};
  std::atomic<std::size_t> reserved_{k_reserved};  ///< Of addresses, from base_ on.
  int file_ = -1;
  mutable std::mutex mutex_;
  std::array<Segment, k_segments> segments_{};
  std::size_t limit_ = 0;                ///< Of resident memory, now.
  std::size_t next_ = 0;                 ///< Segment that is taken out next.
  std::size_t used_ = 0;                 ///< Segments from there on were never used.
  std::size_t empty_heap_ = k_segments;  ///< One is kept when its last block goes.
};

}  // namespace papilla::app
