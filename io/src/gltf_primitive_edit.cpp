// SPDX-License-Identifier: MIT
#include "gltf_primitive_edit.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>

#include "papilla/io/gltf_vertices.hpp"
#include "tangents.hpp"

namespace papilla {
namespace {

using Json = GltfFile::Json;
using GltfUv = std::array<float, 2>;  // v downwards

constexpr const char* k_draco = "KHR_draco_mesh_compression";
constexpr int k_float = 5126, k_unsigned_short = 5123, k_unsigned_int = 5125;

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A primitive whose vertices get more.
struct Member {
  PrimitiveNumber number;
  const Part* part = nullptr;
  const GltfOrigin::Primitive* origin = nullptr;
  const GltfSurfaceEdit* edit = nullptr;
  std::size_t first_of_surface = 0;  ///< Number of its first triangle within the surface.
  int channel = 0;
  bool wants_tangents = false;
  std::vector<Triangle> vertices;  ///< As `origin`, after vertices were repeated.
};

/// Primitives that share all vertex data.
struct VertexGroup {
  std::vector<Member> members;
  std::size_t count = 0;        ///< Vertices.
  std::vector<Index> repeated;  ///< Vertices that stand once more behind the others.
  std::vector<GltfUv> uv;
  std::vector<std::uint8_t> turned;  ///< Per vertex: whether its normal is negated.
  std::vector<std::array<float, 4>> tangents;

  bool any_turned() const { return std::find(turned.begin(), turned.end(), 1) != turned.end(); }
};

/// The uv of a corner, v upwards.
Vec2 uv_of(const Member& member, std::size_t triangle, std::size_t corner) {
  const bool is_new = !member.edit->uv.empty();
  const CornerAttribute<Vec2>& uv = is_new ? member.edit->uv : member.part->mesh.uv;
  const std::size_t number = triangle + (is_new ? member.first_of_surface : member.origin->first_triangle);
  return uv.has_value(number) ? uv.values[uv.indices[number][corner]] : Vec2{};
}

GltfUv stored(Vec2 uv) { return {static_cast<float>(uv.x), static_cast<float>(1 - uv.y)}; }

bool is_turned(const Member& member, std::size_t triangle) {
  return !member.edit->turned.empty() && member.edit->turned[member.first_of_surface + triangle] != 0;
}

/// Gives every vertex one uv, one handedness and one side; it is repeated where its corners differ in them.
class VertexSplitter {
 public:
  explicit VertexSplitter(VertexGroup& group) : group_(group), kind_(group.count, k_unused) {
    group_.uv.resize(group.count);
    group_.turned.resize(group.count);
    tangents_ =
        std::any_of(group.members.begin(), group.members.end(), [](const Member& m) { return m.wants_tangents; });
  }

  void run() {
    for (Member& member : group_.members) {
      member.vertices = member.origin->vertices;
      for (std::size_t t = 0; t < member.vertices.size(); ++t) {
        std::array<Vec2, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) {
          const GltfUv rounded = stored(uv_of(member, t, k));
          uv[k] = {rounded[0], 1 - double{rounded[1]}};
        }
        const int kind =
            (tangents_ && tangent_handedness(uv) < 0 ? k_mirrored : k_upright) | (is_turned(member, t) ? k_turned : 0);
        for (std::size_t k = 0; k < 3; ++k)
          member.vertices[t][k] = vertex(member.vertices[t][k], stored(uv_of(member, t, k)), kind);
      }
    }
  }

 private:
  static constexpr int k_unused = 0, k_upright = 1, k_mirrored = 2, k_turned = 4;

  Index vertex(Index number, GltfUv uv, int kind) {
    if (kind_[number] == k_unused) {
      kind_[number] = kind;
      group_.uv[number] = uv;
      group_.turned[number] = (kind & k_turned) != 0;
    }
    if (kind_[number] == kind && group_.uv[number] == uv) return number;
    const auto [known, is_new] = others_.try_emplace({number, uv, kind}, static_cast<Index>(group_.uv.size()));
    if (is_new) {
      group_.repeated.push_back(number);
      group_.uv.push_back(uv);
      group_.turned.push_back((kind & k_turned) != 0);
    }
    return known->second;
  }

