// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/gltf_edit.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla {

struct BakeFileOptions {
  ReadOptions read;
  Deadline read_deadline;  ///< Of reading, before which there is no result to end with. bake_file() is cancelled there.
  BakeOptions bake;        ///< Its `plan.in_place` does not matter.
  WriteOptions write;
  bool for_pictures = false;  ///< The result's scene is read again, for write_bake_pictures().
};

/// How a bake is written: a glTF file is edited where nothing is asked for that changes its meshes or nodes (fewer
/// triangles, parts left out, decals, pictures in the place of surfaces, instances of one node with different
/// materials, compression), everything else is written anew.
struct BakeWay {
  bool in_place = false;
  std::string reason;
};

struct BakeFileResult : BakeResult {
  BakeWay way;
  std::vector<GltfChange> changes;  ///< Of an edited file.
  GlbSizes sizes;                   ///< Of one edited in place only the tags' pictures.
};

/// As far as file name, options and rules tell.
BakeWay bake_way(const std::filesystem::path& input, const BakeFileOptions& options, const Materials& rules = {});

/// What a bake would find in the cache.
struct RememberedPlan {
  std::set<std::string> grains;        ///< Materials.
  std::vector<std::uint8_t> surfaces;  ///< 1: the uv of that surface of the plan. Empty without a cache.
};

struct PlannedFile : BakePlan {
  BakeWay way;
  RememberedPlan remembered;
  std::vector<GrainPlan> grains;        ///< Of the materials whose grain is used.
  ObjectTextures object_textures_made;  ///< Triangles of decals and carriers.
};

/// What bake_file() would do. In place no loss is listed, as what the reader leaves out stays in the file.
/// @throws as read_scene() and plan_bake().
PlannedFile plan_file(const std::filesystem::path& input, const Materials& rules, const BakeFileOptions& options,
                      const ProgressCallback& progress = {});

/// Reads, bakes and writes a .glb, or a .gltf with files beside it: bake_scene() with write_scene(), or
/// write_edited_gltf(). In place uses of one mesh that get different materials get meshes of their own. Sheets that
/// face away are turned where they get relief, and those without a side become double sided there, with their coarser
/// levels of detail; all others stay and are counted in the plan's sides.
/// @throws as read_scene(), bake_scene(), write_scene(), write_edited_gltf().
BakeFileResult bake_file(const std::filesystem::path& input, const std::filesystem::path& output,
                         const Materials& rules, const BakeFileOptions& options, const ProgressCallback& progress = {});

}  // namespace papilla
