// SPDX-License-Identifier: GPL-3.0-or-later
#include "photograph_gains.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "albedo_normals.hpp"
#include "checks.hpp"
#include "cosine_filter.hpp"
#include "light_matrix.hpp"
#include "papilla/texture/even_light.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "pyramid.hpp"

namespace papilla::texture_detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int k_terms = 6;
using Terms = std::array<double, k_terms>;

/// Coordinates in halves of the longer side, from the middle.
class Frame {
 public:
  Frame(int width, int height)
      : half_(std::max(width, height) / 2.0), middle_x_((width - 1) / 2.0), middle_y_((height - 1) / 2.0) {}

  Terms terms(double column, double row) const {
    const double x = (column - middle_x_) / half_, y = (row - middle_y_) / half_;
    return {1, x, y, x * x, x * y, y * y};
  }

 private:
  double half_, middle_x_, middle_y_;
};

double value_of(const VectorXd& coefficients, const Terms& terms) {
  double sum = 0;
  for (int i = 0; i < k_terms; ++i) sum += coefficients[i] * terms[static_cast<std::size_t>(i)];
  return sum;
}

GreyImage picture_of(const Field& field, int width, int height) {
  GreyImage image{width, height, {}};
  image.pixels.assign(field.begin(), field.end());
  return image;
}

/// The light_field() of the means over blocks, in which shading is linear in the slopes.
VectorXd log_quadric(const Field& field, int width, int height) {
  constexpr int k_most_blocks = 64;  // Along a side.
  const GreyImage blocks = shrunk(picture_of(field, width, height), k_most_blocks).image;
  const auto q = light_field(SamplesInMemory(blocks.pixels, blocks.width, blocks.height), false).quadric;
  const double side = std::max(width, height), x = side / width, y = side / height;  // From borders to the longer side.
  return (VectorXd(k_terms) << q[0], x * q[1], y * q[2], x * x * q[3], x * y * q[4], y * y * q[5]).finished();
}

void divide(Field& field, int width, int height, const VectorXd& log_gain, double mean) {
  const Frame frame(width, height);
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      sum += field[pixel_index(x, y, width)] *= std::exp(-value_of(log_gain, frame.terms(x, y)));
  const double scale = sum > 0 ? mean * static_cast<double>(field.size()) / sum : 0;
  for (double& value : field) value *= scale;
}

/// Variance of the slopes in one wave of k half periods along the longer side, continued to long waves.
class SlopeSpectrum {
 public:
  SlopeSpectrum(const Slopes& slopes, int width, int height) {
    constexpr std::array<double, 5> k_bands = {2.5, 4.5, 7, 10.5, 16};
    const Field relief = integrate(slopes, width, height);
    const double side = std::max(width, height);
    CosineFilter2d transform(width, height);
    Field gains(relief.size()), band(relief.size());
    double weights = 0, mean_x = 0, mean_y = 0, product = 0, square = 0, first_x = 0, first_y = 0;
    for (std::size_t i = 0; i + 1 < k_bands.size(); ++i) {
      double waves = 0, logs = 0;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
          const double k = std::hypot(u * side / width, v * side / height);
          const bool inside = k >= k_bands[i] && k < k_bands[i + 1];
          gains[pixel_index(u, v, width)] = inside ? k * std::numbers::pi / side : 0;
          if (inside) waves += 1, logs += std::log(k);
        }
      if (waves == 0) continue;
      transform.apply(relief, gains, band);
      double power = 0;
      for (const double value : band) power += value * value;
      const double x = logs / waves, y = std::log(std::max(power / static_cast<double>(band.size()) / waves, 1e-30));
      if (weights == 0) first_x = x, first_y = y;
      weights += waves, mean_x += waves * x, mean_y += waves * y, product += waves * x * y, square += waves * x * x;
    }
    if (weights == 0) return;
    const double spread = square - mean_x * mean_x / weights;
    exponent_ = spread > 0 ? std::clamp((product - mean_x * mean_y / weights) / spread, -2.0, 0.0) : 0;
    level_ = first_y - exponent_ * first_x;
  }

  double operator()(double k) const { return std::exp(level_ + exponent_ * std::log(k)); }

 private:
  double level_ = std::log(1e-30), exponent_ = 0;
};

/// Coefficients of the photographs' quadrics: what of them belongs to the relief.
struct Split {
  MatrixXd relief;     ///< Columns: what a unit of each parameter of the relief adds to them.
  MatrixXd nuisance;   ///< Columns: what is the same in all photographs.
  VectorXd lamp;       ///< What a near lamp adds; empty: nothing.
  VectorXd variances;  ///< Of the parameters.
  double usual = 0;    ///< Usual deviation of the light's coefficients.
};

