// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <memory>

namespace papilla::texture_detail {

/// Least n ≥ `least` whose only prime factors are 2, 3 and 5, and even when `least` > 1.
int good_fft_size(int least);

/// Memory aligned for the vector units, as FFTW wants it.
template <typename T>
class FftBuffer {
 public:
  explicit FftBuffer(std::size_t size);
  T* data() noexcept { return data_.get(); }
  const T* data() const noexcept { return data_.get(); }
  std::size_t size() const noexcept { return size_; }
  T& operator[](std::size_t i) noexcept { return data_.get()[i]; }
  const T& operator[](std::size_t i) const noexcept { return data_.get()[i]; }

 private:
  struct Free {
    void operator()(T* data) const noexcept;
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_;
};

/// Real 2D Fourier transform in place of a picture of `width` × `height`, row by row. The real rows are
/// padded to `stride()` = 2·(width/2+1) values, the spectrum has rows of width/2+1 complex values.
/// Plans by estimate, so that the same input gives the same bits in every run. Plans of different objects
/// may be made and used by different threads.
class RealFft2d {
 public:
  RealFft2d(int width, int height);
  ~RealFft2d();
  RealFft2d(const RealFft2d&) = delete;
  RealFft2d& operator=(const RealFft2d&) = delete;

  std::size_t stride() const noexcept { return 2 * spectrum_width(); }
  std::size_t spectrum_width() const noexcept { return static_cast<std::size_t>(width_) / 2 + 1; }
  double* real() noexcept { return buffer_.data(); }
  double& real(int x, int y) noexcept {
    return buffer_[static_cast<std::size_t>(y) * stride() + static_cast<std::size_t>(x)];
  }
  std::complex<double>* spectrum() noexcept { return reinterpret_cast<std::complex<double>*>(buffer_.data()); }
  void forward();   ///< real() -> spectrum().
  void backward();  ///< spectrum() -> real(), not normalised: forward and backward multiply by width·height.

 private:
  struct Plans;
  int width_, height_;
  FftBuffer<double> buffer_;
  std::unique_ptr<Plans> plans_;
};

/// Real transforms of single rows in place: the first `forward_rows` rows to spectra of width/2+1 complex values, and
/// the first `backward_rows` spectra back.
class RealFftRows {
 public:
  RealFftRows(int width, int forward_rows, int backward_rows);
  ~RealFftRows();
  RealFftRows(const RealFftRows&) = delete;
  RealFftRows& operator=(const RealFftRows&) = delete;

  std::size_t spectrum_width() const noexcept { return width_ / 2 + 1; }
  double* real(int row) noexcept { return buffer_.data() + 2 * spectrum_width() * static_cast<std::size_t>(row); }
  std::complex<double>* spectrum(int row) noexcept { return reinterpret_cast<std::complex<double>*>(real(row)); }
  void forward();
  void backward();  ///< Not normalised: forward and backward multiply by the width.

 private:
  struct Plans;
  std::size_t width_;
  FftBuffer<double> buffer_;
  std::unique_ptr<Plans> plans_;
};

/// `count` complex transforms of `length` values in place, one behind the other.
class ComplexFftBatch {
 public:
  ComplexFftBatch(int length, int count);
  ~ComplexFftBatch();
  ComplexFftBatch(const ComplexFftBatch&) = delete;
  ComplexFftBatch& operator=(const ComplexFftBatch&) = delete;

  std::complex<double>* data(int transform) noexcept {
    return reinterpret_cast<std::complex<double>*>(buffer_.data()) + length_ * static_cast<std::size_t>(transform);
  }
  void forward();
  void backward_half();  ///< Only the first count/2 ones; not normalised.

 private:
  struct Plans;
  std::size_t length_;
  FftBuffer<double> buffer_;
  std::unique_ptr<Plans> plans_;
};

/// Cosine transform (DCT-II and its inverse) in place, rows of `width` values: diagonalises the
/// Laplacian with reflecting borders.
class CosineTransform2d {
 public:
  CosineTransform2d(int width, int height);
  ~CosineTransform2d();
  CosineTransform2d(const CosineTransform2d&) = delete;
  CosineTransform2d& operator=(const CosineTransform2d&) = delete;

  double* data() noexcept { return buffer_.data(); }
  void forward();
  void backward();  ///< Not normalised: forward and backward multiply by 4·width·height.

 private:
  struct Plans;
  FftBuffer<double> buffer_;
  std::unique_ptr<Plans> plans_;
};

}  // namespace papilla::texture_detail
