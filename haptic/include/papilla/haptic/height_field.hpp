// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/core/uv_transform.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {

/// Texture coordinates outside [0, 1), per axis (the sampler modes of glTF).
enum class Wrap { repeat, clamp, mirror };

/// Interpolation between samples. Bilinear is continuous; bicubic (Catmull–Rom) has a continuous gradient as well and
/// still passes through the samples, but overshoots beside a crease. The cubic B-spline of the samples has continuous
/// second derivatives, along rows and columns the means of the samples' second differences; it passes beside the
/// samples by a sixth of these.
enum class Interpolation { bilinear, bicubic, bspline };

/// From 16-bit samples to heights in metres: h = offset + scale · v / 65535.
struct HeightFieldOptions {
  double scale_m = 0;
  double offset_m = 0;
  bool white_is_outward = true;  ///< False: 65535 − v takes the place of v.
  UvTransform uv_transform;
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
  Interpolation interpolation = Interpolation::bicubic;
};

/// Height and its gradient by the texture coordinates before the transform.
struct HeightSample {
  double height_m = 0;
  Vec2 gradient_m{};  ///< (∂h/∂u, ∂h/∂v) in metres per unit of uv.
};

/// A relief over texture coordinates, stored in 16 bits a sample.
///
/// Texel (x, y) of a w × h picture has its centre at uv = ((x+½)/w, (y+½)/h), row 0 on top, as glTF samples
/// pictures. Bicubic values are clamped to the range of the samples and of the values halfway between them, so that
/// min_m() and max_m() are bounds everywhere.
/// sample() is noexcept, allocates nothing, and costs 16 reads. Where a uv gives a place in the picture
/// that is not finite, it is read at the centre of the first column or row.
class HeightField {
 public:
  /// @param samples width × height values, row by row.
  /// @throws InvalidInput when a size is zero, the number of samples differs from it, or an option is not finite.
  HeightField(int width, int height, std::vector<std::uint16_t> samples, const HeightFieldOptions& options);

  HeightSample sample(Vec2 uv) const noexcept { return by_uv(sample_texels(texel_at(uv))); }

  /// Texel coordinates of a place, the centre of the first texel at (0, 0); in the first copy of a map that repeats.
  Vec2 texel_at(Vec2 uv) const noexcept;
  /// The same by texel coordinates; the gradient is in metres per texel.
  HeightSample sample_texels(Vec2 texel) const noexcept;

  /// Grey dilation by a ball of radius r: H(a) = max over |b−a| ≤ r of h(b) + √(r² − |b−a|²) − r, the height of the
  /// ball's centre less r (as the tip of a force microscope dilates a relief). Exact on the samples; quantised to 16
  /// bits of the old range. Cost: samples × π(ρ/texel)², ρ² = 2·range·r − range² (at most r²).
  /// @param metres_per_uv length of one unit of the untransformed u and v on the surface, > 0.
  /// @throws InvalidInput when a texel is below ρ/64.
  HeightField dilated(double radius_m, Vec2 metres_per_uv) const;

  /// The relief with peaks no sharper than the radius R: the largest function below it whose second derivatives are at
  /// least −1/R, the proximal hull [Rockafellar and Wets, Variational Analysis, 1998, example 1.44]
  ///     O(a) = max over b of (E(b) − |a − b|²/2R),   E(b) = min over c of (h(c) + |b − c|²/2R)
  /// Valleys stay as sharp as they are. A probe that is less than R below has one closest point, not several to choose
  /// from: below a smooth surface that is so as far as the smallest radius of its peaks [Federer, Curvature measures,
  /// 1959]. Exact on the samples where their rows and columns are orthogonal on the surface; quantised to 16 bits of
  /// the old range. Bicubic interpolation becomes that of B-splines: beside a crease Catmull–Rom's overshoot is a peak
  /// as sharp as a texel, from which a probe slips. By parabola envelopes [Felzenszwalb and Huttenlocher, Distance
  /// transforms of sampled functions, 2012]. Cost: about 0.3 µs a sample.
  /// @param metres_per_uv as for dilated().
  HeightField rounded(double radius_m, Vec2 metres_per_uv) const;

  /// Share of the samples at which the relief is steeper than `slope`, by differences to the next sample of row and
  /// column. @param metres_per_uv as for dilated().
  double share_steeper(double slope, Vec2 metres_per_uv) const;

  /// The relief with half the samples in each direction, each the mean of four. Wavelengths below four old texels are
  /// lost.
  /// @throws InvalidInput when a size is odd.
  HeightField halved() const;

  /// The interpolated relief at `factor` times the samples in each direction, plus a height for each of these.
  /// @param added_m (factor·width) × (factor·height) heights in metres, row by row.
  /// @throws InvalidInput when factor is not positive, or the number of heights is another.
  HeightField overlaid(int factor, const std::vector<double>& added_m) const;

  /// Lengths on the surface of a step of one texel along the rows and along the columns, in metres; nothing when the uv
  /// transform has no area. @param metres_per_uv as for dilated().
  std::optional<Vec2> pitch_m(Vec2 metres_per_uv) const;

  double min_m() const noexcept { return min_m_; }
  double max_m() const noexcept { return max_m_; }
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  /// Grey levels, of which there are 256, per metre of height.
  double greys_per_m() const noexcept { return options_.scale_m != 0 ? 256 / std::abs(options_.scale_m) : 0; }
  /// Texels per unit of untransformed u and v: the columns of the linear map from uv to texels.
  std::array<Vec2, 2> texels_per_uv() const noexcept;
  /// Upper bounds of the slope along x and y, in metres per texel.
  Vec2 steepest_m() const noexcept { return steepest_m_; }

 private:
  /// Bounds of the interpolated samples; slopes per texel.
  struct Extremes {
    double least, most;
    Vec2 steepest;
  };

  /// What a step of one texel along x and y is on the surface, in metres.
  struct Steps {
    Vec2 x, y;
  };

  std::uint16_t texel(long x, long y) const noexcept;
  HeightSample by_uv(const HeightSample& at) const noexcept {
    return {at.height_m,
            {at.gradient_m.x * a_[0][0] + at.gradient_m.y * a_[1][0],
             at.gradient_m.x * a_[0][1] + at.gradient_m.y * a_[1][1]}};
  }
  std::optional<Steps> steps(Vec2 metres_per_uv) const;
  std::vector<std::uint16_t> quantised(const std::vector<double>& heights_m) const;
  struct Patch;
  double in_first_copy(std::size_t axis, double at) const noexcept;
  Patch patch_inside(double x, double y, double x0, double y0) const noexcept;
  Patch patch_across_edge(Vec2 at) const noexcept;
  Extremes extremes() const;

  int width_, height_;
  std::vector<std::uint16_t> samples_;
  HeightFieldOptions options_;
  double base_m_ = 0, metres_per_step_ = 0;            // h = base + step · v.
  double a_[2][2] = {{1, 0}, {0, 1}}, t_[2] = {0, 0};  // texel coordinates = A uv + t.
  double min_m_ = 0, max_m_ = 0;
  Vec2 steepest_m_;
};

}  // namespace papilla
