// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_library.hpp"

#include <memory>

#include "json/materials_json.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/pictures/material_picture.hpp"
#include "studio/studio_answers.hpp"

namespace papilla::app {

std::filesystem::path StudioLibrary::folder() const { return folder_.empty() ? find_material_library() : folder_; }

Json StudioLibrary::list() const {
  Json list = Json::array();
  for (const LibraryMaterial& material : MaterialLibrary(folder()).materials())
    list.push_back(library_material_json(material));
  return list;
}

SharedText StudioLibrary::picture(const std::string& id) const {
  constexpr int k_side = 128;
  const LibraryMaterial material = MaterialLibrary(folder()).material(id);
  const auto make = [&] {
    MaterialPictureOptions options;
    options.side_px = k_side;
    options.library = recipes_;
    options.cache = cache_;
    const std::scoped_lock lock(mutex_);
    return text_of(encode_png(material_picture(rule_of(material, id), options)));
  };
  const std::string text = read_file(material.file);
  return std::make_shared<const std::string>(
      remembered(cache_, "studio-picture", CacheUse::read_write, make, text).value);
}

void add_library_routes(StudioRoutes& routes, const StudioLibrary& library) {
  routes.get["/library"] = [&library](const Query&) { return json_answer(library.list()); };
  routes.get["/library-picture"] = [&library](const Query& query) {
    return bytes_answer("image/png", library.picture(required(query, "id")));
  };
}

}  // namespace papilla::app
