// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

struct aiMaterial;
struct aiScene;

namespace papilla {

/// Counts of one kind of loss or oddity each, in the order of first use.
class Tally {
 public:
  void add(const std::string& kind, std::size_t count = 1);
  /// "3 kind" for each kind with a count.
  std::vector<std::string> lines() const;

 private:
  std::vector<std::pair<std::string, std::size_t>> counts_;
};

/// Adds nodes, parts and materials of what assimp read to a scene that has its unit, and what has no place to `losses`
/// and `warnings`. Of pictures: Scene::images has embedded ones with their bytes, others with their path as `uri`.
/// @param file  as messages name it.
/// @throws InvalidInput when a position or a transform is not finite, an index is out of range, nodes are nested deeper
///         than 1024 levels, or there is no triangle.
void convert_assimp_scene(const aiScene& from, const std::string& file, Scene& scene);

/// Appends the material.
void convert_assimp_material(const aiMaterial& from, const aiScene& owner, Tally& losses, Scene& scene);

}  // namespace papilla
