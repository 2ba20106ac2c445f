// SPDX-License-Identifier: MIT
#include "papilla/texture/height_from_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/symmetry.hpp"
#include "papilla/texture/tiling.hpp"
#include "row_window.hpp"
#include "shading_spectrum.hpp"
#include "shaped_noise.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

constexpr std::array<std::string_view, 7> k_method_names = {
    "auto", "variational", "pentland", "tsai-shah", "intensity", "wiener", "photometric-stereo"};

constexpr std::array<std::string_view, 4> k_roughness_names = {"whole", "none", "residual", "synthesized"};

/// Finer than this is roughness, coarser is relief.
constexpr double k_roughness_mm = 1;

void require_options(const HeightOptions& options) {
  if (options.method == HeightMethod::photometric_stereo)
    throw InvalidInput("height_from_image: photometric-stereo needs three or more photographs");
  if (!texture_detail::is_positive(options.depth_mm))
    throw InvalidInput("height_from_image: depth " + std::to_string(options.depth_mm) + " mm is not positive");
  if (options.pitch_mm != 0 && !texture_detail::is_positive(options.pitch_mm))
    throw InvalidInput("height_from_image: pitch " + std::to_string(options.pitch_mm) + " mm is not positive");
  if (options.albedo != 0 && !texture_detail::is_positive(options.albedo))
    throw InvalidInput("height_from_image: albedo " + std::to_string(options.albedo) + " is not positive");
  if (options.iterations < 0)
    throw InvalidInput("height_from_image: iterations " + std::to_string(options.iterations) + " is negative");
  if (options.shortest_wavelength_mm != 0 && !texture_detail::is_positive(options.shortest_wavelength_mm))
    throw InvalidInput("height_from_image: wavelength " + std::to_string(options.shortest_wavelength_mm) +
                       " mm is not positive");
}

/// Sets the size of the map to one tile of the lattice.
void choose_tile(const GreyImage& image, const Lattice& lattice, HeightResult& result) {
  if (!lattice.found)
    throw InvalidInput("height_from_image: a tile needs a lattice, but " + lattice.reason +
                       "; other pictures are made to tile by matching their borders");
  CommensurateOptions options;
  options.least_side = std::min({options.least_side, image.width, image.height});
  result.tile = find_commensurate_tile(lattice.vectors_px, options);
  result.map.width = result.tile->width;
  result.map.height = result.tile->height;
  result.map.periodic = true;
}

struct Statistics {
  float low = 0, high = 0;
  double mean = 0, deviation = 0;  ///< Root mean square from the mean.
  double dark = 0, bright = 0;     ///< Shares below and above the bounds.
};

/// Brightness over the mean.
struct Bounds {
  double dark = 0, bright = 1e300;
};

/// @throws InvalidInput when a sample is not finite.
Statistics statistics(const SampleRows& samples, const Bounds& bounds = {}) {
  Statistics s;
  std::vector<float> row(static_cast<std::size_t>(samples.width()));
  const auto each_row = [&](const auto& visit) {
    for (int y = 0; y < samples.height(); ++y) {
      samples.read(0, y, samples.width(), row.data());
      visit(y);
    }
  };
  double sum = 0, squares = 0;
  each_row([&](int y) {
    const auto bad = std::find_if(row.begin(), row.end(), [](float value) { return !std::isfinite(value); });
    if (bad != row.end())
      throw InvalidInput("height_from_rows: sample [" + std::to_string(bad - row.begin()) + ", " + std::to_string(y) +
                         "] is not a finite number");
    const auto [low, high] = std::minmax_element(row.begin(), row.end());
    s.low = y == 0 ? *low : std::min(s.low, *low);
    s.high = y == 0 ? *high : std::max(s.high, *high);
    for (const float value : row) sum += static_cast<double>(value);
  });
  s.mean = sum / samples.count();
  each_row([&](int) {
    for (const float sample : row) {
      const auto value = static_cast<double>(sample);
      squares += (value - s.mean) * (value - s.mean);
      if (value < bounds.dark * s.mean) s.dark += 1 / samples.count();
      if (value > bounds.bright * s.mean) s.bright += 1 / samples.count();
    }
  });
  s.deviation = std::sqrt(squares / samples.count());
  return s;
}

