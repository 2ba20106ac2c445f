// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace papilla {

/// Memory on huge pages where the system grants them, so that scattered reads miss the TLB less often.
/// @throws std::bad_alloc.
void* large_allocate(std::size_t bytes);
void large_free(void* memory) noexcept;

/// For arrays with scattered reads.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() noexcept = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) noexcept {}
  T* allocate(std::size_t count) { return static_cast<T*>(large_allocate(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { large_free(memory); }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) noexcept { return true; }
};

template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace papilla
