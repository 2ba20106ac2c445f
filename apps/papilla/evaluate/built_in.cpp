// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/built_in.hpp"

#include <fmt/format.h>

#include <set>

#include "evaluate/stability/extreme_meshes.hpp"
#include "evaluate/stability/extreme_pictures.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

/// A name that every file system takes.
std::string file_name(const std::string& name, const char* extension) {
  std::string out;
  for (const char c : name) out += c == ' ' || c == ',' || c == '/' ? '-' : c;
  return out + extension;
}

std::vector<std::string> meshes(const fs::path& folder) {
  const std::set<std::string> wanted = {"dome, nothing extreme", "sphere, a 3 degree hole", "finger, 30 radii long"};
  std::vector<std::string> files;
  for (NamedMesh& input : extreme_meshes()) {
    if (!wanted.contains(input.name)) continue;
    Part part;
    part.name = input.name;
    part.mesh = std::move(input.mesh);
    files.push_back((folder / file_name(input.name, ".ply")).string());
    write_scene(single_part_scene(std::move(part), "PLY"), files.back());
  }
  return files;
}

std::vector<std::string> pictures(const fs::path& folder, bool lattices) {
  std::vector<std::string> files;
  for (const NamedPicture& input : extreme_pictures()) {
    const bool wanted = lattices ? input.period_px.value_or(0) > 4 : input.dimension && *input.dimension > 2;
    if (!wanted) continue;
    files.push_back((folder / file_name(input.name, ".png")).string());
    write_grey_image(files.back(), input.picture, 16);
  }
  return files;
}

std::vector<std::string> reliefs(const fs::path& folder) {
  std::vector<std::string> files;
  for (const GrainKind kind : {GrainKind::spheres6, GrainKind::quads6, GrainKind::sine, GrainKind::leather}) {
    files.push_back((folder / (std::string(to_string(kind)) + ".exr")).string());
    write_height_float(files.back(), synthesize_grain(kind, {.size_px = 128}).relief);
  }
  return files;
}

}  // namespace

std::vector<std::string> write_built_in_inputs(const std::string& kind, const fs::path& folder) {
  if (kind == "param" || kind == "charts" || kind == "weld" || kind == "simplification") return meshes(folder);
  if (kind == "fractal" || kind == "symmetry") return pictures(folder, kind == "symmetry");
  if (kind == "height") return reliefs(folder);
  return {};
}

}  // namespace papilla::app
