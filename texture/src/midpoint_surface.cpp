// SPDX-License-Identifier: MIT
#include "papilla/texture/midpoint_surface.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "random.hpp"

namespace papilla {
namespace {

using texture_detail::Random;

void require(int levels, int most_levels, double hurst, const char* function) {
  if (levels < 1 || levels > most_levels)
    throw InvalidInput(std::string(function) + ": levels " + std::to_string(levels) + " is not within 1 to " +
                       std::to_string(most_levels));
  if (!(hurst > 0 && hurst < 1))
    throw InvalidInput(std::string(function) + ": hurst " + std::to_string(hurst) + " is not within (0, 1)");
}

/// The samples: `side` intervals, one sample more unless periodic.
class Grid {
 public:
  Grid(int levels, bool periodic) : side_(1 << levels), size_(side_ + (periodic ? 0 : 1)), periodic_(periodic) {
    heights_.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_));
  }
  int side() const { return side_; }
  int size() const { return size_; }
  bool holds(int x, int y) const { return periodic_ || (x >= 0 && y >= 0 && x < size_ && y < size_); }
  double& at(int x, int y) {
    if (periodic_) {
      x = texture_detail::wrapped(x, size_);
      y = texture_detail::wrapped(y, size_);
    }
    return heights_[texture_detail::pixel_index(x, y, size_)];
  }
  HeightGrid surface() && { return {size_, std::move(heights_), periodic_}; }

 private:
  int side_, size_;
  bool periodic_;
  Values<double> heights_;
};

double covariance(Vec2 s, Vec2 t, double hurst) {
  const auto power = [&](double r) { return std::pow(r, 2 * hurst); };
  return (power(norm(s)) + power(norm(t)) - power(norm(s - t))) / 2;
}

/// Heights of (1,0), (0,1), (1,1) over X(0,0) = 0, jointly normal, by Cholesky's factorization.
std::array<double, 3> corner_heights(double hurst, Random& random) {
  constexpr std::array<Vec2, 3> k_corners = {{{1, 0}, {0, 1}, {1, 1}}};
  std::array<std::array<double, 3>, 3> factor{};
  std::array<double, 3> heights{};
  std::array<double, 3> normal{};
  for (double& value : normal) value = random.normal();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = covariance(k_corners[i], k_corners[j], hurst);
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      factor[i][j] = i == j ? std::sqrt(std::max(0.0, rest)) : rest / factor[j][j];
      heights[i] += factor[i][j] * normal[j];
    }
  return heights;
}

/// Takes the share of the samples that have their height.
using ReportShare = std::function<void(double)>;

void displace_corrected(Grid& grid, double hurst, Random& random, const ReportShare& report_share) {
  const int n = grid.side();
  if (grid.holds(n, n) && grid.size() > n) {
    const std::array<double, 3> corners = corner_heights(hurst, random);
    grid.at(n, 0) = corners[0];
    grid.at(0, n) = corners[1];
    grid.at(n, n) = corners[2];
  }
  const double square = std::pow(2, -hurst) - 0.25 - std::pow(2, hurst - 3);
  const double border = 1 - (std::pow(4, hurst) + 2 * std::pow(2, hurst)) / 9;
  for (int s = n; s > 1; s /= 2) {
    const int half = s / 2;
    const double side = std::pow(static_cast<double>(s) / n, hurst);
    const double centre = side * std::sqrt(square), edge = centre * std::pow(2, -hurst / 2);
    const double at_border = side * std::pow(2, -hurst) * std::sqrt(border);
    for (int y = half; y < grid.size(); y += s)
      for (int x = half; x < grid.size(); x += s)
        grid.at(x, y) = (grid.at(x - half, y - half) + grid.at(x + half, y - half) + grid.at(x - half, y + half) +
                         grid.at(x + half, y + half)) /
                            4 +
                        centre * random.normal();
    for (int y = 0; y < grid.size(); y += half)
      for (int x = (y / half) % 2 == 0 ? half : 0; x < grid.size(); x += s) {
        double sum = 0;
        int count = 0;
        for (const auto& [dx, dy] : {std::pair{-half, 0}, std::pair{half, 0}, std::pair{0, -half}, std::pair{0, half}})
          if (grid.holds(x + dx, y + dy)) {
            sum += grid.at(x + dx, y + dy);
            ++count;
          }
        grid.at(x, y) = sum / count + (count == 4 ? edge : at_border) * random.normal();
      }
    report_share(1.0 / half / half);
  }
}

