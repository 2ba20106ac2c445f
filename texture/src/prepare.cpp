// SPDX-License-Identifier: MIT
#include "papilla/texture/prepare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "best_plane.hpp"
#include "border_cut.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/symmetry.hpp"
#include "pyramid.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

using texture_detail::best_plane;
using Field = std::vector<double>;

constexpr std::array<std::pair<BorderMatching, std::string_view>, 4> k_names = {{{BorderMatching::automatic, "auto"},
                                                                                 {BorderMatching::none, "none"},
                                                                                 {BorderMatching::cut, "cut"},
                                                                                 {BorderMatching::mirror, "mirror"}}};

/// Convolution with a Gaussian of that standard deviation; mirrored borders.
Field blurred(Field field, int width, int height, double deviation_px) {
  texture_detail::filter(field, width, height, false, [=](double x, double y) {
    const double wave = 2 * std::numbers::pi * deviation_px;
    return std::exp(-wave * wave * (x * x + y * y) / 2);
  });
  return field;
}

struct Moments {
  double mean = 0, deviation = 0;
};

Moments block_moments(const GreyImage& image, int blocks, int column, int row) {
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = row * image.height / blocks; y < (row + 1) * image.height / blocks; ++y)
    for (int x = column * image.width / blocks; x < (column + 1) * image.width / blocks; ++x, ++count) {
      const double grey = static_cast<double>(image.at(x, y));
      sum += grey;
      squares += grey * grey;
    }
  if (count == 0) return {};
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

std::vector<Moments> block_grid(const GreyImage& image, int blocks) {
  std::vector<Moments> grid;
  for (int row = 0; row < blocks; ++row)
    for (int column = 0; column < blocks; ++column) grid.push_back(block_moments(image, blocks, column, row));
  return grid;
}

