// SPDX-License-Identifier: GPL-3.0-or-later
#include "photograph_gains.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

/// Of a polynomial of third degree, those of the second first.
constexpr int k_terms = 10;
using Terms = Eigen::Matrix<double, k_terms, 1>;

/// Coordinates in halves of the longer side, from the middle.
class Frame {
 public:
  Frame(int width, int height)
      : half_(std::max(width, height) / 2.0), middle_x_((width - 1) / 2.0), middle_y_((height - 1) / 2.0) {}

  Terms terms(double column, double row) const {
    const double x = (column - middle_x_) / half_, y = (row - middle_y_) / half_;
    return (Terms() << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y).finished();
  }

 private:
  double half_, middle_x_, middle_y_;
};

GreyImage picture_of(const Field& field, int width, int height) {
  GreyImage image{width, height, {}};
  image.pixels.assign(field.begin(), field.end());
  return image;
}

/// The light_field() of the means over blocks, in which shading is linear in the slopes.
Terms log_quadric(const Field& field, int width, int height) {
  constexpr int k_most_blocks = 64;  // Along a side.
  const GreyImage blocks = shrunk(picture_of(field, width, height), k_most_blocks).image;
  const auto q = light_field(SamplesInMemory(blocks.pixels, blocks.width, blocks.height)).quadric;
  const double side = std::max(width, height), x = side / width, y = side / height;  // From borders to the longer side.
  return (Terms() << q[0], x * q[1], y * q[2], x * x * q[3], x * y * q[4], y * y * q[5], 0, 0, 0, 0).finished();
}

