// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/srgb.hpp"
#include "placed_mesh.hpp"
#include "scene_losses.hpp"
#include "vertex_values.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// A name that stays one statement: without line breaks and not empty.
std::string statement_name(std::string_view name, std::string_view fallback) {
  return one_line(name.empty() ? fallback : name);
}

/// A name for a file: without separators and other characters that some system forbids.
std::string file_name(std::string_view name) {
  std::string text(name);
  for (char& c : text)
    if ((c >= 0 && c < ' ') || std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos) c = '_';
  return text;
}

double finite(double value, const char* what) {
  if (!std::isfinite(value)) throw InvalidInput(fmt::format("write_obj: a {} is not finite", what));
  return value;
}

/// Names that no two materials share, since OBJ finds materials by name.
std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const std::string wanted = statement_name(scene.materials[i].name, fmt::format("material {}", i));
    std::string name = wanted;
    for (int k = 2; !taken.insert(name).second; ++k) name = fmt::format("{}~{}", wanted, k);
    names.push_back(name);
  }
  return names;
}

/// Writes the MTL file and the pictures that it names.
class MtlWriter {
 public:
  MtlWriter(const Scene& scene, const fs::path& obj) : scene_(scene), obj_(obj) {}

  void write(const fs::path& path, const std::vector<std::string>& names) {
    fmt::format_to(std::back_inserter(text_), "# papilla {}\n", version());
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) write_material(scene_.materials[i], names[i]);
    write_atomically(path, {text_.data(), text_.size()});
  }

 private:
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_.push_back('\n');
  }

  void write_material(const Material& material, const std::string& name) {
    const auto& c = material.base_color;
    line("\nnewmtl {}", name);
    line("Kd {} {} {}", finite(c[0], "colour"), finite(c[1], "colour"), finite(c[2], "colour"));
    line("d {}", material.alpha_mode == "OPAQUE" ? 1.0 : finite(c[3], "opacity"));
    const double smooth = 1 - finite(material.roughness, "roughness");
    line("Ns {}", 1000 * smooth * smooth);
    line("Pr {}", material.roughness);
    line("Pm {}", finite(material.metallic, "metalness"));
    const auto& e = material.emissive;
    if (e != std::array<double, 3>{0, 0, 0})
      line("Ke {} {} {}", finite(e[0], "colour"), finite(e[1], "colour"), finite(e[2], "colour"));
    write_map("map_Kd", material.base_color_texture);
    write_map("map_Ke", material.emissive_texture);
    write_map("norm", material.normal_texture);
  }

  /// Texture channel 1 and rotated uv can't be expressed.
  void write_map(const char* keyword, const std::optional<TextureReference>& reference) {
    if (!reference || reference->tex_coord != 0 || reference->texture >= scene_.textures.size()) return;
    const UvTransform transform = reference->transform.value_or(UvTransform{});
    const Texture& texture = scene_.textures[reference->texture];
    if (transform.rotation != 0 || !texture.image) return;
    const auto file = picture(*texture.image);
    if (!file) return;
    std::string options;
    if (texture.wrap_s == 33071 && texture.wrap_t == 33071) options += " -clamp on";
    const double offset_up = 1 - transform.scale.y - transform.offset.y;  // In OBJ v runs up.
    if (transform.offset.x != 0 || offset_up != 0)
      options += fmt::format(" -o {} {} 0", finite(transform.offset.x, "uv offset"), finite(offset_up, "uv offset"));
    if (!(transform.scale == Vec2{1, 1}))
      options +=
          fmt::format(" -s {} {} 1", finite(transform.scale.x, "uv scale"), finite(transform.scale.y, "uv scale"));
    line("{}{} {}", keyword, options, *file);
  }

  /// The file name of a picture, written at its first use.
  std::optional<std::string> picture(std::uint32_t number) {
    if (number >= scene_.images.size() || scene_.images[number].bytes.empty()) return std::nullopt;
    if (const auto known = pictures_.find(number); known != pictures_.end()) return known->second;
    const EncodedImage& image = scene_.images[number];
    const std::string extension = image.mime_type == "image/jpeg" ? ".jpg" : ".png";
    const std::string name = image.name.empty() ? fmt::format("{}", number) : image.name;
    const std::string stem = obj_.stem().string() + "_" + file_name(name);
    std::string file = stem + extension;
    for (int k = 2; !files_.insert(file).second; ++k) file = fmt::format("{}~{}{}", stem, k, extension);
    write_atomically(obj_.parent_path() / file,
                     {reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()});
    return pictures_[number] = file;
  }

  const Scene& scene_;
  const fs::path& obj_;
  fmt::memory_buffer text_;
  std::map<std::uint32_t, std::string> pictures_;
  std::set<std::string> files_;
};

class ObjWriter {
 public:
  ObjWriter(const Scene& scene, std::vector<std::string> names) : scene_(scene), names_(std::move(names)) {}

