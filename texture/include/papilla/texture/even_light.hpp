// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla {

/// How stored grey values become brightness. `automatic` takes the curve of the picture's colour profile; without one,
/// pictures of 8 bits for sRGB and all others for linear. Height maps and normal maps are data and must not be decoded.
enum class Transfer { automatic, srgb, linear };

/// The name on the command line: auto, srgb, linear.
std::string_view to_string(Transfer transfer) noexcept;
/// The transfer of that name. @throws InvalidInput for any other name.
Transfer transfer(std::string_view name);

/// Where the curve that decodes a picture comes from.
enum class CurveSource { linear, srgb, profile };

/// The name in JSON: linear, srgb, profile.
std::string_view to_string(CurveSource source) noexcept;

/// Brightness over stored values.
struct TransferCurve {
  CurveSource source = CurveSource::linear;
  std::vector<float> linear;  ///< At equal steps over 0 to 1; empty: stored values are linear.
};

/// The curve of a picture of `bits` per sample with the `profile` curve of its file, see GreyImage.
TransferCurve transfer_curve(Transfer transfer, int bits, const std::vector<float>& profile = {});

/// The best quadric of the logarithm of a picture's brightness: vignette and uneven light, and what the relief has of
/// them. Coefficients of 1, x, y, x², xy, y², both from −1 to 1 from border to border.
struct LightField {
  std::array<double, 6> quadric{};
  double unevenness = 0;  ///< Largest over least value of the field, less 1.
};

/// The light field of a picture, by least squares over its pixels, or those of a reduced copy. Brightness under a
/// hundredth of the mean counts as that. Cost: O(pixels), read once. Deterministic.
/// @throws InvalidInput when the picture is empty. @pre the samples are finite.
LightField light_field(const SampleRows& picture, const TransferCurve& curve = {});

/// Linear brightness of a picture over its light field, which makes its mean about 1: decoded and divided as the rows
/// are read. The picture must outlive the object.
class EvenedSamples final : public SampleRows {
 public:
  EvenedSamples(const SampleRows& picture, TransferCurve curve, const LightField& field);
  void read(int x, int y, int count, float* samples) const override;

 private:
  const SampleRows& picture_;
  LightField field_;
  TransferCurve curve_;
};

}  // namespace papilla