  VertexGroup& group_;
  bool tangents_ = false;
  std::vector<int> kind_;
  std::map<std::tuple<Index, GltfUv, int>, Index> others_;
};

/// Of the members that want them; other vertices get any.
void compute_tangents(VertexGroup& group) {
  std::vector<Vec3> positions(group.uv.size()), normals(group.uv.size());
  std::vector<Vec2> uv;
  for (const GltfUv& value : group.uv) uv.push_back({value[0], 1 - double{value[1]}});
  std::vector<Triangle> triangles;
  for (const Member& member : group.members) {
    if (!member.wants_tangents) continue;
    const TriangleMesh& mesh = member.part->mesh;
    for (std::size_t t = 0; t < member.vertices.size(); ++t) {
      const std::size_t own = member.origin->first_triangle + t;
      for (std::size_t k = 0; k < 3; ++k) {
        positions[member.vertices[t][k]] = mesh.corner(own, static_cast<int>(k));
        normals[member.vertices[t][k]] = mesh.normals.values[mesh.normals.indices[own][k]];
      }
    }
    triangles.insert(triangles.end(), member.vertices.begin(), member.vertices.end());
  }
  if (!triangles.empty()) group.tangents = vertex_tangents(positions, normals, uv, triangles);
}

template <class T>
void negate_as(char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  value = static_cast<T>(-value);
  std::memcpy(at, &value, sizeof value);
}

/// Negates one component: a float, or a signed normalized integer.
void negate(char* at, std::size_t bytes) {
  if (bytes == 1) return negate_as<std::int8_t>(at);
  bytes == 2 ? negate_as<std::int16_t>(at) : negate_as<float>(at);
}

/// Turns the normal of a vertex over; its tangent keeps its direction and changes its handedness.
void turn_element(const std::string& attribute, std::size_t bytes, char* at) {
  if (attribute == "NORMAL")
    for (std::size_t k = 0; k < 3; ++k) negate(at + k * (bytes / 3), bytes / 3);
  if (attribute == "TANGENT" && bytes % 4 == 0 && bytes != 12) negate(at + 3 * (bytes / 4), bytes / 4);
}

class PrimitiveEditor {
 public:
  PrimitiveEditor(GltfFile& file, const GltfSource& source, const WantedEdits& wanted, std::vector<std::string>& notes)
      : file_(file), source_(source), wanted_(wanted), notes_(notes) {}

