// SPDX-License-Identifier: MIT
#include "gltf_instancing.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "gltf_transform.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"

namespace papilla::gltf {
namespace {

/// A node costs as much memory as this many elements of an accessor.
constexpr std::size_t k_elements_per_node = 16;

class InstanceReader {
 public:
  InstanceReader(const Document& document, AccessorReader& reader) : file_(document.file), reader_(reader) {}

  /// The places of all instances, in metres.
  std::vector<Transform> read(const tinygltf::Value& attributes, const std::string& where) {
    const auto translations = numbers(attributes, "TRANSLATION", 3, where);
    const auto rotations = numbers(attributes, "ROTATION", 4, where);
    const auto scales = numbers(attributes, "SCALE", 3, where);
    const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
    const auto fits = [&](const std::vector<double>& n, std::size_t width) {
      return n.empty() || n.size() == width * count;
    };
    if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3))
      throw InvalidInput(file_ + ": " + where + ": the instances' attributes differ in number");
    reader_.spend(k_elements_per_node * count, where);
    std::vector<Transform> places;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 t = translations.empty() ? Vec3{} : vec3_at(translations, i);
      const Vec3 s = scales.empty() ? Vec3{1, 1, 1} : vec3_at(scales, i);
      std::array<double, 4> q = {0, 0, 0, 1};
      if (!rotations.empty()) std::copy_n(rotations.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, q.begin());
      places.push_back(transform_from_trs(t, q, s, file_ + ": " + where + ", instance " + std::to_string(i)));
    }
    return places;
  }

 private:
  static Vec3 vec3_at(const std::vector<double>& numbers, std::size_t i) {
    return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }

  std::vector<double> numbers(const tinygltf::Value& attributes, const char* name, int components,
                              const std::string& where) {
    if (!attributes.Has(name)) return {};
    const tinygltf::Value& accessor = attributes.Get(name);
    return reader_.numbers(accessor.IsNumber() ? accessor.GetNumberAsInt() : -1, components, where + ", " + name);
  }

  const std::string& file_;
  AccessorReader& reader_;
};

void add_children(std::vector<Transform> places, std::uint32_t number, const std::string& where, Scene& scene) {
  const auto part = scene.nodes[number].part;
  scene.nodes[number].part.reset();
  for (Transform& place : places) {
    for (const std::size_t i : {3U, 7U, 11U}) place[i] *= k_mm_per_metre;
    if (!std::all_of(place.begin(), place.end(), [](double x) { return std::isfinite(x); }))
      throw InvalidInput(where + ": an instance's transform is not finite");
    Node child;
    child.part = part;
    child.local = place;
    scene.nodes[number].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(child));
  }
}

}  // namespace

void expand_instances(const Document& document, AccessorReader& reader, Scene& scene) {
  InstanceReader instances(document, reader);
  std::set<std::string> lost;
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const auto& extensions = document.model.nodes[i].extensions;
    const auto extension = extensions.find("EXT_mesh_gpu_instancing");
    if (extension == extensions.end() || !scene.nodes[i].part) continue;
    const std::string where = "node " + std::to_string(i) + ", EXT_mesh_gpu_instancing";
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    if (!attributes.IsObject()) throw InvalidInput(document.file + ": " + where + ": attributes are missing");
    add_children(instances.read(attributes, where), static_cast<std::uint32_t>(i), document.file + ": " + where, scene);
    for (const std::string& name : attributes.Keys())
      if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE") lost.insert("instances' attribute " + name);
  }
  scene.losses.insert(scene.losses.end(), lost.begin(), lost.end());
}

}  // namespace papilla::gltf
