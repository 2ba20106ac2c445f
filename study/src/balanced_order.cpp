// SPDX-License-Identifier: MIT
#include "papilla/study/balanced_order.hpp"

#include <algorithm>

namespace papilla {

std::vector<std::size_t> balanced_order(std::size_t n, std::size_t row) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < n; ++i) order.push_back(((i % 2 == 1 ? (i + 1) / 2 : n - i / 2) + row) % n);
  if (n % 2 == 1 && row / n % 2 == 1) std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace papilla
