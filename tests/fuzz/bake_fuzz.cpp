// SPDX-License-Identifier: GPL-3.0-or-later
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <optional>

#include "fuzz_input.hpp"
#include "gltf_mutator.hpp"
#include "materials_mutator.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/io/image_bands.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "scene_promises.hpp"

namespace {

using namespace papilla;

/// Limits that keep a bake within milliseconds.
constexpr std::size_t k_most_triangles = 120, k_most_pixels = 1024, k_most_uses = 64;

/// What fits in: the bake of recipes, which are rendered large, has targets of its own.
bool is_small(const Scene& scene, const Materials& rules, const RecipeLibrary& library) {
  std::size_t triangles = 0;
  for (const Part& part : scene.parts) triangles += part.mesh.triangles.size();
  if (triangles > k_most_triangles || instances(scene).size() > k_most_uses) return false;
  for (const auto& [name, rule] : rules.materials) {
    if (rule.texture.empty()) continue;
    if (rule.texture.filename() != "grain.png" || looks_like_recipe(rule.recipe, library)) return false;
    ImageBands(rule.texture, k_most_pixels);
  }
  return true;
}

/// The grammar of a whole input.
const fuzz::JsonGrammar& grammar() {
  static const fuzz::JsonGrammar made = [] {
    fuzz::JsonGrammar both = fuzz::gltf_grammar();
    const fuzz::JsonGrammar& rules = fuzz::materials_grammar();
    both.ranges.insert(both.ranges.begin(), rules.ranges.begin(), rules.ranges.end());
    both.words.insert(both.words.end(), rules.words.begin(), rules.words.end());
    both.sample = {{"scene", both.sample},
                   {"rules", rules.sample},
                   {"options", {{"budget", 8}, {"reach", {0, 0, 0, 500}}, {"leave_out", true}}}};
    return both;
  }();
  return made;
}

BakeOptions bake_options(const fuzz::Json& input) {
  BakeOptions options;
  const fuzz::Json given = input.value("options", fuzz::Json::object());
  if (!given.is_object()) return options;
  if (given.contains("budget") && given["budget"].is_number_unsigned())
    options.plan.budget = std::max<std::size_t>(1, given["budget"].get<std::size_t>());
  const fuzz::Json reach = given.value("reach", fuzz::Json());
  if (!reach.is_array() || reach.size() != 4 ||
      !std::all_of(reach.begin(), reach.end(), [](const fuzz::Json& x) { return x.is_number(); }))
    return options;
  options.plan.perception.samples = 16;
  for (auto* volumes : {&options.plan.perception.reach, &options.plan.perception.view})
    volumes->push_back(SphereVolume{{reach[0].get<double>(), reach[1].get<double>(), reach[2].get<double>()},
                                    std::max(1e-3, reach[3].get<double>())});
  options.plan.perception.leave_out_unreachable = given.value("leave_out", fuzz::Json()) == true;
  return options;
}

}  // namespace

/// {"scene": glTF, "rules": MATERIALS.json, "picture": data: URI of grain.png, "options": {...}}, then what
/// `papilla bake` does. What it writes has to be read again, by the toolkit and by the player.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  static const RecipeLibrary library = RecipeLibrary::builtin();
  const auto input = fuzz::parse_blob_document(fuzz::text_of(data, size));
  if (!input || input->glb) return 0;
  fuzz::BlobDocument whole = *input;
  const auto* picture = whole.blob_of(whole.json.value("picture", fuzz::Json()));
  fuzz::write_input("grain.png", picture == nullptr ? "" : picture->bytes);
  const auto rules_file = fuzz::write_input("rules.json", whole.json.value("rules", fuzz::Json()).dump());
  fuzz::BlobDocument gltf = *input;
  gltf.json = whole.json.value("scene", fuzz::Json());
  const auto scene_file = fuzz::write_input("scene.gltf", to_bytes(gltf));

  std::optional<Scene> scene;
  Materials rules;
  const bool read = fuzz::expect_read([&] {
    rules = read_materials(rules_file);
    scene = read_scene(scene_file);
    if (!is_small(*scene, rules, library)) scene.reset();
  });
  if (!read || !scene) return 0;
  const auto baked = fuzz::write_input("baked.glb", "");
  bool written = false;
  fuzz::expect_result_or_refusal([&] {
    const BakeResult result = bake_scene(std::move(*scene), rules, bake_options(whole.json));
    write_glb(result.scene, baked, {.mirror_mpeg_haptics = true, .mirror_khr_physics = true});
    written = true;
  });
  if (!written) return 0;
  fuzz::require_promises(read_scene(baked));
  fuzz::expect_result_or_refusal([&] { load_haptic_scene(baked); });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return fuzz::mutate_scene(data, size, max_size, seed, grammar(), [](fuzz::Json& input) {
    fuzz::repair_materials(input["rules"]);
    for (auto& [name, material] : input["rules"]["materials"].items())
      if (material.contains("texture")) material["texture"] = "grain.png";
  });
}
