// SPDX-License-Identifier: MIT
#include "papilla/texture/picture_relief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "checks.hpp"
#include "papilla/texture/roughness.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla {
namespace {

constexpr std::array<std::string_view, 3> k_source_names = {"auto", "picture", "synthesis"};

/// Sides of a synthesized surface: what surface_like() takes, and where more samples repeat no later to the hand.
constexpr int k_least_surface = 64, k_most_surface = 512;

/// Says what became of a step.
void settle(AnalysisPlan& plan, std::string_view step, bool run, std::string reason) {
  const auto found = std::find_if(plan.begin(), plan.end(), [&](const PlanStep& s) { return s.step == step; });
  if (found != plan.end())
    *found = {std::string(step), run, std::move(reason)};
  else
    plan.push_back({std::string(step), run, std::move(reason)});
}

double grey_range(const GreyImage& image) {
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  return static_cast<double>(*high) - static_cast<double>(*low);
}

/// Grey values as heights that span the depth over the picture's grey range.
HeightMap as_relief(const GreyImage& image, double mm_per_grey, double pitch_mm, bool periodic) {
  HeightMap map{image.width, image.height, image.pixels, pitch_mm, pitch_mm, periodic};
  for (float& height : map.mm) height = static_cast<float>(mm_per_grey * static_cast<double>(height));
  return map;
}

/// Whether a surface like the picture takes the place of its relief, and why.
std::pair<bool, std::string> chooses_synthesis(const GreyImage& image, const TextureReading& reading,
                                               const PictureReliefOptions& options) {
  if (reading.suitability.flat) return {false, "the picture is flat"};
  if (reading.kind.kind != TextureKind::disordered)
    return {false, "the texture has an order that a surface like it loses"};
  if (std::min(image.width, image.height) < k_least_surface)
    return {false, fmt::format("the picture has less than {} pixels a side", k_least_surface)};
  if (options.source == ReliefSource::picture) return {false, "the picture's own relief is asked for"};
  if (options.source == ReliefSource::synthesis) return {true, "asked for"};
  if (options.seen) return {false, "the picture is seen: what is felt keeps its place"};
  if (!reading.roughness || !reading.roughness->power_law())
    return {false, "no power law holds" + (reading.roughness ? ": " + reading.roughness->reason : std::string())};
  if (!reading.suitability.homogeneous) return {false, "the picture is not the same everywhere"};
  if (measure_tiling(image).tiles) return {false, "the picture tiles as it is"};
  return {true, fmt::format("a power law of H {:.2f} holds and the picture does not tile",
                            reading.roughness->estimate->hurst)};
}

/// A surface like the picture as its relief.
void synthesize_relief(const GreyImage& image, const PictureReliefOptions& options, PictureRelief& result) {
  const int size = std::min({image.width, image.height, k_most_surface});
  result.like = surface_like(image, {.size = size, .seed = options.height.seed, .progress = options.height.progress});
  HeightGrid surface = std::exchange(result.like->surface, {});
  HeightResult& height = result.height;
  const double pitch = options.height.pitch_mm > 0 ? options.height.pitch_mm : std::max(0.0, image.pitch_mm);
  const double mm_per_grey = options.height.depth_mm / grey_range(image);
  height.map = {surface.size, surface.size, {}, pitch, pitch, true};
  for (const double z : surface.heights) height.map.mm.push_back(static_cast<float>(mm_per_grey * z));
  const auto [low, high] = std::minmax_element(height.map.mm.begin(), height.map.mm.end());
  const float lowest = *low;
  height.depth_mm = static_cast<double>(*high) - static_cast<double>(lowest);
  for (float& h : height.map.mm) h -= lowest;
  height.rms_mm = rms_height_mm(height.map);
  height.reason = "a surface like the picture: " + step_of(result.plan, "fractal_synthesis").reason;
  if (pitch > 0) height.shortest_wavelength_mm = 2 * pitch;
  height.measured.emplace_back("H, anisotropy and rms of the grey values");
  height.assumed.emplace_back("grey value is height: nothing in the picture says so");
  height.trace = result.like->trace;
}

/// Takes the roughness out of the relief of a picture without lattice.
void part_relief(PictureRelief& result) {
  HeightResult& height = result.height;
  if (!(height.map.pitch_mm_x > 0)) {
    settle(result.plan, "roughness", false, "without a pitch nothing says what is finer than 1 mm");
    return;
  }
  PartedRelief parted = part_roughness(height.map);
  settle(result.plan, "roughness", parted.roughness.has_value(), parted.reason);
  if (!parted.roughness) return;
  result.roughness = parted.roughness;
  height.map = std::move(parted.relief);
  const auto [low, high] = std::minmax_element(height.map.mm.begin(), height.map.mm.end());
  height.depth_mm = static_cast<double>(*high) - static_cast<double>(*low);
  height.rms_mm = rms_height_mm(height.map);
  height.shortest_wavelength_mm = parted.roughness->longest_mm;
}

/// Describes what the lattice leaves.
void describe_residual(const GreyImage& image, const TextureReading& reading, double depth_mm, PictureRelief& result) {
  const double pitch = result.height.map.pitch_mm_x, range = grey_range(image);
  if (!(pitch > 0) || !(range > 0)) {
    settle(result.plan, "roughness", false, "without a pitch nothing says what is finer than 1 mm");
    return;
  }
  const PartedRelief parted =
      part_roughness(as_relief(reading.symmetry.part->residual, depth_mm / range, pitch, false));
  settle(result.plan, "roughness", parted.roughness.has_value(), "of what the lattice leaves: " + parted.reason);
  result.roughness = parted.roughness;
}

}  // namespace

