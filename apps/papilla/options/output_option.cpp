// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/output_option.hpp"

#include "exit_code.hpp"
#include "option_checks.hpp"

namespace papilla::app {

void OutputOptions::add_to(CLI::App& verb) {
  auto* const compress = add_choice<MeshCoding>(verb, "--compress", meshes,
                                                {{"none", MeshCoding::none},
                                                 {"meshopt", MeshCoding::meshopt},
                                                 {"draco", MeshCoding::draco},
                                                 {"quantize", MeshCoding::quantize}},
                                                "Meshes of a glTF output, rounded and packed; grain, touch and levels "
                                                "of detail stay [none]")
                             ->group("Output");
  verb.add_option("--compress-precision", most_rounding_mm,
                  "Farthest that rounding may move a vertex; without it 1/16384 of a part's longest side, at most 0.02 "
                  "on parts up to 0.6 m")
      ->type_name("MM")
      ->check(positive())
      ->needs(compress)
      ->group("Output");
  add_choice<PictureCoding>(
      verb, "--images", pictures,
      {{"png", PictureCoding::as_is}, {"webp", PictureCoding::webp}, {"jpeg", PictureCoding::jpeg}},
      "Pictures of a glTF output: as they are, or so where that is smaller; height maps of touch stay [png]")
      ->group("Output");
}

WriteOptions OutputOptions::write_options(const std::string& output) const {
  const auto require_gltf = [&](bool asked, const char* option) {
    if (asked && !is_gltf_file(output))
      throw UsageError(std::string(option) + ": '" + output + "' must end in .glb or .gltf");
  };
  require_gltf(meshes != MeshCoding::none, "--compress");
  require_gltf(pictures != PictureCoding::as_is, "--images");
  if (most_rounding_mm > 0 && meshes == MeshCoding::none)
    throw UsageError("--compress-precision: there is nothing to round with --compress none");
  if (!can_write(meshes)) throw UsageError("--compress: this build was made without the library for it");
  WriteOptions options;
  options.meshes = meshes;
  options.most_rounding_mm = most_rounding_mm;
  options.pictures = pictures;
  return options;
}

}  // namespace papilla::app
