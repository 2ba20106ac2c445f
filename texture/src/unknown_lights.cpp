// SPDX-License-Identifier: GPL-3.0-or-later
#include "unknown_lights.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "checks.hpp"
#include "light_matrix.hpp"
#include "papilla/core/units.hpp"
#include "shaped_noise.hpp"

namespace papilla::texture_detail {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector4d;
using Eigen::VectorXd;

/// A pixel and its neighbours: brightness in all photographs.
struct Cross {
  enum Place { centre, left, right, above, below };
  std::array<VectorXd, 5> values;
  int tile = 0;  ///< 0 or 1: its square of a checkerboard.
};
using Crosses = std::vector<Cross>;

/// Noise of single pixels is no slope.
Photographs smoothed(const Photographs& photographs) {
  constexpr double k_radius_px = 1;
  Photographs result = photographs;
  for (Field& field : result.fields)
    filter(field, result.width, result.height, false, [](double x, double y) {
      return std::exp(-2 * std::numbers::pi * std::numbers::pi * k_radius_px * k_radius_px * (x * x + y * y));
    });
  return result;
}

/// Pixels that are neither shadow nor highlight in any photograph, evenly over the picture.
Crosses sample(const Photographs& photographs) {
  constexpr double k_most = 12000, k_darkest = 0.3, k_brightest = 2.5;
  constexpr int k_tile_px = 16;
  const int width = photographs.width, height = photographs.height;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(width) * height / k_most)));
  const auto count = static_cast<Eigen::Index>(photographs.fields.size());
  const auto at = [&](int x, int y) {
    VectorXd values(count);
    for (Eigen::Index k = 0; k < count; ++k)
      values[k] = photographs.fields[static_cast<std::size_t>(k)][pixel_index(x, y, width)];
    return values;
  };
  Crosses crosses;
  for (int y = 1; y + 1 < height; y += step)
    for (int x = 1; x + 1 < width; x += step) {
      Cross cross{{at(x, y), at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)},
                  (x / k_tile_px + y / k_tile_px) % 2};
      const VectorXd& values = cross.values[Cross::centre];
      const double mean = values.mean();
      if (values.minCoeff() > k_darkest * mean && values.maxCoeff() < k_brightest * mean && mean > 0.1)
        crosses.push_back(std::move(cross));
    }
  return crosses;
}

Crosses half_of(const Crosses& crosses, int tile) {
  Crosses half;
  std::copy_if(crosses.begin(), crosses.end(), std::back_inserter(half),
               [&](const Cross& cross) { return cross.tile == tile; });
  return half;
}

/// Rows (s_x/s_z, s_y/s_z), one a light.
using Obliqueness = MatrixXd;

