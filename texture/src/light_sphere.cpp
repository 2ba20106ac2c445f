// SPDX-License-Identifier: MIT
#include "papilla/texture/light_sphere.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "checks.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// Calls visit(normal, grey) for every pixel within 95 % of the radius: the rim is blurred.
template <class Visit>
void visit_sphere(const GreyImage& image, const LightSphere& sphere, const Visit& visit) {
  constexpr double k_rim = 0.95;
  const double reach = k_rim * sphere.radius_px;
  for (int y = static_cast<int>(std::ceil(sphere.centre_px.y - reach)); y <= sphere.centre_px.y + reach; ++y)
    for (int x = static_cast<int>(std::ceil(sphere.centre_px.x - reach)); x <= sphere.centre_px.x + reach; ++x) {
      const double dx = (x - sphere.centre_px.x) / sphere.radius_px, dy = (y - sphere.centre_px.y) / sphere.radius_px;
      const double square = dx * dx + dy * dy;
      if (square <= k_rim * k_rim) visit(Vec3{dx, dy, std::sqrt(1 - square)}, static_cast<double>(image.at(x, y)));
    }
}

Vec3 mirrored_light(const GreyImage& image, const LightSphere& sphere, double brightest) {
  Vec3 sum{};
  visit_sphere(image, sphere, [&](Vec3 normal, double grey) {
    if (grey >= 0.5 * brightest) sum = sum + grey * normal;
  });
  const Vec3 normal = normalized(sum);
  return 2 * normal.z * normal - Vec3{0, 0, 1};
}

Vec3 matt_light(const GreyImage& image, const LightSphere& sphere, double brightest) {
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d products = Eigen::Vector4d::Zero();
  visit_sphere(image, sphere, [&](Vec3 normal, double grey) {
    if (grey < 0.25 * brightest) return;
    const Eigen::Vector4d row(normal.x, normal.y, normal.z, 1);
    squares += row * row.transpose();
    products += grey * row;
  });
  const Eigen::Vector4d solution = squares.ldlt().solve(products);
  return normalized({solution[0], solution[1], solution[2]});
}

}  // namespace

Vec3 light_of_sphere(const GreyImage& photograph, const LightSphere& sphere) {
  texture_detail::require_image(photograph, "light_of_sphere");
  const auto [centre, radius, mirror] = sphere;
  if (!(radius >= 4) || !is_finite(centre) || centre.x < radius || centre.y < radius ||
      centre.x > photograph.width - 1 - radius || centre.y > photograph.height - 1 - radius)
    throw InvalidInput("light_of_sphere: the ball at (" + std::to_string(centre.x) + ", " + std::to_string(centre.y) +
                       ") with a radius of " + std::to_string(radius) + " pixels is not inside the picture of " +
                       std::to_string(photograph.width) + " x " + std::to_string(photograph.height) +
                       ", or smaller than 4 pixels");
  double brightest = 0;
  visit_sphere(photograph, sphere, [&](Vec3, double grey) { brightest = std::max(brightest, grey); });
  const Vec3 light =
      brightest > 0 ? mirror ? mirrored_light(photograph, sphere, brightest) : matt_light(photograph, sphere, brightest)
                    : Vec3{};
  if (!is_finite(light) || !(light.z > 0))
    throw InvalidInput("light_of_sphere: the ball shows no light from the front");
  return light;
}

}  // namespace papilla
