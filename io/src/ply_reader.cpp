// SPDX-License-Identifier: MIT
// A parser of our own: CGAL 5.5 and OpenMesh 9 take the memory that a header or a list claims (a file of 100 bytes ends
// in bad_alloc), and both drop triangle strips and texture coordinates of faces without a word.
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "ply_file.hpp"
#include "polygon_mesh.hpp"
#include "scene_pictures.hpp"
#include "text_scanner.hpp"

namespace papilla {
namespace {

/// Finds the properties of an element by name, and lists those that were never looked up. Places are indices
/// into PlyElement::properties.
class PlyProperties {
 public:
  explicit PlyProperties(const PlyElement& element) : element_(element), used_(element.properties.size(), false) {}

  /// The places of several scalars, under the first of several namings of which the element has all.
  template <std::size_t N>
  std::optional<std::array<std::size_t, N>> scalars(std::initializer_list<std::array<std::string_view, N>> namings) {
    for (const auto& names : namings) {
      std::array<std::size_t, N> places{};
      bool has_all = true;
      for (std::size_t i = 0; i < N; ++i) has_all = has_all && find(names[i], false, places[i]);
      if (!has_all) continue;
      for (const std::size_t place : places) used_[place] = true;
      return places;
    }
    return std::nullopt;
  }

  std::optional<std::size_t> scalar(std::string_view name) { return one(name, false); }
  std::optional<std::size_t> list(std::string_view name) { return one(name, true); }

  std::vector<std::string_view> unused() const {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (!used_[i]) names.push_back(element_.properties[i].name);
    return names;
  }

 private:
  bool find(std::string_view name, bool is_list, std::size_t& place) const {
    const auto& all = element_.properties;
    const auto found = std::find_if(all.begin(), all.end(), [&](const PlyProperty& property) {
      return property.is_list == is_list && property.name == name;
    });
    place = static_cast<std::size_t>(found - all.begin());
    return found != all.end();
  }

  std::optional<std::size_t> one(std::string_view name, bool is_list) {
    std::size_t place = 0;
    if (!find(name, is_list, place)) return std::nullopt;
    used_[place] = true;
    return place;
  }

  const PlyElement& element_;
  std::vector<bool> used_;
};

template <std::size_t N>
using Places = std::array<std::size_t, N>;

struct ColorPlaces {
  Places<3> rgb{};
  std::optional<std::size_t> alpha;
};

std::optional<ColorPlaces> find_colors(PlyProperties& properties) {
  const auto rgb = properties.scalars<3>(
      {{"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}});
  if (!rgb) return std::nullopt;
  return ColorPlaces{*rgb, properties.scalar("alpha")};
}

/// vertex_indices is the original name, vertex_index what many write.
std::size_t find_indices(PlyProperties& properties, const PlyElement& element, const PlyBody& body) {
  for (const char* name : {"vertex_indices", "vertex_index"})
    if (const auto place = properties.list(name)) return *place;
  body.fail("element '" + element.name + "' has no list 'vertex_indices'");
}

/// The largest number of an integer type; floats go up to 1.
double full_value(PlyType type) {
  switch (type) {
    case PlyType::int8: return 127;
    case PlyType::uint8: return 255;
    case PlyType::int16: return 32767;
    case PlyType::uint16: return 65535;
    case PlyType::int32: return 2147483647;
    case PlyType::uint32: return 4294967295;
    default: return 1;
  }
}

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& path, std::string_view bytes, double unit, Scene& scene)
      : path_(path),
        file_(path.string()),
        header_(parse_ply_header(bytes, file_)),
        body_(bytes, header_, file_),
        unit_(unit),
        scene_(scene) {}

  Part read() {
    std::vector<std::pair<const PlyElement*, std::size_t>> waiting;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
        const std::size_t behind = body_.position();
        for (const auto& [faces, position] : waiting) {
          body_.go_to(position);
          read_faces(*faces);
        }
        body_.go_to(behind);
      } else if (element.name != "face" && element.name != "tristrips") {
        if (element.count > 0)
          scene_.losses.push_back(fmt::format("{} elements '{}'", element.count, printable(element.name)));
        body_.skip(element);
      } else if (has_vertices_) {
        read_faces(element);
      } else {
        waiting.emplace_back(&element, body_.position());
        body_.skip(element);
      }
    }
    if (!has_vertices_) throw InvalidInput(file_ + ": has no element 'vertex'");
    Part part;
    part.mesh = mesh_.finish();
    add_materials(part);
    note_oddities();
    return part;
  }

