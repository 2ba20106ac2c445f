// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/photometric_stereo.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "albedo_normals.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "photograph_gains.hpp"
#include "unknown_lights.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

constexpr const char* k_function = "photometric_stereo";

std::string size_text(const GreyImage& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

void require_photographs(const std::vector<GreyImage>& photographs) {
  const std::string name(k_function);
  if (photographs.size() < 3)
    throw InvalidInput(name + ": " + std::to_string(photographs.size()) + " photographs, at least 3 are needed");
  const GreyImage& first = photographs.front();
  for (std::size_t k = 0; k < photographs.size(); ++k) {
    const GreyImage& photograph = photographs[k];
    require_image(photograph, k_function, 16);
    if (photograph.width != first.width || photograph.height != first.height)
      throw InvalidInput(name + ": photograph [" + std::to_string(k) + "] is " + size_text(photograph) +
                         " pixels, photograph [0] " + size_text(first));
    if (!std::any_of(photograph.pixels.begin(), photograph.pixels.end(), [](float v) { return v > 0; }))
      throw InvalidInput(name + ": photograph [" + std::to_string(k) + "] is black");
  }
}

std::vector<Vec3> require_lights(const std::vector<Vec3>& lights, std::size_t photographs) {
  const std::string name(k_function);
  if (lights.size() != photographs)
    throw InvalidInput(name + ": " + std::to_string(lights.size()) + " lights for " + std::to_string(photographs) +
                       " photographs");
  std::vector<Vec3> units;
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(lights.size()), 3);
  for (const Vec3 light : lights) {
    units.push_back(require_light(light, k_function));
    matrix.row(static_cast<Eigen::Index>(units.size()) - 1) << units.back().x, units.back().y, units.back().z;
  }
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  constexpr double k_least_spread = 0.05;  // About 3 degrees out of the plane.
  if (!(values[2] > k_least_spread * values[0]))
    throw InvalidInput(name + ": the lights lie in one plane; move at least one of them by 10 degrees or more");
  return units;
}

Photographs load(const std::vector<GreyImage>& images) {
  Photographs photographs{images.front().width, images.front().height, {}};
  for (const GreyImage& image : images) {
    Field field(image.pixels.begin(), image.pixels.end());
    for (double& value : field) value = std::max(0.0, value);
    photographs.fields.push_back(std::move(field));
  }
  return photographs;
}

/// Pixels in the shadow that a relief throws under a light.
std::vector<bool> cast_shadow(const Field& relief, int width, int height, Vec3 light, double sign) {
  const auto [low, high] = std::minmax_element(relief.begin(), relief.end());
  const double range = *high - *low, flat = std::hypot(light.x, light.y);
  std::vector<bool> dark(relief.size());
  if (!(flat > 1e-6)) return dark;
  const double dx = sign * light.x / flat, dy = sign * light.y / flat, rise = light.z / flat;
  constexpr int k_farthest_px = 64;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = pixel_index(x, y, width);
      for (int step = 1; step <= k_farthest_px && step * rise < range && !dark[i]; ++step) {
        const int column = static_cast<int>(std::lround(x + step * dx)),
                  row = static_cast<int>(std::lround(y + step * dy));
        if (column < 0 || row < 0 || column >= width || row >= height) break;
        dark[i] = sign * relief[pixel_index(column, row, width)] > sign * relief[i] + step * rise + 0.25;
      }
    }
  return dark;
}

/// How well the shadows of a relief of that sign agree with the dark pixels: their correlation over all photographs.
double shadow_agreement(const Photographs& photographs, const RobustNormals& surface, const Field& relief,
                        const std::vector<Vec3>& lights, double sign, double& dark_share) {
  constexpr double k_dark = 0.25;
  double both = 0, cast = 0, dark = 0, count = 0;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const std::vector<bool> shadow = cast_shadow(relief, photographs.width, photographs.height, lights[k], sign);
    for (std::size_t i = 0; i < shadow.size(); ++i) {
      const double albedo = norm(surface.normals[i]);
      const bool is_dark = photographs.fields[k][i] < k_dark * albedo;
      const bool faces_away = dot(lights[k], surface.normals[i]) < k_dark * albedo;
      if (faces_away && !is_dark) continue;
      both += shadow[i] && is_dark, cast += shadow[i], dark += is_dark, count += 1;
    }
  }
  dark_share = count > 0 ? dark / count : 0;
  const double spread = std::sqrt(cast * (count - cast) * dark * (count - dark));
  return spread > 0 ? (count * both - cast * dark) / spread : 0;
}

}  // namespace

PhotometricStereoResult photometric_stereo(const std::vector<GreyImage>& images,
                                           const PhotometricStereoOptions& options) {
  require_photographs(images);
  PhotometricStereoResult result;
  result.lights_estimated = options.lights.empty();
  if (!result.lights_estimated) result.lights = require_lights(options.lights, images.size());
  const Photographs given = load(images);
  result.width = given.width, result.height = given.height;
  report_progress(options.progress, "photometric stereo", 0);
  if (result.lights_estimated) {
    Photographs flat = given;
    flatten(flat);
    UnknownLights unknown = estimate_lights(flat);
    result.lights = std::move(unknown.lights);
    result.light_uncertainty_deg = unknown.uncertainty_deg;
    result.trace = std::move(unknown.trace);
    result.stop = unknown.stop;
  }
  report_progress(options.progress, "photometric stereo", 0.3);
  Photographs photographs = given;
  std::vector<Vec3> lights = result.lights;
  result.ambient = even_out(photographs, lights);
  report_progress(options.progress, "photometric stereo", 0.6);
  result.residual = disagreement(photographs, lights);
  RobustNormals surface = robust_normals(photographs, lights, result.residual);
  result.height_px = integrate(slopes_of(surface.normals), result.width, result.height);
  report_progress(options.progress, "photometric stereo", 0.9);
  result.shadows_fraction = surface.shadows_fraction;
  result.highlights_fraction = surface.highlights_fraction;
  if (result.lights_estimated) {
    double dark = 0;
    const double convex = shadow_agreement(photographs, surface, result.height_px, lights, 1, dark),
                 concave = shadow_agreement(photographs, surface, result.height_px, lights, -1, dark);
    constexpr double k_least_dark = 0.002, k_least_lead = 0.1;
    result.two_sided = dark < k_least_dark || std::abs(convex - concave) < k_least_lead;
    if (concave > convex) {
      for (double& height : result.height_px) height = -height;
      for (Vec3& light : result.lights) light = {-light.x, -light.y, light.z};
    }
  }
  result.confidence = std::move(surface.confidence);
  return result;
}

}  // namespace papilla
