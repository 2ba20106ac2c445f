// SPDX-License-Identifier: MIT
#include "papilla/texture/fshot_dimension.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "checks.hpp"
#include "line_fit.hpp"
#include "papilla/core/units.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {
namespace {

constexpr int k_least_side = 32;
constexpr int k_most_distance = 16;
constexpr int k_angle_step_deg = 2, k_bins = 180 / k_angle_step_deg;
constexpr std::size_t k_least_distances = 5;
constexpr int k_blocks_a_side = 4, k_blocks = k_blocks_a_side * k_blocks_a_side;

using BlockMaxima = std::array<float, k_blocks>;

/// One offset of the ring and the largest |step| by block.
struct Offset {
  int dx, dy;
  double distance;
  int bin;
  BlockMaxima maxima{};

  double largest(int skipped) const {
    float most = 0;
    for (int b = 0; b < k_blocks; ++b)
      if (b != skipped) most = std::max(most, maxima[static_cast<std::size_t>(b)]);
    return static_cast<double>(most);
  }
};

/// The offsets of the half plane, by rising distance.
std::vector<Offset> ring() {
  std::vector<Offset> offsets;
  for (int dy = 0; dy <= k_most_distance; ++dy)
    for (int dx = dy == 0 ? 1 : -k_most_distance; dx <= k_most_distance; ++dx) {
      const double distance = std::hypot(dx, dy);
      if (distance > k_most_distance) continue;
      const double angle = std::atan2(dy, dx) / k_radians_per_degree;
      offsets.push_back({dx, dy, distance, static_cast<int>(std::lround(angle / k_angle_step_deg)) % k_bins});
    }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Offset& p, const Offset& q) { return p.distance < q.distance; });
  return offsets;
}

/// Largest |a[i] − b[i]|; as integers, because the bits of positive floats are ordered and integer maxima vectorise.
std::int32_t largest_step_bits(const float* a, const float* b, int count) {
  std::int32_t most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, std::bit_cast<std::int32_t>(std::abs(a[i] - b[i])));
  return most;
}

void measure(const GreyImage& image, Offset& offset) {
  const int first = std::max(0, -offset.dx), last = std::min(image.width, image.width - offset.dx);
  for (int y = 0; y + offset.dy < image.height; ++y) {
    const float* here = image.pixels.data() + image.index(0, y);
    const float* there = here + static_cast<std::ptrdiff_t>(offset.dy) * image.width + offset.dx;
    const int row = y * k_blocks_a_side / image.height * k_blocks_a_side;
    for (int column = 0; column < k_blocks_a_side; ++column) {
      const int begin = std::max(first, column * image.width / k_blocks_a_side);
      const int end = std::min(last, (column + 1) * image.width / k_blocks_a_side);
      float& most = offset.maxima[static_cast<std::size_t>(row + column)];
      most = std::max(most, std::bit_cast<float>(largest_step_bits(here + begin, there + begin, end - begin)));
    }
  }
}

struct Direction {
  int bin;
  double hurst;
};

/// Slopes of all directions with enough distances at which anything changes.
std::vector<Direction> directions(const std::vector<Offset>& offsets, int skipped_block) {
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> points;
  for (const Offset& offset : offsets) {
    const double step = offset.largest(skipped_block);
    if (!(step > 0)) continue;
    auto& [x, y] = points[offset.bin];
    x.push_back(std::log(offset.distance));
    y.push_back(std::log(step));
  }
  std::vector<Direction> found;
  for (const auto& [bin, logs] : points)
    if (logs.first.size() >= k_least_distances)
      found.push_back({bin, texture_detail::fit_line(logs.first, logs.second).slope});
  return found;
}

/// The ellipse through (H cos φ, H sin φ).
struct Ellipse {
  double minor = 1, major = 1;  ///< Half axes.
  double angle = 0;             ///< Of the minor axis.

  double radius(double direction) const {
    return minor * major / std::hypot(minor * std::sin(direction - angle), major * std::cos(direction - angle));
  }
};

/// Least squares of A x² + B x y + C y² = 1; a circle of the mean radius where that is no ellipse.
Ellipse fit_ellipse(const std::vector<Direction>& points) {
  double mean = 0;
  std::array<std::array<double, 4>, 3> normal{};
  for (const Direction& point : points) {
    const double angle = point.bin * k_angle_step_deg * k_radians_per_degree;
    const double x = point.hurst * std::cos(angle), y = point.hurst * std::sin(angle);
    const std::array<double, 4> row = {x * x, x * y, y * y, 1};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) normal[i][j] += row[i] * row[j];
    mean += point.hurst / static_cast<double>(points.size());
  }
  const double trace = normal[0][0] + normal[1][1] + normal[2][2];
  for (std::size_t i = 0; i < 3; ++i) {  // Gauss-Jordan; the matrix is positive definite unless all H are zero.
    if (!(normal[i][i] > 1e-12 * trace)) return {mean, mean, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == i) continue;
      const double factor = normal[k][i] / normal[i][i];
      for (std::size_t j = i; j < 4; ++j) normal[k][j] -= factor * normal[i][j];
    }
  }
  const double a = normal[0][3] / normal[0][0], b = normal[1][3] / normal[1][1], c = normal[2][3] / normal[2][2];
  const double middle = (a + c) / 2, spread = std::hypot((a - c) / 2, b / 2);
  if (!(middle - spread > 0)) return {mean, mean, 0};
  // The larger eigenvalue belongs to the minor axis.
  return {1 / std::sqrt(middle + spread), 1 / std::sqrt(middle - spread), 0.5 * std::atan2(b, a - c)};
}

