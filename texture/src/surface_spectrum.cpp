// SPDX-License-Identifier: MIT
#include "surface_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace papilla::texture_detail {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Γ(−h, x), the upper incomplete gamma function, for h in (0, 1) and x > 0.
double upper_gamma(double h, double x) {
  const double a = 1 - h, front = std::exp(-x) * std::pow(x, a);
  double upper = 0;  // Γ(a, x).
  if (x < 2) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 60; ++n) {
      term *= x / (a + n);
      sum += term;
      if (term < 1e-17 * sum) break;
    }
    upper = std::tgamma(a) - front * sum;
  } else {
    // Lentz's continued fraction.
    double b = x + 1 - a, c = 1e300, d = 1 / b, h_n = d;
    for (int n = 1; n < 100; ++n) {
      const double an = -n * (n - a);
      b += 2;
      d = 1 / (an * d + b);
      c = b + an / c;
      h_n *= d * c;
      if (std::abs(d * c - 1) < 1e-15) break;
    }
    upper = front * h_n;
  }
  return (std::pow(x, -h) * std::exp(-x) - upper) / h;
}

/// What lies outside of the square of side 5 about the frequency: the sum there is ∫ g + (f²/4 − 1/24) ∫ Δg with
/// g = |k|^(−2H−2) e^(−κk²), the midpoint rule and the shift by f to second order.
struct Tail {
  double level = 0, laplacian = 0;
  Tail(double hurst, double kappa) {
    constexpr double k_half_side = 2.5;
    constexpr std::array<double, 3> nodes = {0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr std::array<double, 3> weights = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double r = k_half_side / std::cos(nodes[i] * k_pi / 4), x = kappa * r * r;
      const double weight = 2 * k_pi * weights[i];
      if (x > 700) continue;
      const double radial =
          x > 1e-12 ? 0.5 * std::pow(kappa, hurst) * upper_gamma(hurst, x) : std::pow(r, -2 * hurst) / (2 * hurst);
      level += weight * radial;
      laplacian += weight * std::pow(r, -2 * hurst - 2) * std::exp(-x) * (2 * (hurst + 1) + 2 * x);
    }
  }
  double at(double f_squared) const { return level + (f_squared / 4 - 1.0 / 24) * laplacian; }
};

/// The tail and its derivatives by H and κ.
struct TailSlopes {
  static constexpr double k_step = 1e-5;
  Tail here, more_hurst, less_hurst, more_kappa;
  double kappa_step;
  TailSlopes(double hurst, double kappa)
      : here(hurst, kappa),
        more_hurst(hurst + k_step, kappa),
        less_hurst(hurst - k_step, kappa),
        more_kappa(hurst, kappa + k_step * (1 + kappa)),
        kappa_step(k_step * (1 + kappa)) {}
  double by_hurst(double f) const { return (more_hurst.at(f) - less_hurst.at(f)) / (2 * k_step); }
  double by_kappa(double f) const { return (more_kappa.at(f) - here.at(f)) / kappa_step; }
};

/// Transfer of the sampled Gaussian kernel along one axis, and the derivative of its logarithm by σ². By Poisson's
/// formula from the kernel's samples when it is narrow and from its spectrum's aliases when it is wide; what is left
/// out is below 1e-5.
class KernelTransfer {
 public:
  struct Value {
    double log = 0, slope = 0;
  };
  explicit KernelTransfer(double spread_squared) : spread_squared_(spread_squared) {
    for (int n = 1; n <= 3 && spread_squared > 0; ++n) {
      const double weight = 2 * std::exp(-n * n / (2 * spread_squared));
      samples_[static_cast<std::size_t>(n)] = weight;
      slopes_[static_cast<std::size_t>(n)] = weight > 0 ? weight * n * n / (2 * spread_squared * spread_squared) : 0;
    }
    middle_ = sums(0);
  }
  Value at(double f) const {
    const Value here = sums(f);
    return {std::log(here.log / middle_.log), here.slope / here.log - middle_.slope / middle_.log};
  }

 private:
  static constexpr double k_narrow = 0.3;
  /// The sum, not its logarithm, and its derivative.
  Value sums(double f) const {
    Value sum;
    if (spread_squared_ < k_narrow) {
      const double cosine = std::cos(2 * k_pi * f);
      double before = 1, here = cosine;
      sum.log = 1;
      for (std::size_t n = 1; n <= 3; ++n) {
        sum.log += samples_[n] * here;
        sum.slope += slopes_[n] * here;
        before = std::exchange(here, 2 * cosine * here - before);
      }
    } else {
      for (int m = -2; m <= 1; ++m) {
        const double k = 2 * k_pi * k_pi * (f + m) * (f + m), g = std::exp(-k * spread_squared_);
        sum.log += g;
        sum.slope -= k * g;
      }
    }
    return sum;
  }
  double spread_squared_;
  std::array<double, 4> samples_{}, slopes_{};
  Value middle_;
};

/// In (0, 1).
template <std::size_t count>
std::array<double, count> chebyshev_nodes() {
  std::array<double, count> nodes{};
  for (std::size_t i = 0; i < count; ++i)
    nodes[i] = 0.5 - 0.5 * std::cos(k_pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return nodes;
}

double sinc_squared(double k) {
  if (std::abs(k) < 1e-9) return 1;
  const double s = std::sin(k_pi * k) / (k_pi * k);
  return s * s;
}

}  // namespace

