// SPDX-License-Identifier: MIT
#include "papilla/pipeline/grain_doubts.hpp"

#include <fmt/format.h>

#include <cmath>

namespace papilla {
namespace {

/// What is near to a share of the variance at which classify() takes another class.
constexpr double k_near = 0.05;

bool is_near(double share, double threshold) { return std::abs(share - threshold) < k_near; }

}  // namespace

std::vector<std::string> grain_doubts(const MaterialRule& rule, const Grain& grain) {
  std::vector<std::string> doubts;
  const TextureClass& kind = grain.kind;
  const bool is_picture = !grain.plan.empty();
  if (is_picture &&
      (is_near(kind.strongly_ordered, k_strong_share) || is_near(kind.strongly_ordered, k_composite_share)))
    doubts.push_back(fmt::format("class: {:.0f} % of the variance repeats, near where another class begins",
                                 100 * kind.strongly_ordered));
  if (is_picture && !grain.lattice && kind.strongly_ordered >= k_composite_share)
    doubts.push_back("lattice: there is order, but no lattice was found");
  if (is_picture && !rule.height.depth_mm && !grain.height.stereo)
    doubts.push_back(fmt::format("depth: one photograph does not say it; {:.3g} mm are 1 % of the shorter side",
                                 grain.height.depth_mm));
  if (grain.height.light && grain.height.light_estimated && !grain.height.stereo)
    doubts.push_back("light: its direction is estimated; from the opposite side bumps would be hollows");
  if (is_picture && !grain.roughness.fractal && !grain.roughness.reason.empty())
    doubts.push_back("roughness: " + grain.roughness.reason);
  doubts.insert(doubts.end(), grain.warnings.begin(), grain.warnings.end());
  return doubts;
}

}  // namespace papilla
