// SPDX-License-Identifier: MIT
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace papilla::param_detail {

/// Triangles or vertices that one thread works through at a time.
inline constexpr std::size_t k_chunk = 4096;

/// Calls body(chunk, begin, end) for all parts of [0, count), in parallel when there are several.
template <class Body>
void for_chunks(std::size_t count, Body body) {
  const std::size_t chunks = (count + k_chunk - 1) / k_chunk;
  const auto run = [&](std::size_t chunk) { body(chunk, chunk * k_chunk, std::min(count, (chunk + 1) * k_chunk)); };
  if (chunks == 1)
    run(0);
  else
    oneapi::tbb::parallel_for(std::size_t{0}, chunks, run);
}

/// Sums term(i), a number or a vector, in an order that depends on nothing but `count`.
template <class Term>
auto sum_over(std::size_t count, Term term) {
  using Sum = decltype(term(std::size_t{0}));
  std::vector<Sum> sums((count + k_chunk - 1) / k_chunk, Sum{});
  for_chunks(count, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Sum sum{};
    for (std::size_t i = begin; i < end; ++i) sum = sum + term(i);
    sums[chunk] = sum;
  });
  Sum sum{};
  for (const Sum& s : sums) sum = sum + s;
  return sum;
}

/// The least term(i); infinite when there is none.
template <class Term>
double least_over(std::size_t count, Term term) {
  std::vector<double> least((count + k_chunk - 1) / k_chunk, std::numeric_limits<double>::infinity());
  for_chunks(count, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) least[chunk] = std::min(least[chunk], term(i));
  });
  double result = std::numeric_limits<double>::infinity();
  for (const double l : least) result = std::min(result, l);
  return result;
}

}  // namespace papilla::param_detail
