// SPDX-License-Identifier: MIT
#include "assimp_scene.hpp"

#include <assimp/scene.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "mesh_file_scene.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/io/vertex_welder.hpp"
#include "polygon_triangulation.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_max_depth = 1024;
constexpr Triangle k_no_values = {k_no_value, k_no_value, k_no_value};

std::string text_of(const aiString& text) { return {text.data, std::min<std::size_t>(text.length, MAXLEN - 1)}; }

/// assimp's FBX reader makes a chain of nodes of the pivots of one.
bool is_pivot(const aiNode& node) {
  return text_of(node.mName).find("_$AssimpFbx$_") != std::string::npos && node.mNumMeshes == 0;
}

Vec3 vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// An attribute of some of a part's meshes.
template <class T>
void append_values(CornerAttribute<T>& to, std::vector<T> values, std::span<const Triangle> corners,
                   std::size_t triangles_before) {
  const auto base = static_cast<Index>(to.values.size());
  to.values.insert(to.values.end(), values.begin(), values.end());
  to.indices.resize(triangles_before, k_no_values);
  for (const Triangle& c : corners) to.indices.push_back({base + c[0], base + c[1], base + c[2]});
}

class Converter {
 public:
  Converter(const aiScene& from, const std::string& file, Scene& scene) : from_(from), file_(file), scene_(scene) {}

  void convert() {
    if (from_.mRootNode == nullptr || from_.mNumMeshes == 0) throw InvalidInput(file_ + ": holds no triangle mesh");
    for (unsigned i = 0; i < from_.mNumMaterials; ++i) {
      if (from_.mMaterials[i] == nullptr) fail(fmt::format("material {} is empty", i));
      convert_assimp_material(*from_.mMaterials[i], from_, losses_, scene_);
    }
    convert_nodes();
    if (scene_.parts.empty()) throw InvalidInput(file_ + ": holds no triangles");
    drop_unused_materials();
    note_rest();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw InvalidInput(file_ + ": " + reason); }

  static std::string place(const aiMesh& mesh, std::size_t number) {
    return fmt::format("mesh {} '{}'", number, shown(text_of(mesh.mName)));
  }

  /// A node that waits for its turn: the transforms of pivots above it are still to be applied.
  struct Waiting {
    const aiNode* node;
    std::optional<std::uint32_t> parent;
    Transform above = k_identity;
    std::size_t depth = 0;
  };

  void convert_nodes() {
    std::vector<Waiting> stack;
    const aiNode& root = *from_.mRootNode;
    const bool is_added = root.mNumMeshes == 0 && root.mTransformation.IsIdentity() && root.mNumChildren > 0;
    const auto push_children = [&](const aiNode& node, std::optional<std::uint32_t> parent, const Transform& above,
                                   std::size_t depth) {
      if (depth > k_max_depth) fail(fmt::format("nodes are nested deeper than {} levels", k_max_depth));
      for (unsigned i = node.mNumChildren; i-- > 0;)
        if (node.mChildren[i] != nullptr) stack.push_back({node.mChildren[i], parent, above, depth});
    };
    if (is_added)
      push_children(root, std::nullopt, k_identity, 1);
    else
      stack.push_back({&root, std::nullopt, k_identity, 1});
    while (!stack.empty()) {
      const Waiting next = stack.back();
      stack.pop_back();
      const Transform local = multiply(next.above, transform_of(*next.node));
      if (is_pivot(*next.node)) {
        push_children(*next.node, next.parent, local, next.depth + 1);
        continue;
      }
      const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
      (next.parent ? scene_.nodes[*next.parent].children : scene_.roots).push_back(number);
      Node node;
      node.name = text_of(next.node->mName);
      node.local = local;
      node.part = part_of(*next.node);
      scene_.nodes.push_back(std::move(node));
      push_children(*next.node, number, k_identity, next.depth + 1);
    }
  }

  Transform transform_of(const aiNode& node) const {
    const aiMatrix4x4& m = node.mTransformation;
    const double unit = scene_.millimetres_per_unit;
    Transform local = {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1};
    for (const std::size_t k : {3u, 7u, 11u}) local[k] *= unit;
    const bool is_finite_map = std::all_of(local.begin(), local.end(), [](double x) { return std::isfinite(x); });
    if (!is_finite_map || m.d1 != 0 || m.d2 != 0 || m.d3 != 0 || m.d4 != 1)
      fail("the transform of node '" + shown(text_of(node.mName)) + "' is not finite or not affine");
    return local;
  }

