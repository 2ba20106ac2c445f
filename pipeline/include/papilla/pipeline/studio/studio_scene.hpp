// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/studio/shown_mesh.hpp"

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
  std::uint32_t part = 0, slot = 0;  ///< As read.
  std::vector<std::uint32_t> uses;   ///< Into StudioScene::uses().
  std::string label;                 ///< PartSurface::label.
  std::string material;              ///< Name of an entry of the rules; empty: it stays as it came.
  std::string rule;                  ///< That entry as JSON.
  std::string key;                   ///< What is made of it depends on this text alone.
};

/// What a document makes of a scene, before anything is computed.
struct StudioPlan {
  Materials rules;
  std::vector<StudioWish> wishes;
  std::vector<RuleUse> uses;  ///< Of the rules.
};

/// A surface as it will be baked.
struct StudioSurface {
  std::uint32_t part = 0, slot = 0;
  std::string label, key;
  ShownMesh mesh;
  /// Its one material with the textures and pictures that it names, as bake_scene() makes them. Without part and node.
  std::shared_ptr<const Scene> look;
  BakedSurface report;  ///< With grain. Its meshes and numbers per triangle are left out.
  Vec2 mm_per_uv;       ///< 0: unknown.
  std::vector<std::string> warnings;
  double seconds = 0;  ///< That it took.
};

/// A scene whose surfaces are baked one by one while materials change: what bake_scene() makes of the whole, but for
/// pictures that several surfaces share (recipes that read the surface get an atlas each), and decals and carriers,
/// which are left out. Parts that a bake would find to be copies of each other count one by one.
class StudioScene {
 public:
  /// @param options of the bake. Its sheets are turned here, once. @param in_place the file would be edited in place
  /// (bake_way()): sheets and triangles stay.
  /// @throws as turn_sheets().
  StudioScene(Scene scene, const BakeOptions& options, bool in_place);

  const Scene& scene() const noexcept { return scene_; }
  const std::vector<StudioUse>& uses() const noexcept { return uses_; }
  /// Where people's eyes are, mm in the scene's frame, as far as its sheets tell.
  const std::optional<Vec3>& eye() const noexcept { return eye_; }

  /// Selectors that mean a surface and no other, where names allow it: the part's name, or paths of the nodes that
  /// show it where another part has that name; the material's name, or its colour, where a part has several.
  std::vector<SurfaceSelector> selectors(std::uint32_t part, std::uint32_t slot) const;

  /// @param path the document's file, also where it is not written yet. @param library as parse_materials().
  /// @throws as parse_materials(). Cost: O(uses x rules), independent of triangles.
  StudioPlan plan(const std::string& document, const std::filesystem::path& path,
                  const std::filesystem::path& library) const;

  /// bake_scene() of one surface. Grains are kept from call to call. For one thread at a time.
  /// @throws as bake_scene().
  StudioSurface bake(const StudioPlan& plan, const StudioWish& wish, const ProgressCallback& progress = {});

  /// A surface as it came: what is shown first.
  StudioSurface as_read(std::uint32_t part, std::uint32_t slot) const;

 private:
  static constexpr std::size_t k_most_grains = 24;
  Scene piece(std::uint32_t part, std::uint32_t slot, const std::string& name) const;
  Grain grain_of(const std::string& key, const MaterialRule& rule);

  Scene scene_;
  Scene skeleton_;  ///< The same as it was read, with a triangle for each slot of a part.
  std::vector<std::vector<std::uint32_t>> slots_;
  std::vector<StudioUse> uses_;
  std::optional<Vec3> eye_;
  BakeOptions options_;
  PartContext context_;
  bool in_place_ = false;
  std::list<std::pair<std::string, Grain>> grains_;  ///< By what they are made of; used last, first.
};

}  // namespace papilla