/// Linear, evened brightness of a picture, whose samples it checks.
EvenedSamples brightness_of(const SampleRows& picture, TransferCurve curve, HeightResult& result) {
  statistics(picture);
  result.decoded = curve.source;
  const LightField field = result.map.periodic ? LightField{} : light_field(picture, curve);
  result.unevenness = field.unevenness;
  return EvenedSamples(picture, std::move(curve), field);
}

TransferCurve curve_of(const GreyImage& image, const HeightOptions& options) {
  return transfer_curve(options.transfer, image.bits, image.curve);
}

void choose_light(const SampleRows& brightness, const HeightOptions& options, HeightResult& result) {
  if (options.light) {
    result.light = texture_detail::require_light(*options.light, "height_from_image");
    return;
  }
  const LightEstimate estimate = estimate_light(brightness);
  result.light = estimate.direction;
  result.light_estimated = result.ambiguous = true;
  result.light_coherence = estimate.coherence;
  result.light_uncertainty_deg = estimate.uncertainty_deg;
}

std::string rounded(double value) {
  const auto hundredths = std::lround(100 * value);
  return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") + std::to_string(hundredths % 100);
}

/// Wiener's filter or grey as height, whichever is expected to correlate more; the light is known then.
void choose_by_expectation(const SampleRows& brightness, const HeightOptions& options, HeightResult& result) {
  choose_light(brightness, options, result);
  // Share of pictures with such a coherence that are lit, of the model's and of real ones.
  constexpr double k_not_lit = 0.15, k_lit = 0.35;
  const double lit =
      options.light ? 1 : std::clamp((result.light_coherence - k_not_lit) / (k_lit - k_not_lit), 0.0, 1.0);
  const double turned = std::cos(result.light_uncertainty_deg * k_radians_per_degree);
  const double shading = lit > 0
                             ? lit * turned *
                                   texture_detail::ShadingSpectrum(texture_detail::middle_of(brightness), result.light)
                                       .expected_correlation()
                             : 0;
  constexpr double k_grey_of_heights = 0.5, k_grey_of_lit = 0.10;  // Means; see wiener.md.
  const double grey = (1 - lit) * k_grey_of_heights + lit * k_grey_of_lit;
  result.method = shading >= grey ? HeightMethod::wiener : HeightMethod::intensity;
  // What is assumed of pictures without a direction of light decides, but is no expectation to be told.
  if (result.method == HeightMethod::wiener)
    result.expected_correlation = shading;
  else if (lit == 1)
    result.expected_correlation = grey;
  result.reason = std::string(lit > 0 ? "" : "no direction of light is seen: ") + "expected correlation " +
                  rounded(shading) + " from shading, " + rounded(grey) + (lit < 1 ? ", an assumption," : "") +
                  " with grey read as height";
  if (result.method == HeightMethod::intensity) {
    result.light = HeightResult{}.light;
    result.light_estimated = result.ambiguous = false;
    result.light_uncertainty_deg = 0;
    result.ambiguous = !options.light;
  }
}

void choose_method(const SampleRows& picture, const TransferCurve& curve, const HeightOptions& options,
                   HeightResult& result) {
  if (options.method == HeightMethod::automatic) {
    choose_by_expectation(brightness_of(picture, curve, result), options, result);
    return;
  }
  result.method = options.method;
  result.reason = "asked for";
}

/// The light, and how the picture is to be solved for its heights; nothing for a flat or black one, whose heights are
/// 0.
std::optional<ShadingOptions> choose_shading(const SampleRows& brightness, const HeightOptions& options,
                                             HeightResult& result) {
  if (options.method != HeightMethod::automatic) choose_light(brightness, options, result);
  // A matt surface that faces the light is 1 / s_z times as bright as level ground.
  constexpr double k_shadow = 0.25, k_highlight = 1.05;
  const Statistics grey = statistics(brightness, {k_shadow, k_highlight / result.light.z});
  if (!(grey.low < grey.high) || !(grey.mean > 0)) {
    result.stop = StopReason::direct;
    return std::nullopt;
  }
  result.shadows_fraction = grey.dark;
  result.highlights_fraction = grey.bright;
  ShadingOptions shading;
  shading.light = result.light;
  shading.albedo = options.albedo > 0 ? options.albedo : grey.mean / result.light.z;
  shading.periodic = result.map.periodic;
  shading.largest_piece_px = options.largest_piece_px;
  if (options.iterations > 0) shading.iterations = options.iterations;
  shading.progress = options.progress;
  return shading;
}

