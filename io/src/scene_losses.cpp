// SPDX-License-Identifier: MIT
#include "scene_losses.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "papilla/core/one_line.hpp"

namespace papilla {
namespace {

class Losses {
 public:
  Losses(const Scene& scene, const FormatKeeps& keeps) : scene_(scene), keeps_(keeps), instances_(instances(scene)) {
    for (const Instance& instance : instances_) parts_.insert(instance.part);
    for (const std::uint32_t part : parts_)
      for (const std::uint32_t material : scene.parts[part].materials)
        if (material < scene.materials.size()) materials_.insert(material);
  }

  std::vector<std::string> list() {
    note_structure();
    note_attributes();
    note_materials();
    note_extras();
    return std::move(losses_);
  }

 private:
  void note(bool kept, std::size_t count, const char* what) {
    if (!kept && count > 0) losses_.push_back(fmt::format("{} {}", count, what));
  }

  template <class Has>
  std::size_t parts_with(Has has) const {
    return static_cast<std::size_t>(
        std::count_if(parts_.begin(), parts_.end(), [&](std::uint32_t part) { return has(scene_.parts[part]); }));
  }

  template <class Has>
  std::size_t materials_with(Has has) const {
    return static_cast<std::size_t>(std::count_if(
        materials_.begin(), materials_.end(), [&](std::uint32_t material) { return has(scene_.materials[material]); }));
  }

  void note_structure() {
    if (instances_.size() > 1)
      note(keeps_.parts, instances_.size(),
           "parts become one, without their names; where they touch, edges have more than two triangles");
    note(keeps_.nodes, instances_.size() - parts_.size(), "repeated parts are written out once more");
    const auto grouping = std::count_if(scene_.nodes.begin(), scene_.nodes.end(),
                                        [](const Node& node) { return !node.children.empty(); });
    note(keeps_.nodes, static_cast<std::size_t>(grouping), "nodes above parts (their transforms are applied)");
  }

  void note_attributes() {
    note(keeps_.normals, parts_with([](const Part& p) { return !p.mesh.normals.empty(); }), "parts' normals");
    note(keeps_.uv, parts_with([](const Part& p) { return !p.mesh.uv.empty(); }), "parts' texture coordinates");
    note(keeps_.uv1, parts_with([](const Part& p) { return !p.mesh.uv1.empty(); }),
         "parts' second texture coordinates");
    note(keeps_.cad_uv, parts_with([](const Part& p) { return !p.mesh.cad_uv.empty(); }), "parts' CAD (u,v)");
    note(keeps_.colors, parts_with([](const Part& p) { return !p.mesh.colors.empty(); }), "parts' vertex colours");
    note(keeps_.faces, parts_with([](const Part& p) { return !p.mesh.face.empty(); }), "parts' face numbers");
  }

  void note_materials() {
    note(keeps_.materials, materials_.size(), "materials");
    if (!keeps_.materials || keeps_.all_of_materials) return;
    note(false, materials_with([](const Material& m) { return m.metallic_roughness_texture || m.occlusion_texture; }),
         "materials' roughness, metalness or occlusion pictures");
    note(false, materials_with([](const Material& m) { return !m.extensions_json.empty(); }), "materials' extensions");
    note(false, materials_with([](const Material& m) { return m.haptic || !m.extras_json.empty(); }),
         "materials' extras, the haptic tag among them");
  }

  void note_extras() {
    const auto nodes =
        std::count_if(scene_.nodes.begin(), scene_.nodes.end(), [](const Node& n) { return !n.extras_json.empty(); });
    note(keeps_.extras, static_cast<std::size_t>(nodes), "nodes' extras");
    note(keeps_.extras, parts_with([](const Part& p) { return !p.extras_json.empty(); }), "parts' extras");
    note(keeps_.extras, scene_.extras_json.empty() ? 0 : 1, "scene's extras");
    if (!keeps_.extras && !scene_.asset.copyright.empty())
      losses_.push_back("copyright notice: " + one_line(scene_.asset.copyright));
  }

  const Scene& scene_;
  FormatKeeps keeps_;
  std::vector<Instance> instances_;
  std::set<std::uint32_t> parts_, materials_;
  std::vector<std::string> losses_;
};

}  // namespace

std::vector<std::string> scene_losses(const Scene& scene, const FormatKeeps& keeps) {
  return Losses(scene, keeps).list();
}

}  // namespace papilla