/// Lights by the two strongest directions of the differences between photographs, and integrability.
Obliqueness linear_lights(const Crosses& crosses, Eigen::Index count) {
  MatrixXd differences = MatrixXd::Zero(count, count);
  for (const Cross& cross : crosses) {
    const VectorXd& values = cross.values[Cross::centre];
    const VectorXd difference = values.array() - values.mean();
    differences += difference * difference.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> directions(differences);
  const MatrixXd strongest = directions.eigenvectors().rightCols(2);
  // Albedo that does not depend on the slope: its part along the slopes is taken out.
  Matrix2d squares = Matrix2d::Zero();
  Vector2d products = Vector2d::Zero();
  for (const Cross& cross : crosses) {
    const Vector2d part = strongest.transpose() * cross.values[Cross::centre];
    squares += part * part.transpose();
    products += part * cross.values[Cross::centre].mean();
  }
  const Vector2d along = -(squares + 1e-12 * Matrix2d::Identity()).ldlt().solve(products);
  const auto slope = [&](const VectorXd& values) -> Vector2d {
    const Vector2d part = strongest.transpose() * values;
    return -part / std::max(values.mean() + along.dot(part), 0.05);
  };
  Matrix4d curls = Matrix4d::Zero(), energies = Matrix4d::Zero();
  for (const Cross& cross : crosses) {
    const Vector2d across = slope(cross.values[Cross::right]) - slope(cross.values[Cross::left]);
    const Vector2d down = slope(cross.values[Cross::below]) - slope(cross.values[Cross::above]);
    Vector4d row;
    row << down, -across;
    curls += row * row.transpose();
    const Matrix2d energy = across * across.transpose() + down * down.transpose();
    energies.topLeftCorner<2, 2>() += energy;
    energies.bottomRightCorner<2, 2>() += energy;
  }
  energies += 1e-9 * (energies.trace() + 1e-12) * Matrix4d::Identity();
  // Least curl for its energy: (E^-1/2) C (E^-1/2) of the Cholesky factor of E.
  const Eigen::LLT<Matrix4d> factor(energies);
  Matrix4d relative = factor.matrixL().solve(curls);
  relative = factor.matrixL().solve(relative.transpose().eval());
  const Vector4d whitened = Eigen::SelfAdjointEigenSolver<Matrix4d>(relative).eigenvectors().col(0);
  const Vector4d least = factor.matrixU().solve(whitened);
  Matrix2d slopes;
  slopes << least[0], least[1], least[2], least[3];
  // Ridges of one direction say nothing about the slopes along them: those stay small and finite.
  constexpr double k_least_ratio = 0.1;
  const Eigen::SelfAdjointEigenSolver<Matrix2d> parts(slopes.transpose() * slopes);
  const double largest = std::sqrt(std::max(parts.eigenvalues()[1], 1e-24));
  Matrix2d inverse = Matrix2d::Zero();
  Vector2d first = slopes * parts.eigenvectors().col(1) / largest;
  inverse += parts.eigenvectors().col(1) * first.transpose();
  const Vector2d image = slopes * parts.eigenvectors().col(0) / largest;
  const double side = first.x() * image.y() - first.y() * image.x() < 0 ? -1 : 1;
  const Vector2d second = side * Vector2d(-first.y(), first.x());
  inverse += parts.eigenvectors().col(0) * second.transpose() / std::max(image.norm(), k_least_ratio);
  const MatrixXd rows = strongest - VectorXd::Ones(count) * along.transpose();
  return rows * inverse;
}

MatrixXd with_ones(const Obliqueness& lights) {
  MatrixXd matrix(lights.rows(), 3);
  matrix << lights, VectorXd::Ones(lights.rows());
  return matrix;
}

/// What the least squares run over: how far the photographs are from three dimensions and the slopes from a relief,
/// both relative to their usual size, and how far the lights are from their usual elevation.
class Residuals {
 public:
  Residuals(const Crosses& crosses, const Obliqueness& start) : crosses_(crosses), lights_(start.rows()) {
    std::vector<double> ranks, curls;
    evaluate(start, ranks, curls);
    rank_scale_ = usual(ranks), curl_scale_ = usual(curls);
    for (std::size_t i = 0; i < crosses.size(); ++i)
      weights_.push_back({trust(ranks[i] / rank_scale_), trust(curls[i] / curl_scale_)});
  }

  int size() const { return static_cast<int>(2 * crosses_.size() + static_cast<std::size_t>(lights_)); }

  bool operator()(double const* const* parameters, double* residuals) const {
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>> lights(parameters[0], lights_, 2);
    std::vector<double> ranks, curls;
    evaluate(lights, ranks, curls);
    for (std::size_t i = 0; i < crosses_.size(); ++i) {
      residuals[2 * i] = weights_[i][0] * ranks[i] / rank_scale_;
      residuals[2 * i + 1] = weights_[i][1] * curls[i] / curl_scale_;
    }
    // Level ground has no scale; Ceres would say so on stderr.
    if (!std::all_of(residuals, residuals + 2 * crosses_.size(), [](double r) { return std::isfinite(r); }))
      return false;
    constexpr double k_usual = 0.2, k_spread = 0.35;  // Of the logarithm of cot(elevation).
    for (Eigen::Index k = 0; k < lights_; ++k)
      residuals[2 * crosses_.size() + static_cast<std::size_t>(k)] =
          (std::log(std::max(lights.row(k).norm(), 1e-3)) - k_usual) / k_spread;
    return true;
  }

 private:
  void evaluate(const Obliqueness& lights, std::vector<double>& ranks, std::vector<double>& curls) const {
    const MatrixXd matrix = with_ones(lights);
    const Eigen::Matrix<double, 3, Eigen::Dynamic> inverse = pseudo_inverse(matrix);
    const auto slope = [&](const VectorXd& values) -> Vector2d {
      const Eigen::Vector3d b = inverse * values;
      return -b.head<2>() / std::max(b[2], 0.05);
    };
    double energy = 1e-12;
    for (const Cross& cross : crosses_) {
      const VectorXd& values = cross.values[Cross::centre];
      ranks.push_back((values - matrix * (inverse * values)).norm() / values.mean());
      const Vector2d across = slope(cross.values[Cross::right]) - slope(cross.values[Cross::left]);
      const Vector2d down = slope(cross.values[Cross::below]) - slope(cross.values[Cross::above]);
      curls.push_back(down.x() - across.y());
      energy += across.squaredNorm() + down.squaredNorm();
    }
    const double scale = 1 / std::sqrt(energy / static_cast<double>(crosses_.size()));
    for (double& curl : curls) curl *= scale;
  }

  static double usual(std::vector<double> values) {
    for (double& value : values) value = std::abs(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return std::max(*middle / 0.6745, 1e-4);
  }

  /// Square root of Cauchy's weight.
  static double trust(double relative) { return 1 / std::sqrt(1 + relative * relative / (2.385 * 2.385)); }

  const Crosses& crosses_;
  Eigen::Index lights_;
  double rank_scale_ = 1, curl_scale_ = 1;
  std::vector<std::array<double, 2>> weights_;
};

Obliqueness refine(const Crosses& crosses, Obliqueness lights, UnknownLights* result) {
  const Stopwatch watch;
  for (int round = 0; round < 2; ++round) {  // The weights follow the lights once.
    const double before = watch.seconds();
    std::vector<double> parameters;
    for (Eigen::Index k = 0; k < lights.rows(); ++k) parameters.insert(parameters.end(), {lights(k, 0), lights(k, 1)});
    auto residuals = std::make_unique<Residuals>(crosses, lights);
    const int count = residuals->size();
    auto cost = std::make_unique<ceres::DynamicNumericDiffCostFunction<Residuals>>(residuals.release());
    cost->AddParameterBlock(static_cast<int>(parameters.size()));
    cost->SetNumResiduals(count);
    ceres::Problem problem;
    problem.AddResidualBlock(cost.release(), nullptr, parameters.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 25;
    options.function_tolerance = 1e-5;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    for (Eigen::Index k = 0; k < lights.rows(); ++k)
      lights.row(k) << parameters[static_cast<std::size_t>(2 * k)], parameters[static_cast<std::size_t>(2 * k + 1)];
    if (!result) continue;
    for (const ceres::IterationSummary& step : summary.iterations)
      result->trace.push_back({before + step.cumulative_time_in_seconds, std::sqrt(2 * step.cost / count)});
    result->stop = summary.termination_type == ceres::CONVERGENCE ? StopReason::converged : StopReason::iteration_limit;
  }
  return lights;
}

/// The factor of the slopes by which the albedo depends least on the steepness, next to lights of usual elevation:
/// b_z √(1 + λ²|slope|²) is the albedo.
double depth_factor(const Crosses& crosses, const Obliqueness& lights) {
  constexpr double k_usual = 0.2, k_spread = 0.3, k_independent = 100;
  const Eigen::Matrix<double, 3, Eigen::Dynamic> inverse = pseudo_inverse(with_ones(lights));
  double elevation = 0;
  for (Eigen::Index k = 0; k < lights.rows(); ++k) elevation += std::log(std::max(lights.row(k).norm(), 1e-3));
  elevation /= static_cast<double>(lights.rows());
  double best = 1, best_cost = 1e300;
  for (int i = -12; i <= 12; ++i) {
    const double factor = std::exp(0.1 * i);
    double sum = 0, squares = 0, count = 0;
    for (const Cross& cross : crosses) {
      const Eigen::Vector3d b = inverse * cross.values[Cross::centre];
      if (!(b[2] > 0.05)) continue;
      const double steepness = b.head<2>().squaredNorm() / (b[2] * b[2]);
      const double value = std::log(b[2]) + 0.5 * std::log1p(factor * factor * steepness);
      sum += value, squares += value * value, count += 1;
    }
    if (count < 1) return 1;
    const double variance = std::max(squares / count - sum * sum / (count * count), 1e-12);
    const double unusual = (elevation - std::log(factor) - k_usual) / k_spread;
    const double cost = k_independent * std::log(variance) + unusual * unusual;
    if (cost < best_cost) best = factor, best_cost = cost;
  }
  return best;
}

std::vector<Vec3> directions(const Obliqueness& lights) {
  std::vector<Vec3> result;
  for (Eigen::Index k = 0; k < lights.rows(); ++k) result.push_back(normalized({lights(k, 0), lights(k, 1), 1}));
  return result;
}

/// Mean angle between lights, the second ones turned to the first ones' side.
double mean_angle_deg(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double agreement = 0, sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) agreement += a[k].x * b[k].x + a[k].y * b[k].y;
  const double side = agreement < 0 ? -1 : 1;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += std::acos(std::clamp(dot(a[k], Vec3{side * b[k].x, side * b[k].y, b[k].z}), -1.0, 1.0));
  return sum / static_cast<double>(a.size()) * k_degrees_per_radian;
}

/// The first light comes from above the picture.
void choose_side(Obliqueness& lights) {
  if (lights(0, 1) > 0) lights = -lights;
}

constexpr double k_usual_obliqueness = 1.2;  // cot(40 degrees).

/// Whether the lights determine a normal at all.
bool is_solvable(const Obliqueness& lights) {
  if (!lights.allFinite()) return false;
  constexpr double k_least_ratio = 1e-3;
  const MatrixXd matrix = with_ones(lights);
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Eigen::Matrix3d(matrix.transpose() * matrix)).eigenvalues();
  return values[0] > k_least_ratio * k_least_ratio * values[2];
}

/// Whether the lights lie around, not on a line.
bool is_spread(const Obliqueness& lights) {
  constexpr double k_least_ratio = 0.1;
  const Matrix2d squares = lights.transpose() * lights;
  const Vector2d values = Eigen::SelfAdjointEigenSolver<Matrix2d>(squares).eigenvalues();
  return lights.allFinite() && values[0] > k_least_ratio * k_least_ratio * values[1];
}

Obliqueness solve(const Crosses& crosses, Eigen::Index count, UnknownLights* result) {
  Obliqueness lights = linear_lights(crosses, count);
  const double length = std::sqrt(lights.squaredNorm() / static_cast<double>(count));
  // Photographs without differences: any lights explain them.
  if (!(length > 0) || !is_solvable(lights * (k_usual_obliqueness / length))) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
      lights.row(k) << std::cos(turn), std::sin(turn);
    }
    return lights;
  }
  lights *= k_usual_obliqueness / length;
  const Obliqueness refined = refine(crosses, lights, result);
  if (is_spread(refined)) lights = refined;
  // Slopes and lights are known up to a common factor: start at the usual elevation.
  lights *= k_usual_obliqueness / std::sqrt(lights.squaredNorm() / static_cast<double>(count));
  lights /= depth_factor(crosses, lights);
  choose_side(lights);
  return lights;
}

}  // namespace

UnknownLights estimate_lights(const Photographs& photographs) {
  const auto count = static_cast<Eigen::Index>(photographs.fields.size());
  const Crosses crosses = sample(smoothed(photographs));
  UnknownLights result;
  result.lights = directions(solve(crosses, count, &result));
  result.uncertainty_deg = mean_angle_deg(directions(solve(half_of(crosses, 0), count, nullptr)),
                                          directions(solve(half_of(crosses, 1), count, nullptr)));
  return result;
}

}  // namespace papilla::texture_detail