VectorXd relief_part(const VectorXd& coefficients, const Split& split) {
  constexpr double k_free = 1e4, k_usual_count = 2;
  const Eigen::Index count = coefficients.size();
  const MatrixXd basis =
      Eigen::HouseholderQR<MatrixXd>(split.nuisance).householderQ() * MatrixXd::Identity(count, split.nuisance.cols());
  const auto reduced = [&](const auto& values) { return (values - basis * (basis.transpose() * values)).eval(); };
  const MatrixXd prior = split.variances.cwiseInverse().asDiagonal();
  const double usual = split.usual * split.usual;
  MatrixXd shape = MatrixXd::Identity(count, count) + k_free * basis * basis.transpose();
  if (split.lamp.size() == count)
    shape += split.lamp * split.lamp.transpose() * (static_cast<double>(count) / 2 / split.lamp.squaredNorm());
  const MatrixXd inverse = shape.inverse();
  const MatrixXd information = split.relief.transpose() * inverse * split.relief;
  double variance = usual;
  VectorXd parameters;
  for (int step = 0; step < 10; ++step) {
    const MatrixXd posterior = (information / variance + prior).inverse();
    parameters = posterior * (split.relief.transpose() * (inverse * coefficients)) / variance;
    const double freedom =
        static_cast<double>(count - split.nuisance.cols() - split.relief.cols()) + (prior * posterior).trace();
    variance = (reduced(coefficients - split.relief * parameters).squaredNorm() + k_usual_count * usual) /
               (std::max(0.0, freedom) + k_usual_count);
  }
  return split.relief * parameters;
}

/// The part of the quadrics that a relief a x²/2 + b x y + c y²/2 and one of third degree make.
MatrixXd relief_of_quadrics(const MatrixXd& quadrics, const std::vector<Vec3>& lights, const SlopeSpectrum& spectrum,
                            double width, double height) {
  const auto count = static_cast<Eigen::Index>(lights.size());
  const double side = std::max(width, height);
  const double xx = width * width / (side * side) / 3, yy = height * height / (side * side) / 3;  // Mean x², y².
  const double vxx = 0.8 * xx * xx, vyy = 0.8 * yy * yy, vxy = xx * yy;  // Variances of x², y², x y.
  Split linear{MatrixXd::Zero(2 * count, 3), MatrixXd::Zero(2 * count, 2), VectorXd::Zero(2 * count), VectorXd(3),
               0.05};
  Split cubic{MatrixXd::Zero(3 * count, 4), MatrixXd::Zero(3 * count, 3), {}, VectorXd(4), 0.025};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec3 s = lights[static_cast<std::size_t>(k)];
    const double p = -s.x / s.z, q = -s.y / s.z;
    linear.relief.block(2 * k, 0, 2, 3) << p, q, 0, 0, p, q;
    linear.nuisance.block(2 * k, 0, 2, 2).setIdentity();
    linear.lamp.segment(2 * k, 2) << p, q;
    cubic.relief.block(3 * k, 0, 3, 4) << 3 * p, q, 0, 0, 0, 2 * p, 2 * q, 0, 0, 0, p, 3 * q;
    cubic.nuisance.block(3 * k, 0, 3, 3).setIdentity();
  }
  linear.variances << spectrum(1.5) / xx, spectrum(1.5) / (xx + yy), spectrum(1.5) / yy;
  cubic.variances << spectrum(2.5) / (9 * vxx), spectrum(2.5) / (4 * vxy + vxx), spectrum(2.5) / (vyy + 4 * vxy),
      spectrum(2.5) / (9 * vyy);
  MatrixXd kept = MatrixXd::Zero(count, k_terms);
  VectorXd first(2 * count), second(3 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    first.segment(2 * k, 2) = quadrics.row(k).segment(1, 2).transpose();
    second.segment(3 * k, 3) = quadrics.row(k).segment(3, 3).transpose();
  }
  first = relief_part(first, linear);
  second = relief_part(second, cubic);
  for (Eigen::Index k = 0; k < count; ++k) {
    kept.row(k).segment(1, 2) = first.segment(2 * k, 2).transpose();
    kept.row(k).segment(3, 3) = second.segment(3 * k, 3).transpose();
  }
  return kept;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Means of blocks of all photographs over their albedo; columns are blocks. Single pixels are noise.
MatrixXd blocks_of(const Photographs& photographs, const MatrixXd& lights, int side) {
  const int columns = photographs.width / side, rows = photographs.height / side;
  const auto count = static_cast<Eigen::Index>(photographs.fields.size());
  MatrixXd values = MatrixXd::Zero(count, static_cast<Eigen::Index>(columns) * rows);
  for (Eigen::Index k = 0; k < count; ++k)
    for (int y = 0; y < rows * side; ++y)
      for (int x = 0; x < columns * side; ++x)
        values(k, (y / side) * static_cast<Eigen::Index>(columns) + x / side) +=
            photographs.fields[static_cast<std::size_t>(k)][pixel_index(x, y, photographs.width)];
  const MatrixXd inverse = lights.completeOrthogonalDecomposition().pseudoInverse();
  const VectorXd albedo = (inverse * values).colwise().norm().transpose();
  const double least = std::max(0.2 * median({albedo.data(), albedo.data() + albedo.size()}), 1e-12);
  for (Eigen::Index i = 0; i < values.cols(); ++i) values.col(i) /= std::max(albedo[i], least);
  return values;
}

