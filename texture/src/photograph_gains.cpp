// SPDX-License-Identifier: GPL-3.0-or-later
#include "photograph_gains.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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

/// Mean and covariance.
struct Posterior {
  VectorXd mean;
  MatrixXd covariance;
};

/// Of the relief's part of the coefficients.
Posterior relief_part(const VectorXd& coefficients, const Split& split) {
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
  MatrixXd posterior;
  for (int step = 0; step < 10; ++step) {
    posterior = (information / variance + prior).inverse();
    parameters = posterior * (split.relief.transpose() * (inverse * coefficients)) / variance;
    const double freedom =
        static_cast<double>(count - split.nuisance.cols() - split.relief.cols()) + (prior * posterior).trace();
    variance = (reduced(coefficients - split.relief * parameters).squaredNorm() + k_usual_count * usual) /
               (std::max(0.0, freedom) + k_usual_count);
  }
  return {split.relief * parameters, split.relief * posterior * split.relief.transpose()};
}

/// The part of the quadrics that a relief a x²/2 + b x y + c y²/2 and one of third degree make, photograph by photograph.
Posterior relief_of_quadrics(const MatrixXd& quadrics, const std::vector<Vec3>& lights, const SlopeSpectrum& spectrum,
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
  VectorXd first(2 * count), second(3 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    first.segment(2 * k, 2) = quadrics.row(k).segment(1, 2).transpose();
    second.segment(3 * k, 3) = quadrics.row(k).segment(3, 3).transpose();
  }
  const Posterior bent = relief_part(first, linear), twisted = relief_part(second, cubic);
  Posterior kept{VectorXd::Zero(k_terms * count), MatrixXd::Zero(k_terms * count, k_terms * count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    kept.mean.segment(k_terms * k + 1, 2) = bent.mean.segment(2 * k, 2);
    kept.mean.segment(k_terms * k + 3, 3) = twisted.mean.segment(3 * k, 3);
    for (Eigen::Index j = 0; j < count; ++j) {
      kept.covariance.block(k_terms * k + 1, k_terms * j + 1, 2, 2) = bent.covariance.block(2 * k, 2 * j, 2, 2);
      kept.covariance.block(k_terms * k + 3, k_terms * j + 3, 3, 3) = twisted.covariance.block(3 * k, 3 * j, 3, 3);
    }
  }
  return kept;
}

/// Brightness of every n-th pixel of all photographs over its albedo, and the terms of the quadrics there.
struct Sample {
  MatrixXd values;  ///< Columns are pixels.
  MatrixXd terms;
};

Sample sample_of(const Photographs& photographs, const MatrixXd& lights) {
  constexpr double k_most_pixels = 30000;
  const int width = photographs.width, height = photographs.height;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(width) * height / k_most_pixels)));
  const int columns = (width + step - 1) / step, rows = (height + step - 1) / step;
  const auto count = static_cast<Eigen::Index>(photographs.fields.size());
  const Frame frame(width, height);
  Sample sample{MatrixXd(count, columns * rows), MatrixXd(k_terms, columns * rows)};
  Eigen::Index at = 0;
  for (int y = 0; y < height; y += step)
    for (int x = 0; x < width; x += step, ++at) {
      for (Eigen::Index k = 0; k < count; ++k)
        sample.values(k, at) = photographs.fields[static_cast<std::size_t>(k)][pixel_index(x, y, width)];
      const Terms terms = frame.terms(x, y);
      sample.terms.col(at) = Eigen::Map<const VectorXd>(terms.data(), k_terms);
    }
  const MatrixXd inverse = lights.completeOrthogonalDecomposition().pseudoInverse();
  VectorXd albedo = (inverse * sample.values).colwise().norm().transpose();
  std::vector<double> sorted(albedo.data(), albedo.data() + albedo.size());
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double least = 0.2 * sorted[sorted.size() / 2];
  for (Eigen::Index i = 0; i < at; ++i) sample.values.col(i) /= std::max({albedo[i], least, 1e-12});
  return sample;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Gains {
  MatrixXd corrections;  ///< Rows: photographs, columns: terms; to be added to 1.
  double deviation = 0;
};

