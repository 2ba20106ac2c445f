// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>

#include "draco_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/vertex_welder.hpp"

namespace papilla::gltf {
namespace {

/// CAD (u,v) as write_glb() keeps them.
constexpr const char* k_cad_attribute = "_CAD_UV";
constexpr const char* k_draco = "KHR_draco_mesh_compression";
constexpr Index k_unused = std::numeric_limits<Index>::max();

/// What a primitive's vertices carry; an attribute that is missing is empty.
struct Vertices {
  std::size_t count = 0;
  std::vector<double> positions, normals, uv, uv1, cad_uv, colors;
  int color_components = 4;
};

/// The part under construction; attribute values follow the order of first use.
struct PartBuilder {
  Part part;
  GltfOrigin::Part origin;
  VertexWelder welder;
  bool has_normals = false;
  std::vector<std::uint8_t> carries;  ///< Per triangle: k_uv, k_uv1, k_colors, k_cad_uv of its primitive.
};

constexpr std::uint8_t k_uv = 1, k_uv1 = 2, k_colors = 4, k_cad_uv = 8;

/// glTF's v runs down.
Vec2 uv_at(const std::vector<double>& numbers, std::size_t i) { return {numbers[2 * i], 1 - numbers[2 * i + 1]}; }

Color color_at(const Vertices& vertices, std::size_t i) {
  const auto width = static_cast<std::size_t>(vertices.color_components);
  const double* c = &vertices.colors[width * i];
  const auto clamped = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); };
  return {clamped(c[0]), clamped(c[1]), clamped(c[2]), width == 4 ? clamped(c[3]) : 1.0F};
}

/// The primitive's corners as triangles; see glTF 2.0, 3.7.2.1 for the order in strips and fans.
std::vector<Triangle> triangles_of(int mode, const std::vector<Index>& corners) {
  std::vector<Triangle> triangles;
  const std::size_t n = corners.size();
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  };
  const auto add_proper = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (corners[a] != corners[b] && corners[b] != corners[c] && corners[c] != corners[a]) add(a, b, c);
  };
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(n / 3);
    for (std::size_t i = 0; i + 2 < n; i += 3) add(i, i + 1, i + 2);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < n; ++i) add_proper(i, i + 1 + i % 2, i + 2 - i % 2);
  } else {
    for (std::size_t i = 1; i + 1 < n; ++i) add_proper(i, i + 1, 0);
  }
  return triangles;
}

std::optional<int> attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return std::nullopt;
  return found->second;
}

class PrimitiveReader {
 public:
  PrimitiveReader(const Document& document, AccessorReader& reader, bool tag_channel, bool cad_uv, Scene& scene)
      : document_(document), reader_(reader), tag_channel_(tag_channel), cad_uv_(cad_uv), scene_(scene) {}

  void read(const tinygltf::Primitive& primitive, std::uint32_t number, const std::string& where,
            PartBuilder& builder) {
    const auto position = attribute(primitive, "POSITION");
    if (!position) {
      scene_.losses.push_back(where + " has no positions and draws nothing");
      return;
    }
    Vertices vertices;
    std::vector<Triangle> triangles;
    if (const tinygltf::Value* stream = compressed(primitive, *position, where)) {
      read_compressed(primitive, *stream, channel_1(primitive.material), where, vertices, triangles);
    } else {
      vertices = read_vertices(primitive, *position, where);
      triangles = read_triangles(primitive, vertices.count, where);
    }
    const std::uint32_t slot = material_slot(primitive.material, where, builder);
    const auto first = static_cast<std::uint32_t>(builder.part.mesh.triangles.size());
    append(vertices, triangles, slot, builder);
    builder.origin.primitives.push_back({number, slot, first, std::move(triangles)});
  }

  /// Notes which material the primitive has, without its triangles.
  void list(const tinygltf::Primitive& primitive, std::uint32_t number, const std::string& where,
            PartBuilder& builder) {
    if (attribute(primitive, "POSITION"))
      builder.origin.primitives.push_back({number, material_slot(primitive.material, where, builder), 0, {}});
    else
      scene_.losses.push_back(where + " has no positions and draws nothing");
  }

