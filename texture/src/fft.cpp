// SPDX-License-Identifier: GPL-3.0-or-later
#include "fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <mutex>
#include <new>

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

/// A pair of plans, destroyed together.
struct PlanPair {
  fftw_plan forward = nullptr, backward = nullptr;
  PlanPair() = default;
  PlanPair(const PlanPair&) = delete;
  PlanPair& operator=(const PlanPair&) = delete;
  ~PlanPair() {
    const std::scoped_lock lock(planner());
    if (forward) fftw_destroy_plan(forward);
    if (backward) fftw_destroy_plan(backward);
  }
  void require() const {
    if (!forward || !backward) throw std::bad_alloc();
  }
};

}  // namespace

int good_fft_size(int least) {
  if (least <= 1) return 1;
  int n = least + least % 2;
  while (!has_small_factors(n)) n += 2;
  return n;
}

template <typename T>
FftBuffer<T>::FftBuffer(std::size_t size) : data_(static_cast<T*>(fftw_malloc(size * sizeof(T)))), size_(size) {
  if (!data_) throw std::bad_alloc();
}

template <typename T>
void FftBuffer<T>::Free::operator()(T* data) const noexcept {
  fftw_free(data);
}

template class FftBuffer<double>;

struct RealFft2d::Plans : PlanPair {};
struct RealFftRows::Plans : PlanPair {};
struct ComplexFftBatch::Plans : PlanPair {};
struct CosineTransform2d::Plans : PlanPair {};

RealFft2d::RealFft2d(int width, int height)
    : width_(width),
      height_(height),
      buffer_(stride() * static_cast<std::size_t>(height)),
      plans_(std::make_unique<Plans>()) {
  auto* complex = reinterpret_cast<fftw_complex*>(buffer_.data());
  const std::scoped_lock lock(planner());
  plans_->forward = fftw_plan_dft_r2c_2d(height_, width_, buffer_.data(), complex, FFTW_ESTIMATE);
  plans_->backward = fftw_plan_dft_c2r_2d(height_, width_, complex, buffer_.data(), FFTW_ESTIMATE);
  plans_->require();
}

RealFft2d::~RealFft2d() = default;
void RealFft2d::forward() { fftw_execute(plans_->forward); }
void RealFft2d::backward() { fftw_execute(plans_->backward); }

RealFftRows::RealFftRows(int width, int forward_rows, int backward_rows)
    : width_(static_cast<std::size_t>(width)),
      buffer_(2 * spectrum_width() * static_cast<std::size_t>(std::max(forward_rows, backward_rows))),
      plans_(std::make_unique<Plans>()) {
  auto* complex = reinterpret_cast<fftw_complex*>(buffer_.data());
  const int reals = static_cast<int>(2 * spectrum_width()), complexes = static_cast<int>(spectrum_width());
  const std::scoped_lock lock(planner());
  plans_->forward = fftw_plan_many_dft_r2c(1, &width, forward_rows, buffer_.data(), nullptr, 1, reals, complex, nullptr,
                                           1, complexes, FFTW_ESTIMATE);
  plans_->backward = fftw_plan_many_dft_c2r(1, &width, backward_rows, complex, nullptr, 1, complexes, buffer_.data(),
                                            nullptr, 1, reals, FFTW_ESTIMATE);
  plans_->require();
}

RealFftRows::~RealFftRows() = default;
void RealFftRows::forward() { fftw_execute(plans_->forward); }
void RealFftRows::backward() { fftw_execute(plans_->backward); }

ComplexFftBatch::ComplexFftBatch(int length, int count)
    : length_(static_cast<std::size_t>(length)),
      buffer_(2 * length_ * static_cast<std::size_t>(count)),
      plans_(std::make_unique<Plans>()) {
  auto* values = reinterpret_cast<fftw_complex*>(buffer_.data());
  const std::scoped_lock lock(planner());
  plans_->forward = fftw_plan_many_dft(1, &length, count, values, nullptr, 1, length, values, nullptr, 1, length,
                                       FFTW_FORWARD, FFTW_ESTIMATE);
  plans_->backward = fftw_plan_many_dft(1, &length, count / 2, values, nullptr, 1, length, values, nullptr, 1, length,
                                        FFTW_BACKWARD, FFTW_ESTIMATE);
  plans_->require();
}

ComplexFftBatch::~ComplexFftBatch() = default;
void ComplexFftBatch::forward() { fftw_execute(plans_->forward); }
void ComplexFftBatch::backward_half() { fftw_execute(plans_->backward); }

CosineTransform2d::CosineTransform2d(int width, int height)
    : buffer_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)), plans_(std::make_unique<Plans>()) {
  double* values = buffer_.data();
  const std::scoped_lock lock(planner());
  plans_->forward = fftw_plan_r2r_2d(height, width, values, values, FFTW_REDFT10, FFTW_REDFT10, FFTW_ESTIMATE);
  plans_->backward = fftw_plan_r2r_2d(height, width, values, values, FFTW_REDFT01, FFTW_REDFT01, FFTW_ESTIMATE);
  plans_->require();
}

CosineTransform2d::~CosineTransform2d() = default;
void CosineTransform2d::forward() { fftw_execute(plans_->forward); }
void CosineTransform2d::backward() { fftw_execute(plans_->backward); }

}  // namespace papilla::texture_detail
