// SPDX-License-Identifier: MIT
#include "levy_systems.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "disk_chart.hpp"
#include "map_descent.hpp"

namespace papilla::param_detail {
namespace {

/// Heights count as at least this fraction of the longest edge, so that slivers don't outweigh everything.
constexpr double k_least_height = 1e-3;

/// Area over which the length condition acts, in areas of the chart.
constexpr double k_length_scale = 0.012;

/// The derivative across an edge is (apex - (1-s) from - s to) / height.
struct Across {
  double s = 0.5, height = 1, area = 0;
  double trust = 1;  ///< The true height over `height`, at most 1: what is left of the conditions on a sliver.
};

Across across_edge(Vec3 from, Vec3 to, Vec3 apex) {
  const Vec3 e = to - from, p = apex - from;
  const double square = dot(e, e), longest = std::sqrt(std::max({square, dot(p, p), dot(apex - to, apex - to)}));
  Across result;
  result.area = 0.5 * norm(cross(e, p));
  if (square > 0) result.s = std::clamp(dot(p, e) / square, -1e3, 1e3);
  const double height = square > 0 ? 2 * result.area / std::sqrt(square) : 0;
  result.height = std::max({height, k_least_height * longest, 1e-300});
  result.trust = height / result.height;
  return result;
}

double cotangent(Vec3 at, Vec3 a, Vec3 b) {
  const Vec3 p = a - at, q = b - at;
  const double longest = std::max({dot(p, p), dot(q, q), dot(b - a, b - a)});
  return longest > 0 ? dot(p, q) / std::max(norm(cross(p, q)), k_least_height * longest) : 0;
}

/// tan(angle / 2) at `at` between a and b.
double half_tangent(Vec3 at, Vec3 a, Vec3 b) {
  const Vec3 p = a - at, q = b - at;
  const double lengths = norm(p) * norm(q), sine = norm(cross(p, q));
  return lengths > 0 ? (lengths - dot(p, q)) / std::max(sine, k_least_height * lengths) : 0;
}

using Complex = std::complex<double>;

constexpr Index k_pinned = ~Index{0};

/// Solves of inverse iteration: the second smallest eigenvalue is far from the third.
constexpr int k_solves = 3;

/// Keeps translations, which change nothing, from being singular; per area.
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

/// The sum of cosine and sine parts of J, whose length is σ1 + σ2 and whose direction is that of the nearest rotation.
Vec2 rotation_part(const Jacobian& j) { return {j.x.x + j.y.y, j.x.y - j.y.x}; }

/// The first column of the rotation nearest to J; the other one is it, turned by 90°.
Vec2 nearest_rotation(const Jacobian& j) {
  const Vec2 part = rotation_part(j);
  const double length = norm(part);
  return length > 0 ? (1 / length) * part : Vec2{1, 0};
}

Vec2 turned(Vec2 p) { return {-p.y, p.x}; }

Jacobian jacobian_of(const RestShape& rest, const Triangle& t, const std::vector<Vec2>& uv) {
  return jacobian(rest, uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
}

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

void LinearRows::add(std::span<const Index> vertices, std::span<const double> coefficients) {
  vertex.insert(vertex.end(), vertices.begin(), vertices.end());
  coefficient.insert(coefficient.end(), coefficients.begin(), coefficients.end());
  first.push_back(static_cast<Index>(vertex.size()));
}

double LinearRows::value(std::size_t row, std::span<const double> x) const {
  double sum = 0;
  for (Index i = first[row]; i < first[row + 1]; ++i) sum += coefficient[i] * x[vertex[i]];
  return sum;
}

LinearRows smoothness_rows(const ChartSurface& chart, LevyWeights weights) {
  const std::size_t count = chart.positions.size();
  std::vector<char> border(count, 0);
  std::vector<Index> first(count + 2, 0);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      ++first[chart.triangles[t][k] + 2];
      if (chart.across[t][k] == k_no_triangle)
        border[chart.triangles[t][k]] = border[chart.triangles[t][(k + 1) % 3]] = 1;
    }
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Index> corner(first.back());
  for (Index c = 0; c < corner.size(); ++c) corner[first[chart.triangles[c / 3][c % 3] + 1]++] = c;

  LinearRows rows;
  std::map<Index, double> around;  // an interior vertex meets each neighbour in two triangles
  for (Index v = 0; v < count; ++v) {
    if (border[v] || first[v] == first[v + 1]) continue;
    around.clear();
    for (Index i = first[v]; i < first[v + 1]; ++i) {
      const Triangle& t = chart.triangles[corner[i] / 3];
      const Index a = t[(corner[i] % 3 + 1) % 3], b = t[(corner[i] % 3 + 2) % 3];
      const Vec3 p = chart.positions[v], pa = chart.positions[a], pb = chart.positions[b];
      switch (weights) {
        case LevyWeights::uniform: around[a] = around[b] = 1; break;
        case LevyWeights::cotangent:
          around[a] += 0.5 * cotangent(pb, p, pa);
          around[b] += 0.5 * cotangent(pa, p, pb);
          break;
        case LevyWeights::mean_value: {
          const double half = half_tangent(p, pa, pb);
          if (norm(pa - p) > 0) around[a] += half / norm(pa - p);
          if (norm(pb - p) > 0) around[b] += half / norm(pb - p);
          break;
        }
      }
    }
    std::vector<Index> vertices;
    std::vector<double> coefficients;
    double sum = 0;
    for (const auto& [w, c] : around) vertices.push_back(w), coefficients.push_back(c), sum += c;
    if (weights == LevyWeights::mean_value && sum > 0) {  // an average of neighbours, of the size of the others
      for (double& c : coefficients) c *= static_cast<double>(around.size()) / sum;
      sum = static_cast<double>(around.size());
    }
    vertices.push_back(v), coefficients.push_back(-sum);
    rows.add(vertices, coefficients);
  }
  return rows;
}

LinearRows length_rows(const ChartSurface& chart) {
  LinearRows rows;
  for (Index t = 0; t < chart.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = chart.across[t][k];
      if (other == k_no_triangle || other < t) continue;
      const Index a = chart.triangles[t][k], b = chart.triangles[t][(k + 1) % 3], c = chart.triangles[t][(k + 2) % 3];
      Index d = a;
      for (const Index v : chart.triangles[other])
        if (v != a && v != b) d = v;
      const auto at = [&](Index v) { return chart.positions[v]; };
      const Across one = across_edge(at(a), at(b), at(c)), two = across_edge(at(a), at(b), at(d));
      const double apart = (one.height + two.height) / 3;
      const double weight = std::sqrt(k_length_scale * (one.area + two.area) / 3) / apart;
      // Multiplied by both trusts, so that the true heights divide nothing; linear maps keep satisfying the condition.
      const double p = weight * two.trust / one.height, q = weight * one.trust / two.height;
      rows.add(std::array{a, b, c, d}, std::array{p * (one.s - 1) + q * (two.s - 1), -p * one.s - q * two.s, p, q});
    }
  return rows;
}

std::vector<std::array<double, 3>> orthogonality_rows(const ChartSurface& chart, std::span<const double> w) {
  const std::vector<RestShape> rest = rest_shapes(chart.positions, chart.triangles);
  std::vector<std::array<double, 3>> rows(rest.size());
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const CornerFactors f = corner_factors(rest[t]);
    double gx = 0, gy = 0;
    for (std::size_t k = 0; k < 3; ++k)
      gx += f[k][0] * w[chart.triangles[t][k]], gy += f[k][1] * w[chart.triangles[t][k]];
    for (std::size_t k = 0; k < 3; ++k) rows[t][k] = std::sqrt(rest[t].area) * (gx * f[k][0] + gy * f[k][1]);
  }
  return rows;
}

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

LengthRounds::LengthRounds(const ChartSurface& chart, double smoothness, const LinearRows& smoothness_rows,
                           const std::vector<std::pair<Index, Vec2>>& pins, const std::vector<Vec2>& uv)
    : chart_(chart), rest_(rest_shapes(chart.positions, chart.triangles)), uv_(uv) {
  double lengths = 0, area = 0;
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    lengths += rest_[t].area * norm(rotation_part(jacobian_of(rest_[t], chart.triangles[t], uv))) / 2;
    area += rest_[t].area;
  }
  scale_ = lengths / area;
  for (Vec2& p : uv_) p = (1 / scale_) * p;
  energy_ = energy_of(uv_);
  factor(smoothness, smoothness_rows, pins);
}