double median(Field values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Indices of values more than five robust deviations from the median.
std::vector<std::size_t> outliers(const Field& values, double least_deviation) {
  constexpr double k_to_deviation = 1.4826, k_most = 5;  // Median absolute deviation of normal numbers.
  const double centre = median(values);
  Field distances;
  for (const double value : values) distances.push_back(std::abs(value - centre));
  const double deviation = std::max(least_deviation, k_to_deviation * median(distances));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (deviation > 0 && std::abs(values[i] - centre) > k_most * deviation) found.push_back(i);
  return found;
}

constexpr int k_knot_blocks = 8;

/// Blocks whose mean or contrast stands out.
std::vector<std::size_t> knots(const GreyImage& image, double contrast) {
  if (std::min(image.width, image.height) < 4 * k_knot_blocks) return {};
  Field means, deviations;
  for (const Moments& block : block_grid(image, k_knot_blocks)) {
    means.push_back(block.mean);
    deviations.push_back(block.deviation);
  }
  const Field plane = best_plane(means, k_knot_blocks, k_knot_blocks);  // A gradient is no knot.
  for (std::size_t i = 0; i < means.size(); ++i) means[i] -= plane[i];
  constexpr double k_least = 0.02;  // Of the contrast: what regular pictures differ by.
  std::vector<std::size_t> found = outliers(means, k_least * contrast);
  for (const std::size_t block : outliers(deviations, k_least * contrast))
    if (std::find(found.begin(), found.end(), block) == found.end()) found.push_back(block);
  std::sort(found.begin(), found.end());
  return found;
}

double mean_of(const GreyImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
}

/// The picture at a size at which a Gaussian of that standard deviation still spans some pixels.
texture_detail::Shrunk sized_for(const GreyImage& image, double deviation_px) {
  constexpr double k_least_deviation = 8;
  constexpr int k_large = 2048;
  const double most = std::max<double>(k_large, std::max(image.width, image.height) * k_least_deviation / deviation_px);
  return texture_detail::shrunk(image, static_cast<int>(std::min(most, 1e9)));
}

/// Replaces every grey by change(grey, value of the smooth field there), row by row: the field never exists at the
/// picture's size.
template <class Change>
void change_rows(GreyImage& image, const GreyImage& small, const Field& smooth, const Change& change) {
  const texture_detail::CoarseHeights field{smooth, small.width, small.height, image.width, image.height, false};
  const double scale = texture_detail::enlargement(field, {0, 1, 0}, {0, 1, 0});
  for (int y = 0; y < image.height; ++y) {
    const Field row = texture_detail::enlarged(field, {0, 1, image.width}, {static_cast<double>(y), 1, 1});
    for (int x = 0; x < image.width; ++x)
      image.at(x, y) =
          static_cast<float>(change(static_cast<double>(image.at(x, y)), row[static_cast<std::size_t>(x)] / scale));
  }
}

Field to_field(const GreyImage& image) { return {image.pixels.begin(), image.pixels.end()}; }

void flatten(GreyImage& image, double deviation_px) {
  const double mean = mean_of(image);
  const auto [small, halvings] = sized_for(image, deviation_px);
  const double deviation_small = std::ldexp(deviation_px, -halvings);
  // The mirrored borders of the blur would bend a gradient: the plane is taken away first.
  Field low = to_field(small);
  const Field plane = best_plane(low, small.width, small.height);
  for (std::size_t i = 0; i < low.size(); ++i) low[i] -= plane[i];
  low = blurred(std::move(low), small.width, small.height, deviation_small);
  for (std::size_t i = 0; i < low.size(); ++i) low[i] += plane[i];
  change_rows(image, small, low, [](double grey, double under) { return grey - under; });

  GreyImage squares = image;
  for (float& value : squares.pixels) value *= value;
  const double deviation = std::sqrt(mean_of(squares));
  squares = texture_detail::shrunk(squares, std::max(small.width, small.height)).image;
  const Field local = blurred(to_field(squares), small.width, small.height, deviation_small);
  change_rows(image, small, local, [=](double rest, double square) {
    const double here = std::sqrt(std::max(0.0, square));
    return mean + (here > 0 ? std::clamp(deviation / here, 0.5, 2.0) : 1) * rest;
  });
}

void raise_detail(GreyImage& image, double amount) {
  constexpr double k_share = 0.005;
  const double deviation_px = k_share * std::min(image.width, image.height);
  const auto [small, halvings] = sized_for(image, deviation_px);
  const Field low = blurred(to_field(small), small.width, small.height, std::ldexp(deviation_px, -halvings));
  change_rows(image, small, low, [=](double grey, double under) { return grey + amount * (grey - under); });
}

GreyImage mirrored(const GreyImage& image) {
  GreyImage twice{2 * image.width, 2 * image.height, {}, image.pitch_mm, 32};
  for (int y = 0; y < twice.height; ++y)
    for (int x = 0; x < twice.width; ++x)
      twice.pixels.push_back(image.at(std::min(x, twice.width - 1 - x), std::min(y, twice.height - 1 - y)));
  return twice;
}

void stretch(GreyImage& image) {
  std::vector<float> greys = image.pixels;
  const auto percentile = [&](double share) {
    const auto place = greys.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(greys.size() - 1));
    std::nth_element(greys.begin(), place, greys.end());
    return static_cast<double>(*place);
  };
  const double low = percentile(0.005), high = percentile(0.995);
  for (float& grey : image.pixels)
    grey = static_cast<float>(high > low ? std::clamp((static_cast<double>(grey) - low) / (high - low), 0.0, 1.0)
                                         : std::clamp(static_cast<double>(grey), 0.0, 1.0));
}

void require(const GreyImage& image, const PrepareOptions& options) {
  constexpr int k_least_side = 16;
  texture_detail::require_image(image, "prepare_picture", k_least_side);
  if (!(options.flatten_px >= 0 && options.flatten_px <= 1e6))
    throw InvalidInput("prepare_picture: flatten_px " + std::to_string(options.flatten_px) + " is not within 0 to 1e6");
  if (!(options.plasticity >= 0 && options.plasticity <= 4))
    throw InvalidInput("prepare_picture: plasticity " + std::to_string(options.plasticity) + " is not within 0 to 4");
}

double default_flatten_px(const GreyImage& image) {
  double length = std::min(image.width, image.height) / 10.0;
  const Lattice lattice = analyze_symmetry(image).lattice;
  if (lattice.found) length = std::max({length, norm(lattice.vectors_px[0]), norm(lattice.vectors_px[1])});
  return length;
}

void match_borders(PreparedPicture& result, BorderMatching wanted) {
  const bool tiles = measure_tiling(result.image).tiles;
  BorderMatching matching = wanted;
  std::string reason = "asked for";
  if (wanted == BorderMatching::automatic) {
    matching = tiles ? BorderMatching::none : BorderMatching::cut;
    reason = tiles ? "the picture tiles already" : "a seam shows when the picture is tiled";
  }
  result.steps.push_back(
      {"match_borders", matching != BorderMatching::none, reason + ": " + std::string(to_string(matching))});
  if (matching == BorderMatching::mirror) result.image = mirrored(result.image);
  if (matching != BorderMatching::cut) return;
  result.image = texture_detail::cut_across(result.image, false);
  result.image = texture_detail::transposed(texture_detail::cut_across(texture_detail::transposed(result.image), true));
  result.steps.push_back({"remove_seams", true, "the path of least difference through the overlap is mixed over"});
}

