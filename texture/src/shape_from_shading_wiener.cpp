// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "linear_shading.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/stored_samples.hpp"
#include "reflectance.hpp"
#include "shading_spectrum.hpp"

namespace papilla {
namespace {

constexpr const char* k_name = "shape_from_shading_wiener";

/// The picture, no brighter than a surface that faces the light and no darker than one that it does not reach.
class LambertSamples final : public SampleRows {
 public:
  LambertSamples(const SampleRows& picture, double albedo)
      : SampleRows(picture.width(), picture.height()), picture_(picture), most_(static_cast<float>(albedo)) {}
  void read(int x, int y, int count, float* samples) const override {
    picture_.read(x, y, count, samples);
    for (int i = 0; i < count; ++i) samples[i] = std::clamp(samples[i], 0.0F, most_);
  }

 private:
  const SampleRows& picture_;
  float most_;
};

Vec3 light_of(const ShadingOptions& options) {
  return texture_detail::oblique(texture_detail::require_light(options.light, k_name));
}

}  // namespace

WienerShadingResult shape_from_shading_wiener(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, k_name);
  std::vector<double> heights(image.pixels.size());
  WienerShadingResult result = shape_from_shading_wiener_by_rows(
      SamplesInMemory(image.pixels, image.width, image.height), options, [&](int y, std::span<const double> row) {
        std::copy(row.begin(), row.end(), heights.begin() + static_cast<std::ptrdiff_t>(image.index(0, y)));
      });
  texture_detail::remove_mean(heights);
  result.height_px = std::move(heights);
  return result;
}

WienerShadingResult shape_from_shading_wiener_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                      const HeightWriter& write) {
  texture_detail::require_shading_options(options, k_name);
  const Vec3 light = light_of(options);
  const LambertSamples bounded(picture, options.albedo);
  const texture_detail::ShadingSpectrum spectrum(texture_detail::middle_of(bounded), light);
  const auto damping = [&](double wx, double wy) { return spectrum.noise_ratio(wx, wy); };
  WienerShadingResult result;
  result.expected_correlation = spectrum.expected_correlation();
  if (std::max(picture.width(), picture.height()) > options.largest_piece_px) {
    static_cast<ShadingResult&>(result) =
        texture_detail::linear_shading_by_rows(bounded, options, light, damping, write);
    return result;
  }
  GreyImage image{picture.width(), picture.height(), {}, 0, 32};
  image.pixels.resize(static_cast<std::size_t>(picture.count()));
  for (int y = 0; y < image.height; ++y) bounded.read(0, y, image.width, &image.at(0, y));
  static_cast<ShadingResult&>(result) = texture_detail::linear_shading(image, options, light, damping);
  for (int y = 0; y < image.height; ++y)
    write(y,
          std::span<const double>(result.height_px).subspan(image.index(0, y), static_cast<std::size_t>(image.width)));
  result.height_px.clear();
  return result;
}

}  // namespace papilla
