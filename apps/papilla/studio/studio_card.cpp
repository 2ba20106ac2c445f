// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_card.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "json/scene_json.hpp"
#include "page/card_photo.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/pipeline/grain_doubts.hpp"

namespace papilla::app {
namespace {

constexpr int k_most_side = 192;

/// Means of blocks of `factor` samples a side; what is left over at the ends is not shown.
std::vector<float> block_means(const HeightMap& relief, int factor, int width, int height) {
  std::vector<float> means;
  means.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < factor; ++j)
        for (int i = 0; i < factor; ++i) sum += double{relief.at(factor * x + i, factor * y + j)};
      means.push_back(static_cast<float>(sum / (factor * factor)));
    }
  return means;
}

Json relief_json(const HeightMap& relief) {
  const int factor = (std::max(relief.width, relief.height) + k_most_side - 1) / k_most_side;
  const int width = std::max(1, relief.width / factor), height = std::max(1, relief.height / factor);
  const std::vector<float> mm = block_means(relief, std::min({factor, relief.width, relief.height}), width, height);
  return {{"width", width},
          {"height", height},
          {"size_mm", {factor * width * relief.pitch_mm_x, factor * height * relief.pitch_mm_y}},
          {"mm", encode_base64(std::as_bytes(std::span(mm)))}};
}

}  // namespace

Json card_json(const MaterialRule& rule, const Grain& grain) {
  Json json = grain_json(rule.name, grain);
  json["photo"] = card_photo(grain.photograph);
  json["relief"] = relief_json(grain.relief);
  json["doubts"] = grain_doubts(rule, grain);
  return json;
}

}  // namespace papilla::app
