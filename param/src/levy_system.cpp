// SPDX-License-Identifier: MIT
#include "levy_system.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <algorithm>

namespace papilla::param_detail {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

int as_int(Index i) { return static_cast<int>(i); }

/// The row of each interior vertex: that whose last entry it is.
std::vector<Index> rows_of_vertices(const LinearRows& rows, std::size_t vertices) {
  std::vector<Index> row(vertices, ~Index{0});
  for (Index r = 0; r < rows.count(); ++r) row[rows.vertex[rows.first[r + 1] - 1]] = r;
  return row;
}

/// D - W over the interior vertices, edge by edge.
void solve_symmetric(const ChartSurface& chart, const LinearRows& rows, const std::vector<Index>& row,
                     std::vector<Vec2>& uv) {
  constexpr Index none = ~Index{0};
  Elements elements;
  std::vector<double> weight;
  std::vector<Vec3> where(rows.count());
  std::vector<Vec2> right(rows.count());
  for (Index r = 0; r < rows.count(); ++r) {
    where[r] = chart.positions[rows.vertex[rows.first[r + 1] - 1]];
    for (Index i = rows.first[r]; i + 1 < rows.first[r + 1]; ++i) {
      const Index other = row[rows.vertex[i]];
      const double c = rows.coefficient[i];
      if (other == none) {
        elements.add(std::array{r});
        right[r] = right[r] + c * uv[rows.vertex[i]];
      } else if (r < other) {
        elements.add(std::array{r, other});
      } else {
        continue;
      }
      weight.push_back(c);
    }
  }
  SparseCholesky<double> factor(elements, where, 1);
  factor.factor([&](std::size_t e, double* matrix) {
    matrix[0] = weight[e];
    if (elements.of(e).size() == 2) matrix[1] = matrix[2] = -weight[e], matrix[3] = weight[e];
  });
  std::vector<double> x(rows.count());
  for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
    for (std::size_t r = 0; r < x.size(); ++r) x[r] = right[r].*axis;
    factor.solve(x);
    for (std::size_t v = 0; v < uv.size(); ++v)
      if (row[v] != none) uv[v].*axis = x[row[v]];
  }
}

}  // namespace

LevySystem::LevySystem(const ChartSurface& chart, const LinearRows& smoothness, const LinearRows& length,
                       Weights weights, const Unknowns& unknowns)
    : chart_(chart), smoothness_(smoothness), length_(length), weights_(weights), where_(unknowns.count) {
  const std::vector<std::array<double, 3>> zero(chart.triangles.size(), std::array<double, 3>{});
  std::vector<Index> members;
  for (std::size_t r = 0; r < row_count(); ++r) {
    const Row terms = row(r, zero);
    members.clear();
    if (terms.weight > 0)
      for (const Index v : terms.vertex)
        if (unknowns.of_vertex[v] != Unknowns::k_fixed) members.push_back(unknowns.of_vertex[v]);
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    elements_.add(members);
  }
  for (std::size_t v = 0; v < unknowns.of_vertex.size(); ++v)
    if (unknowns.of_vertex[v] != Unknowns::k_fixed) where_[unknowns.of_vertex[v]] = chart.positions[v];
}

LevySystem::Row LevySystem::row(std::size_t r, std::span<const std::array<double, 3>> orthogonality) const {
  const auto of = [](const LinearRows& rows, std::size_t i, double weight) {
    const std::size_t first = rows.first[i], count = rows.first[i + 1] - first;
    return Row{{rows.vertex.data() + first, count}, {rows.coefficient.data() + first, count}, weight};
  };
  if (r < smoothness_.count()) return of(smoothness_, r, weights_.smoothness);
  r -= smoothness_.count();
  if (r < length_.count()) return of(length_, r, weights_.length);
  r -= length_.count();
  return {chart_.triangles[r], orthogonality[r], weights_.orthogonality};
}

void LevySystem::solve(std::span<const std::array<double, 3>> orthogonality, Unknowns& unknowns) {
  if (unknowns.count == 0) return;
  if (!factor_) factor_ = std::make_unique<SparseCholesky<double>>(elements_, where_, 1);
  std::vector<double> right(unknowns.count, 0);
  for (std::size_t r = 0; r < row_count(); ++r) {
    const Row terms = row(r, orthogonality);
    double fixed = 0;
    for (std::size_t i = 0; i < terms.vertex.size(); ++i)
      if (unknowns.of_vertex[terms.vertex[i]] == Unknowns::k_fixed)
        fixed += terms.coefficient[i] * unknowns.value[terms.vertex[i]];
    if (fixed == 0) continue;
    for (std::size_t i = 0; i < terms.vertex.size(); ++i)
      if (const Index x = unknowns.of_vertex[terms.vertex[i]]; x != Unknowns::k_fixed)
        right[x] -= terms.weight * terms.coefficient[i] * fixed;
  }
  factor_->factor([&](std::size_t r, double* matrix) {
    const auto members = elements_.of(r);
    const std::size_t size = members.size();
    std::fill_n(matrix, size * size, 0.0);
    if (size == 0) return;
    const Row terms = row(r, orthogonality);
    double* combined = matrix + size * (size - 1);  // the last column holds the coefficients until it is written
    for (std::size_t i = 0; i < terms.vertex.size(); ++i)
      if (const Index x = unknowns.of_vertex[terms.vertex[i]]; x != Unknowns::k_fixed)
        combined[std::lower_bound(members.begin(), members.end(), x) - members.begin()] += terms.coefficient[i];
    for (std::size_t j = 0; j < size; ++j) {
      const double factor = terms.weight * combined[j];
      if (j + 1 == size)
        combined[j] *= factor;
      else
        for (std::size_t i = j; i < size; ++i) matrix[size * j + i] = factor * combined[i];
    }
  });
  factor_->solve(right);
  for (std::size_t v = 0; v < unknowns.value.size(); ++v)
    if (unknowns.of_vertex[v] != Unknowns::k_fixed) unknowns.value[v] = right[unknowns.of_vertex[v]];
}