/// Of the three methods with the same parameters the one that was chosen.
template <class Solve>
Solve* solver(HeightMethod method, Solve* variational, Solve* pentland, Solve* tsai_shah) {
  return method == HeightMethod::variational ? variational : method == HeightMethod::pentland ? pentland : tsai_shah;
}

/// The heights by wiener, which estimates more than the other methods.
ShadingResult kept(WienerShadingResult solved, const HeightOptions& options, HeightResult& result) {
  if (options.method != HeightMethod::automatic) result.expected_correlation = solved.expected_correlation;
  return solved;
}

std::vector<double> height_by_shading(const GreyImage& picture, const HeightOptions& options, HeightResult& result) {
  const SamplesInMemory samples(picture.pixels, picture.width, picture.height);
  const EvenedSamples evened = brightness_of(samples, curve_of(picture, options), result);
  const auto shading = choose_shading(evened, options, result);
  if (!shading) return std::vector<double>(picture.pixels.size(), 0.0);
  GreyImage image{picture.width, picture.height, Values<float>(picture.pixels.size()), 0, 32};
  for (int y = 0; y < image.height; ++y) evened.read(0, y, image.width, &image.at(0, y));
  using Solve = ShadingResult(const GreyImage&, const ShadingOptions&);
  ShadingResult solved = result.method == HeightMethod::wiener
                             ? kept(shape_from_shading_wiener(image, *shading), options, result)
                             : solver<Solve>(result.method, shape_from_shading_variational, shape_from_shading_pentland,
                                             shape_from_shading_tsai_shah)(image, *shading);
  result.trace = std::move(solved.trace);
  result.stop = solved.stop;
  result.pieces = solved.pieces;
  return std::move(solved.height_px);
}

/// Fills the map with heights stretched to 0…depth.
void scale_to_depth(const std::vector<double>& heights, double depth_mm, HeightResult& result) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double offset = *low, range = *high - *low;
  const double scale = range > 0 ? depth_mm / range : 0;
  result.map.mm.resize(heights.size());
  std::transform(heights.begin(), heights.end(), result.map.mm.begin(),
                 [&](double height) { return static_cast<float>(scale * (height - offset)); });
  result.depth_mm = range > 0 ? depth_mm : 0;
}

using Field = std::vector<double>;

Field relief_of(const GreyImage& image, const HeightOptions& options, HeightResult& result) {
  if (result.method == HeightMethod::intensity) return {image.pixels.begin(), image.pixels.end()};
  return height_by_shading(image, options, result);
}

double range_of(const Field& field) {
  const auto [low, high] = std::minmax_element(field.begin(), field.end());
  return *high - *low;
}

double rms_of(const Field& field) {
  double squares = 0;
  for (const double value : field) squares += value * value;
  return std::sqrt(squares / static_cast<double>(field.size()));
}

/// The residual's waves of at most k_roughness_mm, in grey values.
Field rough_part(const GreyImage& residual, const HeightResult& result) {
  Field field(residual.pixels.begin(), residual.pixels.end());
  const double pitch = result.map.pitch_mm_x;
  const double longest_px = pitch > 0 ? k_roughness_mm / pitch : 1e300;
  const bool periodic = result.map.periodic && !result.tile;  // A tile of the lattice is no period of the residual.
  texture_detail::filter(field, residual.width, residual.height, periodic, [=](double x, double y) {
    return (x != 0 || y != 0) && std::hypot(x, y) * longest_px >= 1 ? 1.0 : 0.0;
  });
  return field;
}