SurfaceSpectrumModel::SurfaceSpectrumModel(std::span<const SpectrumCell> cells) {
  for (const SpectrumCell& cell : cells) {
    fx_.push_back(cell.fx);
    fy_.push_back(cell.fy);
    auto& aliases = aliases_.emplace_back();
    std::size_t next = 1;
    for (int j = -k_reach; j <= k_reach; ++j)
      for (int i = -k_reach; i <= k_reach; ++i) {
        const double kx = cell.fx + i, ky = cell.fy + j, squared = kx * kx + ky * ky;
        aliases[i == 0 && j == 0 ? 0 : next++] = {std::log(squared), 4 * k_pi * k_pi * squared,
                                                  sinc_squared(kx) * sinc_squared(ky)};
      }
  }
  SurfaceSpectrum sharp;
  sharp.power.resize(size());
  sharp.by_hurst.resize(size());
  sharp.by_spread.resize(size());
  sharp_.resize(size());
  const std::array<double, k_nodes> nodes = chebyshev_nodes<k_nodes>();
  for (std::size_t i = 0; i < k_nodes; ++i) {
    add_aliases(false, nodes[i], 0, sharp);
    for (std::size_t c = 0; c < size(); ++c) {
      const double own = std::exp(-(nodes[i] + 1) * aliases_[c][0].log_squared);
      sharp_[c][i] = std::log(nodes[i] * (sharp.power[c] - own));
    }
  }
}

void SurfaceSpectrumModel::add_aliases(bool pixel, double hurst, double spread_squared, SurfaceSpectrum& result) const {
  const double kappa = 4 * k_pi * k_pi * spread_squared;
  constexpr double k_nothing = 18;  // e^−18 of the largest.
  const bool has_tail = !pixel && kappa * 6.25 < k_nothing;
  const TailSlopes tail(hurst, has_tail ? kappa : 1.0);
  for (std::size_t c = 0; c < size(); ++c) {
    double sum = 0, by_hurst = 0, by_spread = 0, own = 0;
    for (const Alias& alias : aliases_[c]) {
      const double exponent = -(hurst + 1) * alias.log_squared - spread_squared * alias.squared;
      if (&alias == aliases_[c].data()) own = exponent;
      if (exponent < own - k_nothing) continue;
      const double value = std::exp(exponent) * (pixel ? alias.pixel : 1);
      sum += value;
      by_hurst -= value * alias.log_squared;
      by_spread -= value * alias.squared;
    }
    if (has_tail) {
      const double f = fx_[c] * fx_[c] + fy_[c] * fy_[c];
      sum += tail.here.at(f);
      by_hurst += tail.by_hurst(f);
      by_spread += 4 * k_pi * k_pi * tail.by_kappa(f);
    }
    result.power[c] = sum;
    result.by_hurst[c] = by_hurst / sum;
    result.by_spread[c] = by_spread / sum;
  }
}

void SurfaceSpectrumModel::interpolate(double hurst, SurfaceSpectrum& result) const {
  const std::array<double, k_nodes> nodes = chebyshev_nodes<k_nodes>();
  std::array<double, k_nodes> basis{}, slopes{};
  for (std::size_t i = 0; i < k_nodes; ++i) {
    basis[i] = 1;
    for (std::size_t j = 0; j < k_nodes; ++j)
      if (j != i) basis[i] *= (hurst - nodes[j]) / (nodes[i] - nodes[j]);
    for (std::size_t k = 0; k < k_nodes; ++k) {
      if (k == i) continue;
      double product = 1 / (nodes[i] - nodes[k]);
      for (std::size_t j = 0; j < k_nodes; ++j)
        if (j != i && j != k) product *= (hurst - nodes[j]) / (nodes[i] - nodes[j]);
      slopes[i] += product;
    }
  }
  for (std::size_t c = 0; c < size(); ++c) {
    double value = 0, slope = 0;
    for (std::size_t i = 0; i < k_nodes; ++i) {
      value += basis[i] * sharp_[c][i];
      slope += slopes[i] * sharp_[c][i];
    }
    const double log_squared = aliases_[c][0].log_squared;
    const double own = std::exp(-(hurst + 1) * log_squared), others = std::exp(value) / hurst;
    result.power[c] = own + others;
    result.by_hurst[c] = (others * (slope - 1 / hurst) - own * log_squared) / result.power[c];
  }
}

void SurfaceSpectrumModel::evaluate(PointSpread spread, double hurst, double spread_squared,
                                    SurfaceSpectrum& result) const {
  result.power.resize(size());
  result.by_hurst.resize(size());
  result.by_spread.assign(size(), 0);
  if (spread == PointSpread::optical || spread == PointSpread::pixel) {
    add_aliases(spread == PointSpread::pixel, hurst, spread_squared, result);
    return;
  }
  if (spread == PointSpread::band_limited) {
    for (std::size_t c = 0; c < size(); ++c) {
      result.power[c] = std::exp(-(hurst + 1) * aliases_[c][0].log_squared);
      result.by_hurst[c] = -aliases_[c][0].log_squared;
    }
  } else {
    interpolate(hurst, result);
  }
  const KernelTransfer kernel(spread_squared);
  for (std::size_t c = 0; c < size(); ++c)
    if (spread == PointSpread::kernel) {
      const KernelTransfer::Value x = kernel.at(fx_[c]), y = kernel.at(fy_[c]);
      result.power[c] *= std::exp(2 * (x.log + y.log));
      result.by_spread[c] = 2 * (x.slope + y.slope);
    } else {
      const double k = aliases_[c][0].squared;
      result.power[c] *= std::exp(-spread_squared * k);
      result.by_spread[c] = -k;
    }
}

}  // namespace papilla::texture_detail
