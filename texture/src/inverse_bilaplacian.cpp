// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse_bilaplacian.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "cosine_filter.hpp"
#include "fft.hpp"

namespace papilla::texture_detail {
namespace {

using Field = std::vector<double>;

/// Eigenvalues 2 − 2 cos(k·step) of the one-dimensional −Δ for k = 0…count−1.
Field eigenvalues(int count, double step) {
  Field values(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) values[static_cast<std::size_t>(k)] = 2 - 2 * std::cos(k * step);
  return values;
}

/// 1 / (2(α K + λ K²)) for all sums K of an eigenvalue each way, row by row; 0 for the mean.
Field inverse_eigenvalues(const Field& across, const Field& down, double alpha, double lambda) {
  Field values;
  values.reserve(across.size() * down.size());
  for (const double v : down)
    for (const double u : across) {
      const double k = u + v;
      values.push_back(k > 0 ? 1 / (2 * (alpha * k + lambda * k * k)) : 0);
    }
  return values;
}

class PeriodicInverse final : public InverseBilaplacian {
 public:
  PeriodicInverse(int width, int height)
      : fft_(width, height),
        across_(eigenvalues(width / 2 + 1, 2 * std::numbers::pi / width)),
        down_(eigenvalues(height, 2 * std::numbers::pi / height)) {}

  void set(double alpha, double lambda) override { gains_ = inverse_eigenvalues(across_, down_, alpha, lambda); }

  void apply(const Field& field, Field& result) override {
    fft_.load(field.data());
    fft_.forward();
    const double norm = 1 / static_cast<double>(field.size());
    std::complex<double>* spectrum = fft_.spectrum();
    for (const double gain : gains_) *spectrum++ *= norm * gain;
    fft_.backward();
    fft_.store(result.data());
  }

 private:
  RealFft2d fft_;
  Field across_, down_, gains_;
};

class ReflectingInverse final : public InverseBilaplacian {
 public:
  ReflectingInverse(int width, int height)
      : filter_(width, height),
        across_(eigenvalues(width, std::numbers::pi / width)),
        down_(eigenvalues(height, std::numbers::pi / height)) {}

  void set(double alpha, double lambda) override { gains_ = inverse_eigenvalues(across_, down_, alpha, lambda); }
  void apply(const Field& field, Field& result) override { filter_.apply(field, gains_, result); }

 private:
  CosineFilter2d filter_;
  Field across_, down_, gains_;
};

}  // namespace

std::unique_ptr<InverseBilaplacian> make_inverse_bilaplacian(int width, int height, bool periodic) {
  if (periodic) return std::make_unique<PeriodicInverse>(width, height);
  return std::make_unique<ReflectingInverse>(width, height);
}

}  // namespace papilla::texture_detail
