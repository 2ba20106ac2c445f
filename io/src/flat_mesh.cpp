// SPDX-License-Identifier: MIT
#include "flat_mesh.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "papilla/core/error.hpp"
#include "placed_mesh.hpp"
#include "vertex_values.hpp"

namespace papilla {
namespace {

/// An attribute that every part so far had once per position.
template <class T>
class VertexList {
 public:
  /// @param values  nothing: the part has none, or they jump.
  void add(const std::optional<std::vector<T>>& values) {
    complete_ = complete_ && values;
    if (complete_) values_.insert(values_.end(), values->begin(), values->end());
  }
  std::vector<T> take() { return complete_ ? std::move(values_) : std::vector<T>(); }

 private:
  bool complete_ = true;
  std::vector<T> values_;
};

/// Texture coordinates: with the vertices, or else with the triangles.
class UvList {
 public:
  void add(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv) {
    of_vertices_.add(value_per_position(mesh, uv));
  }

  /// @param number  of the triangle in the flat mesh.
  void add(const CornerAttribute<Vec2>& uv, std::size_t t, const std::array<std::size_t, 3>& order,
           std::size_t number) {
    if (!uv.has_value(t)) return;
    of_triangles_.resize(number + 1);
    auto& corners = of_triangles_.back().emplace();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = uv.values[uv.indices[t][order[k]]];
  }

  void take(std::vector<Vec2>& of_vertices, std::vector<std::optional<std::array<Vec2, 3>>>& of_triangles,
            std::size_t triangles) {
    of_vertices = of_vertices_.take();
    if (!of_vertices.empty() || of_triangles_.empty()) return;
    of_triangles = std::move(of_triangles_);
    of_triangles.resize(triangles);
  }

 private:
  VertexList<Vec2> of_vertices_;
  std::vector<std::optional<std::array<Vec2, 3>>> of_triangles_;
};

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene) {}

  FlatMesh flatten() {
    for (const Instance& instance : instances(scene_)) add(place(scene_, instance));
    flat_.normals = normals_.take();
    uv_.take(flat_.uv, flat_.triangle_uv, flat_.triangles.size());
    cad_uv_.take(flat_.cad_uv, flat_.triangle_cad_uv, flat_.triangles.size());
    if (has_colors_) flat_.colors = colors_.take();
    flat_.keeps.normals = !flat_.normals.empty();
    flat_.keeps.colors = !flat_.colors.empty();
    flat_.keeps.uv = flat_.keeps.cad_uv = true;
    return std::move(flat_);
  }

 private:
  void add(const PlacedMesh& placed) {
    const TriangleMesh& mesh = placed.part->mesh;
    if (flat_.positions.size() + mesh.positions.size() >= k_no_value)
      throw InvalidInput("write: the scene has more than 2^32 - 2 positions");
    normals_.add(value_per_position<Vec3>(mesh, {placed.normals, mesh.normals.indices}));
    uv_.add(mesh, mesh.uv);
    cad_uv_.add(mesh, mesh.cad_uv);
    has_colors_ |= !mesh.colors.empty();
    colors_.add(mesh.colors.empty() ? std::vector<Color>(mesh.positions.size())
                                    : value_per_position(mesh, mesh.colors));
    add_triangles(placed);
    flat_.positions.insert(flat_.positions.end(), placed.positions.begin(), placed.positions.end());
  }

  void add_triangles(const PlacedMesh& placed) {
    const TriangleMesh& mesh = placed.part->mesh;
    const auto offset = static_cast<Index>(flat_.positions.size());
    const auto order = corner_order(placed);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      flat_.triangles.push_back({offset + corners[order[0]], offset + corners[order[1]], offset + corners[order[2]]});
      uv_.add(mesh.uv, t, order, flat_.triangles.size() - 1);
      cad_uv_.add(mesh.cad_uv, t, order, flat_.triangles.size() - 1);
    }
  }

  const Scene& scene_;
  FlatMesh flat_;
  VertexList<Vec3> normals_;
  UvList uv_, cad_uv_;
  VertexList<Color> colors_;
  bool has_colors_ = false;
};

}  // namespace

FlatMesh flatten(const Scene& scene) { return Flattener(scene).flatten(); }

}  // namespace papilla
