// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/meshing/sight_lines.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"
#include "papilla/pipeline/pictures/uv_layout.hpp"
#include "pictures/relief.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

/// More layouts than this are no longer looked at; the largest surfaces are drawn.
constexpr std::size_t k_most_layouts = 24;

/// A name that is safe in any file system: letters, digits, dot and dash, at most 60 characters.
std::string file_name(const std::string& label) {
  std::string name;
  for (const char c : label.substr(0, 60))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.' ? c : '_';
  return name.empty() ? "unnamed" : name;
}

/// Writes pictures into one folder under names that do not repeat.
class PictureFolder {
 public:
  PictureFolder(std::filesystem::path folder, std::size_t expected, const ProgressCallback& progress)
      : folder_(std::move(folder)), expected_(expected), progress_(progress) {}

  void add(const std::string& label, const ColorImage& image) { write(unique(label), encode_png(image)); }
  void add(const std::string& label, const std::vector<std::byte>& png) { write(unique(label), png); }
  std::vector<std::string> names() const { return names_; }

 private:
  std::string unique(const std::string& label) {
    const std::string stem = file_name(label);
    std::string name = stem;
    for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}-{}", stem, i);
    return name + ".png";
  }
  void write(const std::string& name, const std::vector<std::byte>& png) {
    write_atomically(folder_ / name, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    names_.push_back(name);
    report_progress(progress_, "pictures", static_cast<double>(names_.size()) / static_cast<double>(expected_));
  }

  std::filesystem::path folder_;
  std::size_t expected_;
  const ProgressCallback& progress_;
  std::set<std::string> taken_;
  std::vector<std::string> names_;
};

std::vector<const BakedSurface*> largest_surfaces(const std::vector<BakedSurface>& surfaces) {
  std::vector<const BakedSurface*> order;
  for (const BakedSurface& surface : surfaces) order.push_back(&surface);
  std::stable_sort(order.begin(), order.end(), [](const BakedSurface* a, const BakedSurface* b) {
    return a->distortion.area_mm2 > b->distortion.area_mm2;
  });
  order.resize(std::min(order.size(), k_most_layouts));
  return order;
}

/// The spot of a surface nearest to the middle of its area before which nothing stands in the way, with the normal
/// there, in the frame of the scene; the nearest of all when that is true of none.
/// @param extent_mm  Height of what is seen; less for a surface that is smaller, which then fills the picture.
std::optional<CloseUp> close_up_of(const BakedSurface& surface, const std::vector<Instance>& uses, UpAxis up,
                                   const SightLines& sight, double extent_mm) {
  const auto use = std::find_if(uses.begin(), uses.end(), [&](const Instance& u) { return u.part == surface.part; });
  if (use == uses.end()) return std::nullopt;
  std::vector<CloseUp> spots;
  Vec3 sum;
  double area = 0;
  Bounds3 bounds;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    const auto corner = [&](int k) { return transform_point(use->world, surface.mesh.corner(t, k)); };
    const Vec3 twice = cross(corner(1) - corner(0), corner(2) - corner(0));
    if (!(norm(twice) > 0)) continue;
    spots.push_back({(1.0 / 3) * (corner(0) + corner(1) + corner(2)), normalized(twice)});
    sum = sum + norm(twice) * spots.back().point;
    area += norm(twice);
    for (int k = 0; k < 3; ++k) bounds.add(corner(k));
  }
  if (spots.empty()) return std::nullopt;
  for (CloseUp& spot : spots) spot.extent_mm = std::min(extent_mm, bounds.diagonal());
  const auto aside = [&](const CloseUp& spot) { return norm(spot.point - (1 / area) * sum); };
  std::stable_sort(spots.begin(), spots.end(), [&](const CloseUp& a, const CloseUp& b) { return aside(a) < aside(b); });
  const auto seen = std::find_if(spots.begin(), spots.end(), [&](const CloseUp& spot) {
    return sight.sees(camera_position(spot, up), transform_point(to_y_up(up), spot.point));
  });
  return seen == spots.end() ? spots.front() : *seen;
}

/// The largest surface of every grain, so near that three repeats of it or the whole surface fill the picture.
void add_close_ups(const BakeResult& result, const std::vector<const BakedSurface*>& by_size, SceneViewOptions render,
                   PictureFolder& pictures) {
  render.mode = RenderMode::material;
  render.width = render.height = 800;
  const std::vector<Instance> uses = instances(result.scene);
  const SightLines sight(placed_meshes(result.scene, uses, to_y_up(result.scene.up)));
  for (const auto& [name, grain] : result.grains) {
    const auto largest =
        std::find_if(by_size.begin(), by_size.end(), [&](const BakedSurface* s) { return s->material == name; });
    if (largest == by_size.end()) continue;
    render.close_up =
        close_up_of(**largest, uses, result.scene.up, sight, 3 * std::max(grain.size_mm[0], grain.size_mm[1]));
    if (render.close_up) pictures.add("close-up-" + name, render_scene(result.scene, render));
  }
}

}  // namespace

std::vector<std::string> write_bake_pictures(const BakeResult& result, const std::filesystem::path& folder,
                                             std::shared_ptr<const EnvironmentLight> environment,
                                             const ProgressCallback& progress) {
  const std::vector<const BakedSurface*> surfaces = largest_surfaces(result.surfaces);
  PictureFolder pictures(folder, 2 + surfaces.size() + 3 * result.grains.size(), progress);
  SceneViewOptions render;
  render.mm_per_uv = result.mm_per_uv;
  render.environment = std::move(environment);
  pictures.add("scene", render_scene(result.scene, render));
  render.mode = RenderMode::checker;
  pictures.add("scene-checker", render_scene(result.scene, render));
  add_close_ups(result, surfaces, render, pictures);
  for (const BakedSurface* surface : surfaces)
    pictures.add("uv-" + surface->label, draw_uv_layout(surface->mesh.uv, surface->distortion));
  for (const auto& [name, grain] : result.grains) {
    double exaggeration = 1;
    pictures.add("relief-" + name, draw_relief(grain.relief, exaggeration));
    pictures.add("height-" + name, grain.height_png.bytes);
  }
  return pictures.names();
}

}  // namespace papilla
