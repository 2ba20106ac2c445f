// SPDX-License-Identifier: MIT
#include "levy_conformal.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "disk_chart.hpp"
#include "rest_shape.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {
namespace {

using Complex = std::complex<double>;

constexpr Index k_pinned = ~Index{0};

/// Solves of inverse iteration: the second smallest eigenvalue is far from the third.
constexpr int k_solves = 3;

/// Keeps the constant map, which costs nothing, from being singular; in units of the chart's area 1.
constexpr double k_anchor = 1e-8;

/// The conditions as complex rows: those of triangles, then of smoothness, then of length.
class Rows {
 public:
  struct Row {
    std::vector<Index> vertex;
    std::vector<Complex> coefficient;
  };

  Rows(const ChartSurface& chart, const ConformalTerms& terms)
      : chart_(chart), terms_(terms), rest_(rest_shapes(chart.positions, chart.triangles)) {}

  const std::vector<RestShape>& rest() const { return rest_; }
  std::size_t count() const {
    return rest_.size() + (terms_.smoothness > 0 ? terms_.smoothness_rows->count() : 0) +
           (terms_.length > 0 ? terms_.length_rows->count() : 0);
  }

  void get(std::size_t r, Row& row) const {
    row.vertex.clear(), row.coefficient.clear();
    if (r < rest_.size()) {
      // ∂u/∂x - ∂v/∂y + i (∂u/∂y + ∂v/∂x) = (∂/∂x + i ∂/∂y)(u + iv)
      const CornerFactors f = corner_factors(rest_[r]);
      const double weight = std::sqrt(terms_.conformality * rest_[r].area);
      for (std::size_t k = 0; k < 3; ++k) {
        row.vertex.push_back(chart_.triangles[r][k]);
        row.coefficient.push_back(weight * Complex(f[k][0], f[k][1]));
      }
      return;
    }
    r -= rest_.size();
    if (terms_.smoothness > 0) {
      if (r < terms_.smoothness_rows->count()) return copy(*terms_.smoothness_rows, r, terms_.smoothness, row);
      r -= terms_.smoothness_rows->count();
    }
    copy(*terms_.length_rows, r, terms_.length, row);
  }

 private:
  static void copy(const LinearRows& rows, std::size_t r, double weight, Row& row) {
    for (Index i = rows.first[r]; i < rows.first[r + 1]; ++i) {
      row.vertex.push_back(rows.vertex[i]);
      row.coefficient.push_back(std::sqrt(weight) * rows.coefficient[i]);
    }
  }

  const ChartSurface& chart_;
  const ConformalTerms& terms_;
  std::vector<RestShape> rest_;
};

/// A third of the area of its triangles for every vertex.
std::vector<double> vertex_masses(const ChartSurface& chart, const std::vector<RestShape>& rest) {
  std::vector<double> mass(chart.positions.size(), 0);
  for (std::size_t t = 0; t < rest.size(); ++t)
    for (const Index v : chart.triangles[t]) mass[v] += rest[t].area / 3;
  return mass;
}

/// Moves the middle to 0 and scales to inertia 1.
void normalise_inertia(const std::vector<double>& mass, std::vector<Complex>& z) {
  Complex middle = 0;
  double total = 0, inertia = 0;
  for (std::size_t v = 0; v < z.size(); ++v) middle += mass[v] * z[v], total += mass[v];
  middle /= total;
  for (std::size_t v = 0; v < z.size(); ++v) inertia += mass[v] * std::norm(z[v] -= middle);
  if (inertia > 0)
    for (Complex& p : z) p /= std::sqrt(inertia);
}

}  // namespace

bool solve_conformal_terms(const ChartSurface& chart, const ConformalTerms& terms,
                           const std::vector<std::pair<Index, Vec2>>& pins, std::vector<Vec2>& uv) {
  const Rows rows(chart, terms);
  std::vector<Index> number(chart.positions.size(), 0);
  std::vector<Complex> z(chart.positions.size());
  for (const auto& [v, place] : pins) number[v] = k_pinned, z[v] = {place.x, place.y};
  std::vector<Vec3> where;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] != k_pinned) number[v] = static_cast<Index>(where.size()), where.push_back(chart.positions[v]);

  Elements elements;
  std::vector<Complex> right(where.size(), 0);
  Rows::Row row;
  std::vector<Index> free;
  for (std::size_t r = 0; r < rows.count(); ++r) {
    rows.get(r, row);
    free.clear();
    Complex held = 0;
    for (std::size_t i = 0; i < row.vertex.size(); ++i) {
      if (number[row.vertex[i]] == k_pinned)
        held += row.coefficient[i] * z[row.vertex[i]];
      else
        free.push_back(number[row.vertex[i]]);
    }
    for (std::size_t i = 0; i < row.vertex.size(); ++i)
      if (number[row.vertex[i]] != k_pinned) right[number[row.vertex[i]]] -= std::conj(row.coefficient[i]) * held;
    elements.add(free);
  }
  SparseCholesky<Complex> factor(elements, where, 1);
  factor.factor([&](std::size_t r, Complex* matrix) {
    Rows::Row own;
    rows.get(r, own);
    std::size_t size = 0;
    for (std::size_t i = 0; i < own.vertex.size(); ++i)
      if (number[own.vertex[i]] != k_pinned) own.coefficient[size++] = own.coefficient[i];
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = 0; i < size; ++i) matrix[size * j + i] = std::conj(own.coefficient[i]) * own.coefficient[j];
    if (pins.empty() && r < rows.rest().size())
      for (std::size_t i = 0; i < size; ++i) matrix[(size + 1) * i] += k_anchor * rows.rest()[r].area;
  });
  if (pins.empty()) {
    const std::vector<double> mass = vertex_masses(chart, rows.rest());
    for (std::size_t v = 0; v < z.size(); ++v)
      z[v] = {chart.positions[v].x + chart.positions[v].z, chart.positions[v].y};
    for (int i = 0; i < k_solves; ++i) {
      normalise_inertia(mass, z);
      for (std::size_t v = 0; v < z.size(); ++v) z[v] *= mass[v];
      factor.solve(z);
    }
    normalise_inertia(mass, z);
  } else {
    factor.solve(right);
    for (std::size_t v = 0; v < z.size(); ++v)
      if (number[v] != k_pinned) z[v] = right[number[v]];
  }
  uv.clear();
  for (const Complex p : z) uv.push_back({p.real(), p.imag()});
  if (!std::all_of(uv.begin(), uv.end(), [](Vec2 p) { return is_finite(p); })) return false;
  if (pins.empty()) normalise(chart, UpAxis::z, true, uv);
  return true;
}

double conformal_residual(const ChartSurface& chart, const std::vector<Vec2>& uv) {
  const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
  double sum = 0;
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const auto& [a, b, c] = chart.triangles[t];
    const Jacobian j = jacobian(rest[t], uv[b] - uv[a], uv[c] - uv[a]);
    const Vec2 miss{j.x.x - j.y.y, j.x.y + j.y.x};
    sum += rest[t].area * dot(miss, miss);
  }
  return sum;
}

}  // namespace papilla::param_detail
