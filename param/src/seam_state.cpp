// SPDX-License-Identifier: MIT
#include "seam_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "map_energy.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// What e of one triangle counts as at most where energies are compared.
constexpr double k_most_energy = 1e12;

/// e per triangle; infinite where it is turned over.
std::vector<double> energies(const TriangleMesh& mesh, std::span<const RestShape> rest,
                             const CornerAttribute<Vec2>& uv) {
  if (uv.indices.size() != mesh.triangles.size())
    throw InvalidInput("bounded_distortion: " + std::to_string(uv.indices.size()) + " uv triangles for " +
                       std::to_string(mesh.triangles.size()));
  const SymmetricDirichlet dirichlet(rest);
  std::vector<double> energy(rest.size());
  for (std::size_t t = 0; t < rest.size(); ++t) {
    const auto [a, b, c] = uv.indices[t];
    if (std::max({a, b, c}) >= uv.values.size())
      throw InvalidInput("bounded_distortion: triangle[" + std::to_string(t) + "] has no uv");
    energy[t] = dirichlet.value(t, uv.values[a], uv.values[b], uv.values[c]) / rest[t].area;
  }
  return energy;
}

double bounded(std::span<const RestShape> rest, std::span<const double> energy, const DistortionBound& bound) {
  double area = 0, sum = 0;
  for (std::size_t t = 0; t < rest.size(); ++t) area += rest[t].area, sum += rest[t].area * energy[t];
  if (!(area > 0)) return 4;
  if (!bound.percentile) return sum / area;
  std::vector<std::size_t> order(rest.size());
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return energy[a] != energy[b] ? energy[a] < energy[b] : a < b; });
  const double wanted = 0.01 * *bound.percentile * area;
  double below = 0;
  for (const std::size_t t : order)
    if ((below += rest[t].area) >= wanted) return energy[t];
  return energy[order.back()];
}

}  // namespace

double bounded_distortion(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, const DistortionBound& bound) {
  const std::vector<RestShape> rest = rest_shapes(mesh.positions, mesh.triangles);
  return bounded(rest, energies(mesh, rest, uv), bound);
}

namespace param_detail {

SeamMesh::SeamMesh(const TriangleMesh& of, std::span<const double> costs)
    : mesh(of),
      cost(costs),
      opposite(3 * of.triangles.size(), k_no_triangle),
      rest(rest_shapes(of.positions, of.triangles)),
      on_border(of.positions.size(), 0) {
  if (costs.size() != opposite.size())
    throw InvalidInput("keep_bound: " + std::to_string(costs.size()) + " seam costs for " +
                       std::to_string(opposite.size()) + " half-edges");
  for (const RestShape& shape : rest) area += shape.area;
  const Adjacency across = connect_triangles(of);
  for (Index h = 0; h < across.size(); ++h) {
    if (across[h] != k_no_triangle)
      for (Index other = 3 * across[h]; other < 3 * across[h] + 3; ++other)
        if (from(other) == to(h) && to(other) == from(h)) opposite[h] = other;
    if (opposite[h] == k_no_triangle) on_border[from(h)] = on_border[to(h)] = 1;
  }
}

SeamState measured(const SeamMesh& mesh, ChartedMap charted, const DistortionBound& bound) {
  SeamState state;
  state.charted = std::move(charted);
  const Flattening& f = state.charted.flattening;
  state.valid = f.notes.empty();
  const std::vector<double> energy = energies(mesh.mesh, mesh.rest, f.uv);
  state.distortion = bounded(mesh.rest, energy, bound);
  state.excess.resize(energy.size());
  for (std::size_t t = 0; t < energy.size(); ++t)
    state.energy += state.excess[t] = mesh.rest[t].area * std::clamp(energy[t] - 4, 0.0, k_most_energy);
  if (!std::isfinite(state.distortion)) state.valid = false;
  state.seam.assign(mesh.opposite.size(), 1);
  for (Index h = 0; h < state.seam.size(); ++h) {
    const Index other = mesh.opposite[h];
    if (other == k_no_triangle) continue;
    state.seam[h] = state.value(h) != state.value_at_end(other) || state.value_at_end(h) != state.value(other);
    if (!state.seam[h] || other < h) continue;
    state.seam_mm += mesh.length(h);
    state.cost_mm += mesh.cost[h];
  }
  return state;
}

std::vector<double> raised_around(const SeamMesh& mesh, const SeamState& before, const SeamState& after,
                                  const std::vector<std::vector<Index>>& places) {
  std::vector<Index> nearest(mesh.rest.size(), k_no_triangle), queue;
  const auto reach = [&](Index t, Index place) {
    if (nearest[t] != k_no_triangle) return;
    nearest[t] = place;
    queue.push_back(t);
  };
  for (Index p = 0; p < places.size(); ++p)
    for (const Index h : places[p]) reach(h / 3, p), reach(mesh.opposite[h] / 3, p);
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h)
      if (mesh.opposite[h] != k_no_triangle) reach(mesh.opposite[h] / 3, nearest[queue[i]]);
  std::vector<double> raised(places.size(), 0);
  for (const Index t : queue) raised[nearest[t]] += after.excess[t] - before.excess[t];
  return raised;
}

ChartSet charts_between(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam) {
  UnionFind sets(mesh.mesh.triangles.size());
  for (Index h = 0; h < seam.size(); ++h)
    if (!seam[h]) sets.unite(h / 3, mesh.opposite[h] / 3);
  ChartSet charts;
  charts.of_triangle = sets.labels(charts.count);
  for (Index h = 0; h < seam.size(); ++h) {
    const Index other = mesh.opposite[h];
    if (!seam[h] || other == k_no_triangle || other < h) continue;
    charts.seam_length_mm += mesh.length(h);
    if (charts.of_triangle[h / 3] == charts.of_triangle[other / 3]) charts.cuts.push_back(h);
  }
  return charts;
}

}  // namespace param_detail
}  // namespace papilla
