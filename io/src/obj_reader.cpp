// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include "mesh_file_scene.hpp"
#include "obj_content.hpp"
#include "obj_parts.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/mesh_files.hpp"

namespace papilla {
namespace {

/// The content without the text.
io_detail::ObjContent read_content(const std::filesystem::path& path, Scene& scene) {
  const std::string text = read_file(path);
  if (text.empty()) throw InvalidInput(path.string() + ": is empty");
  return io_detail::read_obj_content(text, path.string(), scene);
}

}  // namespace

Scene read_obj(const std::filesystem::path& path, const ReadOptions& options) {
  Scene scene = unitless_scene("OBJ", options, UpAxis::y);
  io_detail::assemble_obj_parts(read_content(path, scene), path, scene);
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
