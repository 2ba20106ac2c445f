// SPDX-License-Identifier: MIT
// Puts large blocks on huge pages, where the kernel has some, and gives them back to it when they are freed: a scene of
// millions of triangles is read and left behind before the loop locks what is there into memory. Replaces the global
// operator new of the player.
#include <malloc.h>
#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t k_huge_page = std::size_t{2} << 20;
constexpr std::size_t k_large = 2 * k_huge_page;

// A fixed limit: malloc raises its own with every large block that is freed, and keeps the next ones.
const bool malloc_is_told = ::mallopt(M_MMAP_THRESHOLD, k_large) != 0;

}  // namespace

void* operator new(std::size_t size) {
  void* block = size < k_large ? std::malloc(size > 0 ? size : 1)
                               : std::aligned_alloc(k_huge_page, (size + k_huge_page - 1) / k_huge_page * k_huge_page);
  if (block == nullptr) throw std::bad_alloc();
  if (size >= k_large) ::madvise(block, size, MADV_HUGEPAGE);  // Only a hint.
  return block;
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
