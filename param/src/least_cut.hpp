// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace papilla::param_detail {

/// What a label of each of two kinds costs an item; infinite: it can't have it.
struct LabelCost {
  double first = 0, second = 0;
};

/// Two items, and what it costs when their labels differ; not negative.
struct LabelPair {
  std::size_t a = 0, b = 0;
  double cost = 0;
};

/// Labels of least cost: minimises Σ of the items' costs and of the pairs whose labels differ, by a least cut
/// [Boykov and Kolmogorov, 2004]. @param items at least one of the costs of each is finite. @return per item: whether
/// it has the second label; of what costs the same, the second. Deterministic. Memory O(items + pairs); time most often
/// near to linear in these.
std::vector<char> least_cut(const std::vector<LabelCost>& items, const std::vector<LabelPair>& pairs);

}  // namespace papilla::param_detail
