// SPDX-License-Identifier: MIT
#include <set>

#include "evaluate/extreme_meshes.hpp"
#include "evaluate/extreme_pictures.hpp"
#include "evaluate/kinds.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/sample_solids.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// A name that is valid in every file system.
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

std::vector<std::string> solids(const fs::path& folder) {
  const fs::path file = folder / "ball, ring and cone.brep";
  write_sample_solids(file);
  return {file.string()};
}

/// A baked dome with leather on it.
std::vector<std::string> leather_dome(const fs::path& folder) {
  MaterialRule leather;
  leather.name = "leather";
  leather.texture = folder / "leather.png";
  leather.size_mm[0] = leather.size_mm[1] = 40;
  leather.stiffness = 700;
  leather.damping = 0.4;
  leather.static_friction = 0.5;
  leather.dynamic_friction = 0.4;
  leather.height.depth_mm = 0.3;
  write_grey_image(leather.texture, synthesize_grain(GrainKind::leather, {.size_px = 256}).picture, 8);
  Materials rules;
  rules.materials[leather.name] = leather;
  rules.assign.emplace_back().material = leather.name;
  std::vector<NamedMesh> inputs = extreme_meshes();
  Part dome;
  dome.name = "dome";
  dome.mesh = std::move(inputs.front().mesh);
  Scene scene = single_part_scene(std::move(dome), "PLY");
  const fs::path file = folder / "leather dome.glb";
  write_glb(bake_scene(std::move(scene), rules).scene, file, {});
  return {file.string()};
}

}  // namespace

std::vector<std::string> write_built_in_inputs(std::string_view kind, const fs::path& folder) {
  if (kind == "param" || kind == "charts" || kind == "weld" || kind == "simplification") return meshes(folder);
  if (kind == "fractal" || kind == "symmetry") return pictures(folder, kind == "symmetry");
  if (kind == "height") return reliefs(folder);
  if (kind == "tessellation") return solids(folder);
  if (kind == "contact") return leather_dome(folder);
  return {};
}

}  // namespace papilla