std::string_view to_string(ReliefSource source) noexcept { return k_source_names[static_cast<std::size_t>(source)]; }

ReliefSource relief_source(std::string_view name) {
  return static_cast<ReliefSource>(texture_detail::index_of_name(name, k_source_names, "relief_source"));
}

AnalysisPlan plan_relief(const GreyImage& image, const TextureReading& reading, const PictureReliefOptions& options) {
  AnalysisPlan plan = reading.plan;
  auto [synthesizes, why] = chooses_synthesis(image, reading, options);
  settle(plan, "fractal_synthesis", synthesizes, std::move(why));
  const bool ordered = step_of(plan, "primitive").run;
  if (synthesizes) {
    settle(plan, "shape_from_shading", false, "the relief is synthesized");
    settle(plan, "intensity_as_height", false, "the relief is synthesized");
  } else if (!reading.suitability.flat) {
    const HeightChoice choice = choose_height_method(image, options.height);
    const bool lit = choice.method != HeightMethod::intensity;
    settle(plan, "shape_from_shading", lit, choice.reason);
    settle(plan, "intensity_as_height", !lit, lit ? "shape from shading gives the relief" : choice.reason);
  }
  const bool tile = options.tile.value_or(ordered && !options.seen);
  if (ordered || tile)
    settle(plan, "exact_tile", tile,
           options.tile ? (tile ? "asked for" : "not asked for")
           : tile       ? "the relief repeats with the lattice to the last bit"
                        : "the picture is seen: what is felt keeps its place");
  if (step_of(plan, "roughness").run && (!options.part || options.roughness))
    settle(plan, "roughness", false, "relief and roughness are one map");
  return plan;
}

PictureRelief relief_of_picture(const GreyImage& image, const TextureReading& reading,
                                const PictureReliefOptions& options) {
  PictureRelief result;
  result.plan = plan_relief(image, reading, options);
  const auto runs = [&](std::string_view step) { return step_of(result.plan, step).run; };
  if (runs("fractal_synthesis")) {
    synthesize_relief(image, options, result);
    return result;
  }
  const bool ordered = runs("primitive"), apart = runs("roughness");
  // A lattice that bends has its mean cell in the straight picture; the relief of a picture that keeps its frame bends.
  const SymmetryAnalysis& symmetry = reading.symmetry;
  const bool bends = symmetry.deformation.has_value(), straightens = bends && runs("exact_tile");
  HeightOptions height = options.height;
  height.lattice = symmetry.lattice;
  height.tile = runs("exact_tile");
  if (ordered && reading.group) height.primitive = reading.group->primitive;
  if (options.roughness)
    height.roughness = *options.roughness;
  else if (ordered && bends == straightens)
    height.roughness =
        apart || !step_of(reading.plan, "roughness").run ? HeightRoughness::none : HeightRoughness::residual;
  result.height = height_from_image(straightens ? symmetry.regular() : image, height);
  if (apart && ordered) describe_residual(image, reading, options.height.depth_mm, result);
  if (apart && !ordered) part_relief(result);
  return result;
}

}  // namespace papilla