void displace_cho(Grid& grid, int levels, double hurst, Random& random, const ReportShare& report_share) {
  const int n = grid.side();
  for (int y = 0; y < grid.size(); y += n)
    for (int x = 0; x < grid.size(); x += n) grid.at(x, y) = random.normal();
  for (int level = 1; level <= levels; ++level) {
    const int s = n >> (level - 1), half = s / 2;
    const double amplitude = std::pow(2, -level * hurst);
    const auto delta = [&] { return random.uniform() < 0.5 ? -amplitude : amplitude; };
    const auto mean_around = [&](int x, int y, int straight, int slanted) {
      return (grid.at(x - straight, y - slanted) + grid.at(x + slanted, y - straight) +
              grid.at(x + straight, y + slanted) + grid.at(x - slanted, y + straight)) /
             4;
    };
    const auto set_centres = [&](int slanted) {
      for (int y = half; y < grid.size(); y += s)
        for (int x = half; x < grid.size(); x += s) grid.at(x, y) = mean_around(x, y, half, slanted) + delta();
    };
    set_centres(half);
    for (int y = 0; y < grid.size(); y += half)
      for (int x = (y / half) % 2 == 0 ? half : 0; x < grid.size(); x += s) {
        const bool along_x = (y / half) % 2 == 0;  // The edge's ends are left and right, the centres above and below.
        const int ex = along_x ? half : 0, ey = along_x ? 0 : half;
        const double ends = grid.at(x - ex, y - ey) + grid.at(x + ex, y + ey);
        double centres = 0;
        int count = 0;
        for (const int sign : {-1, 1})
          if (grid.holds(x + sign * ey, y + sign * ex)) {
            centres += grid.at(x + sign * ey, y + sign * ex);
            ++count;
          }
        grid.at(x, y) = (ends + centres / count) / 3 + delta();
      }
    set_centres(0);
    report_share(1.0 / half / half);
  }
}

}  // namespace

HeightGrid midpoint_surface(const MidpointOptions& options) {
  require(options.levels, 13, options.hurst, "midpoint_surface");
  Random random(options.seed);
  Grid grid(options.levels, options.periodic);
  const ReportShare report_share = [&](double share) { report_progress(options.progress, "synthesis", share); };
  if (options.rule == MidpointRule::corrected)
    displace_corrected(grid, options.hurst, random, report_share);
  else
    displace_cho(grid, options.levels, options.hurst, random, report_share);
  return std::move(grid).surface();
}

std::vector<double> brownian_graph(const BrownianGraphOptions& options) {
  require(options.levels, 24, options.hurst, "brownian_graph");
  Random random(options.seed);
  const std::size_t n = std::size_t{1} << options.levels;
  std::vector<double> graph(n + 1, 0.0);
  graph[n] = random.normal();
  const double share = std::sqrt(1 - std::pow(2, 2 * options.hurst - 2));
  int stage = 1;
  for (std::size_t s = n; s > 1; s /= 2, ++stage) {
    const double deviation = std::pow(2, -stage * options.hurst) * share;
    for (std::size_t x = s / 2; x < n; x += s)
      graph[x] = (graph[x - s / 2] + graph[x + s / 2]) / 2 + deviation * random.normal();
  }
  return graph;
}

}  // namespace papilla
