// SPDX-License-Identifier: GPL-3.0-or-later
#include "fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <tuple>
#include <utility>

namespace papilla::texture_detail {
namespace {

/// FFTW's planner is not safe for threads.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

bool has_small_factors(int n) {
  for (const int prime : {2, 3, 5})
    while (n % prime == 0) n /= prime;
  return n == 1;
}

fftw_complex* to_fftw(std::complex<double>* values) { return reinterpret_cast<fftw_complex*>(values); }

}  // namespace

int good_fft_size(int least) {
  if (least <= 1) return 1;
  int n = least + least % 2;
  while (!has_small_factors(n)) n += 2;
  return n;
}

void InPlaceTransform::Free::operator()(double* values) const noexcept { fftw_free(values); }

InPlaceTransform::InPlaceTransform(std::size_t size) : values_(fftw_alloc_real(size)) {
  if (!values_) throw std::bad_alloc();
}

InPlaceTransform::~InPlaceTransform() {
  const std::scoped_lock lock(planner());
  if (forward_) fftw_destroy_plan(forward_);
  if (backward_) fftw_destroy_plan(backward_);
}

template <typename Plans>
void InPlaceTransform::plan(const Plans& plans) {
  const std::scoped_lock lock(planner());
  std::tie(forward_, backward_) = plans();
  if (!forward_ || !backward_) throw std::bad_alloc();
}

void InPlaceTransform::forward() { fftw_execute(forward_); }
void InPlaceTransform::backward() { fftw_execute(backward_); }

RealFft2d::RealFft2d(int width, int height)
    : InPlaceTransform((2 * (static_cast<std::size_t>(width) / 2 + 1)) * static_cast<std::size_t>(height)),
      width_(width),
      height_(height) {
  plan([&] {
    return std::pair{fftw_plan_dft_r2c_2d(height, width, real(), to_fftw(spectrum()), FFTW_ESTIMATE),
                     fftw_plan_dft_c2r_2d(height, width, to_fftw(spectrum()), real(), FFTW_ESTIMATE)};
  });
}

void RealFft2d::load(const double* field) {
  for (int y = 0; y < height_; ++y, field += width_) std::copy_n(field, width_, &real(0, y));
}

void RealFft2d::store(double* field) {
  for (int y = 0; y < height_; ++y, field += width_) std::copy_n(&real(0, y), width_, field);
}

RealFftRows::RealFftRows(int width, int forward_rows, int backward_rows)
    : InPlaceTransform(2 * (static_cast<std::size_t>(width) / 2 + 1) *
                       static_cast<std::size_t>(std::max(forward_rows, backward_rows))),
      width_(static_cast<std::size_t>(width)) {
  const int reals = static_cast<int>(2 * spectrum_width()), complexes = static_cast<int>(spectrum_width());
  plan([&] {
    return std::pair{fftw_plan_many_dft_r2c(1, &width, forward_rows, real(0), nullptr, 1, reals, to_fftw(spectrum(0)),
                                            nullptr, 1, complexes, FFTW_ESTIMATE),
                     fftw_plan_many_dft_c2r(1, &width, backward_rows, to_fftw(spectrum(0)), nullptr, 1, complexes,
                                            real(0), nullptr, 1, reals, FFTW_ESTIMATE)};
  });
}

ComplexFftBatch::ComplexFftBatch(int length, int count)
    : InPlaceTransform(2 * static_cast<std::size_t>(length) * static_cast<std::size_t>(count)),
      length_(static_cast<std::size_t>(length)) {
  const auto plan_of = [&](int transforms, int sign) {
    return fftw_plan_many_dft(1, &length, transforms, to_fftw(data(0)), nullptr, 1, length, to_fftw(data(0)), nullptr,
                              1, length, sign, FFTW_ESTIMATE);
  };
  plan([&] { return std::pair{plan_of(count, FFTW_FORWARD), plan_of(count / 2, FFTW_BACKWARD)}; });
}

}  // namespace papilla::texture_detail
