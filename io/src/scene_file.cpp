// SPDX-License-Identifier: MIT
#include "papilla/io/scene_file.hpp"

#include <algorithm>
#include <string>

#include "mesh_file_scene.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/cold_arrays.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/haptic/material_tag_stream.hpp"
#include "papilla/io/assimp_reader.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/mesh_files.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; });
  return extension;
}

Scene make_cad_scene(const std::filesystem::path& path, const ReadOptions& options, const ProgressCallback& progress) {
  CadReadOptions cad;
  cad.cache = options.cache;
  cad.chord_mm = options.chord_mm;
  cad.angle_deg = options.angle_deg;
  cad.max_edge_mm = options.max_edge_mm;
  cad.millimetres_per_unit = options.millimetres_per_unit;
  Scene scene = read_cad(path, cad, nullptr, progress);
  scene.up = options.up.value_or(scene.up);
  return scene;
}

/// A STEP file may name others that hold parts of it: they are not in its bytes.
bool names_other_files(const std::string& bytes) { return bytes.find("DOCUMENT_FILE") != std::string::npos; }

/// With a cache, a file that was read before with the same options is not given to the library again.
Scene read_cad_scene(const std::filesystem::path& path, const ReadOptions& options, const ProgressCallback& progress) {
  if (options.cache == nullptr) return make_cad_scene(path, options, progress);
  const std::string bytes = read_file(path);
  if (names_other_files(bytes)) return make_cad_scene(path, options, progress);
  const auto make = [&] { return make_cad_scene(path, options, progress); };
  return remembered(options.cache, "scene", CacheUse::read_write, make, sha256(bytes.data(), bytes.size()),
                    path.filename(), options)
      .value;
}

/// The formats that state no unit.
Scene read_mesh_scene(const std::string& extension, const std::filesystem::path& path, const ReadOptions& options) {
  Scene scene = extension == ".stl"   ? read_stl(path, options)
                : extension == ".obj" ? read_obj(path, options)
                : extension == ".ply" ? read_ply(path, options)
                                      : read_off(path, options);
  if (!options.millimetres_per_unit) hint_at_unit(scene, path.stem().string());
  return scene;
}

Scene read_by_extension(const std::filesystem::path& path, const ReadOptions& options,
                        const ProgressCallback& progress) {
  const std::string extension = lower_extension(path);
  if (extension == ".stl" || extension == ".obj" || extension == ".ply" || extension == ".off")
    return read_mesh_scene(extension, path, options);
  if (is_gltf_file(path)) {
    Scene scene = read_gltf(path, {.tags = options.tags, .tag_channel = options.tag_channel, .cad_uv = true});
    scene.up = options.up.value_or(scene.up);
    complete_tag_pictures(scene);
    return scene;
  }
  if (is_cad_extension(path)) return read_cad_scene(path, options, progress);
  if (is_assimp_extension(path)) return read_assimp(path, options, progress);
  throw InvalidInput(
      path.string() + ": the extension '" + extension +
      "' is unknown; known are .step .stp .p21 .iges .igs .brep .brp .stl .obj .ply .off .glb .gltf .fbx .3mf "
      ".dae .ac .x3d .blend");
}

}  // namespace

bool is_gltf_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".glb" || extension == ".gltf";
}

Scene read_scene(const std::filesystem::path& path, const ReadOptions& options, const ProgressCallback& progress) {
  require_file(path);
  report_progress(progress, "read", 0);
  const ColdArrays waiting;
  Scene scene = read_by_extension(path, options, progress);
  report_progress(progress, "read", 1);
  return scene;
}

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path, const WriteOptions& options,
                                     GlbSizes* sizes) {
  const ColdArrays waiting;
  const std::string extension = lower_extension(path);
  if (extension == ".glb") return write_glb(scene, path, options, sizes);
  if (extension == ".gltf") return write_gltf(scene, path, options, sizes);
  if (extension == ".obj") return write_obj(scene, path);
  if (extension == ".off") return write_off(scene, path);
  if (extension == ".ply") return write_ply(scene, path);
  if (extension == ".stl") return write_stl(scene, path);
  throw InvalidInput(path.string() + ": the extension '" + extension +
                     "' can't be written; .glb .gltf .obj .off .ply .stl can");
}

}  // namespace papilla