  /// The part of the node's meshes, made when they are met first; nothing when they have no triangles.
  std::optional<std::uint32_t> part_of(const aiNode& node) {
    if (node.mNumMeshes == 0) return std::nullopt;
    std::vector<unsigned> meshes(node.mMeshes, node.mMeshes + node.mNumMeshes);
    const auto known = parts_.find(meshes);
    if (known != parts_.end()) return known->second;
    Part part = make_part(meshes, text_of(node.mName));
    std::optional<std::uint32_t> number;
    if (!part.mesh.triangles.empty()) {
      number = static_cast<std::uint32_t>(scene_.parts.size());
      scene_.parts.push_back(std::move(part));
    }
    parts_.emplace(std::move(meshes), number);
    return number;
  }

  Part make_part(const std::vector<unsigned>& meshes, const std::string& node_name) {
    Part part;
    VertexWelder welder;
    for (const unsigned number : meshes) {
      if (number >= from_.mNumMeshes || from_.mMeshes[number] == nullptr)
        fail(fmt::format("node '{}' names mesh {} of {}", shown(node_name), number, from_.mNumMeshes));
      const aiMesh& mesh = *from_.mMeshes[number];
      if (part.name.empty()) part.name = text_of(mesh.mName);
      append(mesh, number, welder, part);
    }
    if (part.name.empty()) part.name = node_name;
    TriangleMesh& mesh = part.mesh;
    mesh.positions = welder.take_points();
    if (part.materials.size() <= 1) mesh.material.clear();
    // What assimp makes up for meshes without a material.
    if (part.materials.size() == 1 && scene_.materials[part.materials[0]].name == AI_DEFAULT_MATERIAL_NAME)
      part.materials.clear();
    const auto complete = [&](auto& attribute) {
      if (!attribute.empty()) attribute.indices.resize(mesh.triangles.size(), k_no_values);
    };
    complete(mesh.normals), complete(mesh.uv), complete(mesh.uv1), complete(mesh.colors);
    return part;
  }

