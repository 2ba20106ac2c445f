// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/part_roughness.hpp"
#include "papilla/texture/surface_like.hpp"
#include "papilla/texture/texture_reading.hpp"

namespace papilla {

/// What the relief of a disordered picture is: the picture's own, or a synthesized surface like it, which tiles.
/// `automatic` synthesizes where a power law holds, the picture is homogeneous, does not tile and is not seen.
enum class ReliefSource { automatic, picture, synthesis };

/// The name on the command line: auto, picture, synthesis.
std::string_view to_string(ReliefSource source) noexcept;
/// The source of that name. @throws InvalidInput for any other name.
ReliefSource relief_source(std::string_view name);

/// Options of relief_of_picture().
struct PictureReliefOptions {
  HeightOptions height;  ///< Its lattice, tile and roughness are set by the class, where the following are not given.
  std::optional<bool> tile = {};                  ///< One tile of the lattice.
  std::optional<HeightRoughness> roughness = {};  ///< As one map with the relief, or left out.
  bool part = true;                               ///< Take the roughness out and describe it by parameters.
  ReliefSource source = ReliefSource::automatic;
  bool seen = false;  ///< The picture itself is seen on the surface: what is felt keeps its place.
};

/// What relief_of_picture() returns.
struct PictureRelief {
  HeightResult height;
  std::optional<RoughnessModel> roughness;  ///< To be laid over the relief, which does not hold it.
  std::optional<SurfaceLike> like;          ///< The synthesized surface, without its heights, when the relief is one.
  AnalysisPlan plan;  ///< Of the reading, with what the relief took instead of what it might have.
};

/// The plan of a picture's relief: that of its reading, with what the options and the picture decide, and the method of
/// choose_height_method(). Nothing of the relief is computed.
/// Cost: O(pixels). @throws InvalidInput when the picture is empty or not finite.
AnalysisPlan plan_relief(const GreyImage& image, const TextureReading& reading,
                         const PictureReliefOptions& options = {});

/// Carries out the part of the plan of a picture's class [plan_analysis()] that makes its relief:
///   strongly ordered symmetric   the mean cell, averaged over its group, so the relief of the generating region, on
///   the
///                                smallest exact tile (tile_generating_region)
///   composite                    the same, and what the lattice leaves as roughness
///   weakly ordered               relief, and roughness below 1 mm by its parameters (part_roughness())
///   disordered                   the picture's own relief, or a fractal surface with its H, rms and anisotropy that
///   tiles
///                                (surface_like())
///   ordered in one direction     the relief of the whole picture
/// A tile or a synthesized surface has no place in the picture: a picture that is seen keeps its own frame.
/// One function for all who make a relief of a picture in memory: `analyze` reports its plan, `height` and `bake` run
/// it. Cost: that of height_from_image() and the steps run. Deterministic.
/// @param reading of the same picture.
/// @throws InvalidInput as height_from_image().
PictureRelief relief_of_picture(const GreyImage& image, const TextureReading& reading,
                                const PictureReliefOptions& options = {});

}  // namespace papilla