/// See balance().
Gains fit_gains(const Sample& sample, const MatrixXd& lights, const MatrixXd& prior) {
  constexpr double k_least_deviation = 0.003;  // Rounding of a byte.
  constexpr double k_usual_brightness = 0.03, k_usual_slope = 0.05, k_common = 1e3;
  static const char* mode = std::getenv("MODE");
  static const int m = mode ? std::atoi(mode) : 0;
  constexpr double k_independent =
      100;  // What differs from the model does so over wide areas: few pixels say their own.
  const Eigen::Index count = lights.rows(), unknowns = count * k_terms, pixels = sample.values.cols();
  const MatrixXd across = Eigen::JacobiSVD<MatrixXd>(lights, Eigen::ComputeFullU).matrixU().rightCols(count - 3);
  Gains best{MatrixXd::Zero(count, k_terms), 0};
  MatrixXd corrections = best.corrections;
  const auto residuals = [&](const MatrixXd& change) {
    const MatrixXd corrected = sample.values.cwiseProduct(MatrixXd::Ones(count, pixels) + change * sample.terms);
    return (across.transpose() * corrected).eval();
  };
  const auto lengths = [&](const MatrixXd& errors) {
    const VectorXd norms = errors.colwise().norm().transpose();
    return std::vector<double>(norms.data(), norms.data() + norms.size());
  };
  const double freedom = std::sqrt(static_cast<double>(count - 3));
  std::vector<double> errors = lengths(residuals(corrections));
  best.deviation = std::max(median(errors) / (0.6745 * freedom), k_least_deviation);
  double deviation = best.deviation;
  MatrixXd row(unknowns, count - 3);
  for (int step = 0; step < 6; ++step) {
    MatrixXd normal = MatrixXd::Zero(unknowns, unknowns);
    VectorXd right = VectorXd::Zero(unknowns);
    for (Eigen::Index i = 0; i < pixels; ++i) {
      const double relative = errors[static_cast<std::size_t>(i)] / (4.685 * freedom * deviation);  // Tukey's biweight.
      if (relative >= 1) continue;
      const double tukey = 1 - relative * relative;
      const double weight = tukey * tukey * k_independent / (static_cast<double>(pixels) * deviation * deviation);
      for (Eigen::Index k = 0; k < count; ++k)
        row.middleRows(k * k_terms, k_terms).noalias() = sample.terms.col(i) * (sample.values(k, i) * across.row(k));
      normal.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
      right.noalias() -= row * (across.transpose() * sample.values.col(i)) * weight;
    }
    normal = normal.selfadjointView<Eigen::Lower>();
    if (m == 2) { normal += prior; } else {
    const double common = k_common * std::max(1.0, normal.trace() / static_cast<double>(unknowns));
    for (Eigen::Index a = 0; a < unknowns; ++a) {
      const double usual = a % k_terms == 0 ? k_usual_brightness : k_usual_slope;
      normal(a, a) += 1 / (usual * usual);
      for (Eigen::Index b = a % k_terms; b < unknowns; b += k_terms) normal(a, b) += common;
    }}
    if (m == 1) normal += 1e12 * MatrixXd::Identity(unknowns, unknowns);
    const VectorXd solution = normal.ldlt().solve(right);
    if (!solution.allFinite()) break;
    for (Eigen::Index k = 0; k < count; ++k) corrections.row(k) = solution.segment(k * k_terms, k_terms).transpose();
    errors = lengths(residuals(corrections));
    deviation = std::max(median(errors) / (0.6745 * freedom), k_least_deviation);
    if (deviation <= best.deviation) best = {corrections, deviation};
  }
  return best;
}

}  // namespace

Field integrate(const Slopes& slopes, int width, int height) {
  const std::size_t count = slopes.across.size();
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
      const double laplacian =
          4 - 2 * std::cos(std::numbers::pi * x / width) - 2 * std::cos(std::numbers::pi * y / height);
      gains[i] = i > 0 ? -1 / laplacian : 0;
    }
  CosineFilter2d(width, height).apply(divergence, gains, relief);
  return relief;
}

void flatten(Photographs& photographs) {
  const int width = photographs.width, height = photographs.height;
  for (Field& field : photographs.fields)
    divide(field, width, height, log_quadric(field, width, height), 1);
}

Eigen::MatrixXd even_out(Photographs& photographs, const std::vector<Vec3>& lights) {
  const int width = photographs.width, height = photographs.height;
  const auto count = static_cast<Eigen::Index>(lights.size());
  MatrixXd quadrics(count, k_terms);
  Posterior kept{VectorXd::Zero(k_terms * count), {}};
  for (Eigen::Index k = 0; k < count; ++k)
    quadrics.row(k) = log_quadric(photographs.fields[static_cast<std::size_t>(k)], width, height).transpose();
  for (int step = 0; step < 3; ++step) {  // The spectrum of the flattened relief, then of what was found with it.
    Photographs even = photographs;
    for (Eigen::Index k = 0; k < count; ++k)
      divide(even.fields[static_cast<std::size_t>(k)], width, height, quadrics.row(k).transpose() - kept.mean.segment(k_terms * k, k_terms),
             lights[static_cast<std::size_t>(k)].z);
    if (step == 2) {
      photographs = std::move(even);
      return std::move(kept.covariance);
    }
    const SlopeSpectrum spectrum(slopes_of(normals_of(even, lights)), width, height);
    kept = relief_of_quadrics(quadrics, lights, spectrum, width, height);
  }
  return {};
}

Balance balance(Photographs& photographs, std::vector<Vec3>& lights, const Eigen::MatrixXd& uncertainty) {
  if (lights.size() < 4) return {};
  constexpr std::array<double, 7> k_ambient = {0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3};
  MatrixXd prior = uncertainty;
  static const double nug = std::getenv("NUG") ? std::atof(std::getenv("NUG")) : 0.003, bri = std::getenv("BRI") ? std::atof(std::getenv("BRI")) : 0.03;
  for (Eigen::Index i = 0; i < prior.rows(); ++i) prior(i, i) += i % k_terms == 0 ? bri * bri : nug * nug;
  prior = prior.inverse().eval();
  std::vector<Vec3> best_lights = lights;
  Gains best;
  Balance result;
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
  for (const double ambient : k_ambient) {
    const std::vector<Vec3> moved = with_ambient(ambient);
    const MatrixXd matrix = matrix_of(moved);
    const Gains gains = fit_gains(sample_of(photographs, matrix), matrix, prior);
    if (ambient > 0 && gains.deviation > 0.98 * best.deviation) continue;
    best = gains, best_lights = moved, result = {ambient, gains.deviation};
  }
  lights = best_lights;
  const Frame frame(photographs.width, photographs.height);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const VectorXd correction = best.corrections.row(static_cast<Eigen::Index>(k)).transpose();
    for (int y = 0; y < photographs.height; ++y)
      for (int x = 0; x < photographs.width; ++x)
        photographs.fields[k][pixel_index(x, y, photographs.width)] *= 1 + value_of(correction, frame.terms(x, y));
  }
  return result;
}

}  // namespace papilla::texture_detail