  void run(const std::vector<EditedMaterial>& materials) {
    std::map<std::string, VertexGroup> groups;
    for (const EditedMaterial& material : materials)
      for (const MaterialUse& use : material.uses) {
        const bool wants_tangents = material.has_normal_map && can_have_tangents(use.primitive, *material.edit);
        const bool is_turned = !wanted_.at(use.primitive)->turned.empty();
        if (material.edit->uv.empty() && !wants_tangents && !is_turned) continue;
        std::vector<Member>& members = groups[vertex_data(use.primitive)].members;
        const auto known =
            std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.number == use.primitive; });
        if (known == members.end())
          members.push_back(member(use.primitive, *wanted_.at(use.primitive), material.channel, wants_tangents));
        else
          known->wants_tangents = known->wants_tangents || wants_tangents;
      }
    for (const auto& [number, edit] : wanted_)
      if (edit->keeps_material && !edit->turned.empty())
        groups[vertex_data(number)].members.push_back(member(number, *edit, 0, false));
    for (auto& [data, group] : groups) edit(group);
    if (decoded_ && !any_primitive_has(k_draco)) file_.forget_extension(k_draco);
  }

 private:
  Json& primitive(PrimitiveNumber number) { return file_.json["meshes"][number.first]["primitives"][number.second]; }

  /// Without normals tangents are ignored; those that the file has belong to the kept uv.
  bool can_have_tangents(PrimitiveNumber number, const GltfSurfaceEdit& edit) {
    const Json& attributes = primitive(number)["attributes"];
    return attributes.contains("NORMAL") && (!edit.uv.empty() || !attributes.contains("TANGENT"));
  }

  bool is_compressed(PrimitiveNumber number) {
    const Json& json = primitive(number);
    return json.contains("extensions") && json["extensions"].contains(k_draco);
  }

  bool any_primitive_has(const char* extension) const {
    for (const Json& mesh : file_.json["meshes"])
      for (const Json& json : mesh["primitives"])
        if (json.contains("extensions") && json["extensions"].contains(extension)) return true;
    return false;
  }

  std::string vertex_data(PrimitiveNumber number) {
    const Json& json = primitive(number);
    std::string text = json["attributes"].dump() + json.value("targets", Json()).dump();
    if (is_compressed(number)) text += json["extensions"][k_draco].dump();
    return text;
  }

  Member member(PrimitiveNumber number, const GltfSurfaceEdit& edit, int channel, bool wants_tangents) const {
    Member member;
    member.number = number;
    member.edit = &edit;
    member.channel = channel;
    member.wants_tangents = wants_tangents;
    member.part = &source_.scene.parts[edit.part];
    for (const GltfOrigin::Primitive& primitive : source_.origin.parts[edit.part].primitives) {
      if (primitive.number == number.second) {
        member.origin = &primitive;
        break;
      }
      if (primitive.slot == edit.slot) member.first_of_surface += primitive.vertices.size();
    }
    return member;
  }

  void edit(VertexGroup& group) {
    const PrimitiveNumber first = group.members.front().number;
    const bool decode = is_compressed(first);
    std::optional<GltfVertices> vertices;
    if (decode) vertices = read(group.members.front());
    group.count = decode
                      ? vertices->count
                      : file_.json["accessors"][primitive(first)["attributes"]["POSITION"].get<std::size_t>()]["count"]
                            .get<std::size_t>();
    VertexSplitter(group).run();
    compute_tangents(group);
    if ((!group.repeated.empty() || group.any_turned()) && !vertices) vertices = read(group.members.front());
    Json attributes, targets;
    if (vertices) {
      attributes = write(vertices->attributes, group, decode);
      targets = Json::array();
      for (const auto& target : vertices->targets) targets.push_back(write(target, group, false));
    }
    for (const Member& member : group.members) {
      if (vertices) replace_vertices(member, attributes, targets, group.uv.size());
      add_attributes(member, group);
    }
  }

  GltfVertices read(const Member& member) {
    if (!reader_) reader_ = std::make_unique<GltfVertexReader>(source_.path);
    return reader_->read(source_.origin.parts[member.edit->part].mesh, member.number.second);
  }

  /// Accessors for the attributes with the repeated vertices.
  Json write(const std::vector<GltfAttribute>& attributes, const VertexGroup& group, bool decoded) {
    Json numbers = Json::object();
    for (const GltfAttribute& attribute : attributes) {
      const std::size_t size = attribute.element_bytes, stride = (size + 3) / 4 * 4;
      std::string bytes(group.uv.size() * stride, '\0');
      const std::size_t originals = group.uv.size() - group.repeated.size();
      for (std::size_t i = 0; i < group.uv.size(); ++i) {
        const std::size_t from = i < originals ? i : group.repeated[i - originals];
        std::memcpy(&bytes[i * stride], &attribute.bytes[from * size], size);
        if (group.turned[i] != 0) turn_element(attribute.name, size, &bytes[i * stride]);
      }
      Json accessor = {{"bufferView", file_.add_view(bytes, GltfFile::k_vertices, stride == size ? 0 : stride)}};
      const Json& source = file_.json["accessors"][attribute.accessor];
      for (const auto& [name, value] : source.items())
        if (name != "bufferView" && name != "byteOffset" && name != "sparse") accessor[name] = value;
      accessor["count"] = group.uv.size();
      if (attribute.name == "NORMAL") accessor.erase("min"), accessor.erase("max");
      if (decoded && accessor.contains("min") && accessor["componentType"] == k_float) set_range(bytes, accessor);
      numbers[attribute.name] = file_.add("accessors", std::move(accessor));
    }
    return numbers;
  }

  /// Compression moves positions a little.
  static void set_range(const std::string& bytes, Json& accessor) {
    const std::size_t width = accessor["min"].size();
    std::vector<float> low(width, std::numeric_limits<float>::max()), high(width, std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i + 4 * width <= bytes.size(); i += 4 * width)
      for (std::size_t k = 0; k < width; ++k) {
        float value = 0;
        std::memcpy(&value, &bytes[i + 4 * k], sizeof value);
        low[k] = std::min(low[k], value), high[k] = std::max(high[k], value);
      }
    accessor["min"] = low, accessor["max"] = high;
  }

  void replace_vertices(const Member& member, const Json& attributes, const Json& targets, std::size_t count) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : member.vertices) corners.insert(corners.end(), triangle.begin(), triangle.end());
    std::vector<std::uint16_t> narrow;
    const bool fits = count <= 65535;  // 65535 itself restarts a primitive
    if (fits)
      for (const std::uint32_t corner : corners) narrow.push_back(static_cast<std::uint16_t>(corner));
    const std::size_t view = file_.add_view(fits ? bytes_of(narrow) : bytes_of(corners), GltfFile::k_indices);
    const std::size_t indices = file_.add("accessors", {{"bufferView", view},
                                                        {"componentType", fits ? k_unsigned_short : k_unsigned_int},
                                                        {"count", corners.size()},
                                                        {"type", "SCALAR"}});
    Json& json = primitive(member.number);
    for (auto& [name, accessor] : json["attributes"].items()) accessor = attributes.at(name);
    if (json.contains("targets"))
      for (std::size_t i = 0; i < targets.size(); ++i)
        for (auto& [name, accessor] : json["targets"][i].items()) accessor = targets[i].at(name);
    json["indices"] = indices;
    if (json.contains("mode")) json["mode"] = 4;  // Strips and fans are triangles now.
    note_extensions(member.number);
    if (!is_compressed(member.number)) return;
    decoded_ = true;
    json["extensions"].erase(k_draco);
    if (json["extensions"].empty()) json.erase("extensions");
  }

  /// Extensions may name vertices or triangles; all but these are kept without knowing.
  void note_extensions(PrimitiveNumber number) {
    const Json& json = primitive(number);
    if (!json.contains("extensions")) return;
    for (const auto& [name, value] : json["extensions"].items())
      if (name != k_draco && name != "KHR_materials_variants")
        notes_.push_back("mesh " + std::to_string(number.first) + ", primitive " + std::to_string(number.second) +
                         ": its extension " + name +
                         " stays as it is, though the primitive's vertices or their order changed");
  }

  void add_attributes(const Member& member, const VertexGroup& group) {
    const auto add = [&](const std::string& name, std::optional<std::size_t> view, const char* type) {
      Json accessor = Json::object();
      if (view) accessor["bufferView"] = *view;
      accessor.update({{"componentType", k_float}, {"count", group.uv.size()}, {"type", type}});
      const std::size_t number = file_.add("accessors", std::move(accessor));
      primitive(member.number)["attributes"][name] = number;
    };
    if (!member.edit->uv.empty()) {
      // Channels are numbered without gaps: missing ones are zero, as an accessor without data is.
      for (int channel = 0; channel < member.channel; ++channel)
        if (const std::string name = "TEXCOORD_" + std::to_string(channel);
            !primitive(member.number)["attributes"].contains(name))
          add(name, std::nullopt, "VEC2");
      add("TEXCOORD_" + std::to_string(member.channel), file_.add_view(bytes_of(group.uv), GltfFile::k_vertices),
          "VEC2");
    }
    if (member.wants_tangents) add("TANGENT", file_.add_view(bytes_of(group.tangents), GltfFile::k_vertices), "VEC4");
  }

  GltfFile& file_;
  const GltfSource& source_;
  const WantedEdits& wanted_;
  std::vector<std::string>& notes_;
  std::unique_ptr<GltfVertexReader> reader_;
  bool decoded_ = false;
};

}  // namespace

void edit_primitives(GltfFile& file, const GltfSource& source, const WantedEdits& wanted,
                     const std::vector<EditedMaterial>& materials, std::vector<std::string>& notes) {
  PrimitiveEditor(file, source, wanted, notes).run(materials);
}

}  // namespace papilla
