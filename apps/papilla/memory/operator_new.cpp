// SPDX-License-Identifier: GPL-3.0-or-later
// Puts large blocks of memory on huge pages: the arrays of a mesh of millions of triangles are walked out of order, and
// with small pages a quarter of that time goes to page tables. Replaces the global operator new of a program that
// links this file; where the kernel offers no huge pages nothing changes. The large blocks freed last, 64 MiB of them,
// are handed out again, as the system clears what it gives; the others go back to it when they are freed: malloc would
// raise its limit for that to 32 MiB and keep what the tasks of a repair leave behind. What is smaller stays: a heap
// that shrinks and grows with every chart of a part would be cleared page by page each time. Cold arrays lie in a file
// once memory is short.
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "memory/spilled_memory.hpp"
#include "papilla/core/cold_arrays.hpp"

namespace {

constexpr std::size_t k_huge_page = std::size_t{2} << 20;
constexpr std::size_t k_large = 2 * k_huge_page;

const bool malloc_is_told = ::mallopt(M_MMAP_THRESHOLD, k_large) && ::mallopt(M_TRIM_THRESHOLD, 4 * k_large);

/// Freed blocks in the order they came, for those who want one of about their size.
class FreedBlocks {
 public:
  void* take(std::size_t size) noexcept {
    const std::lock_guard lock(mutex_);
    std::size_t best = count_;
    for (std::size_t i = 0; i < count_; ++i)
      if (blocks_[i].size >= size && blocks_[i].size <= size + size / 4 &&
          (best == count_ || blocks_[i].size < blocks_[best].size))
        best = i;
    return best < count_ ? remove(best) : nullptr;
  }

  void give(void* block, std::size_t size) noexcept {
    if (size > k_most_bytes) return std::free(block);
    const std::lock_guard lock(mutex_);
    while (count_ == blocks_.size() || bytes_ + size > k_most_bytes) std::free(remove(0));
    blocks_[count_++] = {block, size};
    bytes_ += size;
  }

  std::mutex& mutex() noexcept { return mutex_; }

 private:
  static constexpr std::size_t k_most_bytes = std::size_t{64} << 20;

  struct Block {
    void* start;
    std::size_t size;
  };

  void* remove(std::size_t i) noexcept {
    void* block = blocks_[i].start;
    bytes_ -= blocks_[i].size;
    for (--count_; i < count_; ++i) blocks_[i] = blocks_[i + 1];
    return block;
  }

  std::mutex mutex_;
  std::array<Block, k_most_bytes / k_large> blocks_{};
  std::size_t count_ = 0, bytes_ = 0;
};

constinit FreedBlocks freed_blocks;

/// Nobody is in the middle of it while the process is forked: a child has no other thread that would leave it.
const bool forks_between = ::pthread_atfork([] { freed_blocks.mutex().lock(); }, [] { freed_blocks.mutex().unlock(); },
                                            [] { freed_blocks.mutex().unlock(); }) == 0;

constexpr std::size_t k_mib = std::size_t{1} << 20;
constinit papilla::app::SpilledMemory spilled_memory({.begin_bytes = 128 * k_mib,
                                                      .resident_bytes = 320 * k_mib,
                                                      .least_block = 8192});

void* allocate(std::size_t size) noexcept {
  if (papilla::ColdArrays::any())
    if (void* block = spilled_memory.take(size)) return block;
  if (size < k_large) return std::malloc(size > 0 ? size : 1);
  const std::size_t whole = (size + k_huge_page - 1) / k_huge_page * k_huge_page;
  if (void* block = freed_blocks.take(whole)) return block;
  void* block = std::aligned_alloc(k_huge_page, whole);
  if (block) ::madvise(block, whole, MADV_HUGEPAGE);
  return block;
}

/// Only what allocate() aligned to huge pages is that large and starts where one does.
void release(void* block) noexcept {
  if (spilled_memory.owns(block)) return spilled_memory.give(block);
  const bool is_large = reinterpret_cast<std::uintptr_t>(block) % k_huge_page == 0 && block;
  if (is_large && ::malloc_usable_size(block) >= k_large)
    freed_blocks.give(block, ::malloc_usable_size(block) / k_huge_page * k_huge_page);
  else
    std::free(block);
}

void* allocate_or_throw(std::size_t size) {
  while (true) {
    if (void* block = allocate(size)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}

}  // namespace

void* operator new(std::size_t size) { return allocate_or_throw(size); }
void* operator new[](std::size_t size) { return allocate_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { release(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { release(block); }
