// SPDX-License-Identifier: MIT
#include "papilla/param/seam_visibility.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "adjacency.hpp"
#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "tile_phase.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "seam_visibility";
constexpr int k_samples = 5;

void check(const SeamVisibilityOptions& o) {
  if (!(o.grain_mm > 0) || !std::isfinite(o.grain_mm))
    throw InvalidInput(std::string(k_function) + ": grain_mm is " + std::to_string(o.grain_mm) + ", expected above 0");
  if (!(o.tile_mm.x >= 0 && o.tile_mm.y >= 0) || !is_finite(o.tile_mm))
    throw InvalidInput(std::string(k_function) + ": tile_mm is negative or not finite");
}

constexpr double k_turn_deg = 15;  ///< A grain that turns by less hides in its own scatter.
const double k_smooth = std::cos(30 * k_radians_per_degree);

Vec3 normal_of(const TriangleMesh& mesh, std::size_t t) {
  return normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
}

double turn_deg(const SeamEdge& e) {
  const Vec2 here = e.here[1] - e.here[0], there = e.there[1] - e.there[0];
  return k_degrees_per_radian * std::abs(std::atan2(cross(here, there), dot(here, there)));
}

}  // namespace

SeamVisibility seam_visibility(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                               const SeamVisibilityOptions& options) {
  check(options);
  check_mesh(mesh, k_function);
  check_uv(mesh, uv, k_function);
  const Adjacency across = connect_triangles(mesh);
  SeamVisibility result;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    area += 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = across[3 * t + k];
      if (other == k_no_triangle || other < t) continue;
      const SeamEdge e = seam_edge(mesh, uv, t, k, other);
      if (e.here[0] == e.there[0] && e.here[1] == e.there[1]) continue;
      result.seam_mm += e.length_mm;
      const double turn = turn_deg(e);
      result.mean_turn_deg += e.length_mm * turn;
      if (turn > k_turn_deg && dot(normal_of(mesh, t), normal_of(mesh, other)) > k_smooth)
        result.turned_mm += e.length_mm;
      for (int i = 0; i < k_samples; ++i) {
        const double s = (i + 0.5) / k_samples, length = e.length_mm / k_samples;
        const Vec2 difference = (1 - s) * (e.here[0] - e.there[0]) + s * (e.here[1] - e.there[1]);
        const double jump = norm(wrap_to_tile(difference, options.tile_mm));
        result.visible_mm += length * std::min(1.0, jump / options.grain_mm);
        result.mean_jump_mm += length * jump;
        result.max_jump_mm = std::max(result.max_jump_mm, jump);
      }
    }
  }
  if (result.seam_mm > 0) result.mean_jump_mm /= result.seam_mm, result.mean_turn_deg /= result.seam_mm;
  if (area > 0) result.per_size = result.visible_mm / std::sqrt(area);
  return result;
}

}  // namespace papilla
