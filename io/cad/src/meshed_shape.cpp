// SPDX-License-Identifier: MIT
#include "meshed_shape.hpp"

#include <BinTools.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>

#include "cad_parallel.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla::cad {
namespace {

MeshedShape meshed(TessellatedShape shape) {
  MeshedShape result;
  result.faces = shape.faces.size();
  result.added_nodes = shape.added_nodes;
  result.troubles = std::move(shape.troubles);
  result.off = std::move(shape.off);
  result.max_deviation_mm = shape.max_deviation_mm, result.max_angle_deg = shape.max_angle_deg;
  ShapeMesh mesh = to_mesh(std::move(shape));
  result.mesh = std::move(mesh.mesh);
  result.dropped_triangles = mesh.dropped_triangles;
  return result;
}

/// Numbers of the shapes that share edges, ascending, and the groups by their first.
std::vector<std::vector<std::size_t>> groups_with_common_edges(const std::vector<TopoDS_Shape>& shapes) {
  UnionFind joined(shapes.size());
  std::unordered_map<const TopoDS_TShape*, std::size_t> first_with;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shapes[i], TopAbs_EDGE, edges);
    for (int e = 1; e <= edges.Extent(); ++e) {
      const auto [first, is_new] = first_with.try_emplace(edges(e).TShape().get(), i);
      if (!is_new) joined.unite(static_cast<std::uint32_t>(first->second), static_cast<std::uint32_t>(i));
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < shapes.size(); ++i) by_root[joined.find(static_cast<std::uint32_t>(i))].push_back(i);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [root, members] : by_root) groups.push_back(std::move(members));
  std::sort(groups.begin(), groups.end());
  return groups;
}

/// Geometry and topology of a shape as OpenCASCADE's binary format has them, without triangles.
std::string brep_of(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BinTools::Write(shape, out, false, false, BinTools_FormatVersion_CURRENT);
  return std::move(out).str();
}

Digest key_of_group(const std::vector<TopoDS_Shape>& shapes, const std::vector<std::size_t>& group,
                    const CadReadOptions& options) {
  std::vector<Digest> geometry;
  for (const std::size_t i : group) {
    const std::string brep = brep_of(shapes[i]);
    geometry.push_back(sha256(brep.data(), brep.size()));
  }
  return key_of("tessellation", geometry, options);
}

}  // namespace

std::vector<MeshedShape> mesh_shapes(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                     const ProgressCallback& progress) {
  std::vector<MeshedShape> result(shapes.size());
  struct Missing {
    std::vector<std::size_t> group;
    Digest key;
  };
  std::vector<Missing> missing;
  std::vector<TopoDS_Shape> to_make;
  if (options.cache == nullptr) {
    to_make = shapes;
    std::vector<std::size_t> all(shapes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    missing.push_back({std::move(all), {}});
  } else {
    for (std::vector<std::size_t>& group : groups_with_common_edges(shapes)) {
      const Digest key = key_of_group(shapes, group, options);
      if (auto found = options.cache->find<std::vector<MeshedShape>>("tessellation", key);
          found && found->size() == group.size()) {
        for (std::size_t k = 0; k < group.size(); ++k) result[group[k]] = std::move((*found)[k]);
        continue;
      }
      for (const std::size_t i : group) to_make.push_back(shapes[i]);
      missing.push_back({std::move(group), key});
    }
  }
  std::vector<TessellatedShape> tessellated = tessellate(to_make, options, progress);
  std::vector<MeshedShape> made(tessellated.size());
  parallel_for(made.size(), [&](std::size_t i) { made[i] = meshed(std::move(tessellated[i])); });
  std::size_t next = 0;
  for (const Missing& one : missing) {
    std::vector<MeshedShape> group;
    for (std::size_t k = 0; k < one.group.size(); ++k) group.push_back(std::move(made[next++]));
    if (options.cache != nullptr) options.cache->put("tessellation", one.key, CacheUse::read_write, group);
    for (std::size_t k = 0; k < group.size(); ++k) result[one.group[k]] = std::move(group[k]);
  }
  return result;
}

}  // namespace papilla::cad
