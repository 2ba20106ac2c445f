// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <memory>

struct fftw_plan_s;

namespace papilla::texture_detail {

/// Least n ≥ `least` whose only prime factors are 2, 3 and 5, and even when `least` > 1.
int good_fft_size(int least);

/// Values in memory aligned for the vector units, a transform of them in place and its inverse. Plans by estimate, so
/// that the same input gives the same bits in every run. Different threads may make and use different objects.
class InPlaceTransform {
 public:
  InPlaceTransform(const InPlaceTransform&) = delete;
  InPlaceTransform& operator=(const InPlaceTransform&) = delete;
  void forward();
  void backward();  ///< Not normalised.

 protected:
  explicit InPlaceTransform(std::size_t size);
  ~InPlaceTransform();
  /// @param plans  returns the forward and the backward plan.
  template <typename Plans>
  void plan(const Plans& plans);
  double* values() noexcept { return values_.get(); }
  std::complex<double>* complex_values() noexcept { return reinterpret_cast<std::complex<double>*>(values()); }

 private:
  struct Free {
    void operator()(double* values) const noexcept;
  };
  std::unique_ptr<double[], Free> values_;
  fftw_plan_s *forward_ = nullptr, *backward_ = nullptr;
};

/// Real 2D Fourier transform of a picture of `width` × `height`, row by row. The real rows are padded to
/// `stride()` = 2·(width/2+1) values, the spectrum has rows of width/2+1 complex values.
/// Forward and backward multiply by width·height.
class RealFft2d : public InPlaceTransform {
 public:
  RealFft2d(int width, int height);

  std::size_t stride() const noexcept { return 2 * spectrum_width(); }
  std::size_t spectrum_width() const noexcept { return static_cast<std::size_t>(width_) / 2 + 1; }
  double* real() noexcept { return values(); }
  double& real(int x, int y) noexcept {
    return values()[static_cast<std::size_t>(y) * stride() + static_cast<std::size_t>(x)];
  }
  std::complex<double>* spectrum() noexcept { return complex_values(); }
  /// Copies a field of width · height values, row by row, to or from real().
  void load(const double* field);
  void store(double* field);

 private:
  int width_, height_;
};

/// Real transforms of single rows: the first `forward_rows` rows to spectra of width/2+1 complex values, and the first
/// `backward_rows` spectra back. Forward and backward multiply by the width.
class RealFftRows : public InPlaceTransform {
 public:
  RealFftRows(int width, int forward_rows, int backward_rows);

  std::size_t spectrum_width() const noexcept { return width_ / 2 + 1; }
  double* real(int row) noexcept { return values() + 2 * spectrum_width() * static_cast<std::size_t>(row); }
  std::complex<double>* spectrum(int row) noexcept {
    return complex_values() + spectrum_width() * static_cast<std::size_t>(row);
  }

 private:
  std::size_t width_;
};

/// `count` complex transforms of `length` values, one behind the other. Only the first count/2 are transformed back.
class ComplexFftBatch : public InPlaceTransform {
 public:
  ComplexFftBatch(int length, int count);

  std::complex<double>* data(int transform) noexcept {
    return complex_values() + length_ * static_cast<std::size_t>(transform);
  }

 private:
  std::size_t length_;
};

}  // namespace papilla::texture_detail
