// SPDX-License-Identifier: MIT
#include "papilla/pipeline/environment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>

#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;

std::size_t offset(int width, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
}

/// Means over the area of each pixel of the result.
LinearImage resized(const LinearImage& image, int width, int height) {
  LinearImage result{width, height, Values<float>(offset(width, 0, height))};
  const double sx = static_cast<double>(image.width) / width, sy = static_cast<double>(image.height) / height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<double, 3> sum{};
      double area = 0;
      const int bottom = std::min(image.height, static_cast<int>(std::ceil((y + 1) * sy)));
      const int right = std::min(image.width, static_cast<int>(std::ceil((x + 1) * sx)));
      for (int j = static_cast<int>(y * sy); j < bottom; ++j)
        for (int i = static_cast<int>(x * sx); i < right; ++i) {
          const double weight = (std::min(i + 1.0, (x + 1) * sx) - std::max<double>(i, x * sx)) *
                                (std::min(j + 1.0, (y + 1) * sy) - std::max<double>(j, y * sy));
          if (!(weight > 0)) continue;
          area += weight;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(image.at(i, j)[c]);
        }
      for (std::size_t c = 0; c < 3; ++c) result.pixels[offset(width, x, y) + c] = static_cast<float>(sum[c] / area);
    }
  }
  return result;
}

/// Where row and column of a picture of this size look, at pixel centres.
Vec3 direction_at(double x, double y, int width, int height) {
  const double longitude = 2 * k_pi * (x / width - 0.5), latitude = k_pi * (0.5 - y / height);
  return {std::cos(latitude) * std::cos(longitude), std::sin(latitude), std::cos(latitude) * std::sin(longitude)};
}

/// Real spherical harmonics of the first three bands, without constants that the weights hold.
std::array<double, 9> harmonics(Vec3 d) {
  return {0.282095,
          0.488603 * d.y,
          0.488603 * d.z,
          0.488603 * d.x,
          1.092548 * d.x * d.y,
          1.092548 * d.y * d.z,
          0.315392 * (3 * d.z * d.z - 1),
          1.092548 * d.x * d.z,
          0.546274 * (d.x * d.x - d.y * d.y)};
}

}  // namespace

EnvironmentPicture encode_environment(const LinearImage& image) {
  EnvironmentPicture picture{image.width, image.height, Values<unsigned char>(image.pixels.size() / 3 * 4)};
  for (std::size_t i = 0; i < image.pixels.size() / 3; ++i) {
    const float* c = &image.pixels[3 * i];
    const double largest = static_cast<double>(std::max({c[0], c[1], c[2]}));
    if (!(largest > 1e-30)) continue;
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
    if (exponent < -127) continue;
    for (std::size_t k = 0; k < 3; ++k)
      picture.rgbe[4 * i + k] =
          static_cast<unsigned char>(std::lround(std::ldexp(static_cast<double>(c[k]), 8 - exponent)));
    picture.rgbe[4 * i + 3] = static_cast<unsigned char>(exponent + 128);
  }
  return picture;
}

