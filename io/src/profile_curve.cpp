// SPDX-License-Identifier: MIT
#include "profile_curve.hpp"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace papilla::io_detail {
namespace {

constexpr int k_steps = 1024;
/// Profiles with tables in them take a megabyte; larger ones are no picture's.
constexpr std::size_t k_most_bytes = std::size_t{1} << 24;

using Context = std::unique_ptr<std::remove_pointer_t<cmsContext>, decltype(&cmsDeleteContext)>;

struct Close {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, Close>;

struct Delete {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
using Transform = std::unique_ptr<void, Delete>;

/// Y of the grey levels; empty when the profile gives none.
std::vector<double> luminances(std::span<const std::byte> bytes, int colours) {
  const Context context(cmsCreateContext(nullptr, nullptr), &cmsDeleteContext);  // Errors of others are not ours.
  const Profile from(cmsOpenProfileFromMemTHR(context.get(), bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!from || cmsGetColorSpace(from.get()) != (colours == 3 ? cmsSigRgbData : cmsSigGrayData)) return {};
  const Profile to(cmsCreateXYZProfileTHR(context.get()));
  const Transform transform(
      cmsCreateTransformTHR(context.get(), from.get(), colours == 3 ? TYPE_RGB_DBL : TYPE_GRAY_DBL, to.get(),
                            TYPE_XYZ_DBL, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE));
  if (!transform) return {};
  std::vector<double> result;
  for (int i = 0; i <= k_steps; ++i) {
    const double level = static_cast<double>(i) / k_steps;
    const std::array<double, 3> grey{level, level, level};
    std::array<double, 3> xyz{};
    cmsDoTransform(transform.get(), grey.data(), xyz.data(), 1);
    result.push_back(xyz[1]);
  }
  return result;
}

}  // namespace

std::vector<float> profile_curve(std::span<const std::byte> profile, int colours) {
  if (profile.empty() || profile.size() > k_most_bytes) return {};
  std::vector<double> y = luminances(profile, colours);
  if (y.empty() || !std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); })) return {};
  for (double& value : y) value = std::max(0.0, value);
  if (!std::is_sorted(y.begin(), y.end()) || !(y.back() > 0)) return {};
  std::vector<float> curve;
  for (const double value : y) curve.push_back(static_cast<float>(value / y.back()));
  return curve;
}

std::vector<std::byte> profile_of_curve(const std::vector<float>& curve) {
  const Context context(cmsCreateContext(nullptr, nullptr), &cmsDeleteContext);
  const std::unique_ptr<cmsToneCurve, decltype(&cmsFreeToneCurve)> tones(
      cmsBuildTabulatedToneCurveFloat(context.get(), static_cast<cmsUInt32Number>(curve.size()), curve.data()),
      &cmsFreeToneCurve);
  const Profile profile(cmsCreateGrayProfileTHR(context.get(), cmsD50_xyY(), tones.get()));
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile.get(), nullptr, &size);
  std::vector<std::byte> bytes(size);
  cmsSaveProfileToMem(profile.get(), bytes.data(), &size);
  constexpr std::ptrdiff_t k_date = 24, k_date_bytes = 12;  // Of the header.
  std::fill_n(bytes.begin() + k_date, k_date_bytes, std::byte{0});
  return bytes;
}

}  // namespace papilla::io_detail
