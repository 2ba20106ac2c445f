// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluate/extreme_pictures.hpp"
#include "evaluate/suite.hpp"
#include "papilla/texture/feature_matrix.hpp"
#include "papilla/texture/lattice.hpp"

namespace papilla {
namespace {

struct Method {
  const char* name;
  FeatureMatrix (*matrix)(const GreyImage&);
  LatticeMethod lattice;
};
constexpr std::array<Method, 3> k_methods = {
    {{"squared, best", feature_matrix, LatticeMethod::best},
     {"squared, projection", feature_matrix, LatticeMethod::projection},
     {"absolute, best", [](const GreyImage& image) { return absolute_feature_matrix(image); }, LatticeMethod::best}}};

void measure_lattice(const Method& method, const NamedPicture& input, StabilityCell& cell) {
  LatticeOptions options;
  options.method = method.lattice;
  const Lattice found = find_lattice(method.matrix(input.picture), options);
  cell.residual = found.significance;
  cell.note = found.reason;
  if (!input.period_px) return;
  const double period = *input.period_px;
  if (period <= 0) {
    if (found.found) cell.outcome = Outcome::breaks;
    return;
  }
  if (!found.found) {
    cell.outcome = Outcome::fails;
    return;
  }
  cell.error = std::max(std::abs(norm(found.vectors_px[0]) - period), std::abs(norm(found.vectors_px[1]) - period));
  if (*cell.error > 0.5) cell.outcome = Outcome::breaks;
}

}  // namespace

StabilitySuite lattice_stability(const StabilityRun& run) {
  StabilitySuite suite{
      "lattice", "Lattice", "largest error of a lattice vector's length in pixels", "significance of the lattice", {}};
  fill_suite(suite, run, extreme_pictures(), k_methods, measure_lattice);
  return suite;
}

}  // namespace papilla
