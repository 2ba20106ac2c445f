// SPDX-License-Identifier: MIT
#include "large_array.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace papilla {
namespace {

constexpr std::size_t k_page = std::size_t{2} << 20;
constexpr std::size_t k_least = 2 * k_page;  // Below, rounding up to a page would waste too much.

}  // namespace

void* large_allocate(std::size_t bytes) {
  void* memory = nullptr;
  if (bytes < k_least) {
    memory = std::malloc(bytes);
  } else {
    memory = std::aligned_alloc(k_page, (bytes + k_page - 1) / k_page * k_page);
    if (memory != nullptr) ::madvise(memory, bytes, MADV_HUGEPAGE);  // Only a hint.
  }
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void large_free(void* memory) noexcept { std::free(memory); }

}  // namespace papilla
