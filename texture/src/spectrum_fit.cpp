// SPDX-License-Identifier: MIT
#include "spectrum_fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace papilla::texture_detail {
namespace {

constexpr double k_least_hurst = 0.005, k_most_hurst = 0.995;
constexpr double k_widest_spread_squared = 16;
constexpr int k_most_parameters = 8, k_squared = 6;  // The parameters from the sixth on are not negative.

/// ln a, H, cos 2θ, sin 2θ, cos 4θ, sin 4θ, then σ² and the noise where the model has them.
struct Layout {
  explicit Layout(const SpectrumModel& model) {
    if (model.blurred) spread = count++;
    if (model.noisy) noise = count++;
  }
  int count = k_squared, spread = -1, noise = -1;
};

/// The angular terms of a cell or of its mirror.
std::array<double, 4> directions_of(const SpectrumCell& cell, std::size_t mirrored) {
  const double theta = std::atan2(mirrored == 1 ? -cell.fy : cell.fy, cell.fx);
  return {std::cos(2 * theta), std::sin(2 * theta), std::cos(4 * theta), std::sin(4 * theta)};
}

/// Signed roots of the deviances: half the sum of their squares is the negative logarithm of Whittle's likelihood.
class WhittleCost : public ceres::CostFunction {
 public:
  WhittleCost(std::span<const SpectrumCell> cells, const SurfaceSpectrumModel& surface, const SpectrumModel& model,
              const SpectrumBand& band, double rounding, double noise_unit)
      : cells_(cells), surface_(surface), model_(model), layout_(model), rounding_(rounding), noise_unit_(noise_unit) {
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (std::size_t m = 0; m < 2; ++m)
        if (cells[c].count[m] > 0 && cells[c].power[m] > 0 && band.holds(cells[c]))
          places_.push_back({c, m, directions_of(cells[c], m)});
    mutable_parameter_block_sizes()->push_back(layout_.count);
    set_num_residuals(static_cast<int>(places_.size()));
  }

  /// P of one cell or mirror with its derivatives by the parameters.
  struct Value {
    double power;
    std::array<double, k_most_parameters> slopes;
  };
  Value value(const double* p, std::size_t cell, const std::array<double, 4>& directions) const {
    double angular = 0;
    for (std::size_t k = 0; k < 4; ++k) angular += p[2 + k] * directions[k];
    const double signal = std::exp(std::min(600.0, p[0] + angular)) * spectrum_.power[cell];
    Value result{signal + rounding_, {signal, signal * spectrum_.by_hurst[cell]}};
    for (std::size_t k = 0; k < 4; ++k) result.slopes[2 + k] = signal * directions[k];
    if (layout_.spread >= 0)
      result.slopes[static_cast<std::size_t>(layout_.spread)] = signal * spectrum_.by_spread[cell];
    if (layout_.noise >= 0) {
      result.power += p[layout_.noise] * noise_unit_;
      result.slopes[static_cast<std::size_t>(layout_.noise)] = noise_unit_;
    }
    return result;
  }

  void prepare(const double* p) const {
    surface_.evaluate(model_.spread, p[1], layout_.spread >= 0 ? p[layout_.spread] : 0, spectrum_);
  }

  /// Parameters within their bounds from free ones: H by the logistic function, σ² and noise as squares.
  std::array<double, k_most_parameters> bounded(const double* u, std::array<double, k_most_parameters>& slopes) const {
    std::array<double, k_most_parameters> p{};
    slopes.fill(1);
    std::copy(u, u + layout_.count, p.begin());
    const double share = 1 / (1 + std::exp(-u[1]));
    p[1] = k_least_hurst + (k_most_hurst - k_least_hurst) * share;
    slopes[1] = (k_most_hurst - k_least_hurst) * share * (1 - share);
    for (auto k = static_cast<std::size_t>(k_squared); k < static_cast<std::size_t>(layout_.count); ++k) {
      p[k] = u[k] * u[k];
      slopes[k] = 2 * u[k];
    }
    return p;
  }
  static double free_hurst(double hurst) {
    const double share = (std::clamp(hurst, 0.01, 0.99) - k_least_hurst) / (k_most_hurst - k_least_hurst);
    return std::log(share / (1 - share));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::array<double, k_most_parameters> chain{};
    const std::array<double, k_most_parameters> bound = bounded(parameters[0], chain);
    const double* p = bound.data();
    if (layout_.spread >= 0 && p[layout_.spread] > k_widest_spread_squared) return false;
    prepare(p);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto& [cell, mirrored, directions] = places_[i];
      const Value found = value(p, cell, directions);
      const double count = cells_[cell].count[mirrored], ratio = cells_[cell].power[mirrored] / found.power;
      if (!std::isfinite(found.power) || !(found.power > 0)) return false;
      const double excess = ratio - 1;
      // 1 + excess/3 … is the series of the root about 0.
      const double root = std::abs(excess) < 1e-4
                              ? std::sqrt(count) * excess * (1 - excess / 3)
                              : std::copysign(std::sqrt(2 * count * (excess - std::log(ratio))), excess);
      residuals[i] = root;
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      const double by_log_power =
          std::abs(excess) < 1e-4 ? -std::sqrt(count) * (1 + excess / 3) : -count * excess / root;
      for (int k = 0; k < layout_.count; ++k)
        jacobians[0][i * static_cast<std::size_t>(layout_.count) + static_cast<std::size_t>(k)] =
            by_log_power * found.slopes[static_cast<std::size_t>(k)] * chain[static_cast<std::size_t>(k)] / found.power;
    }
    return true;
  }