void warn(const GreyImage& picture, PreparedPicture& result) {
  constexpr double k_visible_gradient = 1, k_visible_ratio = 2;
  const PictureNumbers& after = result.after;
  if (after.gradient > k_visible_gradient)
    result.warnings.push_back("block means differ by " + std::to_string(after.gradient) +
                              " standard deviations: shows as a pattern when tiled");
  if (after.contrast_ratio > k_visible_ratio)
    result.warnings.push_back("block contrasts differ by a factor of " + std::to_string(after.contrast_ratio) +
                              ": shows as a pattern when tiled");
  for (const std::size_t block : knots(picture, result.before.contrast)) {
    const auto column = static_cast<int>(block) % k_knot_blocks, row = static_cast<int>(block) / k_knot_blocks;
    result.warnings.push_back(
        "a knot around pixel (" + std::to_string((2 * column + 1) * picture.width / (2 * k_knot_blocks)) + ", " +
        std::to_string((2 * row + 1) * picture.height / (2 * k_knot_blocks)) + ") of the input stands out when tiled");
  }
  if (!after.tiling.tiles) result.warnings.push_back("the result does not tile");
}

}  // namespace

std::string_view to_string(BorderMatching matching) noexcept {
  for (const auto& [value, name] : k_names)
    if (value == matching) return name;
  return "unknown";
}

BorderMatching border_matching(std::string_view name) {
  for (const auto& [value, known] : k_names)
    if (known == name) return value;
  throw InvalidInput("border_matching: '" + std::string(name) + "' is not auto, none, cut or mirror");
}

PictureNumbers measure_picture(const GreyImage& image) {
  texture_detail::require_image(image, "measure_picture");
  constexpr int k_blocks = 4;
  const Moments whole = block_moments(image, 1, 0, 0);
  PictureNumbers numbers{image.width, image.height, whole.mean, whole.deviation, 0, 1, 0, measure_tiling(image)};
  if (std::min(image.width, image.height) < k_blocks || !(whole.deviation > 0)) return numbers;
  const std::vector<Moments> blocks = block_grid(image, k_blocks);
  const auto [dark, bright] = std::minmax_element(blocks.begin(), blocks.end(),
                                                  [](const Moments& a, const Moments& b) { return a.mean < b.mean; });
  const auto [weak, strong] = std::minmax_element(
      blocks.begin(), blocks.end(), [](const Moments& a, const Moments& b) { return a.deviation < b.deviation; });
  constexpr double k_most_ratio = 1e6;
  numbers.gradient = (bright->mean - dark->mean) / whole.deviation;
  numbers.contrast_ratio =
      weak->deviation * k_most_ratio > strong->deviation ? strong->deviation / weak->deviation : k_most_ratio;
  numbers.knots = static_cast<int>(knots(image, whole.deviation).size());
  return numbers;
}

PreparedPicture prepare_picture(const GreyImage& image, const PrepareOptions& options) {
  require(image, options);
  const auto tell = [&](double fraction) { report_progress(options.progress, "prepare", fraction); };
  tell(0);
  PreparedPicture result;
  result.image = image;
  result.image.bits = 32;
  result.before = measure_picture(image);
  const bool flat = !(result.before.contrast > 0);
  tell(0.1);
  result.steps.push_back({"flatten", options.flatten && !flat,
                          flat              ? "the picture is flat"
                          : options.flatten ? "gradients of brightness and contrast show as a pattern when tiled"
                                            : "not asked for"});
  if (options.flatten && !flat)
    flatten(result.image, options.flatten_px > 0 ? options.flatten_px : default_flatten_px(image));
  tell(0.4);
  result.steps.push_back({"plasticity", options.plasticity > 0,
                          options.plasticity > 0 ? "fine detail raised as asked for" : "not asked for"});
  if (options.plasticity > 0) raise_detail(result.image, options.plasticity);
  tell(0.5);
  match_borders(result, options.borders);
  tell(0.8);
  result.steps.push_back(
      {"contrast", options.contrast, options.contrast ? "the full range of greys is used" : "not asked for"});
  if (options.contrast) stretch(result.image);
  tell(0.9);
  result.after = measure_picture(result.image);
  tell(1);
  warn(image, result);
  return result;
}

}  // namespace papilla