  GltfPrimitive read_single(const tinygltf::Primitive& primitive, const std::string& where, std::optional<int> channel,
                            bool normals) {
    const int position = *attribute(primitive, "POSITION");
    const std::string uv = "TEXCOORD_" + std::to_string(channel.value_or(0));
    GltfPrimitive result;
    if (const tinygltf::Value* stream = compressed(primitive, position, where)) {
      Vertices vertices;
      read_compressed(primitive, *stream, uv, where, vertices, result.triangles);
      result.positions = narrowed<3>(vertices.positions);
      if (channel) result.uv = narrowed<2>(vertices.uv1);
      if (normals) result.normals = narrowed<3>(vertices.normals);
      return result;
    }
    result.positions = reader_.floats<3>(position, where + ", POSITION");
    if (channel) result.uv = optional_floats<2>(primitive, uv.c_str(), result.positions.size(), where);
    if (normals) result.normals = optional_floats<3>(primitive, "NORMAL", result.positions.size(), where);
    result.triangles = read_triangles(primitive, result.positions.size(), where);
    return result;
  }

 private:
  /// The primitive's Draco stream, if it is what holds the content.
  const tinygltf::Value* compressed(const tinygltf::Primitive& primitive, int position,
                                    const std::string& where) const {
    const auto found = primitive.extensions.find(k_draco);
    const bool used =
        found != primitive.extensions.end() && (has_draco() || reader_.accessor(position, where).bufferView < 0);
    return used ? &found->second : nullptr;
  }

  template <std::size_t k_components>
  static std::vector<std::array<float, k_components>> narrowed(const std::vector<double>& numbers) {
    std::vector<std::array<float, k_components>> result(numbers.size() / k_components);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      result[i / k_components][i % k_components] = static_cast<float>(numbers[i]);
    return result;
  }

  template <std::size_t k_components>
  std::vector<std::array<float, k_components>> optional_floats(const tinygltf::Primitive& primitive, const char* name,
                                                               std::size_t count, const std::string& where) {
    const auto accessor = attribute(primitive, name);
    if (!accessor) return {};
    const std::string place = where + ", " + name;
    auto values = reader_.floats<k_components>(*accessor, place);
    check_count(values.size(), count, place);
    return values;
  }

  void check_count(std::size_t found, std::size_t count, const std::string& place) const {
    if (found != count) throw InvalidInput(document_.file + ": " + place + ": has not as many elements as POSITION");
  }

  std::vector<double> optional_numbers(const tinygltf::Primitive& primitive, const char* name, int components,
                                       std::size_t count, const std::string& where) {
    const auto accessor = attribute(primitive, name);
    if (!accessor) return {};
    const std::string place = where + ", " + name;
    std::vector<double> numbers = reader_.numbers(*accessor, components, place);
    check_count(numbers.size() / static_cast<std::size_t>(components), count, place);
    return numbers;
  }

  Vertices read_vertices(const tinygltf::Primitive& primitive, int position, const std::string& where) {
    Vertices vertices;
    vertices.positions = reader_.numbers(position, 3, where + ", POSITION");
    vertices.count = vertices.positions.size() / 3;
    vertices.normals = optional_numbers(primitive, "NORMAL", 3, vertices.count, where);
    vertices.uv = optional_numbers(primitive, "TEXCOORD_0", 2, vertices.count, where);
    vertices.uv1 = optional_numbers(primitive, channel_1(primitive.material).c_str(), 2, vertices.count, where);
    if (cad_uv_) vertices.cad_uv = optional_numbers(primitive, k_cad_attribute, 2, vertices.count, where);
    if (const auto color = attribute(primitive, "COLOR_0")) {
      vertices.color_components = reader_.accessor(*color, where).type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
      vertices.colors = optional_numbers(primitive, "COLOR_0", vertices.color_components, vertices.count, where);
    }
    return vertices;
  }

  /// One attribute of a Draco stream; empty when the primitive or the stream lacks it.
  struct CompressedAttribute {
    const char* name;
    int components;
    std::vector<double>* numbers;
    int id = -1, accessor = -1;
  };