/// Periodic noise with the dimension and the rms of the residual's rough part.
Field synthesized_like(const GreyImage& residual, const Field& rough, const HeightOptions& options,
                       const HeightResult& result) {
  constexpr int k_least_side = 32;
  const bool measurable = std::min(residual.width, residual.height) >= k_least_side;
  const auto fractal = measurable ? best_dimension(residual).estimate : std::nullopt;
  const double hurst = fractal ? std::clamp(fractal->hurst, 0.05, 0.95) : 0.5;  // Without a law the middle.
  const double pitch = result.map.pitch_mm_x;
  const double longest_px = pitch > 0 ? k_roughness_mm / pitch : 1e300;
  Field noise =
      texture_detail::shaped_noise(result.map.width, result.map.height, options.seed, [=](double x, double y) {
        const double frequency = std::hypot(x, y);
        return frequency > 0 && frequency * longest_px >= 1 ? std::pow(frequency, -hurst - 1) : 0;
      });
  const double rms = rms_of(rough);
  for (double& value : noise) value *= rms;
  return noise;
}

/// Relief of the symmetric part plus roughness, both in units of the relief's range.
Field relief_with_roughness(const GreyImage& image, const Lattice& lattice, const HeightOptions& options,
                            HeightResult& result) {
  const SymmetricPart part = symmetric_part(image, lattice.vectors_px);
  const GreyImage& cell = options.primitive ? *options.primitive : part.primitive;
  GreyImage regular = result.tile ? fill_tile(cell, *result.tile) : part.synthesis;
  regular.bits = image.bits;  // Of the camera: the mean is as it stored the grey values.
  regular.curve = image.curve;
  Field field = relief_of(regular, options, result);
  const double range = range_of(field);
  if (range > 0)
    for (double& value : field) value /= range;
  if (result.roughness == HeightRoughness::none) return field;
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  const double greys = static_cast<double>(*high) - static_cast<double>(*low);
  Field rough = rough_part(part.residual, result);
  if (result.roughness == HeightRoughness::synthesized) rough = synthesized_like(part.residual, rough, options, result);
  for (std::size_t i = 0; i < field.size() && greys > 0; ++i) field[i] += rough[i] / greys;
  result.roughness_rms_mm = greys > 0 ? rms_of(rough) / greys : 0;  // Of the range; scaled with it later.
  return field;
}

/// Removes the waves shorter than the cut and attenuates those up to half as long again.
void cut_short_waves(Field& field, const HeightOptions& options, HeightResult& result) {
  const double pitch = result.map.pitch_mm_x;
  if (pitch > 0) result.shortest_wavelength_mm = std::max(2 * pitch, options.shortest_wavelength_mm);
  if (options.shortest_wavelength_mm <= 2 * pitch) return;
  if (!(pitch > 0)) throw InvalidInput("height_from_image: a shortest wavelength in millimetres needs a pitch");
  const double cut_px = options.shortest_wavelength_mm / pitch;
  texture_detail::filter(field, result.map.width, result.map.height, result.map.periodic, [=](double x, double y) {
    const double waves = std::hypot(x, y) * cut_px;  // 1 at the cut, 2/3 where the attenuation begins.
    return waves <= 2.0 / 3 ? 1.0 : waves >= 1 ? 0.0 : 0.5 + 0.5 * std::cos(std::numbers::pi * (3 * waves - 2));
  });
}

/// See HeightResult::guessed_share.
double share_across(const SampleRows& relief, bool periodic, Vec3 light) {
  const Vec2 azimuth = {light.x, light.y};
  const double length = norm(azimuth);
  if (!(length > 0)) return 1;
  const int width = relief.width();
  double across = 0, total = 0;
  texture_detail::visit_rows(relief, periodic, [&](int y, const texture_detail::RowWindow& rows) {
    const double span = texture_detail::stencil(y, relief.height(), periodic).span;
    for (int x = 0; x < width; ++x) {
      const texture_detail::Stencil columns = texture_detail::stencil(x, width, periodic);
      const auto at = [](const std::vector<float>& row, int i) {
        return static_cast<double>(row[static_cast<std::size_t>(i)]);
      };
      const Vec2 slope{(at(rows.row, columns.after) - at(rows.row, columns.before)) / columns.span,
                       (at(rows.below, x) - at(rows.above, x)) / span};
      const double sideways = cross(azimuth, slope) / length;
      across += sideways * sideways;
      total += dot(slope, slope);
    }
  });
  return total > 0 ? across / total : 0;
}