  std::string_view text(const std::string& library) {
    fmt::format_to(out_, "# papilla {}, millimetres, {} up\n", version(), scene_.up == UpAxis::y ? 'Y' : 'Z');
    if (!library.empty()) fmt::format_to(out_, "mtllib {}\n", library);
    for (const Instance& instance : instances(scene_)) write(place(scene_, instance));
    return {buffer_.data(), buffer_.size()};
  }

  /// After text().
  bool wrote_all_colors() const noexcept { return wrote_all_colors_; }

 private:
  void write(const PlacedMesh& mesh) {
    const TriangleMesh& source = mesh.part->mesh;
    fmt::format_to(out_, "o {}\n", statement_name(mesh.name, "part"));
    write_positions(mesh);
    for (const Vec2& t : source.uv.values)
      fmt::format_to(out_, "vt {} {}\n", finite(t.x, "texture coordinate"), finite(t.y, "texture coordinate"));
    for (const Vec3& n : mesh.normals)
      fmt::format_to(out_, "vn {} {} {}\n", finite(n.x, "normal"), finite(n.y, "normal"), finite(n.z, "normal"));
    write_faces(mesh);
    first_position_ += mesh.positions.size();
    first_uv_ += source.uv.values.size();
    first_normal_ += mesh.normals.size();
  }

  /// With colours, as many programs read them, when a position has only one.
  void write_positions(const PlacedMesh& mesh) {
    const auto colors = value_per_position(mesh.part->mesh, mesh.part->mesh.colors);
    wrote_all_colors_ = wrote_all_colors_ && (colors || mesh.part->mesh.colors.empty());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Vec3& p = mesh.positions[i];
      fmt::format_to(out_, "v {} {} {}", p.x, p.y, p.z);
      if (colors)
        for (const float x : {(*colors)[i].r, (*colors)[i].g, (*colors)[i].b})
          fmt::format_to(out_, " {:.6f}", srgb_from_linear(finite(static_cast<double>(x), "vertex colour")));
      buffer_.push_back('\n');
    }
  }

  void write_faces(const PlacedMesh& mesh) {
    const TriangleMesh& source = mesh.part->mesh;
    const auto order = corner_order(mesh);
    std::optional<std::uint32_t> material, group;
    for (std::size_t t = 0; t < source.triangles.size(); ++t) {
      if (!source.face.empty() && group != source.face.at(t)) {
        group = source.face[t];
        fmt::format_to(out_, "g face{}\n", *group);
      }
      select_material(*mesh.part, t, material);
      buffer_.push_back('f');
      for (const std::size_t k : order) write_corner(source, t, k);
      buffer_.push_back('\n');
    }
  }

  void select_material(const Part& part, std::size_t t, std::optional<std::uint32_t>& current) {
    if (part.materials.empty()) return;
    const std::uint32_t slot = part.mesh.material.empty() ? 0 : part.mesh.material.at(t);
    if (slot >= part.materials.size() || part.materials[slot] >= names_.size())
      throw InvalidInput(fmt::format("write_obj: part '{}': triangle {} names material slot {}", part.name, t, slot));
    if (current == part.materials[slot]) return;
    current = part.materials[slot];
    fmt::format_to(out_, "usemtl {}\n", names_[*current]);
  }

  void write_corner(const TriangleMesh& mesh, std::size_t t, std::size_t k) {
    fmt::format_to(out_, " {}", first_position_ + mesh.triangles[t][k]);
    const bool has_uv = mesh.uv.has_value(t);
    if (has_uv) fmt::format_to(out_, "/{}", first_uv_ + mesh.uv.indices[t][k]);
    if (mesh.normals.has_value(t))
      fmt::format_to(out_, "{}{}", has_uv ? "/" : "//", first_normal_ + mesh.normals.indices[t][k]);
  }

  const Scene& scene_;
  std::vector<std::string> names_;
  fmt::memory_buffer buffer_;
  std::back_insert_iterator<fmt::memory_buffer> out_{buffer_};
  std::size_t first_position_ = 1, first_uv_ = 1, first_normal_ = 1;
  bool wrote_all_colors_ = true;
};

}  // namespace

std::vector<std::string> write_obj(const Scene& scene, const fs::path& path) {
  const std::vector<std::string> names = material_names(scene);
  fs::path library = path;
  library.replace_extension(".mtl");
  ObjWriter writer(scene, names);
  const std::string_view text = writer.text(scene.materials.empty() ? "" : library.filename().string());
  std::error_code error;
  const bool had_library = fs::exists(library, error);
  if (!scene.materials.empty()) MtlWriter(scene, path).write(library, names);
  try {
    write_atomically(path, text);
  } catch (...) {
    if (!scene.materials.empty() && !had_library) fs::remove(library, error);
    throw;
  }
  FormatKeeps keeps;
  keeps.parts = keeps.materials = keeps.normals = keeps.uv = keeps.faces = true;
  keeps.colors = writer.wrote_all_colors();
  return scene_losses(scene, keeps);
}

}  // namespace papilla