void LengthRounds::factor(double smoothness, const LinearRows& smoothness_rows,
                          const std::vector<std::pair<Index, Vec2>>& pins) {
  number_.assign(uv_.size(), 0);
  for (const auto& [v, place] : pins) number_[v] = k_pinned;
  std::vector<Vec3> where;
  for (std::size_t v = 0; v < number_.size(); ++v)
    if (number_[v] != k_pinned) number_[v] = static_cast<Index>(where.size()), where.push_back(chart_.positions[v]);
  held_.assign(where.size(), {});

  // Entry (i, j) of the matrix of an element over its vertices, pinned or not.
  const std::size_t triangles = rest_.size(), rows = smoothness > 0 ? smoothness_rows.count() : 0;
  const auto vertices_of = [&](std::size_t e) -> std::span<const Index> {
    if (e < triangles) return chart_.triangles[e];
    const Index first = smoothness_rows.first[e - triangles], end = smoothness_rows.first[e - triangles + 1];
    return {smoothness_rows.vertex.data() + first, end - first};
  };
  const auto entry = [&](std::size_t e, std::size_t i, std::size_t j) {
    if (e < triangles) {
      const CornerFactors f = corner_factors(rest_[e]);
      return rest_[e].area * (f[i][0] * f[j][0] + f[i][1] * f[j][1] + (i == j ? k_anchor : 0));
    }
    const double* c = smoothness_rows.coefficient.data() + smoothness_rows.first[e - triangles];
    return smoothness * c[i] * c[j];
  };

  Elements elements;
  std::vector<Index> free;
  for (std::size_t e = 0; e < triangles + rows; ++e) {
    const auto vertices = vertices_of(e);
    free.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (number_[vertices[i]] == k_pinned) continue;
      free.push_back(number_[vertices[i]]);
      for (std::size_t j = 0; j < vertices.size(); ++j)
        if (number_[vertices[j]] == k_pinned)
          held_[free.back()] = held_[free.back()] - entry(e, i, j) * uv_[vertices[j]];
    }
    elements.add(free);
  }
  factor_ = std::make_unique<SparseCholesky<double>>(elements, where, 1);
  factor_->factor([&](std::size_t e, double* matrix) {
    const auto vertices = vertices_of(e);
    for (std::size_t j = 0; j < vertices.size(); ++j)
      for (std::size_t i = 0; i < vertices.size(); ++i)
        if (number_[vertices[i]] != k_pinned && number_[vertices[j]] != k_pinned) *matrix++ = entry(e, i, j);
  });
}

