// SPDX-License-Identifier: MIT
#include "levy_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "rest_shape.hpp"

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

}  // namespace papilla::param_detail