  /// Most likely noise with all other parameters as they are, by one step of Fisher's scoring from none.
  double noise_step(const double* p) const {
    prepare(p);
    double score = 0, information = 0;
    for (const auto& [cell, mirrored, directions] : places_) {
      const double power = value(p, cell, directions).power, count = cells_[cell].count[mirrored];
      score += count * (cells_[cell].power[mirrored] / power - 1) / power;
      information += count / (power * power);
    }
    return score / information / noise_unit_;
  }

  /// Fisher's information.
  Eigen::MatrixXd information(const double* p) const {
    prepare(p);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(layout_.count, layout_.count);
    for (const auto& [cell, mirrored, directions] : places_) {
      const Value found = value(p, cell, directions);
      Eigen::VectorXd slopes(layout_.count);
      for (int k = 0; k < layout_.count; ++k) slopes[k] = found.slopes[static_cast<std::size_t>(k)] / found.power;
      sum += cells_[cell].count[mirrored] * slopes * slopes.transpose();
    }
    return sum;
  }

  const Layout& layout() const { return layout_; }
  std::size_t size() const { return places_.size(); }

 private:
  struct Place {
    std::size_t cell, mirrored;
    std::array<double, 4> directions;
  };
  std::span<const SpectrumCell> cells_;
  const SurfaceSpectrumModel& surface_;
  SpectrumModel model_;
  Layout layout_;
  double rounding_, noise_unit_;
  std::vector<Place> places_;
  mutable SurfaceSpectrum spectrum_;
};

/// The cells by distance from the origin: where the scan for first parameters is cheap.
struct Ring {
  double squared = 0, power = 0, count = 0;  ///< f², mean power, independent frequencies.
};

std::vector<Ring> rings_of(std::span<const SpectrumCell> cells, const SpectrumBand& band) {
  constexpr double k_rings_per_log = 7, k_lowest_log = -12;
  std::vector<Ring> rings(static_cast<std::size_t>(-k_lowest_log * k_rings_per_log) + 1);
  for (const SpectrumCell& cell : cells) {
    if (!band.holds(cell)) continue;
    const double squared = cell.frequency_squared(), level = std::pow(squared, 1.5);
    Ring& ring =
        rings[static_cast<std::size_t>(std::max(0.0, (0.5 * std::log(squared) - k_lowest_log) * k_rings_per_log))];
    for (std::size_t m = 0; m < 2; ++m) {
      ring.squared += cell.count[m] * squared;
      ring.power += cell.count[m] * cell.power[m] * level;
      ring.count += cell.count[m];
    }
  }
  std::erase_if(rings, [](const Ring& ring) { return !(ring.count > 0) || !(ring.power > 0); });
  for (Ring& ring : rings) {
    ring.squared /= ring.count;
    ring.power /= ring.count * std::pow(ring.squared, 1.5);
  }
  return rings;
}

double least_power(std::span<const SpectrumCell> cells, const SpectrumBand& band) {
  double least = 1e300;
  for (const SpectrumCell& cell : cells)
    for (std::size_t m = 0; m < 2; ++m)
      if (cell.count[m] > 0 && cell.power[m] > 0 && band.holds(cell)) least = std::min(least, cell.power[m]);
  return least;
}

}  // namespace

