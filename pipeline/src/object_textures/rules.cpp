// SPDX-License-Identifier: MIT
#include "object_textures/rules.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/pipeline/hex_colour.hpp"

namespace papilla {
namespace {

constexpr double k_largest_mm = 1e6, k_least_mm = 1e-3;

std::vector<double> read_numbers(const JsonValue& value, std::size_t count, double low, double high) {
  if (value.list().size() != count) value.fail("must be an array of " + std::to_string(count) + " numbers");
  std::vector<double> numbers;
  for (const JsonValue& v : value.list()) numbers.push_back(v.number(low, high));
  return numbers;
}

Vec3 read_vector(const JsonValue& value) {
  const std::vector<double> v = read_numbers(value, 3, -1e9, 1e9);
  return {v[0], v[1], v[2]};
}

Vec3 read_direction(const JsonValue& value) {
  const Vec3 v = read_vector(value);
  if (!(norm(v) > 0)) value.fail("must not be zero");
  return v;
}

std::filesystem::path read_path(const JsonValue& value, const std::filesystem::path& source) {
  const std::string name = value.text();
  if (name.empty()) value.fail("must not be empty");
  return source.parent_path() / name;
}

ProjectorBox read_box(const JsonValue& value) {
  ProjectorBox box;
  box.at = read_vector(value.require("at"));
  box.direction = read_direction(value.require("direction"));
  box.up = read_direction(value.require("up"));
  const std::vector<double> size = read_numbers(value.require("size_mm"), 2, k_least_mm, k_largest_mm);
  box.width_mm = size[0], box.height_mm = size[1];
  box.depth_mm = value.require("depth_mm").number(k_least_mm, k_largest_mm);
  try {
    projector_axes(box.direction, box.up);
  } catch (const InvalidInput&) {
    value.require("up").fail("must not be along 'direction'");
  }
  return box;
}

ObjectRelief read_relief(const JsonValue& value, const std::filesystem::path& source) {
  value.expect_keys({"depth_mm", "from", "picture", "max_slope"});
  ObjectRelief relief;
  relief.depth_mm = value.require("depth_mm").number(1e-3, 20);
  const auto from = value.get("from"), picture = value.get("picture");
  if (from && picture) from->fail("is of the picture that is shown, not of 'picture'");
  if (from) {
    using Source = ObjectRelief::Source;
    const std::string name = from->one_of({"auto", "alpha", "bright", "dark"});
    relief.source = name == "alpha"    ? Source::alpha
                    : name == "bright" ? Source::brightness
                    : name == "dark"   ? Source::darkness
                                       : Source::automatic;
  }
  if (picture) relief.picture = read_path(*picture, source);
  if (const auto v = value.get("max_slope")) relief.max_slope = v->number(0.01, 1000);
  return relief;
}

CutOut read_cut_out(const JsonValue& value) {
  CutOut cut;
  if (!value.json().is_object()) {
    cut.by = value.one_of({"alpha", "none"}) == "alpha" ? CutOut::By::alpha : CutOut::By::none;
    return cut;
  }
  value.expect_keys({"color", "tolerance"});
  cut.by = CutOut::By::color;
  const std::array<double, 4> linear = linear_colour(value.require("color").hex_colour());
  for (std::size_t c = 0; c < 3; ++c) cut.color[c] = srgb_from_linear(linear[c]);
  if (const auto v = value.get("tolerance")) cut.tolerance = v->number(0, 1);
  return cut;
}

void read_look(const JsonValue& value, std::optional<double>& roughness, std::optional<double>& metallic) {
  if (const auto v = value.get("roughness")) roughness = v->number(0, 1);
  if (const auto v = value.get("metallic")) metallic = v->number(0, 1);
}

std::string read_name(const JsonValue& value, const std::filesystem::path& picture) {
  if (const auto v = value.get("name")) {
    if (v->text().empty()) v->fail("must not be empty");
    return v->text();
  }
  return picture.stem().string();
}

}  // namespace

DecalRule read_decal(const JsonValue& value, const std::filesystem::path& source) {
  DecalRule rule;
  static_cast<SurfaceSelector&>(rule) =
      read_selector(value, {"not", "name", "picture", "at", "direction", "up", "size_mm", "depth_mm", "max_angle",
                            "offset_mm", "roughness", "metallic", "height", "$comment"});
  rule.picture = read_path(value.require("picture"), source);
  rule.name = read_name(value, rule.picture);
  rule.box = read_box(value);
  if (const auto v = value.get("max_angle")) rule.max_angle_deg = v->number(0, 90);
  if (const auto v = value.get("offset_mm")) rule.offset_mm = v->number(0, 100);
  read_look(value, rule.roughness, rule.metallic);
  if (const auto v = value.get("height")) rule.height = read_relief(*v, source);
  return rule;
}

CarrierRule read_carrier(const JsonValue& value, const std::filesystem::path& source) {
  CarrierRule rule;
  static_cast<SurfaceSelector&>(rule) =
      read_selector(value, {"not", "name", "picture", "at", "direction", "up", "size_mm", "depth_mm", "crop", "scale",
                            "contrast", "brightness", "cut_out", "height", "roughness", "metallic", "$comment"});
  const JsonValue picture = value.require("picture");
  const bool renders = picture.json().is_object();
  if (renders) {
    picture.expect_keys({"render", "pixels", "felt"});
    if (!picture.require("render").yes_or_no()) picture.require("render").fail("must be true");
    if (const auto v = picture.get("pixels")) {
      const double pixels = v->number(16, 4096);
      if (pixels != std::floor(pixels)) v->fail("must be a whole number");
      rule.pixels = static_cast<int>(pixels);
    }
    if (const auto v = picture.get("felt")) rule.felt = v->yes_or_no();
    for (const char* key : {"crop", "cut_out", "height"})
      if (const auto v = value.get(key)) v->fail("is of a picture from a file");
  } else {
    rule.picture = read_path(picture, source);
  }
  rule.name = read_name(value, renders ? std::filesystem::path("picture") : rule.picture);
  if (value.get("at")) {
    rule.box = read_box(value);
  } else {
    for (const char* key : {"size_mm", "depth_mm"})
      if (const auto v = value.get(key)) v->fail("needs 'at', the middle of a region");
    if (rule.is_empty()) value.fail("needs the surfaces to replace, or a region by 'at', 'size_mm' and 'depth_mm'");
    if (const auto v = value.get("direction")) rule.direction = read_direction(*v);
    if (const auto v = value.get("up")) rule.up = read_direction(*v);
  }
  if (const auto v = value.get("crop")) {
    const std::vector<double> crop = read_numbers(*v, 4, 0, 1);
    if (!(crop[0] < crop[2] && crop[1] < crop[3])) v->fail("must be [left, top, right, bottom]");
    std::copy(crop.begin(), crop.end(), rule.crop.begin());
  }
  if (const auto v = value.get("scale")) {
    if (rule.box) v->fail("is of carriers that are fitted; a region has its 'size_mm'");
    const std::vector<double> scale = read_numbers(*v, 2, 0.01, 100);
    std::copy(scale.begin(), scale.end(), rule.scale.begin());
  }
  if (const auto v = value.get("contrast")) rule.contrast = v->number(0, 100);
  if (const auto v = value.get("brightness")) rule.brightness = v->number(-1, 1);
  if (const auto v = value.get("cut_out")) rule.cut_out = read_cut_out(*v);
  read_look(value, rule.roughness, rule.metallic);
  if (const auto v = value.get("height")) rule.height = read_relief(*v, source);
  return rule;
}

}  // namespace papilla