double half_turn_deg(double radians) {
  const double degrees = std::fmod(radians / k_radians_per_degree, 180);
  return degrees < 0 ? degrees + 180 : degrees;
}

void set_ellipse(const Ellipse& ellipse, FshotSignature& signature) {
  signature.sta = ellipse.minor;
  signature.str = ellipse.major > 0 ? ellipse.minor / ellipse.major : 1;
  signature.angle_deg = half_turn_deg(ellipse.angle);
  signature.fs_h = 3 - (ellipse.major > 0 ? ellipse.radius(0) : 0);
  signature.fs_v = 3 - (ellipse.major > 0 ? ellipse.radius(std::numbers::pi / 2) : 0);
  signature.estimate.dimension = 3 - signature.sta;
  signature.estimate.hurst = signature.sta;
}

void add_intervals(const std::vector<Offset>& offsets, FshotSignature& signature) {
  std::array<double, k_blocks> sta{};
  std::map<int, std::array<double, k_blocks>> slopes;
  for (const DirectionalHurst& direction : signature.directions)
    slopes[static_cast<int>(std::lround(direction.angle_deg / k_angle_step_deg))].fill(direction.hurst);
  for (int block = 0; block < k_blocks; ++block) {
    const std::vector<Direction> without = directions(offsets, block);
    sta[static_cast<std::size_t>(block)] = without.empty() ? signature.sta : fit_ellipse(without).minor;
    for (const Direction& direction : without)
      if (const auto found = slopes.find(direction.bin); found != slopes.end())
        found->second[static_cast<std::size_t>(block)] = direction.hurst;
  }
  const double half_width = texture_detail::jackknife_half_width(sta);
  texture_detail::set_interval(signature.estimate, half_width);
  for (DirectionalHurst& direction : signature.directions) {
    const double width = texture_detail::jackknife_half_width(
        slopes[static_cast<int>(std::lround(direction.angle_deg / k_angle_step_deg))]);
    direction.low = direction.hurst - width;
    direction.high = direction.hurst + width;
  }
}

/// Mean over the directions at each whole distance that rows and columns hold.
std::vector<ScalePoint> mean_curve(const std::vector<Offset>& offsets) {
  std::vector<ScalePoint> curve;
  for (int r = 1; r <= k_most_distance; ++r) {
    double sum = 0;
    int count = 0;
    for (const Offset& offset : offsets)
      if (std::abs(offset.distance - r) < 0.5) {
        sum += offset.largest(-1);
        ++count;
      }
    if (sum > 0) curve.push_back({static_cast<double>(r), sum / count});
  }
  return curve;
}

}  // namespace

FshotSignature mean_signature(std::span<const FshotSignature> pieces) {
  if (pieces.size() == 1) return pieces.front();
  std::map<int, std::vector<double>> hurst;
  std::vector<FractalEstimate> estimates;
  for (const FshotSignature& piece : pieces) {
    estimates.push_back(piece.estimate);
    for (const DirectionalHurst& direction : piece.directions)
      hurst[static_cast<int>(std::lround(direction.angle_deg / k_angle_step_deg))].push_back(direction.hurst);
  }
  FshotSignature signature;
  std::vector<Direction> found;
  for (const auto& [bin, values] : hurst) {
    if (values.size() < pieces.size()) continue;
    const texture_detail::MeanInterval mean = texture_detail::mean_interval(values);
    found.push_back({bin, mean.mean});
    signature.directions.push_back({static_cast<double>(bin * k_angle_step_deg), mean.mean, mean.mean - mean.half_width,
                                    mean.mean + mean.half_width});
  }
  if (found.empty()) return signature;
  signature.estimate = texture_detail::mean_estimate(estimates);
  const double half_width = signature.estimate.high - signature.estimate.dimension;
  set_ellipse(fit_ellipse(found), signature);
  texture_detail::set_interval(signature.estimate, half_width);
  return signature;
}

FshotSignature fshot_dimension(const GreyImage& image) {
  texture_detail::require_image(image, "fshot_dimension", k_least_side);
  std::vector<Offset> offsets = ring();
  oneapi::tbb::parallel_for(std::size_t{0}, offsets.size(), [&](std::size_t i) { measure(image, offsets[i]); });
  FshotSignature signature;
  const std::vector<Direction> found = directions(offsets, -1);
  if (found.empty()) return signature;
  for (const Direction& direction : found)
    signature.directions.push_back(
        {static_cast<double>(direction.bin * k_angle_step_deg), direction.hurst, direction.hurst, direction.hurst});
  set_ellipse(fit_ellipse(found), signature);
  signature.estimate.curve = mean_curve(offsets);
  add_intervals(offsets, signature);
  return signature;
}

}  // namespace papilla
