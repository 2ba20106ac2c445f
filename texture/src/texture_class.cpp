// SPDX-License-Identifier: MIT
#include "papilla/texture/texture_class.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/resample.hpp"
#include "texture_class_rules.hpp"

namespace papilla {
namespace texture_detail {

std::vector<Moments> block_moments(const GreyImage& image, int blocks) {
  std::vector<Moments> result;
  for (int row = 0; row < blocks; ++row)
    for (int column = 0; column < blocks; ++column) {
      double sum = 0, squares = 0;
      int pixels = 0;
      for (int y = row * image.height / blocks; y < (row + 1) * image.height / blocks; ++y)
        for (int x = column * image.width / blocks; x < (column + 1) * image.width / blocks; ++x, ++pixels) {
          const double grey = static_cast<double>(image.at(x, y));
          sum += grey;
          squares += grey * grey;
        }
      const double mean = sum / std::max(1, pixels);
      result.push_back({mean, std::sqrt(std::max(0.0, squares / std::max(1, pixels) - mean * mean))});
    }
  return result;
}

bool is_homogeneous(const std::vector<Moments>& blocks, const Moments& whole) {
  constexpr double k_most_contrast_ratio = 2;
  return std::all_of(blocks.begin(), blocks.end(), [&](const Moments& block) {
    return std::abs(block.mean - whole.mean) <= whole.deviation &&
           block.deviation <= k_most_contrast_ratio * whole.deviation &&
           block.deviation * k_most_contrast_ratio >= whole.deviation;
  });
}

TextureClass class_of(double coherence, double explained_variance, double stripes) {
  TextureClass result;
  result.strongly_ordered = std::clamp(std::max(explained_variance, stripes), 0.0, 1.0);
  result.weakly_ordered = (1 - result.strongly_ordered) * coherence;
  result.disordered = 1 - result.strongly_ordered - result.weakly_ordered;
  if (explained_variance < k_strong_share && stripes >= k_strong_share)
    result.kind = TextureKind::strongly_ordered_nonsymmetric;
  else if (result.strongly_ordered >= k_strong_share)
    result.kind = TextureKind::strongly_ordered_symmetric;
  else if (result.strongly_ordered >= k_composite_share)
    result.kind = TextureKind::composite;
  else if (coherence >= k_directional_coherence)
    result.kind = TextureKind::weakly_ordered;
  return result;
}

OrientationField orientation_of(const std::vector<StructureTensor>& tensors, const std::vector<double>& pixels,
                                int columns, int rows) {
  OrientationField field;
  field.columns = columns;
  field.rows = rows;
  double energy = 0, coherent = 0;
  Vec2 mean{};
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const StructureTensor& tensor = tensors[i];
    double along = tensor.angle() * 180 / std::numbers::pi + 90;
    if (along >= 180) along -= 180;
    field.angle_deg.push_back(along);
    field.coherence.push_back(tensor.coherence());
    const double weight = (tensor.xx + tensor.yy) * pixels[i];
    energy += weight;
    coherent += weight * tensor.coherence();
    mean = mean + weight * tensor.coherence() * Vec2{std::cos(2 * tensor.angle()), std::sin(2 * tensor.angle())};
  }
  if (energy > 0) field.mean_coherence = coherent / energy;
  if (coherent > 0) field.spread = 1 - norm(mean) / coherent;
  return field;
}

}  // namespace texture_detail

std::string_view to_string(TextureKind kind) noexcept {
  switch (kind) {
    case TextureKind::disordered: return "disordered";
    case TextureKind::weakly_ordered: return "weakly_ordered";
    case TextureKind::strongly_ordered_symmetric: return "strongly_ordered_symmetric";
    case TextureKind::strongly_ordered_nonsymmetric: return "strongly_ordered_nonsymmetric";
    case TextureKind::composite: return "composite";
  }
  return "unknown";
}

TextureClass classify(const GreyImage& image, double explained_variance, double stripes) {
  texture_detail::require_image(image, "classify");
  return texture_detail::class_of(texture_detail::structure_tensor(image).coherence(), explained_variance, stripes);
}

OrientationField orientation_field(const GreyImage& image) {
  texture_detail::require_image(image, "orientation_field");
  constexpr int k_least_block = 32, k_most_blocks = 8;
  const auto blocks = [&](int side) { return std::clamp(side / k_least_block, 1, k_most_blocks); };
  const int columns = blocks(image.width), rows = blocks(image.height);
  std::vector<texture_detail::StructureTensor> tensors;
  std::vector<double> pixels;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int left = column * image.width / columns, right = (column + 1) * image.width / columns;
      const int top = row * image.height / rows, bottom = (row + 1) * image.height / rows;
      tensors.push_back(texture_detail::structure_tensor(crop(image, left, top, right - left, bottom - top)));
      pixels.push_back(static_cast<double>(right - left) * (bottom - top));
    }
  return texture_detail::orientation_of(tensors, pixels, columns, rows);
}

