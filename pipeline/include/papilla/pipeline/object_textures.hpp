// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// A surface where a node shows it.
struct PlacedSurface {
  std::uint32_t node = 0, slot = 0;
};

/// Which surfaces the rules mean, found in the scene as it was read.
struct ObjectTexturePlaces {
  std::vector<std::vector<PlacedSurface>> decals, carriers;  ///< Of every rule, in the order of surface_places().
  std::vector<RuleUse> decal_uses, carrier_uses;             ///< What each rule means; a problem where it is nothing.
  std::size_t nodes = 0;                                     ///< Of the scene then.
};

/// Whether the rules have decals or carriers: then meshes change.
bool has_object_textures(const Materials& rules);

/// @param label  Of the rule's kind in messages.
/// @throws InvalidInput as instances().
ObjectTexturePlaces find_object_textures(const Scene& scene, const Materials& rules);

struct DecalReport {
  std::string name;
  std::size_t surfaces = 0;  ///< On which some of it lies, with every instance.
  std::size_t triangles = 0;
  double area_mm2 = 0;         ///< Of what it covers.
  double offset_mm = 0;        ///< By how much it is pushed out.
  double relief_mm = 0;        ///< Its height as it is felt; 0: it is not.
  std::size_t turned_off = 0;  ///< Triangles in the box that are turned away too far.
};

struct CarrierReport {
  std::string name;
  std::size_t carriers = 0;   ///< Rectangles drawn, with every instance.
  std::size_t triangles = 0;  ///< Drawn before, with every instance.
  double relief_mm = 0;       ///< Height that is felt; 0: none.
  /// triangles − 2·carriers. A carrier for less than two triangles saves none.
  double saved() const { return static_cast<double>(triangles) - 2 * static_cast<double>(carriers); }
};

struct ObjectTextures {
  std::vector<DecalReport> decals;  ///< Of the rules in their order; with ObjectTextureOptions::decal of that one.
  std::vector<CarrierReport> carriers;
  std::vector<Vec2> mm_per_uv;  ///< Of the materials that were appended, in their order.
};

/// The constants of what hands feel on a surface of the scene; nothing: it is not felt.
using SurfaceConstants = std::function<std::optional<MaterialTag>(std::uint32_t part, std::uint32_t slot)>;

/// The picture of a decal, read once.
struct DecalPicture {
  RgbaImage pixels;
  std::vector<std::byte> png;  ///< Without alpha where it has none.
};

/// @throws IoError, InvalidInput as read_rgba_image().
DecalPicture read_decal_picture(const std::filesystem::path& file);

struct ObjectTextureOptions {
  bool pictures = true;        ///< False: triangles alone, of which the report is made, as for a plan.
  SurfaceConstants constants;  ///< Empty: those of an empty tag.
  /// Pictures of decals by their files; empty: read_decal_picture().
  std::function<std::shared_ptr<const DecalPicture>(const std::filesystem::path&)> decal_picture = {};
  std::optional<std::size_t> decal = std::nullopt;  ///< Of all rules the decal of this number alone.
  /// Of the scene of which this one is a piece: the offsets are that one's.
  std::optional<double> diagonal_mm = std::nullopt;
};

/// Puts pictures in the place of surfaces, then decals onto what is left.
///
/// A decal is a patch of its own below the node that shows the surface: the triangles of the surface cut to the box,
/// with uv (0, 0) to (1, 1) over the picture, moved by the offset against the direction. So it is as continuous as the
/// surface, and its uv are exact. Every vertex on an edge that two triangles share is computed alike for both. The
/// material has the picture as colour and alpha (alphaMode OPAQUE, MASK where alpha is 0 or 255 nearly everywhere,
/// else BLEND) and roughness and metalness of the surface below.
///
/// A carrier is two triangles with a picture. Without a box every part gets one, in the plane through the centroid of
/// its triangles that varies least along its normal (principal axes of the area), or across the direction that the
/// rule gives; it covers what it stands for. Surfaces that all look one way give its front, others the middle of the
/// scene. With a box the triangles wholly within it go, and the box's middle plane is the carrier.
/// Parts of which nothing is left are emptied. Coarser levels of the parts go.
///
/// Cost: O(triangles selected), and for pictures of surfaces 9 samples a pixel. Deterministic.
/// @param places  find_object_textures() of the scene before it was baked.
/// @throws InvalidInput, IoError naming the rule and its picture.
ObjectTextures apply_object_textures(Scene& scene, const Materials& rules, const ObjectTexturePlaces& places,
                                     const ObjectTextureOptions& options = {});

}  // namespace papilla
