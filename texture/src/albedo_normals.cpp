// SPDX-License-Identifier: GPL-3.0-or-later
#include "albedo_normals.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace papilla::texture_detail {
namespace {

using Eigen::MatrixXd;

/// Solves for albedo · normal from some of the photographs.
class Solver {
 public:
  /// @param without  index of a photograph that is left out, or −1.
  Solver(const std::vector<Vec3>& lights, int without) : lights_(lights) {
    MatrixXd matrix(static_cast<Eigen::Index>(lights.size()), 3);
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const Vec3 s = static_cast<int>(k) == without ? Vec3{} : lights[k];
      matrix.row(static_cast<Eigen::Index>(k)) << s.x, s.y, s.z;
    }
    const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
    constexpr double k_least_spread = 0.05;  // Lights closer to a plane say too little.
    usable_ = svd.singularValues()[2] > k_least_spread * svd.singularValues()[0];
    if (!usable_) return;
    const MatrixXd inverse =
        svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal() * svd.matrixU().transpose();
    for (Eigen::Index k = 0; k < inverse.cols(); ++k) rows_.push_back({inverse(0, k), inverse(1, k), inverse(2, k)});
  }

  bool usable() const { return usable_; }

  Vec3 solve(const std::vector<double>& values) const {
    Vec3 sum{};
    for (std::size_t k = 0; k < rows_.size(); ++k) sum = sum + values[k] * rows_[k];
    return sum;
  }

  /// Squared difference of the photographs to what the normal predicts.
  double error(const std::vector<double>& values, Vec3 normal, int without) const {
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (static_cast<int>(k) == without) continue;
      const double difference = values[k] - dot(lights_[k], normal);
      sum += difference * difference;
    }
    return sum;
  }

 private:
  const std::vector<Vec3>& lights_;
  std::vector<Vec3> rows_;
  bool usable_ = false;
};

void read(const Photographs& photographs, std::size_t pixel, std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = photographs.fields[k][pixel];
}

constexpr double k_darkest_shadow = 0.2;  // Of the albedo: what the surroundings light.

/// What makes a photograph one to leave out at a pixel, and how unlikely that is.
struct Suspicion {
  Seen seen = Seen::surface;
  double cost = 0;
};

/// @param value,expected  of the photograph, over the albedo that the others say.
Suspicion suspect(double value, double expected, double mirror, double albedo, double deviation) {
  constexpr double k_shadow_cost = 6, k_highlight_cost = 8, k_least_mirror = 0.85, k_usual_albedo = 0.25;
  const double unusual = std::log(std::max(albedo, 1e-2)) / k_usual_albedo;
  if (value < k_darkest_shadow && std::abs(expected - value) > 2 * deviation)
    return {Seen::shadow, k_shadow_cost + unusual * unusual};
  if (value > expected + 2 * deviation && mirror > k_least_mirror)
    return {Seen::highlight, k_highlight_cost + (1 - mirror) / 0.05 + unusual * unusual};
  return {};
}

}  // namespace

NormalField normals_of(const Photographs& photographs, const std::vector<Vec3>& lights) {
  const Solver solver(lights, -1);
  NormalField normals(photographs.fields.front().size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, normals.size(), 4096), [&](const auto& range) {
    std::vector<double> values(lights.size());
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      read(photographs, i, values);
      normals[i] = solver.usable() ? solver.solve(values) : Vec3{0, 0, 1};
    }
  });
  return normals;
}

RobustNormals robust_normals(const Photographs& photographs, const std::vector<Vec3>& lights, double deviation) {
  constexpr double k_suspicious = 16;  // Squared: beyond four deviations.
  RobustNormals result{normals_of(photographs, lights), {}, 0, 0};
  const std::size_t pixels = result.normals.size(), count = lights.size();
  const double freedom = std::max<double>(1, static_cast<double>(count) - 3);
  std::vector<double> sorted(pixels);
  std::transform(result.normals.begin(), result.normals.end(), sorted.begin(), [](Vec3 b) { return norm(b); });
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(pixels / 2), sorted.end());
  const double usual_albedo = std::max(sorted[pixels / 2], 1e-12);
  const double sigma = std::max(deviation, 0.005);
  const Solver all(lights, -1);
  std::vector<Solver> others;
  std::vector<Vec3> mirrors;
  for (std::size_t k = 0; k < count; ++k) {
    others.emplace_back(lights, static_cast<int>(k));
    mirrors.push_back(normalized(normalized(lights[k]) + Vec3{0, 0, 1}));
  }
  result.confidence.resize(pixels);
  std::vector<std::uint8_t> shadows(pixels), highlights(pixels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 4096), [&](const auto& range) {
    std::vector<double> values(count);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      read(photographs, i, values);
      Vec3& normal = result.normals[i];
      double albedo = std::max(norm(normal), 1e-3 * usual_albedo);
      double error = all.error(values, normal, -1) / (albedo * albedo * sigma * sigma * freedom);
      double trust = 1;
      int without = -1;
      if (count > 3 && error > k_suspicious) {
        double cost = error;
        const Vec3 first = normal;
        for (std::size_t k = 0; k < count; ++k) {
          if (!others[k].usable()) continue;
          const Vec3 found = others[k].solve(values);
          const double length = std::max(norm(found), 1e-3 * usual_albedo);
          const Suspicion suspicion = suspect(values[k] / length, dot(lights[k], found) / length,
                                              dot(mirrors[k], found) / length, length / usual_albedo, sigma);
          if (suspicion.seen == Seen::surface || !(found.z > 0)) continue;
          const double left =
              others[k].error(values, found, static_cast<int>(k)) / (length * length * sigma * sigma) + suspicion.cost;
          if (left >= cost) continue;
          cost = left, normal = found, albedo = length, without = static_cast<int>(k), trust = 0.6;
          shadows[i] = suspicion.seen == Seen::shadow, highlights[i] = suspicion.seen == Seen::highlight;
        }
        if (normal == first) trust = 0.5 * k_suspicious / error;
      }
      for (std::size_t k = 0; k < count; ++k)
        if (static_cast<int>(k) != without && values[k] < k_darkest_shadow * albedo) trust *= 0.3, ++shadows[i];
      if (!(normal.z > 0) || std::hypot(normal.x, normal.y) > k_steepest_slope * normal.z) trust *= 0.2;
      result.confidence[i] = static_cast<float>(std::min(1.0, trust));
    }
  });
  const double all_pixels = static_cast<double>(pixels * count);
  double dark = 0, bright = 0;
  for (std::size_t i = 0; i < pixels; ++i) dark += shadows[i], bright += highlights[i];
  result.shadows_fraction = dark / all_pixels;
  result.highlights_fraction = bright / all_pixels;
  return result;
}

Slopes slopes_of(const NormalField& normals) {
  constexpr double k_least_z = 0.05;  // Of the mean: a normal that looks sideways has no slope.
  double mean = 0;
  for (const Vec3 b : normals) mean += b.z;
  const double least = std::max(k_least_z * mean / static_cast<double>(normals.size()), 1e-12);
  Slopes slopes{Field(normals.size()), Field(normals.size())};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double z = std::max(normals[i].z, least);
    const double p = -normals[i].x / z, q = -normals[i].y / z, length = std::hypot(p, q);
    const double shorter = length > k_steepest_slope ? k_steepest_slope / length : 1;
    slopes.across[i] = p * shorter, slopes.down[i] = q * shorter;
  }
  return slopes;
}

}  // namespace papilla::texture_detail
