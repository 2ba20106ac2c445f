// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_surfaces.hpp"

#include <cstdint>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/studio/shown_levels.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {

std::shared_ptr<const StudioSurface> StudioSurfaces::asked(const Query& query) const {
  if (query.contains("id")) {
    const auto made = worker_.find(query.at("id"));
    if (!made) throw InvalidInput("the surface is not there yet");
    return made;
  }
  const auto scene = desk_.scene();
  const std::uint32_t part = number_of(query, "part"), slot = number_of(query, "slot");
  if (!scene || part >= scene->scene().parts.size()) throw InvalidInput("there is no such surface");
  return std::make_shared<const StudioSurface>(scene->as_read(part, slot));
}

PageAnswer StudioSurfaces::surface(const Query& query) const {
  return bytes_answer("application/octet-stream", surface_bytes(*asked(query)));
}

PageAnswer StudioSurfaces::levels(const Query& query) const {
  const auto surface = worker_.find(required(query, "id"));
  std::vector<ShownLevel> levels;
  if (surface) {
    const std::scoped_lock lock(levels_mutex_);
    levels = shown_levels(surface->mesh, cache_, [this](const Progress&) { return !is_cancelled_; });
  }
  return bytes_answer("application/octet-stream", level_bytes(levels));
}

PageAnswer StudioSurfaces::height(const Query& query) const {
  return bytes_answer("image/png", height_bytes(*asked(query), desk_.scene_file()));
}

PageAnswer StudioSurfaces::picture(const Query& query) const {
  const auto made = query.contains("id") ? worker_.find(query.at("id")) : nullptr;
  std::shared_ptr<const Scene> look = made ? made->look : nullptr;
  if (!look)
    if (const auto scene = desk_.scene(); scene && query.contains("part")) {
      const std::uint32_t part = number_of(query, "part");
      if (part < scene->scene().parts.size()) look = scene->as_read(part, number_of(query, "slot")).look;
    }
  const std::uint32_t number = number_of(query, "image");
  if (!look) throw InvalidInput("there is no such picture");
  return picture_answer(*look, number);
}

void add_surface_routes(StudioRoutes& routes, const StudioSurfaces& surfaces) {
  const auto add = [&](const char* path, PageAnswer (StudioSurfaces::*answer)(const Query&) const) {
    routes.get[path] = [&surfaces, answer](const Query& query) { return (surfaces.*answer)(query); };
  };
  add("/surface", &StudioSurfaces::surface);
  add("/levels", &StudioSurfaces::levels);
  add("/height", &StudioSurfaces::height);
  add("/picture", &StudioSurfaces::picture);
}

}  // namespace papilla::app
