// SPDX-License-Identifier: MIT
#include "flat_mesh.hpp"

#include <algorithm>
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

class Flattener {
 public:
  explicit Flattener(const Scene& scene) : scene_(scene) {}

  FlatMesh flatten() {
    for (const Instance& instance : instances(scene_)) add(place(scene_, instance));
    flat_.normals = normals_.take();
    flat_.uv = uv_.take();
    if (has_colors_) flat_.colors = colors_.take();
    if (!flat_.uv.empty()) flat_.triangle_uv.clear();
    if (!flat_.triangle_uv.empty()) flat_.triangle_uv.resize(flat_.triangles.size());
    flat_.keeps.normals = !flat_.normals.empty();
    flat_.keeps.colors = !flat_.colors.empty();
    flat_.keeps.uv = true;
    return std::move(flat_);
  }

 private:
  void add(const PlacedMesh& placed) {
    const TriangleMesh& mesh = placed.part->mesh;
    if (flat_.positions.size() + mesh.positions.size() >= k_no_value)
      throw InvalidInput("write: the scene has more than 2^32 - 2 positions");
    normals_.add(value_per_position<Vec3>(mesh, {placed.normals, mesh.normals.indices}));
    uv_.add(value_per_position(mesh, mesh.uv));
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
      if (!mesh.uv.has_value(t)) continue;
      flat_.triangle_uv.resize(flat_.triangles.size());
      auto& uv = flat_.triangle_uv.back().emplace();
      for (std::size_t k = 0; k < 3; ++k) uv[k] = mesh.uv.values[mesh.uv.indices[t][order[k]]];
    }
  }

  const Scene& scene_;
  FlatMesh flat_;
  VertexList<Vec3> normals_;
  VertexList<Vec2> uv_;
  VertexList<Color> colors_;
  bool has_colors_ = false;
};

}  // namespace

FlatMesh flatten(const Scene& scene) { return Flattener(scene).flatten(); }

}  // namespace papilla
