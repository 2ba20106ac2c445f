// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/object_textures.hpp"
#include "papilla/pipeline/studio/shown_mesh.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {

/// One use of a part, as people see the scene.
struct StudioUse {
  std::uint32_t node = 0, part = 0;
  Transform world = k_identity;
  std::string path;  ///< Of the node: node_places().
};

/// A surface that some uses of a part show, and what a document wants of it. Uses that get different materials have
/// surfaces of their own.
struct StudioWish {
  std::uint32_t part = 0, slot = 0;   ///< As read.
  std::vector<std::uint32_t> uses;    ///< Into StudioScene::uses().
  std::string label;                  ///< PartSurface::label.
  std::string material;               ///< Name of an entry of the rules; empty: it stays as it came.
  std::string rule;                   ///< That entry as JSON.
  std::string key;                    ///< What is made of it depends on this text alone.
  std::vector<std::size_t> carriers;  ///< Into Materials::replace: those that may take triangles of it.
  std::string files = {};             ///< Times and sizes of the files that its material names.
};

/// A decal of a document and the surfaces that it may lie on.
struct StudioDecalWish {
  /// A surface where one use shows it, as the document wants it.
  struct Below {
    std::string surface;  ///< StudioWish::key.
    std::uint32_t part = 0, slot = 0, use = 0;
    std::string material;  ///< StudioWish::material.
  };
  std::size_t number = 0;    ///< Into Materials::decals.
  std::vector<Below> below;  ///< Those that the decal is for and whose box meets its own.
  std::string problem;       ///< RuleUse::problem of its selector.
  std::string key;           ///< What is made of it depends on this text alone.
};

/// The carriers of a document, all together as one may stand for what another has left, and what they may take.
struct StudioCarrierWish {
  struct Surface {
    std::string surface;  ///< StudioWish::key.
    std::uint32_t slot = 0;
    std::string material;               ///< StudioWish::material.
    std::vector<std::size_t> carriers;  ///< StudioWish::carriers.
  };
  struct Use {
    std::uint32_t use = 0;
    std::uint32_t part = 0;  ///< Uses with the same number and materials show the same.
    std::string materials;   ///< Of all its slots.
    std::vector<Surface> surfaces;
  };
  std::vector<Use> uses;          ///< Of which something may go, ascending.
  std::vector<RuleUse> selected;  ///< By each carrier; a problem where it is nothing.
  std::string key;                ///< What is made of them depends on this text alone.
};

/// What a document makes of a scene, before anything is computed.
struct StudioPlan {
  Materials rules;
  std::vector<StudioWish> wishes;
  std::vector<RuleUse> uses;  ///< Of the rules.
  std::vector<StudioDecalWish> decals;
  std::optional<StudioCarrierWish> carriers;  ///< Nothing: the document has none.
};

/// A surface as it will be baked.
struct StudioSurface {
  std::uint32_t part = 0, slot = 0;
  std::string label, key;
  ShownMesh mesh;  ///< Without what carriers take; with uv1 where the haptic tag lies on those.
  /// With that; null where they take nothing.
  std::shared_ptr<const TriangleMesh> whole;
  /// Its one material with the textures and pictures that it names, as bake_scene() makes them. Without part and node.
  std::shared_ptr<const Scene> look;
  BakedSurface report;  ///< With grain. Its meshes and numbers per triangle are left out.
  Vec2 mm_per_uv;       ///< 0: unknown.
  std::vector<std::string> warnings;
  double seconds = 0;  ///< That it took.
};

/// A decal as it will be baked.
struct StudioDecal {
  /// What of it lies on one surface, in the coordinates of the use's part.
  struct Patch {
    std::shared_ptr<const StudioSurface> surface;  ///< `part` and `slot` are those below; its look is the decal's.
    std::uint32_t use = 0;
  };
  std::string key;
  std::vector<Patch> patches;
  DecalReport report;
  std::vector<std::string> warnings;
};

/// The carriers of a document as they will be baked.
struct StudioCarriers {
  struct Rectangle {
    /// In the coordinates of `world`; its look is the carrier's, `part` and `slot` are of what it stands for.
    std::shared_ptr<const StudioSurface> surface;
    Transform world = k_identity;
    std::optional<std::uint32_t> use;  ///< For which it stands; nothing: for a region.
  };
  std::string key;
  std::vector<Rectangle> rectangles;
  std::vector<CarrierReport> reports;  ///< One for each entry.
  std::vector<std::string> warnings;
};

struct RecipeAtlas;

/// A scene whose surfaces are baked one by one while materials change: what bake_scene() makes of the whole, but for
/// pictures that several surfaces share (recipes that read the surface get an atlas each), and decals on carriers,
/// which are left out. Parts that a bake would find to be copies of each other count one by one.
class StudioScene {
 public:
  /// @param options of the bake. Its sheets are turned here, once. @param in_place the file would be edited in place
  /// (bake_way()): sheets and triangles stay. @param name  begins the keys of all wishes for its surfaces: those of
  /// scenes with other names are not taken for them.
  /// @throws as turn_sheets().
  StudioScene(Scene scene, const BakeOptions& options, bool in_place, std::string name = {});

  const Scene& scene() const noexcept { return scene_; }
  const std::vector<StudioUse>& uses() const noexcept { return uses_; }
  /// Where people's eyes are, mm in the scene's frame, as far as its sheets tell.
  const std::optional<Vec3>& eye() const noexcept { return eye_; }

