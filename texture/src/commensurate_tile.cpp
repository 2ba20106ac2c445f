// SPDX-License-Identifier: MIT
#include "papilla/texture/commensurate_tile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bicubic.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

struct Candidate {
  std::array<int, 2> combination;
  Vec2 vector;
  int side;          ///< Of the tile along the axis it is near.
  double deviation;  ///< From that side of whole pixels, relative.
};

/// Lattice vectors near the x or the y axis, by rising length.
std::vector<Candidate> near_axis(const std::array<Vec2, 2>& vectors, bool horizontal,
                                 const CommensurateOptions& options) {
  const double area = std::abs(cross(vectors[0], vectors[1]));
  const double reach = options.most_side * std::sqrt(2.0);
  // |m| ≤ |v|·|b| / area for v = m a + n b, and likewise for n.
  const int most_m = static_cast<int>(reach * norm(vectors[1]) / area) + 1;
  const int most_n = static_cast<int>(reach * norm(vectors[0]) / area) + 1;
  std::vector<Candidate> found;
  for (int m = -most_m; m <= most_m; ++m)
    for (int n = -most_n; n <= most_n; ++n) {
      const Vec2 v = static_cast<double>(m) * vectors[0] + static_cast<double>(n) * vectors[1];
      const double along = horizontal ? v.x : v.y, across = horizontal ? v.y : v.x;
      const long side = std::lround(along);
      if (side < options.least_side || side > options.most_side || std::abs(across) > along) continue;
      const auto whole = static_cast<double>(side);
      found.push_back({{m, n}, v, static_cast<int>(side), std::hypot(along / whole - 1, across / whole)});
    }
  std::sort(found.begin(), found.end(), [](const Candidate& p, const Candidate& q) {
    return p.side != q.side ? p.side < q.side : p.deviation < q.deviation;
  });
  return found;
}

/// Largest singular value of F − 1, F = [right/width, down/height].
double strain_of(const Candidate& right, const Candidate& down) {
  const double a = right.vector.x / right.side - 1, b = down.vector.x / down.side;
  const double c = right.vector.y / right.side, d = down.vector.y / down.side - 1;
  const double sum = a * a + b * b + c * c + d * d, det = a * d - b * c;
  return std::sqrt((sum + std::sqrt(std::max(0.0, sum * sum - 4 * det * det))) / 2);
}

void require(const std::array<Vec2, 2>& vectors, const CommensurateOptions& options) {
  const double area = std::abs(cross(vectors[0], vectors[1]));
  if (!is_finite(vectors[0]) || !is_finite(vectors[1]) || !(area > 1e-6 * norm(vectors[0]) * norm(vectors[1])) ||
      !(area >= 1))
    throw InvalidInput("find_commensurate_tile: the vectors (" + std::to_string(vectors[0].x) + ", " +
                       std::to_string(vectors[0].y) + "), (" + std::to_string(vectors[1].x) + ", " +
                       std::to_string(vectors[1].y) + ") span no cell");
  if (!(options.most_strain > 0 && options.most_strain < 1) || options.least_side < 1 ||
      options.most_side < options.least_side || options.most_side > 16384)
    throw InvalidInput("find_commensurate_tile: strain " + std::to_string(options.most_strain) + " or sides " +
                       std::to_string(options.least_side) + " to " + std::to_string(options.most_side) +
                       " are out of range");
}

/// Keeps what no shorter candidate matches, up to the first within the limit and those that come closer.
std::vector<Candidate> worth_trying(std::vector<Candidate> candidates, double most_strain) {
  std::vector<Candidate> kept;
  double least = 1e300;
  for (const Candidate& candidate : candidates) {
    if (candidate.deviation > most_strain && candidate.deviation >= least) continue;
    least = std::min(least, candidate.deviation);
    kept.push_back(candidate);
  }
  constexpr std::size_t k_most = 400;
  if (kept.size() > k_most) kept.resize(k_most);
  return kept;
}

}  // namespace

CommensurateTile find_commensurate_tile(const std::array<Vec2, 2>& vectors_px, const CommensurateOptions& options) {
  require(vectors_px, options);
  const std::vector<Candidate> rights = worth_trying(near_axis(vectors_px, true, options), options.most_strain);
  const std::vector<Candidate> downs = worth_trying(near_axis(vectors_px, false, options), options.most_strain);
  std::optional<CommensurateTile> best;
  const auto is_better = [&](const CommensurateTile& tile) {
    if (!best) return true;
    const bool fits = tile.strain <= options.most_strain, best_fits = best->strain <= options.most_strain;
    if (fits != best_fits) return fits;
    if (!fits) return tile.strain < best->strain;
    const auto area = [](const CommensurateTile& t) { return static_cast<std::int64_t>(t.width) * t.height; };
    return area(tile) != area(*best) ? area(tile) < area(*best) : tile.strain < best->strain;
  };
  for (const Candidate& right : rights)
    for (const Candidate& down : downs) {
      const CommensurateTile tile{right.side, down.side, {right.combination, down.combination}, strain_of(right, down)};
      if (is_better(tile)) best = tile;
    }
  if (!best)
    throw InvalidInput("find_commensurate_tile: no lattice vectors of " + std::to_string(options.least_side) + " to " +
                       std::to_string(options.most_side) + " pixels are near both axes");
  return *best;
}

GreyImage fill_tile(const GreyImage& cell, const CommensurateTile& tile) {
  texture_detail::require_image(cell, "fill_tile");
  if (tile.width < 1 || tile.height < 1)
    throw InvalidInput("fill_tile: the tile is " + std::to_string(tile.width) + " x " + std::to_string(tile.height));
  const std::int64_t width = tile.width, height = tile.height, period = width * height;
  const auto& c = tile.combination;
  const auto fraction = [&](int axis, int x, int y) {
    const auto i = static_cast<std::size_t>(axis);
    const std::int64_t whole = c[0][i] * height * x + c[1][i] * width * y, rest = whole % period;
    return static_cast<double>(rest < 0 ? rest + period : rest) / static_cast<double>(period);
  };
  const auto periodic = [&](int x, int y) {
    return cell.at(texture_detail::wrapped(x, cell.width), texture_detail::wrapped(y, cell.height));
  };
  GreyImage picture{tile.width, tile.height, {}, cell.pitch_mm, 32};
  picture.pixels.reserve(static_cast<std::size_t>(period));
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x)
      picture.pixels.push_back(static_cast<float>(
          texture_detail::bicubic(fraction(0, x, y) * cell.width, fraction(1, x, y) * cell.height, periodic)));
  return picture;
}

}  // namespace papilla