  /// KHR_draco_mesh_compression: the stream's attributes stand in for the accessors', triangles for any mode.
  /// @param uv1  name of the attribute that becomes Vertices::uv1.
  void read_compressed(const tinygltf::Primitive& primitive, const tinygltf::Value& extension, const std::string& uv1,
                       const std::string& where, Vertices& vertices, std::vector<Triangle>& triangles) {
    std::vector<CompressedAttribute> attributes = {{"POSITION", 3, &vertices.positions},
                                                   {"NORMAL", 3, &vertices.normals},
                                                   {"TEXCOORD_0", 2, &vertices.uv},
                                                   {uv1.c_str(), 2, &vertices.uv1},
                                                   {"COLOR_0", 4, &vertices.colors}};
    if (const auto color = attribute(primitive, "COLOR_0")) {
      vertices.color_components = reader_.accessor(*color, where).type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
      attributes.back().components = vertices.color_components;
    }
    if (cad_uv_) attributes.push_back({k_cad_attribute, 2, &vertices.cad_uv});
    DracoRequest request = compressed_sizes(primitive, where);
    const tinygltf::Value& ids = extension.Get("attributes");
    for (CompressedAttribute& wanted : attributes) {
      const auto accessor = attribute(primitive, wanted.name);
      wanted.id = index_in(ids, wanted.name);
      if (!accessor || wanted.id < 0) continue;
      wanted.accessor = *accessor;
      request.components[wanted.id] = std::max(request.components[wanted.id], wanted.components);
      reader_.spend(request.max_points, where);
    }
    const int view = index_in(extension, "bufferView");
    const std::string place = document_.file + ": " + where;
    const DracoMesh mesh = decode_draco(reader_.view(view, where + ", Draco"), request, place);
    vertices.count = mesh.points;
    for (const CompressedAttribute& wanted : attributes)
      if (wanted.id >= 0) take_numbers(mesh, request, wanted, where);
    if (vertices.positions.empty() && mesh.points > 0)
      throw InvalidInput(place + ": the Draco stream has no positions");
    for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3)
      triangles.push_back({mesh.corners[i], mesh.corners[i + 1], mesh.corners[i + 2]});
  }

  /// What the accessors promise, taken from what the file may hand out.
  DracoRequest compressed_sizes(const tinygltf::Primitive& primitive, const std::string& where) {
    DracoRequest request;
    request.max_points = reader_.accessor(*attribute(primitive, "POSITION"), where).count;
    const std::size_t corners =
        primitive.indices >= 0 ? reader_.accessor(primitive.indices, where).count : request.max_points;
    request.max_triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
    reader_.spend(corners, where);
    return request;
  }

  void take_numbers(const DracoMesh& mesh, const DracoRequest& request, const CompressedAttribute& wanted,
                    const std::string& where) {
    const DracoMesh::Attribute& source = mesh.attributes.at(wanted.id);
    const tinygltf::Accessor& accessor = reader_.accessor(wanted.accessor, where);
    const auto width = static_cast<std::size_t>(wanted.components);
    const auto stride = static_cast<std::size_t>(request.components.at(wanted.id));
    wanted.numbers->resize(mesh.points * width);
    for (std::size_t i = 0; i < mesh.points; ++i)
      for (std::size_t k = 0; k < width; ++k) {
        double value = source.numbers[i * stride + k];
        if (source.is_integer && accessor.normalized) value = normalize(value, accessor.componentType);
        if (!std::isfinite(value))
          throw InvalidInput(document_.file + ": " + where + ", " + wanted.name + ": element " + std::to_string(i) +
                             " of the Draco stream is not finite");
        (*wanted.numbers)[i * width + k] = value;
      }
  }

  std::vector<Triangle> read_triangles(const tinygltf::Primitive& primitive, std::size_t vertex_count,
                                       const std::string& where) {
    std::vector<Index> corners;
    if (primitive.indices >= 0) {
      corners = reader_.indices(primitive.indices, where + ", indices");
      for (std::size_t i = 0; i < corners.size(); ++i)
        if (corners[i] >= vertex_count)
          throw InvalidInput(document_.file + ": " + where + ": index[" + std::to_string(i) +
                             "] = " + std::to_string(corners[i]) + " is not below the vertex count " +
                             std::to_string(vertex_count));
    } else {
      corners.resize(vertex_count);
      std::iota(corners.begin(), corners.end(), Index{0});
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
      scene_.warnings.push_back(where + ": " + std::to_string(corners.size()) +
                                " corners are no whole number of triangles; the last are ignored");
    return triangles_of(primitive.mode, corners);
  }

  /// The attribute that becomes TriangleMesh::uv1.
  std::string channel_1(int material) const {
    if (!tag_channel_ || material < 0 || static_cast<std::size_t>(material) >= scene_.materials.size())
      return "TEXCOORD_1";
    const auto& tag = scene_.materials[static_cast<std::size_t>(material)].haptic;
    return "TEXCOORD_" + std::to_string(tag ? std::max(tex_coord_of(*tag).value_or(1), 1) : 1);
  }

  std::uint32_t material_slot(int material, const std::string& where, PartBuilder& builder) {
    Part& part = builder.part;
    const std::size_t count = document_.model.materials.size();
    if (material >= static_cast<int>(count))
      throw InvalidInput(document_.file + ": " + where + ": material " + std::to_string(material) + " does not exist");
    const std::uint32_t number = material >= 0 ? static_cast<std::uint32_t>(material) : default_material();
    const auto found = std::find(part.materials.begin(), part.materials.end(), number);
    if (found != part.materials.end()) return static_cast<std::uint32_t>(found - part.materials.begin());
    part.materials.push_back(number);
    builder.origin.materials.push_back(material >= 0 ? std::optional(number) : std::nullopt);
    return static_cast<std::uint32_t>(part.materials.size() - 1);
  }

  std::uint32_t default_material() {
    if (!default_material_) {
      Material material;
      material.name = "default";
      material.metallic = 1;
      material.roughness = 1;
      default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(std::move(material));
    }
    return *default_material_;
  }

  /// Adds the triangles with all attributes. Values of those that this primitive lacks keep the numbering common.
  void append(const Vertices& vertices, std::span<const Triangle> triangles, std::uint32_t slot,
              PartBuilder& builder) const {
    TriangleMesh& mesh = builder.part.mesh;
    builder.has_normals |= !vertices.normals.empty();
    const auto carries =
        static_cast<std::uint8_t>((vertices.uv.empty() ? 0 : k_uv) | (vertices.uv1.empty() ? 0 : k_uv1) |
                                  (vertices.colors.empty() ? 0 : k_colors) | (vertices.cad_uv.empty() ? 0 : k_cad_uv));
    builder.carries.insert(builder.carries.end(), triangles.size(), carries);
    std::vector<Index> welded(vertices.count, k_unused), compact(vertices.count, k_unused);
    for (const Triangle& triangle : triangles) {
      Triangle corners{}, values{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = triangle[k];
        if (compact[v] == k_unused) {
          welded[v] = builder.welder.add(k_mm_per_metre * vec3_at(vertices.positions, v));
          compact[v] = static_cast<Index>(mesh.uv.values.size());
          mesh.uv.values.push_back(vertices.uv.empty() ? Vec2{} : uv_at(vertices.uv, v));
          mesh.uv1.values.push_back(vertices.uv1.empty() ? Vec2{} : uv_at(vertices.uv1, v));
          if (cad_uv_)
            mesh.cad_uv.values.push_back(vertices.cad_uv.empty() ? Vec2{}
                                                                 : Vec2{vertices.cad_uv[2 * std::size_t{v}],
                                                                        vertices.cad_uv[2 * std::size_t{v} + 1]});
          mesh.colors.values.push_back(vertices.colors.empty() ? Color{} : color_at(vertices, v));
          mesh.normals.values.push_back(vertices.normals.empty() ? Vec3{} : normalized(vec3_at(vertices.normals, v)));
        }
        corners[k] = welded[v];
        values[k] = compact[v];
      }
      mesh.triangles.push_back(corners);
      mesh.material.push_back(slot);
      mesh.uv.indices.push_back(values);
    }
  }

  const Document& document_;
  AccessorReader& reader_;
  bool tag_channel_, cad_uv_;
  Scene& scene_;
  std::optional<std::uint32_t> default_material_;
};

