// SPDX-License-Identifier: MIT
#include "papilla/texture/surface_like.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/spectral_surface.hpp"

namespace papilla {
namespace {

double kept(double hurst) { return std::clamp(hurst, 0.02, 0.98); }

double major(const FshotSignature& signature) {
  return signature.str > 0 ? signature.sta / signature.str : signature.sta;
}

double rms(const GreyImage& image) {
  const auto count = static_cast<double>(image.pixels.size());
  const double mean = std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / count;
  double squares = 0;
  for (const float grey : image.pixels)
    squares += (static_cast<double>(grey) - mean) * (static_cast<double>(grey) - mean);
  return std::sqrt(squares / count);
}

}  // namespace

SurfaceLike surface_like(const GreyImage& image, const SurfaceLikeOptions& options) {
  constexpr int k_least_side = 64;
  texture_detail::require_image(image, "surface_like", k_least_side);
  if (options.size < k_least_side || options.size > 4096 || options.rounds < 1 || options.rounds > 100)
    throw InvalidInput("surface_like: size " + std::to_string(options.size) + " is not within 64 to 4096, or rounds " +
                       std::to_string(options.rounds) + " not within 1 to 100");
  const Stopwatch clock;
  SurfaceLike result;
  result.target = fshot_dimension(image);
  double along = kept(result.target.sta), across = kept(major(result.target));
  double best = 1e300;
  for (int round = 0; round < options.rounds; ++round) {
    report_progress(options.progress, "synthesis", static_cast<double>(round) / options.rounds);
    HeightGrid surface = spectral_surface({.size = options.size,
                                           .hurst = along,
                                           .seed = options.seed,
                                           .hurst_across = across,
                                           .angle_deg = result.target.angle_deg});
    const FshotSignature signature = fshot_dimension(to_grey_image(surface));
    const double off_along = result.target.sta - signature.sta, off_across = major(result.target) - major(signature);
    const double distance = std::hypot(off_along, off_across);
    result.trace.push_back({clock.seconds(), distance});
    if (distance < best) {
      best = distance;
      result.surface = std::move(surface);
      result.achieved = signature;
      result.hurst = along;
      result.hurst_across = across;
    }
    along = kept(along + off_along);
    across = kept(across + off_across);
  }
  const double scale = rms(image);
  for (double& height : result.surface.heights) height *= scale;
  return result;
}

}  // namespace papilla