void divide(Field& field, int width, int height, const Terms& log_gain, double mean) {
  const Frame frame(width, height);
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      sum += field[pixel_index(x, y, width)] *= std::exp(-log_gain.dot(frame.terms(x, y)));
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

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Lights with light from everywhere.
std::vector<Vec3> with_ambient(std::vector<Vec3> lights, double ambient) {
  for (Vec3& light : lights) light.z += ambient;
  return lights;
}

/// Orthonormal columns that are normal to those of the lights: combinations of photographs that are 0 at every pixel.
MatrixXd across(const MatrixXd& lights) {
  return Eigen::JacobiSVD<MatrixXd>(lights, Eigen::ComputeFullU).matrixU().rightCols(lights.rows() - 3);
}

/// Gains exp(g_k · terms) of the photographs and the light from everywhere, by Gauss and Newton's steps.
class GainSolver {
 public:
  GainSolver(const Photographs& photographs, const std::vector<Vec3>& lights)
      : photographs_(photographs),
        lights_(lights),
        width_(photographs.width),
        height_(photographs.height),
        count_(static_cast<Eigen::Index>(lights.size())),
        frame_(width_, height_),
        unknowns_(VectorXd::Zero(count_ * k_terms + 1)) {
    if (count_ > 3) unknowns_[count_ * k_terms] = k_usual_ambient;
    Terms mean = Terms::Zero();
    for (Eigen::Index k = 0; k < count_; ++k) {
      changed_gain(k) = log_quadric(photographs_.fields[static_cast<std::size_t>(k)], width_, height_);
      changed_gain(k)[0] -= std::log(lights_[static_cast<std::size_t>(k)].z + ambient());
      mean += gain(k) / static_cast<double>(count_);
    }
    for (Eigen::Index k = 0; k < count_; ++k) changed_gain(k) -= mean;
    level_ = median(photographs_.fields.front());
    make_blocks();
    if (count_ > 3) choose_samples();
  }

  void solve() {
    constexpr int k_spectra = 3, k_steps = 6;
    constexpr double k_least_step = 1e-5;
    for (int spectrum = 0; spectrum < k_spectra; ++spectrum) {
      const BlockSlopes slopes = block_slopes();
      const SlopeSpectrum power({slopes.across, slopes.down}, columns_, rows_);
      double change = 1;
      for (int i = 0; i < k_steps && change > k_least_step; ++i) change = step(power);
    }
  }

  double ambient() const { return unknowns_[count_ * k_terms]; }
  Eigen::Map<const Terms> gain(Eigen::Index k) const { return Eigen::Map<const Terms>(unknowns_.data() + k * k_terms); }

 private:
  static constexpr double k_usual_ambient = 0.06;

  /// Means over blocks of the slopes and of what a unit of a constant log gain and of ambient light adds to them.
  struct BlockSlopes {
    Field across, down;
    MatrixXd across_by, down_by;  ///< Rows: photographs, then the ambient light.
  };

  Eigen::Map<Terms> changed_gain(Eigen::Index k) { return Eigen::Map<Terms>(unknowns_.data() + k * k_terms); }

  double value(Eigen::Index k, std::size_t pixel) const {
    return photographs_.fields[static_cast<std::size_t>(k)][pixel];
  }

  /// Blocks for what is long: their slopes' waves of up to k_longest half periods along the longer side.
  void make_blocks() {
    constexpr int k_most_blocks = 64;
    constexpr double k_shortest = 4.5;
    block_ = (std::max(width_, height_) + k_most_blocks - 1) / k_most_blocks;
    columns_ = (width_ + block_ - 1) / block_, rows_ = (height_ + block_ - 1) / block_;
    const double side = std::max(width_, height_);
    std::vector<VectorXd> waves;
    const Eigen::Index blocks = static_cast<Eigen::Index>(columns_) * rows_;
    for (int v = 0; v < k_shortest; ++v)
      for (int u = 0; u < k_shortest; ++u) {
        const double k = std::hypot(u * side / width_, v * side / height_);
        if (k == 0 || k >= k_shortest) continue;
        const double a = std::numbers::pi * u / columns_, b = std::numbers::pi * v / rows_;
        VectorXd wave(2 * blocks);
        for (int y = 0; y < rows_; ++y)
          for (int x = 0; x < columns_; ++x) {
            const Eigen::Index i = static_cast<Eigen::Index>(y) * columns_ + x;
            wave[i] = -a * std::sin(a * (x + 0.5)) * std::cos(b * (y + 0.5));
            wave[blocks + i] = -b * std::cos(a * (x + 0.5)) * std::sin(b * (y + 0.5));
          }
        waves.push_back(wave / (wave.norm() * std::sqrt(static_cast<double>(blocks))));
        numbers_.push_back(k);
      }
    for (const bool down : {false, true}) {  // The mean slope.
      waves.push_back(VectorXd::Zero(2 * blocks));
      waves.back().segment(down ? blocks : 0, blocks).setConstant(1 / static_cast<double>(blocks));
      numbers_.push_back(1);
    }
    waves_.resize(static_cast<Eigen::Index>(waves.size()), 2 * blocks);
    for (Eigen::Index m = 0; m < waves_.rows(); ++m) waves_.row(m) = waves[static_cast<std::size_t>(m)].transpose();
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        block_terms_.push_back(frame_.terms((x + 0.5) * block_ - 0.5, (y + 0.5) * block_ - 0.5));
  }

  /// Pixels, evenly over the picture, that are dark in no photograph, nor a neighbour of them.
  void choose_samples() {
    constexpr double k_most = 2.5e5, k_darkest = 0.15;
    stride_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(width_) * height_ / k_most))));
    std::vector<double> least;
    for (const Field& field : photographs_.fields) least.push_back(k_darkest * median(field));
    const auto dark = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
      for (Eigen::Index k = 0; k < count_; ++k)
        if (!(value(k, pixel_index(x, y, width_)) > least[static_cast<std::size_t>(k)])) return true;
      return false;
    };
    sample_columns_ = (width_ + stride_ - 1) / stride_;
    for (int y = 0; y < height_; y += stride_)
      for (int x = 0; x < width_; x += stride_)
        if (!dark(x, y) && !dark(x - 1, y) && !dark(x + 1, y) && !dark(x, y - 1) && !dark(x, y + 1))
          samples_.push_back(pixel_index(x, y, width_));
  }

  Terms terms_at(std::size_t pixel) const {
    const auto row = static_cast<std::size_t>(width_);
    return frame_.terms(static_cast<double>(pixel % row), static_cast<double>(pixel / row));
  }

  BlockSlopes block_slopes() const {
    const std::size_t blocks = block_terms_.size();
    BlockSlopes sums{Field(blocks), Field(blocks), MatrixXd::Zero(count_ + 1, static_cast<Eigen::Index>(blocks)),
                     MatrixXd::Zero(count_ + 1, static_cast<Eigen::Index>(blocks))};
    constexpr double k_change = 1e-3, k_least_z = 0.05;
    const auto inverse = pseudo_inverse(matrix_of(with_ambient(lights_, ambient()))),
               moved = pseudo_inverse(matrix_of(with_ambient(lights_, ambient() + k_change)));
    tbb::parallel_for(0, rows_, [&](int row) {
      VectorXd even(count_);
      for (int column = 0; column < columns_; ++column) {
        const std::size_t i = pixel_index(column, row, columns_);
        const auto block = static_cast<Eigen::Index>(i);
        const int right = std::min(width_, (column + 1) * block_), below = std::min(height_, (row + 1) * block_);
        double pixels = 0;
        for (int y = row * block_; y < below; ++y)
          for (int x = column * block_; x < right; ++x) {
            const Terms terms = frame_.terms(x, y);
            for (Eigen::Index k = 0; k < count_; ++k)
              even[k] = value(k, pixel_index(x, y, width_)) * std::exp(-gain(k).dot(terms));
            const Eigen::Vector3d b = inverse * even, c = moved * even;
            ++pixels;
            const double least = k_least_z * b.norm();
            if (!(b.z() > least) || !(c.z() > least) || std::hypot(b.x(), b.y()) > k_steepest_slope * b.z()) continue;
            const double p = -b.x() / b.z(), q = -b.y() / b.z();
            sums.across[i] += p, sums.down[i] += q;
            for (Eigen::Index k = 0; k < count_; ++k) {
              sums.across_by(k, block) += (inverse(0, k) + p * inverse(2, k)) * even[k] / b.z();
              sums.down_by(k, block) += (inverse(1, k) + q * inverse(2, k)) * even[k] / b.z();
            }
            sums.across_by(count_, block) += (-c.x() / c.z() - p) / k_change;
            sums.down_by(count_, block) += (-c.y() / c.z() - q) / k_change;
          }
        sums.across[i] /= pixels, sums.down[i] /= pixels;
        sums.across_by.col(block) /= pixels, sums.down_by.col(block) /= pixels;
      }
    });
    return sums;
  }

  /// −log of the probability of the relief's long waves, as a quadratic form around the unknowns.
  void add_waves(const SlopeSpectrum& power, MatrixXd& matrix, VectorXd& right) const {
    constexpr double k_least = 1e-9;
    const BlockSlopes slopes = block_slopes();
    const auto blocks = static_cast<Eigen::Index>(block_terms_.size());
    VectorXd flat(2 * blocks);
    flat << Eigen::Map<const VectorXd>(slopes.across.data(), blocks),
        Eigen::Map<const VectorXd>(slopes.down.data(), blocks);
    VectorXd weights(waves_.rows());
    for (Eigen::Index m = 0; m < weights.size(); ++m)
      weights[m] = 1 / std::max(k_least, power(numbers_[static_cast<std::size_t>(m)]));
    MatrixXd change(waves_.rows(), unknowns_.size());
    VectorXd column(2 * blocks);
    for (Eigen::Index k = 0; k <= count_; ++k)
      for (int term = 0; term < (k < count_ ? k_terms : 1); ++term) {
        for (Eigen::Index i = 0; i < blocks; ++i) {
          const double factor = k < count_ ? block_terms_[static_cast<std::size_t>(i)][term] : 1;
          column[i] = factor * slopes.across_by(k, i), column[blocks + i] = factor * slopes.down_by(k, i);
        }
        change.col(k * k_terms + term) = waves_ * column;
      }
    matrix += change.transpose() * weights.asDiagonal() * change;
    right += change.transpose() * weights.cwiseProduct(waves_ * flat);
  }

  /// The same of what the photographs disagree by. With noise of the same size in all pixels of all photographs, the
  /// combinations r = Wᵀ(I_k e^(−g_k)) that should be 0 have the covariance Wᵀ diag(e^(−2g_k)) W.
  void add_disagreement(MatrixXd& matrix, VectorXd& right) const {
    const MatrixXd lights = matrix_of(with_ambient(lights_, ambient())), normal = across(lights);
    const auto inverse = pseudo_inverse(lights);
    const Eigen::Index freedom = normal.cols();
    const auto samples = static_cast<Eigen::Index>(samples_.size());
    if (samples < unknowns_.size()) return;
    MatrixXd errors(freedom, samples);
    std::vector<MatrixXd> factors(samples_.size());  // Of the columns of `change`, per photograph; last: ambient.
    tbb::parallel_for(Eigen::Index{0}, samples, [&](Eigen::Index i) {
      const std::size_t pixel = samples_[static_cast<std::size_t>(i)];
      const Terms terms = terms_at(pixel);
      VectorXd scale(count_), even(count_);
      for (Eigen::Index k = 0; k < count_; ++k)
        scale[k] = std::exp(-gain(k).dot(terms)), even[k] = scale[k] * value(k, pixel);
      const Eigen::LLT<MatrixXd> root(normal.transpose() * scale.cwiseAbs2().asDiagonal() * normal);
      errors.col(i) = root.matrixL().solve(normal.transpose() * even);
      const VectorXd fitted =
          even - scale.cwiseAbs2().cwiseProduct(normal * root.matrixU().solve(errors.col(i)));  // What is no noise.
      MatrixXd& factor = factors[static_cast<std::size_t>(i)];
      factor.resize(freedom, count_ + 1);
      factor.leftCols(count_) = -root.matrixL().solve(normal.transpose() * fitted.asDiagonal().toDenseMatrix());
      factor.col(count_) =
          -root.matrixL().solve(normal.transpose() * VectorXd::Constant(count_, inverse.row(2).dot(fitted)));
    });
    const double sigma = deviation_of(errors), limit = k_outlier * sigma;
    const double scale = 1 / (sigma * sigma * correlated_pixels(errors, sigma));
    MatrixXd sum = MatrixXd::Zero(unknowns_.size(), unknowns_.size());
    constexpr Eigen::Index k_batch = 256;
    MatrixXd batch(unknowns_.size(), k_batch * freedom);
    VectorXd batch_errors(k_batch * freedom);
    for (Eigen::Index first = 0; first < samples; first += k_batch) {
      const Eigen::Index size = std::min(k_batch, samples - first);
      for (Eigen::Index i = 0; i < size; ++i) {
        const auto sample = static_cast<std::size_t>(first + i);
        const double off = errors.col(first + i).squaredNorm() / (static_cast<double>(freedom) * limit * limit);
        const double weight = off < 1 ? (1 - off) * std::sqrt(scale) : 0;  // Tukey's, its root.
        const Terms terms = terms_at(samples_[sample]);
        for (Eigen::Index c = 0; c < freedom; ++c) {
          for (Eigen::Index k = 0; k < count_; ++k)
            batch.col(i * freedom + c).segment<k_terms>(k * k_terms) = weight * factors[sample](c, k) * terms;
          batch(count_ * k_terms, i * freedom + c) = weight * factors[sample](c, count_);
          batch_errors[i * freedom + c] = weight * errors(c, first + i);
        }
      }
      sum.selfadjointView<Eigen::Lower>().rankUpdate(batch.leftCols(size * freedom));
      right += batch.leftCols(size * freedom) * batch_errors.head(size * freedom);
    }
    matrix += sum.selfadjointView<Eigen::Lower>();
  }

  static constexpr double k_outlier = 4.685, k_to_deviation = 1.4826, k_least_deviation = 1e-4;

  double deviation_of(const MatrixXd& errors) const {
    const VectorXd sizes = errors.cwiseAbs().reshaped();
    return std::max(k_least_deviation * level_, k_to_deviation * median({sizes.data(), sizes.data() + sizes.size()}));
  }

  /// How many neighbouring samples disagree together: the variance of sums over blocks, over that of free samples.
  double correlated_pixels(const MatrixXd& errors, double sigma) const {
    constexpr int k_most_side = 16;
    constexpr std::size_t k_least_blocks = 30;
    double result = 1;
    for (int side = 4; side <= k_most_side; side *= 2) {
      const std::size_t columns = static_cast<std::size_t>((sample_columns_ + side - 1) / side);
      const std::size_t rows = static_cast<std::size_t>((height_ / stride_ + side) / side);
      for (Eigen::Index c = 0; c < errors.rows(); ++c) {
        Field sums(columns * rows), counts(columns * rows);
        for (std::size_t i = 0; i < samples_.size(); ++i) {
          const std::size_t x = samples_[i] % static_cast<std::size_t>(width_) /
                                static_cast<std::size_t>(stride_ * side),
                            y = samples_[i] / static_cast<std::size_t>(width_) /
                                static_cast<std::size_t>(stride_ * side);
          sums[y * columns + x] += std::clamp(errors(c, static_cast<Eigen::Index>(i)), -3 * sigma, 3 * sigma);
          counts[y * columns + x] += 1;
        }
        std::vector<double> sizes;
        for (std::size_t i = 0; i < sums.size(); ++i)
          if (counts[i] * 3 > side * side) sizes.push_back(std::abs(sums[i]) / std::sqrt(counts[i]));
        if (sizes.size() > k_least_blocks)
          result = std::max(result, std::pow(k_to_deviation * median(sizes) / sigma, 2));
      }
    }
    return result;
  }

  /// @return the largest change of an unknown.
  double step(const SlopeSpectrum& power) {
    // A lamp is seldom less even than that; exposures are free.
    constexpr std::array<double, 4> k_usual = {10, 0.1, 0.04, 0.03};
    constexpr std::array<int, k_terms> k_degrees = {0, 1, 1, 2, 2, 2, 3, 3, 3, 3};
    constexpr double k_ambient_deviation = 0.1, k_most_ambient = 0.5, k_rigid = 1e2;
    const Eigen::Index size = unknowns_.size(), last = size - 1;
    MatrixXd matrix = MatrixXd::Zero(size, size);
    VectorXd right = VectorXd::Zero(size);
    if (count_ > 3) add_disagreement(matrix, right);
    add_waves(power, matrix, right);
    for (Eigen::Index i = 0; i < last; ++i) {
      const double weight =
          std::pow(k_usual[static_cast<std::size_t>(k_degrees[static_cast<std::size_t>(i % k_terms)])], -2);
      matrix(i, i) += weight, right[i] += weight * unknowns_[i];
    }
    const double weight = std::pow(k_ambient_deviation, -2);
    matrix(last, last) += weight, right[last] += weight * (unknowns_[last] - k_usual_ambient);
    // What is the same in all photographs is albedo or vignette: their gains keep the sum 0.
    const double rigid = k_rigid * matrix.diagonal().maxCoeff();
    for (int term = 0; term < k_terms; ++term)
      for (Eigen::Index k = 0; k < count_; ++k)
        for (Eigen::Index l = 0; l < count_; ++l) matrix(k * k_terms + term, l * k_terms + term) += rigid;
    if (count_ == 3) {
      matrix.row(last).setZero(), matrix.col(last).setZero();
      matrix(last, last) = 1, right[last] = 0;
    }
    const VectorXd change = -matrix.ldlt().solve(right);
    unknowns_ += change;
    unknowns_[last] = std::clamp(unknowns_[last], 0.0, k_most_ambient);
    return change.cwiseAbs().maxCoeff();
  }

  const Photographs& photographs_;
  const std::vector<Vec3>& lights_;
  int width_, height_;
  double level_ = 0;  ///< Usual brightness.
  Eigen::Index count_;
  Frame frame_;
  VectorXd unknowns_;  ///< Log gains of all photographs, then the ambient light.
  int block_ = 1, columns_ = 0, rows_ = 0;
  MatrixXd waves_;               ///< A wave a row: slopes across all blocks, then down; t² is the slopes' variance.
  std::vector<double> numbers_;  ///< Half periods of the waves along the longer side.
  std::vector<Terms> block_terms_;
  int stride_ = 1, sample_columns_ = 0;
  std::vector<std::size_t> samples_;
};

}  // namespace