LinearImage decode_environment(const EnvironmentPicture& picture) {
  LinearImage image{picture.width, picture.height, Values<float>(picture.rgbe.size() / 4 * 3)};
  for (std::size_t i = 0; i < picture.rgbe.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[3 * i + c] = std::ldexp(static_cast<float>(picture.rgbe[4 * i + c]), picture.rgbe[4 * i + 3] - 136);
  return image;
}

EnvironmentPicture read_environment(const std::filesystem::path& path, int most_width) {
  constexpr double k_shape_slack = 0.02;
  const LinearImage image = read_linear_image(path);
  if (std::abs(image.width / (2.0 * image.height) - 1) > k_shape_slack)
    throw InvalidInput(fmt::format("{}: {} x {} pixels are not twice as wide as high, as an equirectangular picture is",
                                   path.string(), image.width, image.height));
  if (image.width <= most_width) return encode_environment(image);
  return encode_environment(resized(image, most_width, most_width / 2));
}

std::string environment_json(const EnvironmentPicture& picture) {
  const std::vector<std::byte> png = encode_png(RgbaImage{picture.width, picture.height, picture.rgbe});
  return nlohmann::ordered_json{
      {"projection", "equirectangular"}, {"encoding", "rgbe"}, {"uri", "data:image/png;base64," + encode_base64(png)}}
      .dump();
}

std::optional<EnvironmentPicture> environment_of(const Material& material) {
  if (material.extras_json.find("\"environment\"") == std::string::npos) return std::nullopt;
  const auto extras = nlohmann::json::parse(material.extras_json, nullptr, false);
  const nlohmann::json::json_pointer place("/papilla/environment");
  if (!extras.is_object() || !extras.contains(place) || !extras[place].is_object()) return std::nullopt;
  const nlohmann::json& json = extras[place];
  const std::string where = "material '" + material.name + "': its environment ";
  if (json.value("encoding", nlohmann::json()) != "rgbe" || !json.value("uri", nlohmann::json()).is_string())
    throw InvalidInput(where + "is not coded as rgbe with a uri");
  const std::optional<std::string> bytes = decode_data_uri(json["uri"].get<std::string>());
  if (!bytes) throw InvalidInput(where + "is no data: URI");
  const RgbaImage image = decode_rgba_image(std::as_bytes(std::span(bytes->data(), bytes->size())), where);
  return EnvironmentPicture{image.width, image.height, image.pixels};
}

EnvironmentLight::EnvironmentLight(const EnvironmentPicture& picture) {
  levels_.push_back(decode_environment(picture));
  const LinearImage& image = levels_.front();
  constexpr std::array k_share{1.0, 2.0 / 3, 0.25};  // A_l/π of the clamped cosine, by band.
  for (int y = 0; y < image.height; ++y) {
    const double top = k_pi * (0.5 - static_cast<double>(y) / image.height);
    const double bottom = k_pi * (0.5 - (y + 1.0) / image.height);
    const double solid_angle = 2 * k_pi / image.width * (std::sin(top) - std::sin(bottom));
    for (int x = 0; x < image.width; ++x) {
      const std::array<double, 9> basis = harmonics(direction_at(x + 0.5, y + 0.5, image.width, image.height));
      const Vec3 radiance = texel(image, x, y);
      for (std::size_t k = 0; k < basis.size(); ++k)
        harmonics_[k] = harmonics_[k] + k_share[k == 0 ? 0 : k < 4 ? 1 : 2] * solid_angle * basis[k] * radiance;
    }
  }
  while (levels_.back().height > 1)
    levels_.push_back(resized(levels_.back(), std::max(1, levels_.back().width / 2), levels_.back().height / 2));
}

Vec3 EnvironmentLight::diffuse(Vec3 normal) const noexcept {
  const std::array<double, 9> basis = harmonics(normal);
  Vec3 sum;
  for (std::size_t k = 0; k < basis.size(); ++k) sum = sum + basis[k] * harmonics_[k];
  return {std::max(sum.x, 0.0), std::max(sum.y, 0.0), std::max(sum.z, 0.0)};
}

Vec3 EnvironmentLight::texel(const LinearImage& level, int x, int y) const noexcept {
  const float* c = level.at(((x % level.width) + level.width) % level.width, std::clamp(y, 0, level.height - 1));
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

Vec3 EnvironmentLight::reflection(Vec3 direction, double roughness) const noexcept {
  const double texels = roughness * roughness * levels_.front().width / (2 * k_pi);
  const auto number = static_cast<std::size_t>(std::lround(std::log2(std::max(texels, 1.0))));
  const LinearImage& level = levels_[std::min(number, levels_.size() - 1)];
  const double u = 0.5 + std::atan2(direction.z, direction.x) / (2 * k_pi);
  const double v = 0.5 - std::asin(std::clamp(direction.y, -1.0, 1.0)) / k_pi;
  const double x = u * level.width - 0.5, y = v * level.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  return (1 - fx) * (1 - fy) * texel(level, x0, y0) + fx * (1 - fy) * texel(level, x0 + 1, y0) +
         (1 - fx) * fy * texel(level, x0, y0 + 1) + fx * fy * texel(level, x0 + 1, y0 + 1);
}

}  // namespace papilla
