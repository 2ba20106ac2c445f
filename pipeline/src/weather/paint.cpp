// SPDX-License-Identifier: MIT
#include "weather/paint.hpp"

#include <algorithm>
#include <cstdint>

#include "papilla/pipeline/recipe_source.hpp"

namespace papilla {
namespace {

constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }
constexpr unsigned k_maps = bit(Channel::color) | bit(Channel::bump) | bit(Channel::friction) | bit(Channel::stiffness);

}  // namespace

Painted paint(const PaintJob& job, const SurfaceTexels& texels, const std::vector<float>& sky, double scale,
              double charts, Felt& felt) {
  std::vector<double> x, y;
  std::vector<float> normals, positions, skies, colours, heights;
  std::vector<std::uint32_t> place;
  const auto covered = static_cast<std::size_t>(
      std::count_if(texels.covered.begin(), texels.covered.end(), [](auto c) { return c != 0; }));
  x.reserve(covered), y.reserve(covered), place.reserve(covered), colours.reserve(3 * covered);
  if (!job.reading.directions.empty()) normals.reserve(3 * covered);
  for (int j = 0; j < texels.height; ++j)
    for (int i = 0; i < texels.width; ++i) {
      const std::size_t at = texels.at(texels.left + i, texels.top + j);
      if (!texels.covered[at]) continue;
      place.push_back(static_cast<std::uint32_t>(at));
      x.push_back((texels.left + i + 0.5) / scale), y.push_back((texels.top + j + 0.5) / scale);
      const auto from = static_cast<std::ptrdiff_t>(3 * at);
      if (!job.reading.directions.empty())
        normals.insert(normals.end(), texels.normals.begin() + from, texels.normals.begin() + from + 3);
      if (job.reading.position)
        positions.insert(positions.end(), texels.positions.begin() + from, texels.positions.begin() + from + 3);
      const std::array<float, 3> colour = job.own.colour_at(x.back(), y.back());
      colours.insert(colours.end(), colour.begin(), colour.end());
      if (job.own.has_relief())
        heights.push_back(job.own.height_at(x.back(), y.back()) / static_cast<float>(job.depth_mm));
      if (!sky.empty()) skies.push_back(sky[at]);
    }
  TexturePoints points{x, y, normals, positions, skies, colours, heights};
  if (job.texture.depends_on_neighbours()) points.raster = {texels.width, texels.height, job.tiles, place};
  const TextureValues values = evaluate_texture(job.texture, points, k_maps, 1 / scale);
  const ColorImage image = to_color_image(values[Channel::color], static_cast<int>(place.size()), 1);
  Painted out{texels.width, texels.height, std::vector<unsigned char>(3 * texels.count(), 128),
              std::vector<float>(texels.count(), 0.5F)};
  for (std::size_t k = 0; k < place.size(); ++k) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * k), 3,
                out.rgb.begin() + static_cast<std::ptrdiff_t>(3 * place[k]));
    out.bump[place[k]] = values[Channel::bump][k];
    felt.friction += charts * static_cast<double>(values[Channel::friction][k]);
    felt.stiffness += charts * static_cast<double>(values[Channel::stiffness][k]);
    felt.texels += charts;
  }
  return out;
}

}  // namespace papilla
