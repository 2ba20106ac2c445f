// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_output.hpp"

#include "papilla/io/scene_file.hpp"
#include "shown_format.hpp"

namespace papilla::app {
namespace {

const char* name_of(MeshCoding coding) {
  switch (coding) {
    case MeshCoding::none: return "none";
    case MeshCoding::meshopt: return "meshopt";
    case MeshCoding::draco: return "draco";
    case MeshCoding::quantize: break;
  }
  return "quantize";
}

const char* name_of(PictureCoding coding) {
  return coding == PictureCoding::webp ? "webp" : coding == PictureCoding::jpeg ? "jpeg" : "png";
}

}  // namespace

void print_notes(const Scene& scene, const Console& console) {
  for (const std::string& warning : scene.warnings) console.print(shown_format("warning: {}\n", warning));
  for (const std::string& loss : scene.losses) console.print(shown_format("left out: {}\n", loss));
}

Json storage_json(const WriteOptions& options, const GlbSizes& sizes) {
  const auto stored = [](const char* coding, std::size_t bytes, std::size_t uncompressed) {
    return Json{{"coding", coding}, {"bytes", bytes}, {"uncompressed", uncompressed}};
  };
  const TagPictures& tags = sizes.tag_pictures;
  return {{"meshes", stored(name_of(options.meshes), sizes.meshes, sizes.meshes_uncompressed)},
          {"images", stored(name_of(options.pictures), sizes.pictures, sizes.pictures_uncompressed)},
          {"height_maps", {{"count", tags.copies}, {"bytes", tags.bytes}, {"tags", tags.uses}}}};
}

std::string storage_text(const WriteOptions& options, const GlbSizes& sizes) {
  std::string text;
  const auto megabytes = [](std::size_t bytes) { return static_cast<double>(bytes) / 1e6; };
  if (options.meshes != MeshCoding::none)
    text += shown_format("meshes as {}: {:.2f} MB of {:.2f} MB\n", name_of(options.meshes), megabytes(sizes.meshes),
                         megabytes(sizes.meshes_uncompressed));
  if (options.pictures != PictureCoding::as_is)
    text += shown_format("pictures as {}: {:.2f} MB of {:.2f} MB\n", name_of(options.pictures),
                         megabytes(sizes.pictures), megabytes(sizes.pictures_uncompressed));
  if (const TagPictures& tags = sizes.tag_pictures; tags.copies > 0)
    text +=
        shown_format("height maps: {}, {:.2f} MB, for {} materials\n", tags.copies, megabytes(tags.bytes), tags.uses);
  return text;
}

Json write_output(Scene& scene, const std::string& path, const WriteOptions& options, const Console& console) {
  GlbSizes sizes;
  for (const std::string& loss : write_scene(scene, path, options, &sizes)) scene.losses.push_back(loss);
  print_notes(scene, console);
  if (!is_gltf_file(path)) return nullptr;
  console.print(storage_text(options, sizes));
  return storage_json(options, sizes);
}

}  // namespace papilla::app