/// A primitive without normals is flat shaded (glTF 2.0, 3.7.2.1): gives corners whose normal is zero their triangle's.
void fill_flat_normals(TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 flat = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    for (Index& normal : mesh.normals.indices[t]) {
      if (!(mesh.normals.values[normal] == Vec3{})) continue;
      normal = static_cast<Index>(mesh.normals.values.size());
      mesh.normals.values.push_back(flat);
    }
  }
}

/// Gives an attribute the common corner numbers on the triangles whose primitive carries it.
template <class T>
void number_attribute(CornerAttribute<T>& attribute, const Values<Triangle>& numbers,
                      const std::vector<std::uint8_t>& carries, std::uint8_t kind) {
  const auto carried = [kind](std::uint8_t c) { return (c & kind) != 0; };
  if (std::none_of(carries.begin(), carries.end(), carried)) {
    attribute = {};
    return;
  }
  attribute.indices = numbers;
  for (std::size_t t = 0; t < numbers.size(); ++t)
    if (!carried(carries[t])) attribute.indices[t] = {k_no_value, k_no_value, k_no_value};
}

/// write_glb() has no other way to say that a triangle has no CAD (u,v).
void drop_constant(CornerAttribute<Vec2>& attribute) {
  for (Triangle& t : attribute.indices) {
    if (t[0] == k_no_value) continue;
    const Vec2 value = attribute.values[t[0]];
    if (attribute.values[t[1]] == value && attribute.values[t[2]] == value) t = {k_no_value, k_no_value, k_no_value};
  }
}

