// SPDX-License-Identifier: MIT
#include "papilla/texture/primitive.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bicubic.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using Vectors = std::array<Vec2, 2>;

void require_vectors(const GreyImage& image, const Vectors& vectors) {
  const auto usable = [&](Vec2 v) {
    return is_finite(v) && norm(v) >= 2 && std::abs(v.x) <= image.width && std::abs(v.y) <= image.height;
  };
  const double area = std::abs(cross(vectors[0], vectors[1]));
  if (!usable(vectors[0]) || !usable(vectors[1]) || area < 0.01 * norm(vectors[0]) * norm(vectors[1]) || area < 4)
    throw InvalidInput("symmetric_part: the vectors (" + std::to_string(vectors[0].x) + ", " +
                       std::to_string(vectors[0].y) + "), (" + std::to_string(vectors[1].x) + ", " +
                       std::to_string(vectors[1].y) + ") span no cell of the picture");
}

/// Mean of the picture at `start` plus all lattice vectors.
double mean_over_cells(const GreyImage& image, const Vectors& vectors, Vec2 start) {
  const Vec2 a = vectors[0], b = vectors[1];
  const double area = cross(a, b);
  const double right = image.width - 1, bottom = image.height - 1;
  const auto clamped = [&](int x, int y) {
    return image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  };
  // Range of n for which start + m a + n b can hit the picture: from the corners in lattice coordinates.
  double low_n = 1e300, high_n = -1e300;
  for (const Vec2 corner : {Vec2{0, 0}, Vec2{right, 0}, Vec2{0, bottom}, Vec2{right, bottom}}) {
    const double n = cross(a, corner - start) / area;
    low_n = std::min(low_n, n);
    high_n = std::max(high_n, n);
  }
  double sum = 0;
  int count = 0;
  for (int n = static_cast<int>(std::floor(low_n)); n <= static_cast<int>(std::ceil(high_n)); ++n) {
    const Vec2 line = start + static_cast<double>(n) * b;
    // The part of the line line + m a inside the picture.
    double low = -1e300, high = 1e300;
    const auto clip = [&](double origin, double step, double end) {
      constexpr double k_slack = 1e-9;
      if (std::abs(step) < k_slack) {
        if (origin < -k_slack || origin > end + k_slack) high = -1e300;
        return;
      }
      const double m0 = -origin / step, m1 = (end - origin) / step;
      low = std::max(low, std::min(m0, m1) - k_slack);
      high = std::min(high, std::max(m0, m1) + k_slack);
    };
    clip(line.x, a.x, right);
    clip(line.y, a.y, bottom);
    if (low > high) continue;
    for (double m = std::ceil(low); m <= high; ++m) {
      const Vec2 p = line + m * a;
      sum += texture_detail::bicubic(p.x, p.y, clamped);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

GreyImage mean_cell(const GreyImage& image, const Vectors& vectors) {
  const int columns = std::max(2, static_cast<int>(std::lround(norm(vectors[0]))));
  const int rows = std::max(2, static_cast<int>(std::lround(norm(vectors[1]))));
  GreyImage cell{columns, rows, {}, image.pitch_mm, 32};
  cell.pixels.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Vec2 start = (static_cast<double>(i) / columns) * vectors[0] + (static_cast<double>(j) / rows) * vectors[1];
      cell.pixels.push_back(static_cast<float>(mean_over_cells(image, vectors, start)));
    }
  return cell;
}

GreyImage repeat(const GreyImage& cell, const Vectors& vectors, const GreyImage& like) {
  const double area = cross(vectors[0], vectors[1]);
  const auto periodic = [&](int x, int y) {
    return cell.at(texture_detail::wrapped(x, cell.width), texture_detail::wrapped(y, cell.height));
  };
  GreyImage picture{like.width, like.height, {}, like.pitch_mm, 32};
  picture.pixels.reserve(like.pixels.size());
  for (int y = 0; y < like.height; ++y)
    for (int x = 0; x < like.width; ++x) {
      const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
      const double u = cross(p, vectors[1]) / area, v = cross(vectors[0], p) / area;
      picture.pixels.push_back(static_cast<float>(
          texture_detail::bicubic((u - std::floor(u)) * cell.width, (v - std::floor(v)) * cell.height, periodic)));
    }
  return picture;
}

double explained_variance(const SymmetricPart& part, const GreyImage& image, double cell_area) {
  double mean = 0;
  for (const float grey : image.pixels) mean += static_cast<double>(grey);
  const auto pixels = static_cast<double>(image.pixels.size());
  mean /= pixels;
  double total = 0, left = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double deviation = static_cast<double>(image.pixels[i]) - mean,
                 rest = static_cast<double>(part.residual.pixels[i]);
    total += deviation * deviation;
    left += rest * rest;
  }
  if (!(total > 0) || pixels <= cell_area + 1) return 0;
  return std::clamp(1 - left / (pixels - cell_area) / (total / (pixels - 1)), 0.0, 1.0);
}

}  // namespace

SymmetricPart symmetric_part(const GreyImage& image, const std::array<Vec2, 2>& vectors_px) {
  texture_detail::require_image(image, "symmetric_part");
  require_vectors(image, vectors_px);
  SymmetricPart part;
  part.primitive = mean_cell(image, vectors_px);
  part.synthesis = repeat(part.primitive, vectors_px, image);
  part.residual = image;
  part.residual.bits = 32;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) part.residual.pixels[i] -= part.synthesis.pixels[i];
  const double cell_area = std::abs(cross(vectors_px[0], vectors_px[1]));
  part.cells = static_cast<int>(static_cast<double>(image.pixels.size()) / cell_area);
  part.explained_variance = explained_variance(part, image, cell_area);
  return part;
}

}  // namespace papilla
