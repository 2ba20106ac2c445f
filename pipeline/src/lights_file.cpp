// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "json_value.hpp"
#include "lights_value.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/pipeline/stereo_file.hpp"

namespace papilla {
namespace {

constexpr double k_farthest = 1e6;

Vec2 read_place(const JsonValue& value) {
  const auto numbers = value.list();
  if (numbers.size() != 2) value.fail("must be [x, y] in pixels");
  return {numbers[0].number(-k_farthest, k_farthest), numbers[1].number(-k_farthest, k_farthest)};
}

Vec3 read_direction(const JsonValue& value) {
  const auto numbers = value.list();
  if (numbers.size() != 3) value.fail("must be [x, y, z]");
  const Vec3 direction{numbers[0].number(-k_farthest, k_farthest), numbers[1].number(-k_farthest, k_farthest),
                       numbers[2].number(-k_farthest, k_farthest)};
  if (!(normalized(direction).z > 0)) value.fail("the light must come from the front: z above 0");
  return direction;
}

void read_line(const JsonValue& value, HeightReference& reference) {
  reference.from_px = read_place(value.require("from_px"));
  reference.to_px = read_place(value.require("to_px"));
}

void read_object(const JsonValue& value, const std::filesystem::path& source,
                 std::vector<HeightReference>& references) {
  using Kind = HeightReference::Kind;
  constexpr double k_least_mm = 1e-6;
  value.expect_keys(
      {"ruler_mm", "grid_mm", "step_mm", "profile_csv", "shadow", "from_px", "to_px", "low_px", "high_px", "$comment"});
  const std::size_t before = references.size();
  const auto add = [&](const char* key, Kind kind) -> HeightReference* {
    const auto length = value.get(key);
    if (!length) return nullptr;
    references.push_back({kind, length->number(k_least_mm, k_farthest), {}, {}, {}});
    return &references.back();
  };
  if (HeightReference* ruler = add("ruler_mm", Kind::ruler)) read_line(value, *ruler);
  add("grid_mm", Kind::grid);
  if (HeightReference* step = add("step_mm", Kind::step)) {
    step->from_px = read_place(value.require("low_px"));
    step->to_px = read_place(value.require("high_px"));
  }
  if (const auto file = value.get("profile_csv")) {
    const auto found = resolve_reference({source.parent_path(), source.string() + ": at profile_csv", file->text()});
    if (!found) file->fail("there is no file '" + file->text() + "'");
    references.push_back({Kind::profile, 0, {}, {}, *found});
    read_line(value, references.back());
  }
  if (const auto shadow = value.get("shadow")) {
    shadow->expect_keys({"from_px", "to_px"});
    references.push_back({Kind::shadow, 0, {}, {}, {}});
    read_line(*shadow, references.back());
  }
  if (references.size() == before) value.fail("one of ruler_mm, grid_mm, step_mm, profile_csv, shadow is needed");
}

}  // namespace

StereoLights lights_of_value(const JsonValue& root, std::size_t photographs) {
  StereoLights file;
  if (root.json().is_string()) {
    root.one_of({"unknown"});
    return file;
  }
  const bool is_list = root.json().is_array();
  if (!is_list) root.expect_keys({"lights", "sphere", "$comment"});
  if (const auto sphere = is_list ? std::nullopt : root.get("sphere")) {
    if (root.get("lights")) root.fail("either lights or a sphere");
    sphere->expect_keys({"centre_px", "radius_px", "kind"});
    file.sphere =
        LightSphere{read_place(sphere->require("centre_px")), sphere->require("radius_px").number(4, k_farthest),
                    sphere->require("kind").one_of({"mirror", "matte"}) == "mirror"};
    return file;
  }
  const JsonValue lights = is_list ? root : root.require("lights");
  if (lights.json().is_string()) {
    lights.one_of({"unknown"});
    return file;
  }
  for (const JsonValue& light : lights.list()) file.directions.push_back(read_direction(light));
  if (file.directions.size() != photographs)
    lights.fail(std::to_string(file.directions.size()) + " lights for " + std::to_string(photographs) + " photographs");
  return file;
}

StereoLights read_lights(const std::filesystem::path& path, std::size_t photographs) {
  const JsonValue::Json json = read_json(path);
  StereoLights lights = lights_of_value(JsonValue(json, path.string(), ""), photographs);
  lights.source = path.string();
  return lights;
}

std::vector<HeightReference> references_of_value(const JsonValue& root, const std::filesystem::path& source) {
  std::vector<HeightReference> references;
  if (root.json().is_array())
    for (const JsonValue& value : root.list()) read_object(value, source, references);
  else
    read_object(root, source, references);
  if (references.empty()) root.fail("at least one reference is needed");
  return references;
}

std::vector<HeightReference> read_references(const std::filesystem::path& path) {
  const JsonValue::Json json = read_json(path);
  return references_of_value(JsonValue(json, path.string(), ""), path);
}

}  // namespace papilla
