// SPDX-License-Identifier: MIT
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace papilla::param_detail {

struct FreeArray {
  void operator()(void* array) const noexcept { std::free(array); }
};

/// Numbers without a value yet, for solvers. A large one lies on pages of 2 MiB where the system has such: it clears
/// what it gives page by page, and a factorization of 100,000 unknowns would wait as long for that as it computes.
template <class Scalar>
using LargeArray = std::unique_ptr<Scalar[], FreeArray>;

/// @throws std::bad_alloc. Cost: none until it is written to.
template <class Scalar>
LargeArray<Scalar> make_large_array(std::size_t size) {
  constexpr std::size_t k_page = std::size_t{2} << 20;
  const std::size_t bytes = size * sizeof(Scalar), whole = (bytes + k_page - 1) / k_page * k_page;
  const bool is_large = bytes >= 2 * k_page;
  void* array = is_large ? std::aligned_alloc(k_page, whole) : std::malloc(bytes);
  if (array == nullptr && size > 0) throw std::bad_alloc();
  if (is_large) ::madvise(array, whole, MADV_HUGEPAGE);  // Only a hint.
  return LargeArray<Scalar>(static_cast<Scalar*>(array));
}

}  // namespace papilla::param_detail
