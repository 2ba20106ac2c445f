// SPDX-License-Identifier: MIT
#include "profile_curve.hpp"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/temporary_folder.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla {
namespace {

using io_detail::profile_curve;
using test::TemporaryFolder;
using Bytes = std::vector<std::byte>;

constexpr cmsCIExyY k_white{0.3127, 0.3290, 1};

/// The bytes of a profile, which is closed.
Bytes bytes_of(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  Bytes bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

Bytes rgb_profile(double gamma) {
  cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
  cmsToneCurve* curves[] = {curve, curve, curve};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
  const Bytes bytes = bytes_of(cmsCreateRGBProfile(&k_white, &primaries, curves));
  cmsFreeToneCurve(curve);
  return bytes;
}

Bytes grey_profile(double gamma) {
  cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
  const Bytes bytes = bytes_of(cmsCreateGrayProfile(&k_white, curve));
  cmsFreeToneCurve(curve);
  return bytes;
}

void expect_power(const std::vector<float>& curve, double gamma, const std::string& what) {
  ASSERT_EQ(curve.size(), 1025U) << what;
  for (std::size_t i = 0; i < curve.size(); ++i)
    ASSERT_NEAR(curve[i], std::pow(static_cast<double>(i) / 1024, gamma), 2e-3 * std::pow(i / 1024.0, 0.5) + 2e-4)
        << what << ", " << i;
}

TEST(ProfileCurve, IsThatOfThePower) {
  for (const double gamma : {1.0, 1.8, 2.19921875}) {
    expect_power(profile_curve(rgb_profile(gamma), 3), gamma, "rgb " + std::to_string(gamma));
    expect_power(profile_curve(grey_profile(gamma), 1), gamma, "grey " + std::to_string(gamma));
  }
}

TEST(ProfileCurve, OfSrgbIsThatOfTheStandard) {
  const std::vector<float> curve = profile_curve(bytes_of(cmsCreate_sRGBProfile()), 3);
  ASSERT_EQ(curve.size(), 1025U);
  for (std::size_t i = 0; i < curve.size(); ++i)
    ASSERT_NEAR(curve[i], linear_from_srgb(static_cast<double>(i) / 1024), 1e-4) << i;
}

TEST(ProfileCurve, IsNoneOfAnotherKindOfPictureOrOfDamagedBytes) {
  const Bytes rgb = rgb_profile(1.8);
  EXPECT_TRUE(profile_curve(rgb, 1).empty());
  EXPECT_TRUE(profile_curve(grey_profile(1.8), 3).empty());
  EXPECT_TRUE(profile_curve({}, 3).empty());
  EXPECT_TRUE(profile_curve(Bytes(500, std::byte{7}), 3).empty());
  EXPECT_TRUE(profile_curve(Bytes(rgb.begin(), rgb.begin() + 200), 3).empty());
}

TEST(ProfileCurve, OfAnyDamageIsFiniteAndNeverFalls) {
  const Bytes rgb = rgb_profile(1.8);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    Bytes damaged = rgb;
    for (int k = 0; k < 4; ++k) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    const std::vector<float> curve = profile_curve(damaged, 3);
    for (const float value : curve) ASSERT_TRUE(value >= 0 && value <= 1);
    ASSERT_TRUE(std::is_sorted(curve.begin(), curve.end()));
  }
}

TEST(ProfileCurve, ComesWithThePicture) {
  const TemporaryFolder folder;
  const Bytes profile = rgb_profile(1.8);
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
    const std::string path = folder / name;
    OIIO::ImageSpec spec(8, 8, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                   profile.data());
    const std::vector<unsigned char> pixels(8 * 8 * 3, 100);
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output && output->open(path, spec) && output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
                output->close());
    expect_power(read_grey_image(path).curve, 1.8, name);
    expect_power(ImageBands(path).curve(), 1.8, name);
    expect_power(read_reduced_picture(path, 4).grey.curve, 1.8, name);
  }
}

TEST(ProfileCurve, IsWrittenWithAGreyPicture) {
  const TemporaryFolder folder;
  GreyImage image{8, 8, Values<float>(64, 0.5F)};
  write_grey_image(folder / "none.png", image, 8);
  EXPECT_TRUE(read_grey_image(folder / "none.png").curve.empty());
  for (int i = 0; i <= 1024; ++i) image.curve.push_back(static_cast<float>(std::pow(i / 1024.0, 1.8)));
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
    write_grey_image(folder / name, image, 8);
    expect_power(read_grey_image(folder / name).curve, 1.8, name);
  }
  EXPECT_EQ(io_detail::profile_of_curve(image.curve), io_detail::profile_of_curve(image.curve));
}

}  // namespace
}  // namespace papilla
