// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaped_noise.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cosine_filter.hpp"
#include "fft.hpp"
#include "random.hpp"

namespace papilla::texture_detail {
namespace {

void multiply_spectrum(RealFft2d& fft, int width, int height, double norm,
                       const std::function<double(double, double)>& gain) {
  oneapi::tbb::parallel_for(0, height, [&](int v) {
    const double y = static_cast<double>(2 * v <= height ? v : v - height) / height;
    std::complex<double>* row = fft.spectrum() + static_cast<std::ptrdiff_t>(v) * (width / 2 + 1);
    for (int u = 0; u <= width / 2; ++u) row[u] *= norm * gain(static_cast<double>(u) / width, y);
  });
}

}  // namespace

std::vector<double> shaped_noise(int width, int height, std::uint64_t seed,
                                 const std::function<double(double, double)>& gain, const ProgressCallback& progress) {
  const auto report = [&](double fraction) { report_progress(progress, "synthesis", fraction); };
  report(0);
  RealFft2d fft(width, height);
  Random random(seed);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) fft.real(x, y) = random.normal();
  report(0.4);
  fft.forward();
  report(0.5);
  multiply_spectrum(fft, width, height, 1, gain);
  report(0.8);
  fft.backward();
  std::vector<double> field;
  field.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  double squares = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      field.push_back(fft.real(x, y));
      squares += field.back() * field.back();
    }
  const double scale = squares > 0 ? std::sqrt(static_cast<double>(field.size()) / squares) : 0;
  for (double& value : field) value *= scale;
  report(1);
  return field;
}

void filter(std::vector<double>& field, int width, int height, bool periodic,
            const std::function<double(double, double)>& gain) {
  if (periodic) {
    RealFft2d fft(width, height);
    fft.load(field.data());
    fft.forward();
    multiply_spectrum(fft, width, height, 1 / (static_cast<double>(width) * height), gain);
    fft.backward();
    fft.store(field.data());
    return;
  }
  std::vector<double> gains;
  gains.reserve(field.size());
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) gains.push_back(gain(0.5 * u / width, 0.5 * v / height));
  CosineFilter2d(width, height).apply(field, gains, field);
}

}  // namespace papilla::texture_detail
