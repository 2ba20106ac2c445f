// SPDX-License-Identifier: GPL-3.0-or-later
#include "relief_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fft.hpp"

namespace papilla::texture_detail {
namespace {

/// Eigenvalues 2 − 2 cos(k·step) of the one-dimensional −Δ for k = 0…count−1.
std::vector<double> eigenvalues(int count, double step) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) values[static_cast<std::size_t>(k)] = 2 - 2 * std::cos(k * step);
  return values;
}

/// 1 / (norm · 2(α K + λ K²)), 0 for the mean.
double inverse(double k, double alpha, double lambda, double norm) {
  return k > 0 ? 1 / (norm * 2 * (alpha * k + lambda * k * k)) : 0;
}

}  // namespace

class InverseBilaplacian::Transform {
 public:
  virtual ~Transform() = default;
  virtual void apply(const std::vector<double>& field, double alpha, double lambda, std::vector<double>& result) = 0;
};

class InverseBilaplacian::Periodic : public Transform {
 public:
  Periodic(int width, int height)
      : width_(width),
        height_(height),
        fft_(width, height),
        across_(eigenvalues(width / 2 + 1, 2 * std::numbers::pi / width)),
        down_(eigenvalues(height, 2 * std::numbers::pi / height)) {}

  void apply(const std::vector<double>& field, double alpha, double lambda, std::vector<double>& result) override {
    const auto row = static_cast<std::size_t>(width_);
    for (int y = 0; y < height_; ++y)
      std::copy_n(field.data() + static_cast<std::size_t>(y) * row, row, &fft_.real(0, y));
    fft_.forward();
    const double norm = static_cast<double>(width_) * height_;
    std::complex<double>* spectrum = fft_.spectrum();
    for (const double down : down_)
      for (const double across : across_) *spectrum++ *= inverse(across + down, alpha, lambda, norm);
    fft_.backward();
    for (int y = 0; y < height_; ++y)
      std::copy_n(&fft_.real(0, y), row, result.data() + static_cast<std::size_t>(y) * row);
  }

 private:
  int width_, height_;
  RealFft2d fft_;
  std::vector<double> across_, down_;
};

class InverseBilaplacian::Reflecting : public Transform {
 public:
  Reflecting(int width, int height)
      : transform_(width, height),
        across_(eigenvalues(width, std::numbers::pi / width)),
        down_(eigenvalues(height, std::numbers::pi / height)) {}

  void apply(const std::vector<double>& field, double alpha, double lambda, std::vector<double>& result) override {
    std::copy(field.begin(), field.end(), transform_.data());
    transform_.forward();
    const double norm = 4 * static_cast<double>(field.size());
    double* value = transform_.data();
    for (const double down : down_)
      for (const double across : across_) *value++ *= inverse(across + down, alpha, lambda, norm);
    transform_.backward();
    std::copy_n(transform_.data(), field.size(), result.begin());
  }

 private:
  CosineTransform2d transform_;
  std::vector<double> across_, down_;
};

InverseBilaplacian::InverseBilaplacian(int width, int height, bool periodic) {
  if (periodic)
    transform_ = std::make_unique<Periodic>(width, height);
  else
    transform_ = std::make_unique<Reflecting>(width, height);
}

InverseBilaplacian::~InverseBilaplacian() = default;

void InverseBilaplacian::apply(const std::vector<double>& field, double alpha, double lambda,
                               std::vector<double>& result) {
  transform_->apply(field, alpha, lambda, result);
}

}  // namespace papilla::texture_detail