/// Robust deviation of a photograph from what the others say.
double deviation_of(const Photographs& photographs, const std::vector<Vec3>& lights, int side) {
  constexpr double k_least = 0.003;  // Rounding of a byte.
  const MatrixXd matrix = matrix_of(lights);
  const Eigen::Index freedom = matrix.rows() - 3;
  const MatrixXd across = Eigen::JacobiSVD<MatrixXd>(matrix, Eigen::ComputeFullU).matrixU().rightCols(freedom);
  const VectorXd errors = (across.transpose() * blocks_of(photographs, matrix, side)).colwise().norm().transpose();
  return std::max(
      median({errors.data(), errors.data() + errors.size()}) / (0.6745 * std::sqrt(static_cast<double>(freedom))),
      k_least);
}

}  // namespace

Field integrate(const Slopes& slopes, int width, int height) {
  const std::size_t count = slopes.across.size();
  constexpr double k_weakest = 0.6;  // What is weaker is noise.
  Field divergence(count), gains(count), relief(count);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = pixel_index(x, y, width), down = i + static_cast<std::size_t>(width);
      if (x + 1 < width) {
        const double rise = (slopes.across[i] + slopes.across[i + 1]) / 2;
        divergence[i] += rise, divergence[i + 1] -= rise;
      }
      if (y + 1 < height) {
        const double rise = (slopes.down[i] + slopes.down[down]) / 2;
        divergence[i] += rise, divergence[down] -= rise;
      }
      // The mean of two neighbouring slopes is weaker than the slope between them by the cosine of half a wave.
      const double u = std::numbers::pi * x / width, v = std::numbers::pi * y / height;
      const double laplacian = (2 - 2 * std::cos(u)) * std::max(k_weakest, std::cos(u / 2)) +
                               (2 - 2 * std::cos(v)) * std::max(k_weakest, std::cos(v / 2));
      gains[i] = i > 0 ? -1 / laplacian : 0;
    }
  CosineFilter2d(width, height).apply(divergence, gains, relief);
  return relief;
}

void flatten(Photographs& photographs) {
  const int width = photographs.width, height = photographs.height;
  for (Field& field : photographs.fields) divide(field, width, height, log_quadric(field, width, height), 1);
}

void even_out(Photographs& photographs, const std::vector<Vec3>& lights) {
  const int width = photographs.width, height = photographs.height;
  const auto count = static_cast<Eigen::Index>(lights.size());
  MatrixXd quadrics(count, k_terms), kept = MatrixXd::Zero(count, k_terms);
  for (Eigen::Index k = 0; k < count; ++k)
    quadrics.row(k) = log_quadric(photographs.fields[static_cast<std::size_t>(k)], width, height).transpose();
  for (int step = 0; step < 3; ++step) {  // The spectrum of the flattened relief, then of what was found with it.
    Photographs even = photographs;
    for (Eigen::Index k = 0; k < count; ++k)
      divide(even.fields[static_cast<std::size_t>(k)], width, height, (quadrics - kept).row(k).transpose(),
             lights[static_cast<std::size_t>(k)].z);
    if (step == 2) {
      photographs = std::move(even);
      return;
    }
    const SlopeSpectrum spectrum(slopes_of(normals_of(even, lights)), width, height);
    kept = relief_of_quadrics(quadrics, lights, spectrum, width, height);
  }
}

Agreement agreement(const Photographs& photographs, std::vector<Vec3>& lights) {
  if (lights.size() < 4) return {};
  constexpr std::array<double, 7> k_ambient = {0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3};
  constexpr int k_block_px = 4;
  constexpr double k_lead = 0.98;  // A smaller gain is chance.
  // Level ground looks the same with more light from everywhere: the photographs keep their means.
  const auto with_ambient = [&](double ambient) {
    std::vector<Vec3> moved = lights;
    for (Vec3& light : moved) {
      const double z = light.z;
      light.z += ambient;
      light = (z / light.z) * light;
    }
    return moved;
  };
  Agreement result;
  double least = 0;
  for (const double ambient : k_ambient) {
    const double deviation = deviation_of(photographs, with_ambient(ambient), k_block_px);
    if (ambient > 0 && deviation > k_lead * least) continue;
    least = deviation;
    result.ambient = ambient;
  }
  lights = with_ambient(result.ambient);
  result.residual = deviation_of(photographs, lights, 1);
  return result;
}

}  // namespace papilla::texture_detail