Field integrate(const Slopes& slopes, int width, int height) {
  const std::size_t count = slopes.across.size();
  constexpr double k_weakest = 0.6;                                 // What is weaker is noise.
  constexpr double k_least_blur_px = 0.5, k_most_sharpening = 1.4;  // No lens blurs less.
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
      const double blur = std::exp(k_least_blur_px * k_least_blur_px * (u * u + v * v) / 2);
      gains[i] = i > 0 ? -std::min(blur, k_most_sharpening) / laplacian : 0;
    }
  CosineFilter2d(width, height).apply(divergence, gains, relief);
  return relief;
}

void flatten(Photographs& photographs) {
  const int width = photographs.width, height = photographs.height;
  for (Field& field : photographs.fields) divide(field, width, height, log_quadric(field, width, height), 1);
}

double even_out(Photographs& photographs, std::vector<Vec3>& lights) {
  GainSolver solver(photographs, lights);
  solver.solve();
  lights = with_ambient(std::move(lights), solver.ambient());
  const Frame frame(photographs.width, photographs.height);
  for (std::size_t k = 0; k < lights.size(); ++k)
    for (int y = 0; y < photographs.height; ++y)
      for (int x = 0; x < photographs.width; ++x)
        photographs.fields[k][pixel_index(x, y, photographs.width)] *=
            std::exp(-solver.gain(static_cast<Eigen::Index>(k)).dot(frame.terms(x, y)));
  return solver.ambient();
}

double disagreement(const Photographs& photographs, const std::vector<Vec3>& lights) {
  if (lights.size() < 4) return 0;
  constexpr double k_least = 0.003;  // Rounding of a byte.
  const MatrixXd normal = across(matrix_of(lights));
  const auto inverse = pseudo_inverse(matrix_of(lights));
  std::vector<double> errors, albedos;
  VectorXd values(static_cast<Eigen::Index>(lights.size()));
  for (std::size_t i = 0; i < photographs.fields.front().size(); ++i) {
    for (std::size_t k = 0; k < lights.size(); ++k) values[static_cast<Eigen::Index>(k)] = photographs.fields[k][i];
    errors.push_back((normal.transpose() * values).norm());
    albedos.push_back((inverse * values).norm());
  }
  const double least = std::max(0.2 * median(albedos), 1e-12);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] /= std::max(albedos[i], least);
  return std::max(k_least, median(errors) / (0.6745 * std::sqrt(static_cast<double>(normal.cols()))));
}

}  // namespace papilla::texture_detail
