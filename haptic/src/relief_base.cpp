// SPDX-License-Identifier: MIT
#include "relief_base.hpp"

#include <cmath>

#include "position_weld.hpp"

namespace papilla {
namespace {

constexpr int k_shortenings = 8;  // Halvings of the offset before a vertex that inverts triangles keeps its place.
constexpr double k_least_cosine = 0.3;  // A face that tilts by more than 72 degrees counts as inverted.
constexpr double k_least_miter = 0.5;   // Sharp corners move at most twice the height.

Vec3 face_normal(Vec3 a, Vec3 b, Vec3 c) { return normalized(cross(b - a, c - a)); }

/// Angles of a triangle at its corners; a right angle where an edge has no length.
std::array<double, 3> angles_of(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = normalized(b - a), v = normalized(c - b), w = normalized(a - c);
  const auto between = [](Vec3 from, Vec3 to) { return std::acos(std::clamp(-dot(from, to), -1.0, 1.0)); };
  return {between(w, u), between(u, v), between(v, w)};
}

}  // namespace

ReliefBase make_relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                            const std::vector<HeightField>& heights) {
  const std::size_t n = mesh.triangles.size();
  std::vector<double> lowest(materials.size(), 0.0);
  for (std::size_t m = 0; m < materials.size(); ++m)
    if (const auto& height = materials[m].height) lowest[m] = std::min(0.0, heights[*height].min_m());
  ReliefBase base(mesh);
  bool moves = false;
  for (std::size_t t = 0; t < n && !moves; ++t) moves = lowest[mesh.material_of(t)] < 0;
  if (!moves) return base;

  struct Mean {
    Vec3 normal, faces;  ///< Sums over the triangles, weighted by angle.
    double weight = 0, shift = 0;
  };
  std::size_t count = 0;
  std::vector<std::uint32_t> place = weld_positions(mesh.positions, count);
  std::vector<Mean> means(count);
  for (std::size_t t = 0; t < n; ++t) {
    const std::array<Vec3, 3> at = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const Vec3 face = face_normal(at[0], at[1], at[2]);
    const std::array<double, 3> angles = angles_of(at[0], at[1], at[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      Mean& mean = means[place[mesh.triangles[t][k]]];
      const Vec3 given = mesh.has_normals() ? mesh.normal(t, k) : face;
      const Vec3 weighted = angles[k] * face;
      mean.normal = mean.normal + (is_finite(given) && dot(given, face) > 0 ? angles[k] * normalized(given) : weighted);
      mean.faces = mean.faces + weighted;
      mean.weight += angles[k];
      mean.shift = std::min(mean.shift, lowest[mesh.material_of(t)]);
    }
  }
  for (Mean& mean : means) {
    mean.normal = normalized(mean.normal);
    if (mean.weight > 0)
      mean.normal = (1 / std::clamp(dot(mean.faces, mean.normal) / mean.weight, k_least_miter, 1.0)) * mean.normal;
  }

  const auto moved = [&](std::size_t t, std::size_t k) {
    const Mean& mean = means[place[mesh.triangles[t][k]]];
    return mesh.corner(t, k) + mean.shift * mean.normal;
  };
  for (int round = 0; round <= k_shortenings; ++round) {
    std::vector<std::uint32_t> inverted;
    for (std::size_t t = 0; t < n; ++t) {
      const Vec3 before = face_normal(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      if (before == Vec3{} || dot(before, face_normal(moved(t, 0), moved(t, 1), moved(t, 2))) >= k_least_cosine)
        continue;
      for (const std::uint32_t v : mesh.triangles[t]) inverted.push_back(place[v]);
    }
    if (inverted.empty()) break;
    std::sort(inverted.begin(), inverted.end());
    inverted.erase(std::unique(inverted.begin(), inverted.end()), inverted.end());
    for (const std::uint32_t p : inverted) means[p].shift = round == k_shortenings ? 0 : 0.5 * means[p].shift;
  }
  std::vector<ReliefBase::Move> vertex_moves;
  vertex_moves.reserve(count);
  for (const Mean& mean : means) {
    const Vec3 way = mean.shift * mean.normal;
    vertex_moves.push_back({{static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)},
                            static_cast<float>(mean.shift)});
  }
  base.set(std::move(place), std::move(vertex_moves));
  return base;
}

}  // namespace papilla