  /// Selectors that mean a surface and no other, where names allow it: the part's name, or paths of the nodes that
  /// show it where another part has that name; the material's name, or its colour, where a part has several.
  std::vector<SurfaceSelector> selectors(std::uint32_t part, std::uint32_t slot) const;

  /// A selector that means the part of a use: by its name, and the node's path where another part has that name.
  SurfaceSelector selector_of_use(std::uint32_t use) const;

  /// @param path the document's file, also where it is not written yet. @param library as parse_materials().
  /// @throws as parse_materials(). Cost: O(uses x rules), independent of triangles.
  StudioPlan plan(const std::string& document, const std::filesystem::path& path,
                  const std::filesystem::path& library) const;

  /// bake_scene() of one surface. Grains are kept from call to call, and made one after the other.
  /// @throws as bake_scene().
  StudioSurface bake(const StudioPlan& plan, const StudioWish& wish, const ProgressCallback& progress = {});

  /// A surface laid out for a recipe in place of its material's own, as bake() does, but for about side x side texels
  /// at most. May run beside bake(). Cost: that of bake() without painting, and O(texels). @return null where nothing
  /// with uv shows it. @param texture  of the recipe, not seamless. @throws as bake_scene() and cut_surface().
  std::shared_ptr<const RecipeAtlas> recipe_atlas(const StudioPlan& plan, const StudioWish& wish,
                                                  const ProceduralTexture& texture, int side,
                                                  const ProgressCallback& progress = {});

  /// Of a surface as it was read. Cost: O(triangles of the part).
  double area_mm2(std::uint32_t part, std::uint32_t slot) const;

  /// A decal on its surfaces, by apply_object_textures() with the vertices as they are shown, rounded to single
  /// precision. Pictures are kept from call to call, until their files change. May run beside bake().
  /// @param surfaces those of `wish.below`, in their order. @throws as apply_object_textures().
  StudioDecal decal(const StudioPlan& plan, const StudioDecalWish& wish,
                    const std::vector<std::shared_ptr<const StudioSurface>>& surfaces) const;

  /// All carriers of a document, by apply_object_textures(). May run beside bake().
  /// @param surfaces those of `plan.carriers` by their keys; one that is missing is taken as it was read.
  /// @pre plan.carriers. @throws as apply_object_textures().
  StudioCarriers carriers(const StudioPlan& plan,
                          const std::map<std::string, std::shared_ptr<const StudioSurface>>& surfaces) const;

  /// A surface as it came: what is shown first.
  StudioSurface as_read(std::uint32_t part, std::uint32_t slot) const;

 private:
  static constexpr std::size_t k_most_grains = 24, k_most_pictures = 4;
  /// @param paints  a recipe that reads the surface; else it is laid on as any other.
  BakeResult bake_piece(const StudioPlan& plan, const StudioWish& wish, bool paints, const ProgressCallback& progress);
  Scene piece(std::uint32_t part, std::uint32_t slot, const std::string& name) const;
  Grain grain_of(const std::string& key, const MaterialRule& rule);
  /// Whether a surface is mapped in this way for the first time. @param unwrap  of its material, as JSON.
  bool is_new_map(const StudioWish& wish, const std::string& unwrap);
  bool is_only_of_its_name(std::uint32_t part) const;
  std::shared_ptr<const DecalPicture> decal_picture(const std::filesystem::path& file) const;
  /// @param texts of the document's decals, one each.
  std::vector<StudioDecalWish> decal_wishes(const Materials& rules, const ObjectTexturePlaces& places,
                                            const std::vector<std::string>& texts,
                                            const std::vector<StudioWish>& wishes) const;
  /// By node and slot.
  using CarriersOf = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>>;
  /// The carriers that may take triangles of what nodes show.
  CarriersOf carriers_of(const Materials& rules, const ObjectTexturePlaces& places) const;
  /// @param text of the document's carriers. @param parts what each use shows.
  StudioCarrierWish carrier_wish(const std::string& text, const std::vector<std::uint32_t>& parts,
                                 const std::vector<StudioWish>& wishes) const;
  /// Takes what carriers take from a mesh that was made for a wish.
  void take_out(const StudioPlan& plan, const StudioWish& wish, TriangleMesh& mesh, StudioSurface& surface) const;

  std::string name_;
  Scene scene_;
  Scene skeleton_;  ///< The same as it was read, with a triangle for each slot of a part.
  std::vector<std::vector<std::uint32_t>> slots_;
  std::vector<StudioUse> uses_;
  std::vector<Bounds3> bounds_;  ///< Of the parts.
  Bounds3 scene_box_;
  std::optional<Vec3> eye_;
  BakeOptions options_;
  PartContext context_;
  bool in_place_ = false;
  bool shares_copies_ = true;  ///< The bake does.
  std::mutex mapped_mutex_;
  std::set<std::string> mapped_;  ///< Surfaces, with the "unwrap" of their material, whose map the cache was given.
  std::mutex grains_mutex_;
  std::list<std::pair<std::string, Grain>> grains_;  ///< By what they are made of; used last, first.
  mutable std::mutex pictures_mutex_;
  /// By file, time and size; used last, first.
  mutable std::list<std::pair<std::string, std::shared_ptr<const DecalPicture>>> pictures_;
};

}  // namespace papilla
