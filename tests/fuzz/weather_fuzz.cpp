// SPDX-License-Identifier: MIT
#include <algorithm>

#include "fuzz_input.hpp"
#include "json_mutator.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace {

const papilla::fuzz::JsonGrammar& grammar() {
  using papilla::fuzz::Json;
  static const papilla::fuzz::JsonGrammar made{
      {{"size", 16, 8192}, {"atlas", 64, 8192}, {"sky_rays", 1, 4096}, {"depth_mm", 1e-6, 100}, {"time", 0, 1}},
      {{"recipe", {"rust", "dirt|amount=.5", "formula|bump=u"}},
       {"materials", {"*", "Leather*", "[a"}},
       {"node", {"**", "a/*"}},
       {"part", {"*"}}},
      Json::parse(R"({"$comment":"c","size":256,"atlas":1024,"time":[0,0.5,1],"depth_mm":0.2,"sky_rays":16,
        "libraries":["weather.recipes"],"layers":[{"recipe":"rust","materials":["*"],"node":"**","not":{"part":"q*"}}]})")};
  return made;
}

/// Makes of a damaged configuration one that can be read.
void repair(papilla::fuzz::Json& config) {
  using papilla::fuzz::Json;
  const Json& sample = grammar().sample;
  if (!config.is_object()) config = sample;
  Json layers = config.value("layers", Json()), libraries = config.value("libraries", Json());
  for (const char* list : {"layers", "libraries"}) config.erase(list);
  papilla::fuzz::fit_json(config, sample, grammar());
  if (!layers.is_array() || layers.empty()) layers = sample["layers"];
  for (Json& layer : layers) {
    if (!layer.is_object()) layer = Json::object();
    if (!layer.contains("recipe")) layer["recipe"] = "rust";
    papilla::fuzz::fit_json(layer, sample["layers"][0], grammar());
    if (layer.contains("not") && layer["not"].empty()) layer.erase("not");
  }
  config["layers"] = layers;
  if (libraries.is_array() &&
      std::all_of(libraries.begin(), libraries.end(), [](const Json& name) { return name.is_string(); }))
    config["libraries"] = libraries;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.json", fuzz::text_of(data, size));
  fuzz::expect_read([&] {
    const WeatherConfig config = read_weather_config(path);
    fuzz::require(!config.layers.empty() && !config.times.empty(), "a configuration has layers and times");
    layered_recipe(config, {0}, 0.5);
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_json_text(data, size, max_size, seed, grammar(), repair);
}
