// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "papilla/texture/sample_rows.hpp"

namespace papilla::texture_detail {

/// A row and the rows above and below it: at open borders the row itself, in periodic pictures the row of the opposite
/// border.
struct RowWindow {
  const std::vector<float>&above, &row, &below;
};

/// Calls visit(y, RowWindow) for every row from the top down; every row is read once, the borders twice.
template <class Visit>
void visit_rows(const SampleRows& rows, bool periodic, const Visit& visit) {
  const int height = rows.height();
  const auto read = [&](int y, std::vector<float>& row) { rows.read(0, y, rows.width(), row.data()); };
  std::array<std::vector<float>, 3> window;
  for (std::vector<float>& row : window) row.resize(static_cast<std::size_t>(rows.width()));
  auto& [above, row, below] = window;
  read(periodic ? height - 1 : 0, above);
  read(0, row);
  for (int y = 0; y < height; ++y) {
    read(y + 1 < height ? y + 1 : periodic ? 0 : y, below);
    visit(y, RowWindow{above, row, below});
    std::swap(above, row);
    std::swap(row, below);
  }
}

}  // namespace papilla::texture_detail
