// SPDX-License-Identifier: MIT
#include "papilla/texture/height_reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/symmetry.hpp"

namespace papilla {
namespace {

using texture_detail::is_positive;

std::string text(Vec2 place) { return "(" + std::to_string(place.x) + ", " + std::to_string(place.y) + ")"; }

void require_inside(const PixelRelief& relief, Vec2 place, const char* function) {
  if (!(is_finite(place) && place.x >= 0 && place.y >= 0 && place.x <= relief.width - 1 &&
        place.y <= relief.height - 1))
    throw InvalidInput(std::string(function) + ": " + text(place) + " is not in the picture of " +
                       std::to_string(relief.width) + " x " + std::to_string(relief.height) + " pixels");
}

/// Bilinear.
double height_at(const PixelRelief& relief, Vec2 place) {
  const int x = std::min(static_cast<int>(place.x), relief.width - 2),
            y = std::min(static_cast<int>(place.y), relief.height - 2);
  const double u = place.x - x, v = place.y - y;
  const auto at = [&](int column, int row) {
    return relief.heights[texture_detail::pixel_index(column, row, relief.width)];
  };
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) + v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

double mean_around(const PixelRelief& relief, Vec2 place) {
  double sum = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      sum += height_at(relief, {std::clamp(place.x + dx, 0.0, relief.width - 1.0),
                                std::clamp(place.y + dy, 0.0, relief.height - 1.0)});
  return sum / 25;
}

/// Takes mean and trend out of values over positions.
void remove_trend(std::vector<double>& values, const std::vector<double>& positions) {
  const auto count = static_cast<double>(values.size());
  const double middle = std::accumulate(positions.begin(), positions.end(), 0.0) / count,
               mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double product = 0, square = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    product += (positions[i] - middle) * values[i], square += (positions[i] - middle) * (positions[i] - middle);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= mean + product / square * (positions[i] - middle);
}

}  // namespace

double pitch_of_ruler(double ruler_mm, Vec2 from_px, Vec2 to_px) {
  const double length = norm(to_px - from_px);
  if (!is_positive(ruler_mm) || !(length >= 1) || !std::isfinite(length))
    throw InvalidInput("pitch_of_ruler: " + std::to_string(ruler_mm) + " mm between " + text(from_px) + " and " +
                       text(to_px) + " is no ruler");
  return ruler_mm / length;
}

double pitch_of_grid(const GreyImage& picture, double grid_mm) {
  if (!is_positive(grid_mm)) throw InvalidInput("pitch_of_grid: " + std::to_string(grid_mm) + " mm is not positive");
  const Lattice lattice = analyze_symmetry(picture).lattice;
  if (!lattice.found) throw InvalidInput("pitch_of_grid: the picture shows no grid: " + lattice.reason);
  return grid_mm / std::min(norm(lattice.vectors_px[0]), norm(lattice.vectors_px[1]));
}

double scale_of_step(const PixelRelief& relief, double step_mm, Vec2 low_px, Vec2 high_px) {
  require_inside(relief, low_px, "scale_of_step");
  require_inside(relief, high_px, "scale_of_step");
  const double step = mean_around(relief, high_px) - mean_around(relief, low_px);
  if (!is_positive(step_mm) || !is_positive(step))
    throw InvalidInput("scale_of_step: " + text(high_px) + " is not above " + text(low_px) + " in the relief, or " +
                       std::to_string(step_mm) + " mm is not positive");
  return step_mm / step;
}

ProfileFit fit_profile(const PixelRelief& relief, const ProfileLine& profile, Vec2 from_px, Vec2 to_px) {
  require_inside(relief, from_px, "fit_profile");
  require_inside(relief, to_px, "fit_profile");
  const std::vector<double>& along = profile.along_mm;
  if (along.size() < 3 || along.size() != profile.height_mm.size())
    throw InvalidInput("fit_profile: the profile has " + std::to_string(along.size()) +
                       " points, at least 3 are needed");
  for (std::size_t i = 0; i < along.size(); ++i)
    if (!std::isfinite(along[i]) || !std::isfinite(profile.height_mm[i]) || (i > 0 && !(along[i] > along[i - 1])))
      throw InvalidInput("fit_profile: point [" + std::to_string(i) + "] of the profile is not finite or not rising");
  std::vector<double> found, expected = profile.height_mm;
  for (const double position : along) {
    const double share = (position - along.front()) / (along.back() - along.front());
    found.push_back(height_at(relief, from_px + share * (to_px - from_px)));
  }
  remove_trend(found, along);
  remove_trend(expected, along);
  const double product = std::inner_product(found.begin(), found.end(), expected.begin(), 0.0),
               square = std::inner_product(found.begin(), found.end(), found.begin(), 0.0),
               other = std::inner_product(expected.begin(), expected.end(), expected.begin(), 0.0);
  if (!is_positive(square) || !is_positive(other))
    throw InvalidInput("fit_profile: the profile or the relief along it is straight");
  ProfileFit fit{product / square, product / std::sqrt(square * other), 0};
  fit.rms_mm = std::sqrt(std::max(0.0, other - product * product / square) / static_cast<double>(along.size()));
  return fit;
}

double height_of_shadow(Vec2 edge_px, Vec2 end_px, Vec3 light, double pitch_mm) {
  const Vec3 unit = texture_detail::require_light(light, "height_of_shadow");
  const double flat = std::hypot(unit.x, unit.y), length = norm(end_px - edge_px);
  if (!is_positive(pitch_mm) || !is_positive(length) || !is_positive(flat))
    throw InvalidInput("height_of_shadow: the shadow has no length, the light is straight above, or there is no pitch");
  return length * pitch_mm * unit.z / flat;
}

}  // namespace papilla