SpectrumFit scan_spectrum(std::span<const SpectrumCell> cells, const SpectrumModel& model, const SpectrumBand& band,
                          double rounding) {
  constexpr std::array k_spreads = {0.0, 0.06, 0.13, 0.25, 0.4, 0.65, 1.0, 1.5, 2.5, 5.0};
  constexpr std::array k_noises = {0.0, 0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.99};
  const std::vector<Ring> rings = rings_of(cells, band);
  double lowest = 1e300;
  for (const Ring& ring : rings) lowest = std::min(lowest, ring.power);
  SpectrumFit best;
  best.model = model;
  best.misfit = 1e300;
  std::vector<double> shape(rings.size());
  // ln k² and k² of the nearest frequencies that look alike, for waves along a direction between axis and diagonal.
  std::vector<std::array<std::array<double, 2>, 9>> aliases(rings.size());
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (int i = 0; i < 9; ++i) {
      const double f = std::sqrt(rings[r].squared), x = 0.92 * f + i % 3 - 1, y = 0.39 * f + i / 3 - 1;
      aliases[r][static_cast<std::size_t>(i)] = {std::log(x * x + y * y), x * x + y * y};
    }
  for (int step = 1; step < 10; ++step)
    for (const double spread : k_spreads) {
      if (spread > 0 && !model.blurred) break;
      const double hurst = step / 10.0;
      for (std::size_t r = 0; r < rings.size(); ++r) {
        shape[r] = 0;
        for (const auto& [log_squared, squared] : aliases[r])
          shape[r] += std::exp(-(1 + hurst) * log_squared - 4 * std::numbers::pi * std::numbers::pi * spread * squared);
      }
      for (const double share : k_noises) {
        if (share > 0 && !model.noisy) break;
        const double noise = share * lowest + rounding;
        double logs = 0, weights = 0;
        for (std::size_t r = 0; r < rings.size(); ++r) {
          const double signal = std::max(rings[r].power - noise, 0.02 * rings[r].power);
          const double weight = rings[r].count * std::pow(signal / rings[r].power, 2);
          logs += weight * std::log(signal / shape[r]);
          weights += weight;
        }
        const double amplitude = std::exp(logs / weights);
        double misfit = 0;
        for (std::size_t r = 0; r < rings.size(); ++r) {
          const double ratio = rings[r].power / (amplitude * shape[r] + noise);
          misfit += 2 * rings[r].count * (ratio - 1 - std::log(ratio));
        }
        if (!(misfit < best.misfit)) continue;
        best.misfit = misfit;
        best.amplitude = amplitude;
        best.hurst = hurst;
        best.spread_squared = spread;
        best.noise = share * lowest;
      }
    }
  return best;
}

SpectrumFit fit_spectrum(std::span<const SpectrumCell> cells, const SurfaceSpectrumModel& surface,
                         const SpectrumModel& model, const SpectrumBand& band, double rounding,
                         const SpectrumFit& start) {
  const double low = least_power(cells, band);
  auto* cost = new WhittleCost(cells, surface, model, band, rounding, low);
  const Layout layout = cost->layout();
  std::array<double, k_most_parameters> u{};
  u[0] = std::log(start.amplitude);
  u[1] = WhittleCost::free_hurst(start.hurst);
  for (std::size_t k = 0; k < 4; ++k) u[2 + k] = start.directions[k];
  if (layout.spread >= 0) u[static_cast<std::size_t>(layout.spread)] = std::sqrt(std::max(0.02, start.spread_squared));
  bool at_bound = false;  // More noise than none makes the fit worse.
  if (layout.noise >= 0) {
    u[static_cast<std::size_t>(layout.noise)] = std::sqrt(start.noise / low);
    if (!start.model.noisy) {
      std::array<double, k_most_parameters> chain{};
      const double step = cost->noise_step(cost->bounded(u.data(), chain).data());
      at_bound = step <= 0;
      u[static_cast<std::size_t>(layout.noise)] = std::sqrt(std::max(0.0, step));
    } else if (start.noise == 0) {
      u[static_cast<std::size_t>(layout.noise)] = 0.1;
    }
  }

  ceres::Problem problem;
  problem.AddParameterBlock(u.data(), layout.count);
  problem.AddResidualBlock(cost, nullptr, u.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 25;
  options.function_tolerance = 1e-7;
  ceres::Solver::Summary summary;
  if (at_bound) options.max_num_iterations = 0;
  ceres::Solve(options, &problem, &summary);

  std::array<double, k_most_parameters> chain{};
  const std::array<double, k_most_parameters> p = cost->bounded(u.data(), chain);
  SpectrumFit fit;
  fit.model = model;
  fit.amplitude = std::exp(p[0]);
  fit.hurst = p[1];
  for (std::size_t k = 0; k < 4; ++k) fit.directions[k] = p[2 + k];
  if (layout.spread >= 0) fit.spread_squared = p[static_cast<std::size_t>(layout.spread)];
  if (layout.noise >= 0) fit.noise = p[static_cast<std::size_t>(layout.noise)] * low;
  fit.parameters = layout.count;
  fit.misfit = 2 * summary.final_cost;
  const Eigen::MatrixXd information = cost->information(p.data());
  // By scaled pseudoinverse: a parameter without effect is as good as known.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::MatrixXd covariance = scale.asDiagonal() *
                                     Eigen::MatrixXd(scaled.completeOrthogonalDecomposition().pseudoInverse()) *
                                     scale.asDiagonal();
  fit.hurst_deviation = std::sqrt(std::max(0.0, covariance(1, 1)));
  cost->prepare(p.data());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t m = 0; m < 2; ++m) fit.power.push_back(cost->value(p.data(), c, directions_of(cells[c], m)).power);
  return fit;
}

}  // namespace papilla::texture_detail