void list_measured_and_assumed(const HeightOptions& options, HeightResult& result) {
  const bool lit = result.method != HeightMethod::intensity;
  result.assumed.emplace_back("depth: a single picture determines relief only up to scale");
  if (!lit) result.assumed.emplace_back("grey value is height: nothing in the picture says so");
  if (lit && options.albedo <= 0)
    result.assumed.emplace_back("albedo: such that the mean grey is that of level ground");
  if (lit && result.light_estimated) {
    result.assumed.emplace_back("elevation of the light: 45 degrees");
    result.assumed.emplace_back("side of the light: from above; the opposite one turns the relief inside out");
    result.measured.emplace_back("azimuth of the light, as far as the relief has no direction of its own");
  }
  if (lit) result.measured.emplace_back("slopes along the light");
  if (lit) result.assumed.emplace_back("slopes across the light: the smoothest that fit");
  if (result.roughness == HeightRoughness::residual || result.roughness == HeightRoughness::synthesized)
    result.assumed.emplace_back("height of the roughness: its grey range in proportion to the picture's");
  if (result.roughness == HeightRoughness::synthesized)
    result.measured.emplace_back("dimension and rms of the roughness");
  if (!(result.map.pitch_mm_x > 0)) result.assumed.emplace_back("pitch: unknown");
}

}  // namespace

std::string_view to_string(HeightMethod method) noexcept { return k_method_names[static_cast<std::size_t>(method)]; }

HeightMethod height_method(std::string_view name) {
  return static_cast<HeightMethod>(texture_detail::index_of_name(name, k_method_names, "height_method"));
}

std::string_view to_string(HeightRoughness roughness) noexcept {
  return k_roughness_names[static_cast<std::size_t>(roughness)];
}

HeightRoughness height_roughness(std::string_view name) {
  return static_cast<HeightRoughness>(texture_detail::index_of_name(name, k_roughness_names, "height_roughness"));
}

double shortest_playable_wavelength_mm(double speed_mm_per_s, double rate_hz) {
  if (!texture_detail::is_positive(speed_mm_per_s) || !texture_detail::is_positive(rate_hz))
    throw InvalidInput("shortest_playable_wavelength_mm: speed " + std::to_string(speed_mm_per_s) + " mm/s or rate " +
                       std::to_string(rate_hz) + " Hz is not positive");
  return 2 * speed_mm_per_s / rate_hz;
}

HeightMap opposite_relief(const HeightMap& relief) {
  texture_detail::require_height_map(relief, "opposite_relief", false);
  HeightMap result = relief;
  const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
  const float sum = *low + *high;
  for (float& height : result.mm) height = sum - height;
  return result;
}

HeightChoice choose_height_method(const GreyImage& image, const HeightOptions& options) {
  texture_detail::require_image(image, "choose_height_method");
  require_options(options);
  HeightResult result;
  result.map.periodic = options.periodic ? *options.periodic : measure_tiling(image).tiles;
  choose_method(SamplesInMemory(image.pixels, image.width, image.height), curve_of(image, options), options, result);
  return {result.method, result.reason};
}