bool LengthRounds::advance() {
  std::vector<Vec2> right = held_;
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    const Vec2 x = nearest_rotation(jacobian_of(rest_[t], chart_.triangles[t], uv_)), y = turned(x);
    const CornerFactors f = corner_factors(rest_[t]);
    for (std::size_t k = 0; k < 3; ++k)
      if (const Index i = number_[chart_.triangles[t][k]]; i != k_pinned)
        right[i] = right[i] + rest_[t].area * (f[k][0] * x + f[k][1] * y);
  }
  std::vector<Vec2> next = uv_;
  std::vector<double> values(right.size());
  for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = right[i].*axis;
    factor_->solve(values);
    for (std::size_t v = 0; v < next.size(); ++v)
      if (number_[v] != k_pinned) next[v].*axis = values[number_[v]];
  }
  const double energy = energy_of(next);
  if (!(energy < energy_)) return false;
  energy_ = energy;
  uv_ = std::move(next);
  return true;
}

double LengthRounds::length_error() const {
  double sum = 0;
  for (std::size_t t = 0; t < rest_.size(); ++t) {
    const Jacobian j = jacobian_of(rest_[t], chart_.triangles[t], uv_);
    const Vec2 x = nearest_rotation(j), dx = j.x - x, dy = j.y - turned(x);
    sum += rest_[t].area * (dot(dx, dx) + dot(dy, dy));
  }
  return scale_ * scale_ * sum;
}

std::vector<Vec2> LengthRounds::uv() const {
  std::vector<Vec2> result = uv_;
  for (Vec2& p : result) p = scale_ * p;
  return result;
}

double LengthRounds::energy_of(const std::vector<Vec2>& uv) const {
  const SymmetricDirichlet energy(rest_);
  return total_energy({chart_.triangles, &energy}, uv);
}

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
