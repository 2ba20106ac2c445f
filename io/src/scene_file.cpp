// SPDX-License-Identifier: MIT
#include "papilla/io/scene_file.hpp"

#include <algorithm>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/obj_reader.hpp"
#include "papilla/io/obj_writer.hpp"
#include "papilla/io/read_file.hpp"
#include "papilla/io/stl_reader.hpp"
#include "papilla/io/stl_writer.hpp"

namespace papilla {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c; });
  return extension;
}

Scene read_by_extension(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension == ".stl") return read_stl(path, options);
  if (extension == ".obj") return read_obj(path, options);
  if (extension == ".glb" || extension == ".gltf") {
    Scene scene = read_gltf(path);
    scene.up = options.up.value_or(scene.up);
    return scene;
  }
  throw InvalidInput(path.string() + ": the extension '" + extension + "' is unknown; known are .stl .obj .glb .gltf");
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, const ReadOptions& options, const Progress& progress) {
  require_file(path);
  if (progress) progress("read", 0);
  Scene scene = read_by_extension(path, options);
  if (progress) progress("read", 1);
  return scene;
}

void write_scene(const Scene& scene, const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".glb") return write_glb(scene, path);
  if (extension == ".obj") return write_obj(scene, path);
  if (extension == ".stl") return write_stl(scene, path);
  throw InvalidInput(path.string() + ": the extension '" + extension + "' can't be written; .glb .obj .stl can");
}

}  // namespace papilla