  void append(const aiMesh& from, unsigned number, VertexWelder& welder, Part& part) {
    TriangleMesh& mesh = part.mesh;
    const std::size_t before = mesh.triangles.size();
    const std::vector<Triangle> corners = triangles_of(from, number);
    note_mesh(from, number);
    if (corners.empty()) return;
    const std::uint32_t slot = material_slot(from, number, part);
    mesh.material.resize(before + corners.size(), slot);
    std::vector<Vec3> points(from.mNumVertices);
    for (unsigned v = 0; v < from.mNumVertices; ++v) points[v] = scene_.millimetres_per_unit * vec3(from.mVertices[v]);
    std::vector<Index> welded(points.size(), k_no_value);
    for (const Triangle& c : corners) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        Index& index = welded[c[k]];
        if (index == k_no_value) index = welder.add(points[c[k]]);
        triangle[k] = index;
      }
      mesh.triangles.push_back(triangle);
    }
    if (from.HasNormals()) append_values(mesh.normals, normals_of(from), corners, before);
    if (from.mTextureCoords[0] != nullptr) append_values(mesh.uv, uv_of(from, 0), corners, before);
    if (from.mTextureCoords[1] != nullptr) append_values(mesh.uv1, uv_of(from, 1), corners, before);
    if (from.mColors[0] != nullptr) append_values(mesh.colors, colors_of(from), corners, before);
  }

  /// Corner numbers of the mesh's faces, cut into triangles.
  std::vector<Triangle> triangles_of(const aiMesh& from, unsigned number) {
    if (from.mNumFaces > 0 && (from.mVertices == nullptr || from.mFaces == nullptr))
      fail(place(from, number) + " has no positions");
    for (unsigned v = 0; v < from.mNumVertices; ++v)
      if (!is_finite(vec3(from.mVertices[v]))) fail(fmt::format("{}: vertex {} is not finite", place(from, number), v));
    std::vector<Triangle> triangles;
    std::vector<Vec3> polygon;
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
      const std::span<const unsigned> face(from.mFaces[f].mIndices, from.mFaces[f].mNumIndices);
      for (const unsigned index : face)
        if (index >= from.mNumVertices)
          fail(fmt::format("{}, face {}: vertex {} of {}", place(from, number), f, index, from.mNumVertices));
      if (face.size() < 3) continue;
      if (face.size() == 3) {
        triangles.push_back({face[0], face[1], face[2]});
        continue;
      }
      polygon.clear();
      for (const unsigned index : face) polygon.push_back(vec3(from.mVertices[index]));
      try {
        for (const auto& t : triangulate_polygon(polygon)) triangles.push_back({face[t[0]], face[t[1]], face[t[2]]});
      } catch (const InvalidInput& error) {
        fail(fmt::format("{}, face {}: {}", place(from, number), f, error.what()));
      }
    }
    return triangles;
  }

  std::vector<Vec3> normals_of(const aiMesh& from) {
    std::vector<Vec3> normals(from.mNumVertices);
    for (unsigned v = 0; v < from.mNumVertices; ++v) {
      normals[v] = vec3(from.mNormals[v]);
      if (is_finite(normals[v])) {
        normals[v] = normalized(normals[v]);
      } else {
        normals[v] = {};
        warnings_.add("normals are not finite and are ignored");
      }
    }
    return normals;
  }

  std::vector<Vec2> uv_of(const aiMesh& from, int channel) {
    std::vector<Vec2> uv(from.mNumVertices);
    for (unsigned v = 0; v < from.mNumVertices; ++v) {
      const aiVector3D& at = from.mTextureCoords[channel][v];
      uv[v] = {at.x, at.y};
      if (is_finite(uv[v])) continue;
      uv[v] = {};
      warnings_.add("texture coordinates are not finite and read as 0");
    }
    return uv;
  }

  std::vector<Color> colors_of(const aiMesh& from) {
    std::vector<Color> colors(from.mNumVertices);
    for (unsigned v = 0; v < from.mNumVertices; ++v) {
      const aiColor4D& c = from.mColors[0][v];
      if (std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a))
        colors[v] = color_from_srgb(c.r, c.g, c.b, c.a);
      else
        warnings_.add("colours are not finite and read as white");
    }
    return colors;
  }

  std::uint32_t material_slot(const aiMesh& from, unsigned number, Part& part) {
    if (scene_.materials.empty()) return 0;
    if (from.mMaterialIndex >= scene_.materials.size())
      fail(fmt::format("{} has material {} of {}", place(from, number), from.mMaterialIndex, scene_.materials.size()));
    const auto found = std::find(part.materials.begin(), part.materials.end(), from.mMaterialIndex);
    if (found == part.materials.end()) part.materials.push_back(from.mMaterialIndex);
    return static_cast<std::uint32_t>(std::find(part.materials.begin(), part.materials.end(), from.mMaterialIndex) -
                                      part.materials.begin());
  }

  /// What a mesh has that a part has no place for; each mesh once.
  void note_mesh(const aiMesh& from, unsigned number) {
    if (!noted_.insert(number).second) return;
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
      if (from.mFaces[f].mNumIndices == 1) losses_.add("points");
      if (from.mFaces[f].mNumIndices == 2) losses_.add("lines");
    }
    losses_.add("bones (skinned meshes are read at rest)", from.mNumBones);
    losses_.add("morph targets", from.mNumAnimMeshes);
    for (unsigned i = 2; i < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++i)
      if (from.mTextureCoords[i] != nullptr) losses_.add("sets of texture coordinates beyond the second");
    for (unsigned i = 1; i < AI_MAX_NUMBER_OF_COLOR_SETS; ++i)
      if (from.mColors[i] != nullptr) losses_.add("sets of vertex colours beyond the first");
  }

  /// assimp makes a material up where there is none, and keeps those of lines and points.
  void drop_unused_materials() {
    std::vector<std::uint32_t> numbers(scene_.materials.size(), k_no_value);
    std::vector<Material> used;
    for (Part& part : scene_.parts)
      for (std::uint32_t& material : part.materials) {
        if (numbers[material] == k_no_value) {
          numbers[material] = static_cast<std::uint32_t>(used.size());
          used.push_back(std::move(scene_.materials[material]));
        }
        material = numbers[material];
      }
    scene_.materials = std::move(used);
  }

  void note_rest() {
    losses_.add("animations", from_.mNumAnimations);
    losses_.add("cameras", from_.mNumCameras);
    losses_.add("lights", from_.mNumLights);
    for (const std::string& line : losses_.lines()) scene_.losses.push_back(line);
    for (const std::string& line : warnings_.lines()) scene_.warnings.push_back(line);
  }

  const aiScene& from_;
  const std::string& file_;
  Scene& scene_;
  std::map<std::vector<unsigned>, std::optional<std::uint32_t>> parts_;
  std::set<unsigned> noted_;
  Tally losses_, warnings_;
};

}  // namespace

void Tally::add(const std::string& kind, std::size_t count) {
  if (count == 0) return;
  const auto known =
      std::find_if(counts_.begin(), counts_.end(), [&](const auto& entry) { return entry.first == kind; });
  if (known == counts_.end())
    counts_.emplace_back(kind, count);
  else
    known->second += count;
}

std::vector<std::string> Tally::lines() const {
  std::vector<std::string> lines;
  for (const auto& [kind, count] : counts_) lines.push_back(fmt::format("{} {}", count, kind));
  return lines;
}

void convert_assimp_scene(const aiScene& from, const std::string& file, Scene& scene) {
  Converter(from, file, scene).convert();
  assign_part_ids(scene);
}

}  // namespace papilla
