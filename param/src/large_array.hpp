// SPDX-License-Identifier: MIT
#pragma once

#include <oneapi/tbb/scalable_allocator.h>
#include <sys/mman.h>

#include <bit>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace papilla::param_detail {

/// Frees an array of make_large_array().
class FreeArray {
 public:
  explicit FreeArray(bool is_kept = true) : is_kept_(is_kept) {}
  void operator()(void* array) const noexcept { is_kept_ ? scalable_free(array) : std::free(array); }

 private:
  bool is_kept_;  ///< By the allocator, for the next array.
};

/// Numbers without a value yet, for solvers. The system clears what it gives page by page, and a factorization would
/// wait as long for that as it computes: the memory of small arrays is kept for the next ones by TBB's allocator, which
/// a chart that is mapped again and again needs; large ones lie on pages of 2 MiB where the system has such.
template <class Scalar>
using LargeArray = std::unique_ptr<Scalar[], FreeArray>;

/// @throws std::bad_alloc. Cost: none until it is written to.
template <class Scalar>
LargeArray<Scalar> make_large_array(std::size_t size) {
  constexpr std::size_t k_page = std::size_t{2} << 20;
  const std::size_t bytes = size * sizeof(Scalar), whole = (bytes + k_page - 1) / k_page * k_page;
  const bool is_large = bytes >= 2 * k_page;
  void* array = is_large ? std::aligned_alloc(k_page, whole) : scalable_malloc(std::bit_ceil(bytes));
  if (array == nullptr && size > 0) throw std::bad_alloc();
  if (is_large) ::madvise(array, whole, MADV_HUGEPAGE);  // Only a hint.
  return LargeArray<Scalar>(static_cast<Scalar*>(array), FreeArray(!is_large));
}

}  // namespace papilla::param_detail