HeightResult height_from_image(const GreyImage& image, const HeightOptions& options) {
  texture_detail::require_image(image, "height_from_image");
  require_options(options);
  HeightResult result;
  const double pitch = options.pitch_mm > 0 ? options.pitch_mm : std::max(0.0, image.pitch_mm);
  result.map.width = image.width;
  result.map.height = image.height;
  result.map.pitch_mm_x = result.map.pitch_mm_y = pitch;
  result.map.periodic = options.periodic ? *options.periodic : measure_tiling(image).tiles;
  const bool composes = options.tile || options.roughness != HeightRoughness::whole;
  Lattice lattice;
  std::optional<GreyImage> straight;  // Only a straight picture has the mean cell that tiles.
  if (options.lattice) {
    lattice = *options.lattice;
  } else if (composes) {
    SymmetryAnalysis symmetry = analyze_symmetry(image, {}, FeatureKind::squared, options.progress);
    lattice = std::move(symmetry.lattice);
    if (options.tile && symmetry.deformation && symmetry.straight->pixels.size() == image.pixels.size())
      straight = std::move(symmetry.straight), straight->bits = image.bits, straight->curve = image.curve;
  }
  choose_method(SamplesInMemory(image.pixels, image.width, image.height), curve_of(image, options), options, result);
  if (options.tile) choose_tile(image, lattice, result);
  Field field;
  if (composes && lattice.found) {
    const bool tiles = options.tile && options.roughness != HeightRoughness::none;
    result.roughness = tiles ? HeightRoughness::synthesized : options.roughness;
    field = relief_with_roughness(straight ? *straight : image, lattice, options, result);
  } else {
    field = relief_of(image, options, result);
  }
  cut_short_waves(field, options, result);
  const double range = range_of(field);
  scale_to_depth(field, options.depth_mm, result);
  result.roughness_rms_mm *= range > 0 ? options.depth_mm / range : 0;
  result.rms_mm = rms_height_mm(result.map);
  if (result.method != HeightMethod::intensity)
    result.guessed_share = share_across(SamplesInMemory(result.map.mm, result.map.width, result.map.height),
                                        result.map.periodic, result.light);
  list_measured_and_assumed(options, result);
  return result;
}

HeightRows height_from_rows(const SampleRows& picture, const TransferCurve& curve, const HeightOptions& options,
                            SampleFile& relief) {
  require_options(options);
  if (options.tile || options.roughness != HeightRoughness::whole || options.shortest_wavelength_mm > 0)
    throw InvalidInput(
        "height_from_rows: a tile, roughness apart and a shortest wavelength need the picture in memory");
  HeightRows rows;
  HeightResult& result = rows.result;
  result.map.width = picture.width();
  result.map.height = picture.height();
  result.map.pitch_mm_x = result.map.pitch_mm_y = options.pitch_mm;
  result.map.periodic = options.periodic ? *options.periodic : measure_tiling(picture).tiles;
  choose_method(picture, curve, options, result);

  std::vector<float> row(static_cast<std::size_t>(picture.width()), 0.0F);
  const bool lit = result.method != HeightMethod::intensity;
  const auto write = [&](int y, std::span<const double> heights) {
    std::transform(heights.begin(), heights.end(), row.begin(), [](double h) { return static_cast<float>(h); });
    relief.write(y, row);
  };
  const auto solve = [&] {
    const EvenedSamples evened = brightness_of(picture, curve, result);
    const auto shading = choose_shading(evened, options, result);
    if (!shading) return false;
    using Solve = ShadingResult(const SampleRows&, const ShadingOptions&, const HeightWriter&);
    ShadingResult solved =
        result.method == HeightMethod::wiener
            ? kept(shape_from_shading_wiener_by_rows(evened, *shading, write), options, result)
            : solver<Solve>(result.method, shape_from_shading_variational_by_rows, shape_from_shading_pentland_by_rows,
                            shape_from_shading_tsai_shah_by_rows)(evened, *shading, write);
    result.trace = std::move(solved.trace);
    result.stop = solved.stop;
    result.pieces = solved.pieces;
    return true;
  };
  if (!lit || !solve()) {
    for (int y = 0; y < picture.height(); ++y) {
      if (!lit) picture.read(0, y, picture.width(), row.data());
      relief.write(y, row);
    }
  }

  const Statistics heights = statistics(relief);
  const double range = static_cast<double>(heights.high) - static_cast<double>(heights.low);
  rows.scale = range > 0 ? options.depth_mm / range : 0;
  rows.lowest = static_cast<double>(heights.low);
  result.depth_mm = range > 0 ? options.depth_mm : 0;
  result.rms_mm = rows.scale * heights.deviation;
  if (options.pitch_mm > 0) result.shortest_wavelength_mm = 2 * options.pitch_mm;
  if (lit) result.guessed_share = share_across(relief, result.map.periodic, result.light);
  list_measured_and_assumed(options, result);
  return rows;
}

}  // namespace papilla
