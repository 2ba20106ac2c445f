// SPDX-License-Identifier: MIT
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <complex>

#include "lscm_solvers.hpp"

namespace papilla::param_detail {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;
using Vector = Eigen::Matrix<Complex, Eigen::Dynamic, 1>;

/// Doubled areas are not taken below this fraction of the longest edge squared: the energy of a triangle
/// grows with its inverse, and one without area must not outweigh all others.
constexpr double k_least_area = 1e-7;

/// The triangle's edges opposite to its corners, in an orthonormal frame of its plane, divided by √(2 · doubled area).
std::array<Complex, 3> weighted_edges(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 p = b - a, q = c - a;
  const double length = norm(p);
  const double along = length > 0 ? dot(p, q) / length : norm(q);
  const double height = length > 0 ? norm(cross(p, q)) / length : 0;
  const double longest = std::max({dot(p, p), dot(q, q), dot(c - b, c - b)});
  if (longest == 0) return {};
  const double weight = 1 / std::sqrt(2 * std::max(length * height, k_least_area * longest));
  const Complex z1(0, 0), z2(length, 0), z3(along, height);
  return {weight * (z3 - z2), weight * (z1 - z3), weight * (z2 - z1)};
}

/// Two vertices of the border that are far apart: the farthest from the first one, and the farthest from that.
std::pair<Index, Index> choose_pins(const ChartSurface& chart, const std::vector<Index>& border) {
  const auto farthest = [&](Index from) {
    return *std::max_element(border.begin(), border.end(), [&](Index x, Index y) {
      const Vec3 p = chart.positions[x] - chart.positions[from], q = chart.positions[y] - chart.positions[from];
      return dot(p, p) < dot(q, q);
    });
  };
  const Index first = farthest(border.front());
  return {first, farthest(first)};
}

struct System {
  Matrix matrix;  ///< Lower half.
  Vector right;
};

/// The normal equations Wᴴ W over the free vertices; pinned ones move to the right side.
System assemble(const ChartSurface& chart, const std::vector<int>& row, const std::vector<Complex>& pinned, int free) {
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(6 * chart.triangles.size());
  System system{Matrix(free, free), Vector::Zero(free)};
  for (const Triangle& t : chart.triangles) {
    const auto w = weighted_edges(chart.positions[t[0]], chart.positions[t[1]], chart.positions[t[2]]);
    for (std::size_t i = 0; i < 3; ++i) {
      if (row[t[i]] < 0) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        const Complex entry = std::conj(w[i]) * w[j];
        if (row[t[j]] < 0)
          system.right[row[t[i]]] -= entry * pinned[t[j]];
        else if (row[t[j]] <= row[t[i]])
          entries.emplace_back(row[t[i]], row[t[j]], entry);
      }
    }
  }
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace

ConformalMap solve_lscm_hermitian(const ChartSurface& chart) {
  const auto [first, second] = choose_pins(chart, border_loops(chart).front());
  const double distance = norm(chart.positions[second] - chart.positions[first]);
  if (!(distance > 0)) return {{}, "the border is a single point"};
  std::vector<Complex> pinned(chart.positions.size(), 0);
  pinned[second] = distance;
  std::vector<int> row(chart.positions.size());
  int free = 0;
  for (Index v = 0; v < row.size(); ++v) row[v] = v == first || v == second ? -1 : free++;

  const System system = assemble(chart, row, pinned, free);
  const Eigen::SimplicialLDLT<Matrix> factor(system.matrix);
  if (factor.info() != Eigen::Success) return {{}, "the Hermitian system is singular"};
  const Vector solution = factor.solve(system.right);

  ConformalMap map;
  map.uv.resize(chart.positions.size());
  for (std::size_t v = 0; v < row.size(); ++v) {
    const Complex z = row[v] < 0 ? pinned[v] : solution[row[v]];
    map.uv[v] = {z.real(), z.imag()};
  }
  return map;
}

}  // namespace papilla::param_detail
