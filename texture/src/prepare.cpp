// SPDX-License-Identifier: MIT
#include "papilla/texture/prepare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "best_plane.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice_deformation.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/symmetry.hpp"
#include "pyramid.hpp"
#include "shaped_noise.hpp"
#include "texture_class_rules.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

double squared_step(const GreyImage& image, int x, int y, int shift) {
  const double difference = static_cast<double>(image.at(x, y)) - static_cast<double>(image.at(x + shift, y));
  return difference * difference;
}

/// The overlap within `least` … `most` over which left and right border differ least.
int least_different_overlap(const GreyImage& image, int least, int most) {
  int best = least;
  double lowest = 1e300;
  for (int overlap = least; overlap <= most; ++overlap) {
    const int shift = image.width - overlap;
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < overlap; ++x) sum += squared_step(image, x, y, shift);
    const double mean = sum / (static_cast<double>(overlap) * image.height);
    if (mean >= lowest) continue;
    lowest = mean;
    best = overlap;
  }
  return best;
}

/// least_different_overlap() between a sixteenth and a quarter of the width. In wide pictures only a few pixels around
/// the best overlap of the picture at half its size are tried, so that the search costs a few passes.
int best_overlap(const GreyImage& image) {
  constexpr int k_widest = 2048, k_near = 2;
  const int least = std::max(2, image.width / 16), most = std::max(least, image.width / 4);
  if (image.width <= k_widest) return least_different_overlap(image, least, most);
  const GreyImage half = halved(image);
  const auto near = static_cast<int>(std::lround(static_cast<double>(best_overlap(half)) * image.width / half.width));
  return least_different_overlap(image, std::clamp(near - k_near, least, most), std::clamp(near + k_near, least, most));
}

/// Column of the cut in every row, moving by at most one from row to row; first and last row agree when the picture
/// tiles from top to bottom.
std::vector<int> cut(const GreyImage& image, int overlap, bool periodic_down) {
  const int shift = image.width - overlap, rows = image.height;
  const auto cost = [&](int x, int y) { return squared_step(image, x, y, shift); };
  const auto path = [&](int first, int last) {  // −1: any column.
    std::vector<double> sums(static_cast<std::size_t>(overlap) * static_cast<std::size_t>(rows));
    std::vector<int> from(sums.size());
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < overlap; ++x) {
        double before = y == 0 && first >= 0 && x != first ? 1e300 : 0;
        int best = x;
        if (y > 0) {
          before = 1e300;
          for (int k = std::max(0, x - 1); k <= std::min(overlap - 1, x + 1); ++k)
            if (const double sum = sums[pixel_index(k, y - 1, overlap)]; sum < before) {
              before = sum;
              best = k;
            }
        }
        sums[pixel_index(x, y, overlap)] = std::min(1e300, before + cost(x, y));
        from[pixel_index(x, y, overlap)] = best;
      }
    std::vector<int> columns(static_cast<std::size_t>(rows));
    const auto end = sums.end() - overlap;
    int at = last >= 0 ? last : static_cast<int>(std::min_element(end, sums.end()) - end);
    for (int y = rows - 1; y >= 0; --y) {
      columns[static_cast<std::size_t>(y)] = at;
      at = from[pixel_index(at, y, overlap)];
    }
    return columns;
  };
  std::vector<int> columns = path(-1, -1);
  if (!periodic_down || columns.front() == columns.back()) return columns;
  // Through the row half way along the free path: a closed path near the best one.
  const int through = (columns.front() + columns.back()) / 2;
  columns = path(through, through);
  return columns;
}

/// The picture made to tile from left to right: see prepare_picture(). Narrower by the overlap.
GreyImage cut_across(const GreyImage& image, bool periodic_down) {
  const int overlap = best_overlap(image), width = image.width - overlap;
  const std::vector<int> columns = cut(image, overlap, periodic_down);
  GreyImage result{width, image.height, {}, image.pitch_mm, 32};
  const double feather = std::min(2.0, overlap / 4.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const double own = static_cast<double>(image.at(x, y));
      if (x >= overlap) {
        result.pixels.push_back(static_cast<float>(own));
        continue;
      }
      // Left of the cut what goes on from the right border, right of it the picture itself; the outermost columns are
      // never mixed, so that both neighbours of the seam come from the picture's own rows.
      const double t = (x - columns[static_cast<std::size_t>(y)]) / std::max(feather, 1e-9);
      double share = std::clamp(0.5 + t / 2, 0.0, 1.0);
      if (x == 0) share = 0;
      if (x == overlap - 1) share = 1;
      result.pixels.push_back(
          static_cast<float>(share * own + (1 - share) * static_cast<double>(image.at(x + width, y))));
    }
  return result;
}

/// Rows become columns.
GreyImage transposed(const GreyImage& image) {
  GreyImage result{image.height, image.width, {}, image.pitch_mm, image.bits};
  result.pixels.reserve(image.pixels.size());
  for (int x = 0; x < image.width; ++x)
    for (int y = 0; y < image.height; ++y) result.pixels.push_back(image.at(x, y));
  return result;
}

using Field = std::vector<double>;

constexpr std::array<std::string_view, 4> k_names = {"auto", "none", "cut", "mirror"};

