// SPDX-License-Identifier: MIT
#include "levy_lengths.hpp"

#include <cmath>

#include "map_descent.hpp"

namespace papilla::param_detail {
namespace {

constexpr Index k_pinned = ~Index{0};

/// Keeps translations, which change nothing, from being singular; per area.
constexpr double k_anchor = 1e-8;

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

}  // namespace

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

}  // namespace papilla::param_detail