 private:
  Vec2 uv_at(const Places<2>& at) { return finite_or_zero(Vec2{row_[at[0]], row_[at[1]]}); }
  Vec3 vec3_at(const Places<3>& at) const { return {row_[at[0]], row_[at[1]], row_[at[2]]}; }

  template <class Vec>
  Vec finite_or_zero(Vec value) {
    if (is_finite(value)) return value;
    ++bad_values_;
    return {};
  }

  Color color_at(const PlyElement& element, const ColorPlaces& places) {
    const auto channel = [&](std::size_t at) { return row_[at] / full_value(element.properties[at].type); };
    const double r = channel(places.rgb[0]), g = channel(places.rgb[1]), b = channel(places.rgb[2]);
    const double a = places.alpha ? channel(*places.alpha) : 1;
    if (!std::isfinite(r + g + b + a)) {
      ++bad_values_;
      return {};
    }
    return color_from_srgb(r, g, b, a);
  }

  /// Reads one entry of an element: scalars into row_, lists through `take`(place).
  template <class Take>
  void read_row(const PlyElement& element, Take take) {
    row_.resize(element.properties.size());
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (!element.properties[i].is_list) {
        row_[i] = body_.number(element.properties[i].type);
        continue;
      }
      body_.list(element.properties[i], list_);
      take(i);
    }
  }

  void note_losses(const PlyElement& element, const PlyProperties& properties) {
    for (const std::string_view name : properties.unused())
      scene_.losses.push_back(fmt::format("property '{}' of element '{}'", printable(name), element.name));
  }

