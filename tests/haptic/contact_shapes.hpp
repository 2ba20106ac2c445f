// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"

namespace papilla::testing {

/// A grid of columns × rows cells over [0, width] × [0, depth], z = height(x, y), uv = (x/width, y/depth), front up.
template <class Height>
ContactMesh height_grid(int columns, int rows, double width, double depth, Height&& height) {
  ContactMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double x = width * i / columns, y = depth * j / rows;
      mesh.positions.push_back({x, y, height(x, y)});
    }
  const auto vertex = [columns](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, b, c});
    for (const std::uint32_t v : {a, b, c})
      mesh.corner_uv.push_back({mesh.positions[v].x / width, mesh.positions[v].y / depth});
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      add(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      add(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  return mesh;
}

inline ContactMesh plate(int columns, int rows, double width, double depth) {
  return height_grid(columns, rows, width, depth, [](double, double) { return 0.0; });
}

/// Metres: a relief of ±2.3 mm with slopes up to about 40 degrees and a roughness of 50 µm, over 0.2 m.
inline double rough_relief(double x, double y) {
  return 0.0012 * std::sin(180 * x + 1) * std::sin(150 * y) + 0.0006 * std::sin(500 * x + 300 * y) +
         0.0004 * std::sin(410 * y - 620 * x) + 0.00005 * std::sin(3100 * x) * std::sin(2900 * y);
}

/// Samples of waves in three directions, around the whole picture in both.
inline std::vector<std::uint16_t> wave_samples(int columns, int rows) {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double u = 2 * std::numbers::pi * x / columns, v = 2 * std::numbers::pi * y / rows;
      const double waves = std::sin(4 * u + 3 * v) + std::sin(3 * v - 5 * u) + std::sin(7 * v);
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * (waves + 3) / 6)));
    }
  return samples;
}

/// A sphere around the origin of 2·n·(n−1) triangles, front outside.
inline ContactMesh sphere(int n, double radius) {
  ContactMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double polar = std::numbers::pi * j / n, around = 2 * std::numbers::pi * (i % n) / n;
      mesh.positions.push_back(
          radius * Vec3{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)});
    }
  const auto vertex = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (j + 1 < n) mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      if (j > 0) mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  return mesh;
}

/// An axis-aligned closed box, front outside.
inline ContactMesh box(Vec3 low, Vec3 high) {
  ContactMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A point that wanders over [margin, size − margin]² at a constant speed and turns smoothly at random.
class Wanderer {
 public:
  Wanderer(std::uint64_t seed, double size, double margin, double step)
      : random_(seed), size_(size), margin_(margin), step_(step), x_(size / 2), y_(size / 2) {}
  Vec2 next() {
    std::uniform_real_distribution<double> turn(-0.15, 0.15);
    angle_ += turn(random_);
    const double x = x_ + step_ * std::cos(angle_), y = y_ + step_ * std::sin(angle_);
    if (x < margin_ || x > size_ - margin_ || y < margin_ || y > size_ - margin_)
      angle_ = std::atan2(size_ / 2 - y_, size_ / 2 - x_);
    x_ = std::clamp(x, margin_, size_ - margin_);
    y_ = std::clamp(y, margin_, size_ - margin_);
    return {x_, y_};
  }

 private:
  std::mt19937_64 random_;
  double size_, margin_, step_, x_, y_, angle_ = 0.7;
};

}  // namespace papilla::testing