int LevySystem::sweep(std::span<const std::array<double, 3>> orthogonality, Unknowns& unknowns, int most,
                      double tolerance) const {
  std::vector<Eigen::Triplet<double>> entries;
  Vector right = Vector::Zero(as_int(unknowns.count)), x = right;
  double constant = 0;
  for (std::size_t r = 0; r < row_count(); ++r) {
    const Row terms = row(r, orthogonality);
    if (!(terms.weight > 0)) continue;
    double fixed = 0;
    for (std::size_t i = 0; i < terms.vertex.size(); ++i) {
      const Index a = unknowns.of_vertex[terms.vertex[i]];
      if (a == Unknowns::k_fixed) {
        fixed += terms.coefficient[i] * unknowns.value[terms.vertex[i]];
        continue;
      }
      for (std::size_t j = 0; j < terms.vertex.size(); ++j)
        if (const Index b = unknowns.of_vertex[terms.vertex[j]]; b != Unknowns::k_fixed)
          entries.emplace_back(as_int(a), as_int(b), terms.weight * terms.coefficient[i] * terms.coefficient[j]);
    }
    for (std::size_t i = 0; i < terms.vertex.size(); ++i)
      if (const Index a = unknowns.of_vertex[terms.vertex[i]]; a != Unknowns::k_fixed)
        right[as_int(a)] -= terms.weight * terms.coefficient[i] * fixed;
    constant += terms.weight * fixed * fixed;
  }
  RowMatrix matrix(as_int(unknowns.count), as_int(unknowns.count));
  matrix.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t v = 0; v < unknowns.value.size(); ++v)
    if (unknowns.of_vertex[v] != Unknowns::k_fixed) x[as_int(unknowns.of_vertex[v])] = unknowns.value[v];
  const auto sum = [&] { return x.dot(matrix * x) - 2 * right.dot(x) + constant; };
  double before = sum();
  int sweeps = 0;
  while (sweeps < most) {
    for (int i = 0; i < matrix.rows(); ++i) {
      double rest = right[i], diagonal = 0;
      for (RowMatrix::InnerIterator entry(matrix, i); entry; ++entry)
        (entry.col() == i ? diagonal : rest) += entry.col() == i ? entry.value() : -entry.value() * x[entry.col()];
      if (diagonal > 0) x[i] = rest / diagonal;
    }
    ++sweeps;
    const double after = sum();
    if (!(before - after > tolerance * after)) break;
    before = after;
  }
  for (std::size_t v = 0; v < unknowns.value.size(); ++v)
    if (unknowns.of_vertex[v] != Unknowns::k_fixed) unknowns.value[v] = x[as_int(unknowns.of_vertex[v])];
  return sweeps;
}

bool solve_smooth(const ChartSurface& chart, const LinearRows& rows, bool symmetric, std::vector<Vec2>& uv) {
  if (rows.count() == 0) return true;
  const std::vector<Index> row = rows_of_vertices(rows, uv.size());
  if (symmetric) {
    solve_symmetric(chart, rows, row, uv);
    return true;
  }
  const int size = static_cast<int>(rows.count());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(size, 2);
  for (Index r = 0; r < rows.count(); ++r)
    for (Index i = rows.first[r]; i < rows.first[r + 1]; ++i) {
      const Index v = rows.vertex[i];
      if (row[v] != ~Index{0})
        entries.emplace_back(as_int(r), as_int(row[v]), -rows.coefficient[i]);
      else
        right.row(as_int(r)) += rows.coefficient[i] * Eigen::RowVector2d(uv[v].x, uv[v].y);
    }
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Matrix> factor(matrix);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::MatrixX2d x = factor.solve(right);
  for (std::size_t v = 0; v < uv.size(); ++v)
    if (row[v] != ~Index{0}) uv[v] = {x(as_int(row[v]), 0), x(as_int(row[v]), 1)};
  return true;
}

}  // namespace papilla::param_detail