  void read_vertices(const PlyElement& element) {
    if (has_vertices_) body_.fail("a second element 'vertex'");
    if (element.count >= k_no_value) body_.fail(fmt::format("{} vertices are too many", element.count));
    has_vertices_ = true;
    PlyProperties properties(element);
    const auto position = properties.scalars<3>({{"x", "y", "z"}});
    const auto normal = properties.scalars<3>({{"nx", "ny", "nz"}});
    const auto uv =
        properties.scalars<2>({{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}});
    const auto cad_uv = properties.scalars<2>({{"cad_u", "cad_v"}});
    const auto color = find_colors(properties);
    if (!position) body_.fail("the vertices have no properties x, y, z");
    mesh_.positions.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, [](std::size_t) {});
      mesh_.positions.push_back(unit_ * vec3_at(*position));
      if (!is_finite(mesh_.positions.back())) body_.fail(fmt::format("vertex {} is not finite", i));
      if (normal) mesh_.normals.push_back(normalized(finite_or_zero(vec3_at(*normal))));
      if (uv) mesh_.uv.push_back(uv_at(*uv));
      if (cad_uv) mesh_.cad_uv.push_back(uv_at(*cad_uv));
      if (color) mesh_.colors.push_back(color_at(element, *color));
    }
    note_losses(element, properties);
  }

  void read_faces(const PlyElement& element) {
    if (element.count == 0) return;
    element.name == "face" ? read_polygons(element) : read_strips(element);
  }

  Index vertex_number(double value) const {
    if (!(value >= 0 && value < static_cast<double>(mesh_.positions.size())) || value != std::floor(value))
      body_.fail(fmt::format("vertex {} of {} does not exist", value, mesh_.positions.size()));
    return static_cast<Index>(value);
  }

  void read_polygons(const PlyElement& element) {
    PlyProperties properties(element);
    const std::size_t indices = find_indices(properties, element, body_);
    const auto texcoord = properties.list("texcoord"), cad = properties.list("cad_uv");
    const auto texture = properties.scalar("texnumber");
    const auto color = find_colors(properties);
    std::vector<Index> corners;
    std::vector<Vec2> uv, cad_uv;
    for (std::uint64_t f = 0; f < element.count; ++f) {
      corners.clear();
      uv.clear();
      cad_uv.clear();
      read_row(element, [&](std::size_t place) {
        if (place == indices)
          for (const double value : list_) corners.push_back(vertex_number(value));
        if (place == texcoord) append_pairs(uv);
        if (place == cad) append_pairs(cad_uv);
      });
      for (std::vector<Vec2>* pairs : {&uv, &cad_uv}) {
        if (pairs->size() == corners.size()) continue;
        bad_uv_ += !pairs->empty();
        pairs->clear();
      }
      PolygonMesh::Polygon polygon{corners, uv, {}, texture ? texture_number(row_[*texture]) : 0, cad_uv};
      if (color) polygon.color = color_at(element, *color);
      add(polygon);
    }
    note_losses(element, properties);
  }

  void append_pairs(std::vector<Vec2>& pairs) {
    for (std::size_t k = 0; k + 1 < list_.size(); k += 2) pairs.push_back(finite_or_zero(Vec2{list_[k], list_[k + 1]}));
  }

  void add(const PolygonMesh::Polygon& polygon) {
    try {
      mesh_.add(polygon);
    } catch (const InvalidInput& error) {
      body_.fail(error.what());
    }
  }

  /// Slot 0 when there is no such picture.
  std::uint32_t texture_number(double value) {
    if (value >= 0 && value < static_cast<double>(header_.texture_files.size()))
      return static_cast<std::uint32_t>(value);
    bad_textures_ += !header_.texture_files.empty();
    return 0;
  }

  void read_strips(const PlyElement& element) {
    PlyProperties properties(element);
    const std::size_t indices = find_indices(properties, element, body_);
    for (std::uint64_t s = 0; s < element.count; ++s)
      read_row(element, [&](std::size_t place) {
        if (place == indices) add_strips(list_);
      });
    note_losses(element, properties);
  }

  /// Every further vertex makes a triangle with the two before it, every second one turned round; −1 begins a new
  /// strip.
  void add_strips(const std::vector<double>& numbers) {
    std::vector<Index> strip;
    for (const double value : numbers) {
      if (value == -1) {
        strip.clear();
        continue;
      }
      strip.push_back(vertex_number(value));
      if (strip.size() >= 3) add_strip_triangle(strip);
    }
  }

  /// Strips repeat vertices to turn; such triangles have no area and are left out.
  void add_strip_triangle(const std::vector<Index>& strip) {
    const std::size_t n = strip.size();
    std::array<Index, 3> corners = {strip[n - 3], strip[n - 2], strip[n - 1]};
    if (n % 2 == 0) std::swap(corners[0], corners[1]);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    mesh_.add({corners, {}, {}, 0});
  }

  void add_materials(Part& part) {
    ScenePictures pictures(path_, scene_);
    for (const auto& [name, line] : header_.texture_files) {
      Material material;
      material.name = one_line(name);
      if (const auto texture = pictures.add_texture(name, fmt::format("line {}", line), false))
        material.base_color_texture = TextureReference{*texture, 0, 1, {}};
      part.materials.push_back(static_cast<std::uint32_t>(scene_.materials.size()));
      scene_.materials.push_back(std::move(material));
    }
  }

  void note_oddities() {
    const auto warn = [&](std::size_t count, const char* what) {
      if (count > 0) scene_.warnings.push_back(fmt::format("{} {}", count, what));
    };
    warn(mesh_.short_polygons(), "faces of fewer than three corners are ignored");
    warn(bad_values_, "normals, colours or texture coordinates are not finite and are ignored");
    warn(bad_uv_, "faces have not as many texture coordinates as corners, which are ignored");
    warn(bad_textures_, "faces name a picture that does not exist");
  }

  const std::filesystem::path& path_;
  std::string file_;
  PlyHeader header_;
  PlyBody body_;
  double unit_;
  Scene& scene_;
  PolygonMesh mesh_;
  std::vector<double> row_, list_;
  bool has_vertices_ = false;
  std::size_t bad_values_ = 0, bad_uv_ = 0, bad_textures_ = 0;
};

}  // namespace

Scene read_ply(const std::filesystem::path& path, const ReadOptions& options) {
  Scene scene = unitless_scene("PLY", options, UpAxis::z);
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InvalidInput(path.string() + ": is empty");
  scene.parts.push_back(PlyReader(path, bytes, scene.millimetres_per_unit, scene).read());
  add_part_nodes(scene, path.stem().string());
  return scene;
}

}  // namespace papilla
