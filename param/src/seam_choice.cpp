// SPDX-License-Identifier: MIT
#include "papilla/param/seam_choice.hpp"

#include <cmath>
#include <utility>

#include "map_descent.hpp"
#include "papilla/param/seam_visibility.hpp"
#include "rest_shape.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr double k_generous = 0.01, k_sparing = 0.1;

/// Distortion that is worth more seams: a fifth of the usual seam cost.
constexpr double k_much = 0.2 * k_usual_seam_cost;

/// Distortion that nobody sees: half a per cent of a length.
constexpr double k_invisible = 1e-4;

constexpr double k_power = 5;

/// Distortion that everyone sees, a tenth of a length: fewer seams that leave more than that have to be this much
/// better a bargain.
constexpr double k_plain = 0.1, k_much_better = 0.25;

SeamTrial judge(const TriangleMesh& mesh, const Flattening& flattening, double seam_cost) {
  SeamTrial trial;
  trial.seam_cost = seam_cost;
  trial.charts = flattening.charts.count;
  const double seam_mm = seam_visibility(mesh, flattening.uv).seam_mm;
  const std::vector<RestShape> rest = rest_shapes(mesh.positions, mesh.triangles);
  const SymmetricDirichlet energy(rest);
  double area = 0;
  for (const RestShape& r : rest) area += r.area;
  if (area > 0) {
    trial.distortion = total_energy({flattening.uv.indices, &energy}, flattening.uv.values) / area - 4;
    trial.seam = seam_mm / std::sqrt(area);
  }
  trial.price = (trial.distortion + k_invisible) * std::pow(1 + trial.seam, k_power);
  return trial;
}

}  // namespace

SeamChoice choose_seam_cost(const TriangleMesh& mesh, const MapForSeamCost& map) {
  SeamChoice choice;
  const auto try_cost = [&](double seam_cost) {
    Flattening flattening = map(seam_cost);
    const SeamTrial trial = judge(mesh, flattening, seam_cost);
    const bool is_plain = seam_cost > k_usual_seam_cost && trial.distortion > k_plain;
    const bool is_better =
        choice.trials.empty() || trial.price < (is_plain ? k_much_better : 1) * choice.trials[choice.chosen].price;
    if (is_better) {
      choice.chosen = choice.trials.size();
      choice.flattening = std::move(flattening);
    }
    choice.trials.push_back(trial);
    return is_better;
  };
  try_cost(k_usual_seam_cost);
  if (choice.trials.front().distortion > k_much && try_cost(k_generous)) return choice;
  try_cost(k_sparing);
  return choice;
}

}  // namespace papilla