/// Convolution with a Gaussian of that standard deviation; mirrored borders.
Field blurred(Field field, int width, int height, double deviation_px) {
  filter(field, width, height, false, [=](double x, double y) {
    const double wave = 2 * std::numbers::pi * deviation_px;
    return std::exp(-wave * wave * (x * x + y * y) / 2);
  });
  return field;
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

/// Numbers of the blocks whose mean or contrast is an outlier.
std::vector<std::size_t> knots(const GreyImage& image, double contrast) {
  if (std::min(image.width, image.height) < 4 * k_knot_blocks) return {};
  Field means, deviations;
  for (const Moments& block : block_moments(image, k_knot_blocks)) {
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
Shrunk sized_for(const GreyImage& image, double deviation_px) {
  constexpr double k_least_deviation = 8;
  constexpr int k_large = 2048;
  const double most = std::max<double>(k_large, std::max(image.width, image.height) * k_least_deviation / deviation_px);
  return shrunk(image, static_cast<int>(std::min(most, 1e9)));
}

/// Replaces every grey value by change(grey, value of the smooth field there). The field is enlarged row by row, so
/// that it never takes the memory of the whole picture.
template <class Change>
void change_rows(GreyImage& image, const GreyImage& small, const Field& smooth, const Change& change) {
  const CoarseHeights field{smooth, small.width, small.height, image.width, image.height, false};
  const double scale = enlargement(field, {0, 1, 0}, {0, 1, 0});
  for (int y = 0; y < image.height; ++y) {
    const Field row = enlarged(field, {0, 1, image.width}, {static_cast<double>(y), 1, 1});
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
  squares = shrunk(squares, std::max(small.width, small.height)).image;
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
  Values<float> greys = image.pixels;
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
  require_image(image, "prepare_picture", k_least_side);
  if (!(options.flatten_px >= 0 && options.flatten_px <= 1e6))
    throw InvalidInput("prepare_picture: flatten_px " + std::to_string(options.flatten_px) + " is not within 0 to 1e6");
  if (!(options.plasticity >= 0 && options.plasticity <= 4))
    throw InvalidInput("prepare_picture: plasticity " + std::to_string(options.plasticity) + " is not within 0 to 4");
}

/// Straightens the picture when its lattice bends, and cuts off what would have come from beyond the borders.
void straighten(PreparedPicture& result, const PrepareOptions& options) {
  if (!options.straighten) return;
  constexpr int k_most_side = 2048, k_least_side = 16;
  GreyImage& image = result.image;
  const auto step = [&](bool run, std::string reason) {
    result.steps.push_back({"straighten", run, std::move(reason)});
  };
  if (std::max(image.width, image.height) > k_most_side) return step(false, "the picture has over 2048 pixels a side");
  const SymmetryAnalysis symmetry = analyze_symmetry(image);
  if (!symmetry.lattice.found) return step(false, "no lattice: " + symmetry.lattice.reason);
  if (!symmetry.deformation) return step(false, "the lattice is straight");
  const LatticeDeformation& bent = *symmetry.deformation;
  const double cell = std::sqrt(std::abs(cross(bent.vectors_px[0], bent.vectors_px[1])));
  const int rim = static_cast<int>(std::ceil(bent.max_percent_of_cell / 100 * cell));
  if (std::min(image.width, image.height) - 2 * rim < k_least_side)
    return step(false, "the lattice bends further than the picture is wide");
  image = straightened(image, bent.displacement);
  image = crop(image, rim, rim, image.width - 2 * rim, image.height - 2 * rim);
  step(true, "cells are displaced by " + std::to_string(std::lround(bent.rms_percent_of_cell)) + " % of their size");
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
  result.image = cut_across(result.image, false);
  result.image = transposed(cut_across(transposed(result.image), true));
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

std::string_view to_string(BorderMatching matching) noexcept { return k_names[static_cast<std::size_t>(matching)]; }

BorderMatching border_matching(std::string_view name) {
  return static_cast<BorderMatching>(index_of_name(name, k_names, "border_matching"));
}

PictureNumbers measure_picture(const GreyImage& image) {
  require_image(image, "measure_picture");
  constexpr int k_blocks = 4;
  const Moments whole = moments_of(image);
  PictureNumbers numbers{image.width, image.height, whole.mean, whole.deviation, 0, 1, 0, measure_tiling(image)};
  if (std::min(image.width, image.height) < k_blocks || !(whole.deviation > 0)) return numbers;
  const std::vector<Moments> blocks = block_moments(image, k_blocks);
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
  const auto report = [&](double fraction) { report_progress(options.progress, "prepare", fraction); };
  report(0);
  PreparedPicture result;
  result.image = image;
  result.image.bits = 32;
  result.before = measure_picture(image);
  const bool flat = !(result.before.contrast > 0);
  report(0.1);
  straighten(result, options);
  result.steps.push_back({"flatten", options.flatten && !flat,
                          flat              ? "the picture is flat"
                          : options.flatten ? "gradients of brightness and contrast show as a pattern when tiled"
                                            : "not asked for"});
  if (options.flatten && !flat)
    flatten(result.image, options.flatten_px > 0 ? options.flatten_px : default_flatten_px(result.image));
  report(0.4);
  result.steps.push_back({"plasticity", options.plasticity > 0,
                          options.plasticity > 0 ? "fine detail raised as asked for" : "not asked for"});
  if (options.plasticity > 0) raise_detail(result.image, options.plasticity);
  report(0.5);
  match_borders(result, options.borders);
  report(0.8);
  result.steps.push_back(
      {"contrast", options.contrast, options.contrast ? "the full range of greys is used" : "not asked for"});
  if (options.contrast) stretch(result.image);
  report(0.9);
  result.after = measure_picture(result.image);
  report(1);
  warn(image, result);
  return result;
}

}  // namespace papilla
