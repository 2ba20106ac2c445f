// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilla/param/flattening.hpp"

namespace papilla {

/// Charts and map of a part for one seam cost, as judged by choose_seam_cost().
struct SeamTrial {
  double seam_cost = 0;
  std::uint32_t charts = 0;
  double seam = 0;        ///< S: length of the edges at which uv jump, over the root of the area.
  double distortion = 0;  ///< D: area mean of σ1² + σ2² + σ1⁻² + σ2⁻² - 4; infinite where triangles are flipped.
  double price = 0;       ///< P.
};

struct SeamChoice {
  Flattening flattening;          ///< Of the cheapest trial.
  std::size_t chosen = 0;         ///< Its place among the trials.
  std::vector<SeamTrial> trials;  ///< In the order of the calls.
};

/// Charts and maps a part for a seam cost; called two or three times, one after the other.
using MapForSeamCost = std::function<Flattening(double seam_cost)>;

/// What is tried first: the default of SegmentationOptions.
inline constexpr double k_usual_seam_cost = 0.03;

/// Charts a part two or three times and keeps the best bargain. One seam cost does not suit every shape: on a torus, a
/// few more seams take off four fifths of the distortion; on a dashboard that is nearly developable any seam is one too
/// many. On a scan with small features more seams hardly lower what distorts most, and fewer are the better bargain,
/// too. The second trial has the seam cost 0.01 where the first one leaves D above 0.006, and 0.1 elsewhere; where 0.01
/// is no better, a third one has 0.1. The trial of smallest price
///     P = (D + 1e-4) (1 + S)⁵
/// is kept, the first one at equality, one of fewer seams with a D above 0.1 only when P is below a quarter: one per
/// cent more of 1 + S has to take off five per cent of the distortion, and distortion below 1e-4 counts for nothing. D
/// and S, lengths over the root of the area, have no unit. Cost: that of two or three maps and O(n). Deterministic when
/// `map` is.
/// @throws what `map` throws, and InvalidInput when its uv do not fit the mesh.
SeamChoice choose_seam_cost(const TriangleMesh& mesh, const MapForSeamCost& map);

}  // namespace papilla
