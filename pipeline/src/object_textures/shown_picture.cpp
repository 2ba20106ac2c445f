// SPDX-License-Identifier: MIT
#include "object_textures/shown_picture.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/units.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/slope_limit.hpp"

namespace papilla {
namespace {

constexpr int k_most_relief_side = 1024;

RgbaImage cropped(const RgbaImage& image, const std::array<double, 4>& crop) {
  const auto whole = [](double share, int side) { return static_cast<int>(std::lround(share * side)); };
  const int left = std::min(whole(crop[0], image.width), image.width - 1);
  const int top = std::min(whole(crop[1], image.height), image.height - 1);
  const int right = std::max(whole(crop[2], image.width), left + 1);
  const int bottom = std::max(whole(crop[3], image.height), top + 1);
  RgbaImage part{right - left, bottom - top, {}};
  for (int y = top; y < bottom; ++y)
    part.pixels.insert(part.pixels.end(), image.at(left, y), image.at(left, y) + 4 * part.width);
  return part;
}

void cut_out(const CutOut& rule, unsigned char* pixel) {
  if (rule.by == CutOut::By::none) pixel[3] = 255;
  if (rule.by != CutOut::By::color) return;
  double distance = 0;
  for (std::size_t c = 0; c < 3; ++c) distance = std::max(distance, std::abs(pixel[c] / 255.0 - rule.color[c]));
  const double kept = rule.tolerance > 0 ? std::clamp(distance / rule.tolerance - 1, 0.0, 1.0) : distance > 0;
  pixel[3] = static_cast<unsigned char>(std::lround(pixel[3] * kept));
}

/// Rec. 709 luminance of the stored values.
double brightness(const unsigned char* p) { return (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255; }

double height_share(ObjectRelief::Source source, const unsigned char* p) {
  using Source = ObjectRelief::Source;
  switch (source) {
    case Source::alpha: return p[3] / 255.0;
    case Source::darkness: return (1 - brightness(p)) * p[3] / 255;
    case Source::automatic:
    case Source::brightness: break;
  }
  return brightness(p) * p[3] / 255;
}

}  // namespace

RgbaImage read_carrier_picture(const CarrierRule& rule) {
  RgbaImage image = cropped(read_rgba_image(rule.picture), rule.crop);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    cut_out(rule.cut_out, &image.pixels[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = 0.5 + rule.contrast * (image.pixels[i + c] / 255.0 - 0.5) + rule.brightness;
      image.pixels[i + c] = static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
    }
  }
  return image;
}

std::string alpha_mode_of(const RgbaImage& image) {
  constexpr double k_most_soft = 0.01;
  if (!has_alpha(image)) return "OPAQUE";
  std::size_t soft = 0;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) soft += image.pixels[i] != 0 && image.pixels[i] != 255;
  return static_cast<double>(soft) <= k_most_soft * static_cast<double>(image.pixels.size() / 4) ? "MASK" : "BLEND";
}

HeightMap relief_of_shown_picture(const ObjectRelief& rule, const RgbaImage& shown, double width_mm, double height_mm) {
  const bool is_other = !rule.picture.empty();
  const RgbaImage other = is_other ? read_rgba_image(rule.picture) : RgbaImage{};
  const RgbaImage& image = is_other ? other : shown;
  auto source = is_other ? ObjectRelief::Source::brightness : rule.source;
  if (source == ObjectRelief::Source::automatic && has_alpha(image)) source = ObjectRelief::Source::alpha;
  const int n = (std::max(image.width, image.height) - 1) / k_most_relief_side + 1;
  HeightMap relief{(image.width + n - 1) / n, (image.height + n - 1) / n, {}, 0, 0, false};
  relief.pitch_mm_x = width_mm / relief.width, relief.pitch_mm_y = height_mm / relief.height;
  for (int y = 0; y < relief.height; ++y) {
    for (int x = 0; x < relief.width; ++x) {
      double sum = 0;
      int count = 0;
      for (int j = n * y; j < std::min(n * (y + 1), image.height); ++j)
        for (int i = n * x; i < std::min(n * (x + 1), image.width); ++i, ++count)
          sum += height_share(source, image.at(i, j));
      relief.mm.push_back(static_cast<float>(rule.depth_mm * sum / count));
    }
  }
  const float low = *std::min_element(relief.mm.begin(), relief.mm.end());
  for (float& h : relief.mm) h -= low;
  return relief;
}

FeltRelief felt_relief(const HeightMap& relief, double max_slope, double base_mm) {
  FeltRelief felt;
  felt.relief = limit_slope(relief, {.max_slope = max_slope}).relief;
  HeightMap raised = felt.relief;
  for (float& h : raised.mm) h += static_cast<float>(base_mm);
  const auto [low, high] = std::minmax_element(raised.mm.begin(), raised.mm.end());
  const double low_m = k_metres_per_mm * double{*low}, high_m = k_metres_per_mm * double{*high};
  const double shift = relief_shift_m(low_m, high_m), share = relief_share(low_m + shift, high_m + shift);
  for (float& h : raised.mm) h = static_cast<float>(share * (double{h} + shift / k_metres_per_mm));
  const EncodedHeight encoded = encode_height_png16(raised);
  felt.tag = make_height_tag(raised, {.png = encoded.png,
                                      .scale_mm = encoded.scale_mm,
                                      .offset_mm = encoded.offset_mm,
                                      .rms_mm = rms_height_mm(raised)});
  felt.tag.wrap = {Wrap::clamp, Wrap::clamp};
  return felt;
}

}  // namespace papilla
