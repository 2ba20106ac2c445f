// SPDX-License-Identifier: MIT
#include "shading_energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "checks.hpp"
#include "reflectance.hpp"
#include "wide.hpp"

namespace papilla::texture_detail {
namespace {

/// The two neighbours along one axis and the reciprocal of their distance (0 on a single pixel).
struct Neighbours {
  int before, after;
  double inverse_distance;
};

Neighbours neighbours(int i, int count, bool periodic) {
  if (count == 1) return {0, 0, 0};
  if (periodic) return {i == 0 ? count - 1 : i - 1, i == count - 1 ? 0 : i + 1, 0.5};
  const int before = std::max(0, i - 1), after = std::min(count - 1, i + 1);
  return {before, after, 1.0 / (after - before)};
}

/// The pixels of one row that are shaded alike, and what surrounds them.
struct ShadedRow {
  const double *left, *right, *up, *down, *brightness;
  double inverse_x, inverse_y;
};

/// (R − I)² of `count` pixels and its derivatives by the differences of the neighbours across and down.
PAPILLA_TEXTURE_WIDE void shade(Vec3 light, const ShadedRow& row, double* __restrict across, double* __restrict down,
                                double* __restrict squares, std::size_t count) {
  const ShadedRow r = row;
  for (std::size_t x = 0; x < count; ++x) {
    const double p = (r.right[x] - r.left[x]) * r.inverse_x, q = (r.down[x] - r.up[x]) * r.inverse_y;
    const Reflectance shaded = reflectance(light, p, q);
    const double error = shaded.value - r.brightness[x];
    squares[x] = error * error;
    across[x] = 2 * error * shaded.dp * r.inverse_x;
    down[x] = 2 * error * shaded.dq * r.inverse_y;
  }
}

PAPILLA_TEXTURE_WIDE void add(double* __restrict target, const double* __restrict values, std::size_t count) {
  for (std::size_t x = 0; x < count; ++x) target[x] += values[x];
}

PAPILLA_TEXTURE_WIDE void subtract(double* __restrict target, const double* __restrict values, std::size_t count) {
  for (std::size_t x = 0; x < count; ++x) target[x] -= values[x];
}

/// factor · Δ of the pixels, none of which is at the left or right border.
PAPILLA_TEXTURE_WIDE void laplacian(const double* row, const double* up, const double* down, double factor,
                                    double* __restrict target, std::size_t count) {
  const double *const left = row - 1, *const right = row + 1;
  for (std::size_t x = 0; x < count; ++x) target[x] = factor * (left[x] + right[x] + up[x] + down[x] - 4 * row[x]);
}

/// Four sums side by side: one alone waits for every addition.
double sum(const double* values, std::size_t count) {
  std::array<double, 4> sums{};
  std::size_t x = 0;
  for (; x + sums.size() <= count; x += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[x + k];
  for (; x < count; ++x) sums[0] += values[x];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

PAPILLA_TEXTURE_WIDE void square(const double* __restrict values, double* __restrict squares, std::size_t count) {
  for (std::size_t x = 0; x < count; ++x) squares[x] = values[x] * values[x];
}

}  // namespace

ShadingEnergy::ShadingEnergy(const GreyImage& image, const ShadingOptions& options)
    : width_(image.width),
      height_(image.height),
      periodic_(options.periodic),
      light_(require_light(options.light, "shape_from_shading_variational")),
      brightness_(brightness(image, options.albedo)),
      laplacian_(brightness_.size()),
      across_(static_cast<std::size_t>(image.width)),
      down_(across_.size()),
      squares_(across_.size()) {}

double ShadingEnergy::value_and_gradient(const Field& z, double lambda, Field& gradient) {
  const double roughness = take_laplacian(z);
  for (int y = 0; y < height_; ++y)
    laplacian_row(laplacian_, y, 2 * lambda, gradient.data() + pixel_index(0, y, width_));
  const double shading = add_shading(z, gradient);
  residual_ = std::sqrt(shading / static_cast<double>(z.size()));
  return shading + lambda * roughness;
}

/// factor · Δ, the 5-point Laplacian with periodic or reflecting borders; symmetric as a matrix.
void ShadingEnergy::laplacian_row(const Field& z, int y, double factor, double* result) const {
  const auto beyond = [this](int i, int count) { return periodic_ ? wrapped(i, count) : std::clamp(i, 0, count - 1); };
  const auto row_of = [&](int i) { return z.data() + pixel_index(0, beyond(i, height_), width_); };
  const double *const row = row_of(y), *const up = row_of(y - 1), *const down = row_of(y + 1);
  for (const int x : {0, width_ - 1})
    result[x] = factor * (row[beyond(x - 1, width_)] + row[beyond(x + 1, width_)] + up[x] + down[x] - 4 * row[x]);
  if (width_ > 2) laplacian(row + 1, up + 1, down + 1, factor, result + 1, static_cast<std::size_t>(width_) - 2);
}

/// @return the sum of the Laplacian's squares.
double ShadingEnergy::take_laplacian(const Field& z) {
  double squares = 0;
  for (int y = 0; y < height_; ++y) {
    double* const row = laplacian_.data() + pixel_index(0, y, width_);
    laplacian_row(z, y, 1, row);
    square(row, squares_.data(), squares_.size());
    squares += sum(squares_.data(), squares_.size());
  }
  return squares;
}

double ShadingEnergy::add_shading(const Field& z, Field& gradient) {
  double energy = 0;
  const auto inner = static_cast<std::size_t>(std::max(0, width_ - 2));
  for (int y = 0; y < height_; ++y) {
    const Neighbours rows = neighbours(y, height_, periodic_);
    const double *const row = z.data() + pixel_index(0, y, width_),
                        *const up = z.data() + pixel_index(0, rows.before, width_),
                        *const down = z.data() + pixel_index(0, rows.after, width_),
                        *const target = brightness_.data() + pixel_index(0, y, width_);
    double* const changes = gradient.data() + pixel_index(0, y, width_);
    const auto shade_from = [&](int x, std::size_t count) {
      const Neighbours columns = neighbours(x, width_, periodic_);
      shade(light_,
            {row + columns.before, row + columns.after, up + x, down + x, target + x, columns.inverse_distance,
             rows.inverse_distance},
            across_.data() + x, down_.data() + x, squares_.data() + x, count);
      add(changes + columns.after, across_.data() + x, count);
      subtract(changes + columns.before, across_.data() + x, count);
    };
    shade_from(0, 1);
    if (inner > 0) shade_from(1, inner);
    if (width_ > 1) shade_from(width_ - 1, 1);
    add(gradient.data() + pixel_index(0, rows.after, width_), down_.data(), down_.size());
    subtract(gradient.data() + pixel_index(0, rows.before, width_), down_.data(), down_.size());
    energy += sum(squares_.data(), squares_.size());
  }
  return energy;
}

}  // namespace papilla::texture_detail