/// Keeps the attributes that at least one primitive has; all share the corner numbers collected in mesh.uv.
Part finish(PartBuilder builder) {
  TriangleMesh& mesh = builder.part.mesh;
  mesh.positions = builder.welder.take_points();
  const Values<Triangle> numbers = std::move(mesh.uv.indices);
  number_attribute(mesh.uv, numbers, builder.carries, k_uv);
  number_attribute(mesh.uv1, numbers, builder.carries, k_uv1);
  number_attribute(mesh.colors, numbers, builder.carries, k_colors);
  number_attribute(mesh.cad_uv, numbers, builder.carries, k_cad_uv);
  drop_constant(mesh.cad_uv);
  if (builder.has_normals)
    mesh.normals.indices = numbers;
  else
    mesh.normals = {};
  if (builder.has_normals) fill_flat_normals(mesh);
  if (builder.part.materials.size() <= 1) mesh.material.clear();
  return std::move(builder.part);
}

/// How messages name a primitive.
std::string name_of(std::size_t mesh, std::size_t primitive) {
  return "mesh " + std::to_string(mesh) + ", primitive " + std::to_string(primitive);
}

void note_losses(const tinygltf::Primitive& primitive, const std::string& where, std::set<std::string>& losses) {
  if (!primitive.targets.empty()) losses.insert("morph targets of " + where);
  if (!primitive.extras_json_string.empty()) losses.insert("extras of " + where);
  for (const auto& [name, value] : primitive.extensions)
    if (name != k_draco) losses.insert(name + " of " + where);
  for (const auto& [name, accessor] : primitive.attributes) {
    if (name == "JOINTS_0") losses.insert("skin weights of " + where);
    if ((name.starts_with("_") && name != k_cad_attribute) || name == "TEXCOORD_2" || name == "COLOR_1")
      losses.insert(name + " of " + where);
  }
}

/// Calls use(primitive, number, where, builder) for the primitives that draw triangles, and take(builder) for each
/// mesh.
template <class Use, class Take>
void for_each_mesh(const Document& document, Scene& scene, Use use, Take take) {
  std::set<std::string> losses;
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    const tinygltf::Mesh& mesh = document.model.meshes[m];
    PartBuilder builder;
    builder.origin.mesh = static_cast<std::uint32_t>(m);
    builder.part.name = mesh.name;
    builder.part.extras_json = mesh.extras_json_string;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = mesh.primitives[p];
      const std::string where = name_of(m, p);
      if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        throw InvalidInput(document.file + ": " + where + ": mode " + std::to_string(primitive.mode) +
                           " is not in 0..6");
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        losses.insert("points or lines of " + where);
        continue;
      }
      note_losses(primitive, where, losses);
      use(primitive, static_cast<std::uint32_t>(p), where, builder);
    }
    take(builder);
  }
  scene.losses.insert(scene.losses.end(), losses.begin(), losses.end());
}

}  // namespace

std::vector<GltfOrigin::Part> read_parts(const Document& document, AccessorReader& reader, bool tag_channel,
                                         bool cad_uv, Scene& scene) {
  PrimitiveReader primitives(document, reader, tag_channel, cad_uv, scene);
  std::vector<GltfOrigin::Part> origins;
  for_each_mesh(
      document, scene,
      [&](const auto& primitive, std::uint32_t number, const std::string& where, PartBuilder& builder) {
        primitives.read(primitive, number, where, builder);
      },
      [&](PartBuilder& builder) {
        origins.push_back(std::move(builder.origin));
        scene.parts.push_back(finish(std::move(builder)));
      });
  return origins;
}

std::vector<GltfOrigin::Part> list_parts(const Document& document, AccessorReader& reader, Scene& scene) {
  PrimitiveReader primitives(document, reader, false, false, scene);
  std::vector<GltfOrigin::Part> origins;
  for_each_mesh(
      document, scene,
      [&](const auto& primitive, std::uint32_t number, const std::string& where, PartBuilder& builder) {
        primitives.list(primitive, number, where, builder);
      },
      [&](PartBuilder& builder) {
        origins.push_back(std::move(builder.origin));
        scene.parts.push_back(std::move(builder.part));
      });
  return origins;
}

GltfPrimitive read_primitive(const Document& document, AccessorReader& reader, std::uint32_t mesh, std::uint32_t number,
                             std::optional<int> channel, bool normals, Scene& scene) {
  return PrimitiveReader(document, reader, false, false, scene)
      .read_single(document.model.meshes.at(mesh).primitives.at(number), name_of(mesh, number), channel, normals);
}

}  // namespace papilla::gltf
