// SPDX-License-Identifier: GPL-3.0-or-later
// Puts large blocks of memory on huge pages: the arrays of a mesh of millions of triangles are walked out of order, and
// with small pages a quarter of that time goes to page tables. Replaces the global operator new of a program that
// links this file; where the kernel offers no huge pages nothing changes. Large blocks go back to the system when they
// are freed: malloc would raise its limit for that to 32 MiB and keep what the tasks of a repair leave behind. What is
// smaller stays: a heap that shrinks and grows with every chart of a part would be cleared page by page each time.
#include <malloc.h>
#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t k_huge_page = std::size_t{2} << 20;
constexpr std::size_t k_large = 2 * k_huge_page;

const bool malloc_is_told = ::mallopt(M_MMAP_THRESHOLD, k_large) && ::mallopt(M_TRIM_THRESHOLD, 4 * k_large);

void* allocate(std::size_t size) noexcept {
  if (size < k_large) return std::malloc(size > 0 ? size : 1);
  void* block = std::aligned_alloc(k_huge_page, (size + k_huge_page - 1) / k_huge_page * k_huge_page);
  if (block) ::madvise(block, size, MADV_HUGEPAGE);
  return block;
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
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { std::free(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { std::free(block); }
