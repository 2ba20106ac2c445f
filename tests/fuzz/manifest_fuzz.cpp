// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "gltf_mutator.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/tag_manifest.hpp"
#include "scene_promises.hpp"

namespace {

/// Two squares in a palette's one material, beside a tagged one.
papilla::Scene scene() {
  using namespace papilla;
  Scene made;
  made.materials.resize(2);
  made.materials[0].name = "palette";
  made.materials[1].name = "Leather";
  made.materials[1].haptic = MaterialTag{};
  for (const char* name : {"p", "q"}) {
    Part part;
    part.name = name;
    part.materials = {0, 1};
    part.mesh.positions = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}, {0, 1000, 0}};
    part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    part.mesh.material = {0, 1};
    made.parts.push_back(part);
    Node node;
    node.name = "n";
    node.part = static_cast<std::uint32_t>(made.parts.size() - 1);
    made.roots.push_back(static_cast<std::uint32_t>(made.nodes.size()));
    made.nodes.push_back(node);
  }
  return made;
}

const papilla::fuzz::JsonGrammar& grammar() {
  using papilla::fuzz::Json;
  static const papilla::fuzz::JsonGrammar made = [] {
    papilla::fuzz::JsonGrammar of_gltf = papilla::fuzz::gltf_grammar();
    const Json sample = of_gltf.sample;
    of_gltf.sample = sample["asset"]["extras"];
    of_gltf.sample["hapticMaterials"] = sample["nodes"][0]["extras"]["hapticMaterials"];
    return of_gltf;
  }();
  return made;
}

/// Makes of a damaged manifest one that can be read.
void repair(papilla::fuzz::Json& extras) {
  using papilla::fuzz::Json;
  const Json& sample = grammar().sample["hapticManifest"];
  if (!extras.is_object()) extras = Json::object();
  if (extras.contains("hapticMaterials") && extras["hapticMaterials"].is_array())
    for (Json& entry : extras["hapticMaterials"])
      if (entry.is_object()) papilla::fuzz::repair_tag(entry["tag"]);
  Json& manifest = extras["hapticManifest"];
  if (!manifest.is_object()) manifest = sample;
  manifest["version"] = 1;
  for (const char* list : {"materials", "surfaces"})
    if (!manifest.contains(list) || !manifest[list].is_array()) manifest[list] = sample[list];
  for (Json& entry : manifest["materials"]) {
    if (!entry.is_object()) entry = sample["materials"][0];
    if (!entry.contains("name") || !entry["name"].is_string()) entry["name"] = "Leather";
    papilla::fuzz::repair_tag(entry["tag"]);
  }
  const std::size_t count = manifest["materials"].size();
  for (Json& surface : manifest["surfaces"]) {
    papilla::fuzz::fit_json(surface, sample["surfaces"][0], grammar());
    if (!surface.contains("area")) surface["area"] = 1;
    const bool known = surface.contains("material") && surface["material"].is_number_unsigned() && count > 0;
    surface["material"] = known ? Json(surface["material"].get<std::size_t>() % count) : Json();
  }
}

}  // namespace

/// The input is the extras of the asset, and of a node.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  Scene made = scene();
  made.asset.extras_json = made.nodes[0].extras_json = fuzz::text_of(data, size);
  fuzz::expect_read([&] {
    const auto manifest = take_tag_manifest(made);
    if (!manifest) throw InvalidInput("no manifest");
    made.tags = restore_tags(made, *manifest);
    fuzz::require(survival_sentence(made.tags).find('\n') == std::string::npos, "a sentence is one line");
    Scene again = scene();
    again.asset.extras_json = R"({"hapticManifest":)" + to_json(*manifest) + "}";
    fuzz::require(take_tag_manifest(again).has_value(), "a manifest that is written can be read");
  });
  fuzz::require_promises(made);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_json_text(data, size, max_size, seed, grammar(), repair);
}
