// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla::texture_detail {

/// The middle of the samples, at most this many a side: what spectra are measured on.
inline constexpr int k_spectrum_px = 1024;
GreyImage middle_of(const SampleRows& samples);

/// Power of a picture's waves (Hann window), over frequencies of 0 to 2π in steps of 2π/width and 2π/height.
struct PowerSpectrum {
  int width = 0, height = 0;
  std::vector<double> power;
};
PowerSpectrum power_spectrum(const GreyImage& image);

/// What shading by light of an azimuth makes of the power P of waves ω at the angle θ to it:
///   P(ω) = S(|ω|) cos²θ + N(|ω|),
/// S the power of the slopes and N that of all that is no shading: sensor noise, spots of the albedo. S and N by rings,
/// from the medians over angles, so that the peaks of a lattice are no noise: those are added to S where they stand.
class ShadingSpectrum {
 public:
  /// @param light its azimuth counts.
  ShadingSpectrum(const GreyImage& brightness, Vec3 light);
  /// N/S for a wave, radians per pixel; at least k_least_ratio.
  double noise_ratio(double wx, double wy) const;
  /// Expected correlation of the heights that Wiener's filter makes of the picture to the true ones, if the light is
  /// right: √(Σ G H / Σ H) with the power of the heights H = S/|ω|² and the filter's gain
  /// G = cos²θ / (cos²θ + N/S), times what the model of photographs leaves of that.
  double expected_correlation() const;

 private:
  struct Ratio {
    double signal, noise;
  };
  Ratio at(double wx, double wy) const;

  Vec2 azimuth_;
  PowerSpectrum smooth_;
  std::vector<double> log_frequency_, signal_, noise_;
};

}  // namespace papilla::texture_detail