Suitability measure_suitability(const GreyImage& image, const Lattice& lattice) {
  texture_detail::require_image(image, "measure_suitability");
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  Suitability suitability;
  suitability.flat = !(*low < *high);
  suitability.homogeneous =
      texture_detail::is_homogeneous(texture_detail::block_moments(image, 4), texture_detail::moments_of(image));
  suitability.directional =
      texture_detail::structure_tensor(image).coherence() >= texture_detail::k_directional_coherence;
  suitability.symmetric = lattice.found;
  return suitability;
}

AnalysisPlan plan_analysis(const TextureClass& texture_class, const Suitability& suitability) {
  const bool flat = suitability.flat;
  const bool striped = !flat && texture_class.kind == TextureKind::strongly_ordered_nonsymmetric;
  const bool ordered = !flat && texture_class.kind == TextureKind::strongly_ordered_symmetric;
  const bool mixed = !flat && texture_class.kind == TextureKind::composite;
  const bool rough = !flat && !ordered && !striped;
  const std::string lattice_reason = ordered   ? "the mean cell of the lattice explains at least half of the variance"
                                     : mixed   ? "the mean cell of the lattice explains part of the variance"
                                     : flat    ? "the picture is flat"
                                     : striped ? "the picture repeats in one direction only"
                                               : "the picture has no significant lattice";
  AnalysisPlan plan;
  plan.push_back({"fractal_dimension", rough,
                  flat    ? "the picture is flat"
                  : rough ? "part of the texture is disordered; its roughness is a fractal dimension and an rms height"
                          : "the texture is ordered; a fractal dimension describes what is disordered"});
  const bool weak = !flat && texture_class.kind == TextureKind::weakly_ordered;
  plan.push_back({"orientation_field", weak,
                  flat   ? "the picture is flat"
                  : weak ? "the grey values follow a direction that may change from place to place"
                         : "the texture has no direction of its own to follow"});
  const bool repeats = (ordered || mixed) && suitability.symmetric;
  plan.push_back({"primitive", repeats, lattice_reason});
  plan.push_back({"generating_region", suitability.symmetric,
                  suitability.symmetric ? "a lattice has one of 17 groups" : lattice_reason});
  plan.push_back(
      {"exact_tile", repeats, repeats ? "what repeats is made once, and repeats to the last bit" : lattice_reason});
  const bool lit = ordered || mixed || striped;
  plan.push_back({"shape_from_shading", lit, lit ? "the repeating elements are relief that is lit" : lattice_reason});
  plan.push_back({"intensity_as_height", rough && !mixed,
                  flat              ? "the picture is flat"
                  : rough && !mixed ? "without repeating elements the grey value is the only reading of height"
                                    : "shape from shading gives the relief"});
  plan.push_back({"roughness", mixed || weak,
                  flat    ? "the picture is flat"
                  : mixed ? "what the lattice leaves is felt as roughness"
                  : weak  ? "waves below 1 mm are felt as roughness"
                  : rough ? "the relief itself is rough"
                          : "little is left of the picture beside the lattice"});
  const bool surface = rough && !mixed && !weak;
  plan.push_back({"fractal_synthesis", surface,
                  flat      ? "the picture is flat"
                  : surface ? "a surface of the same dimension tiles, where the picture does not"
                            : "the texture has an order that a surface like it loses"});
  return plan;
}

bool is_monochrome(const ColorImage& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw InvalidInput("is_monochrome: the picture is empty or its buffer has the wrong size");
  const auto color = [&](std::size_t i) {
    return Vec3{image.pixels[3 * i] / 255.0, image.pixels[3 * i + 1] / 255.0, image.pixels[3 * i + 2] / 255.0};
  };
  const std::size_t count = image.pixels.size() / 3;
  const double share = 1.0 / static_cast<double>(count);
  Vec3 mean;
  for (std::size_t i = 0; i < count; ++i) mean = mean + share * color(i);
  Vec3 rows[3];  // Of the covariance.
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 d = color(i) - mean;
    rows[0] = rows[0] + d.x * d, rows[1] = rows[1] + d.y * d, rows[2] = rows[2] + d.z * d;
  }
  // Principal axis by power iteration, started along grey.
  Vec3 axis{1, 1, 1};
  for (int round = 0; round < 8; ++round) {
    const Vec3 next{dot(rows[0], axis), dot(rows[1], axis), dot(rows[2], axis)};
    if (!(norm(next) > 0)) return true;  // One colour.
    axis = normalized(next);
  }
  double distance = 0;
  for (std::size_t i = 0; i < count; ++i) distance += norm(cross(color(i) - mean, axis));
  constexpr double k_most_distance = 0.03;
  return distance / static_cast<double>(count) < k_most_distance;
}

}  // namespace papilla
