// SPDX-License-Identifier: MIT
#include "papilla/haptic/material_tag.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/friction.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/texture/height_map.hpp"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

/// Reads the members of one object. Wrong types and ranges become warnings and leave the default.
class Members {
 public:
  Members(const Json& object, std::string place, std::vector<HapticWarning>& warnings)
      : object_(object), place_(std::move(place)), warnings_(warnings) {}

  bool has(const char* name) const { return object_.contains(name); }

  void warn(const char* code, const char* name, const std::string& what) const {
    warnings_.push_back({code, place_ + "." + name + " = " + shown(name) + ": " + what});
  }

  bool is_number(const char* name, double low, double high) const {
    if (!has(name) || !object_.at(name).is_number()) return false;
    const double read = object_.at(name).get<double>();
    return read >= low && read <= high;
  }

  /// @param other the member that replaces a wrong value, if it is a number in range; else the default does.
  bool number(const char* name, const char* code, double low, double high, double& value,
              const char* other = nullptr) const {
    if (!has(name)) return false;
    if (!is_number(name, low, high)) {
      const bool has_other = other != nullptr && is_number(other, low, high);
      warn(code, name, "is no number in range, " + (has_other ? other : Json(value).dump()) + " is used");
      return false;
    }
    value = object_.at(name).get<double>();
    return true;
  }

  bool pair(const char* name, const char* code, double low, double high, Vec2& value) const {
    if (!has(name)) return false;
    const Json& member = object_.at(name);
    const bool fits = member.is_array() && member.size() == 2 && member[0].is_number() && member[1].is_number();
    const Vec2 read = fits ? Vec2{member[0].get<double>(), member[1].get<double>()} : Vec2{};
    if (!fits || !(std::min(read.x, read.y) >= low) || !(std::max(read.x, read.y) <= high)) {
      warn(code, name, "is no pair of numbers in range, the default is used");
      return false;
    }
    value = read;
    return true;
  }

  void flag(const char* name, const char* code, bool& value) const {
    if (!has(name)) return;
    if (object_.at(name).is_boolean())
      value = object_.at(name).get<bool>();
    else
      warn(code, name, "is neither true nor false, false is used");
  }

  void text(const char* name, const char* code, std::string& value) const {
    if (!has(name)) return;
    if (!object_.at(name).is_string())
      warn(code, name, "is no text and is ignored");
    else
      value = object_.at(name).get<std::string>();
  }

  const Json* object(const char* name, const char* code) const {
    if (!has(name)) return nullptr;
    if (object_.at(name).is_object()) return &object_.at(name);
    warn(code, name, "is no object and is ignored");
    return nullptr;
  }

  const Json& at(const char* name) const { return object_.at(name); }
  const std::string& place() const { return place_; }

 private:
  std::string shown(const char* name) const {
    std::string text = object_.at(name).dump(-1, ' ', true, Json::error_handler_t::replace);
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    return text;
  }
  const Json& object_;
  std::string place_;
  std::vector<HapticWarning>& warnings_;
};

constexpr double k_any = 1e12;  // Bound of numbers without a bound of their own.
constexpr int k_largest_picture = 1 << 16;

std::optional<Wrap> wrap_of(const Json& value) {
  if (value == "repeat") return Wrap::repeat;
  if (value == "clamp") return Wrap::clamp;
  if (value == "mirror") return Wrap::mirror;
  return std::nullopt;
}

const char* name_of(Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp: return "clamp";
    case Wrap::mirror: return "mirror";
    case Wrap::repeat: break;
  }
  return "repeat";
}

bool is_sha256(const std::string& text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
         });
}

/// How the codes of warnings begin, and what they are about.
struct PictureKind {
  const char *code, *sha256_code, *uv_code, *what;
};
constexpr PictureKind k_height{"tag_height", "tag_height_sha256", "tag_height_uv", "map"};
constexpr PictureKind k_maps{"tag_maps", "tag_maps_sha256", "tag_maps", "picture"};

void read_uv_transform(const Json& json, const std::string& place, const char* code,
                       std::vector<HapticWarning>& warnings, UvTransform& t) {
  const Members in(json, place, warnings);
  in.pair("offset", code, -k_any, k_any, t.offset);
  in.pair("scale", code, -k_any, k_any, t.scale);
  in.number("rotation", code, -k_any, k_any, t.rotation);
}

void read_picture(const Members& in, const PictureKind& kind, std::vector<HapticWarning>& warnings,
                  PlacedPicture& picture) {
  in.text("uri", kind.code, picture.uri);
  in.text("image", kind.code, picture.image);
  in.text("sha256", kind.sha256_code, picture.sha256);
  if (!is_sha256(picture.sha256)) {
    warnings.push_back(
        {kind.sha256_code, in.place() + ".sha256: is not 64 hexadecimal digits, no " + kind.what + " can be accepted"});
    picture.sha256.clear();
  }
  std::transform(picture.sha256.begin(), picture.sha256.end(), picture.sha256.begin(),
                 [](char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c; });
  Vec2 size;
  if (in.pair("size", kind.code, 1, k_largest_picture, size))
    picture.size = {static_cast<int>(size.x), static_cast<int>(size.y)};
  double tex_coord = 0;
  if (in.number("texCoord", kind.uv_code, 0, 7, tex_coord)) picture.tex_coord = static_cast<int>(tex_coord);
  if (in.has("wrap")) {
    const Json& wrap = in.at("wrap");
    const bool fits = wrap.is_array() && wrap.size() == 2 && wrap_of(wrap[0]) && wrap_of(wrap[1]);
    if (fits)
      picture.wrap = {*wrap_of(wrap[0]), *wrap_of(wrap[1])};
    else
      in.warn(kind.uv_code, "wrap", "is not two of repeat, clamp, mirror; repeat is used");
  }
  if (const Json* transform = in.object("uvTransform", kind.uv_code))
    read_uv_transform(*transform, in.place() + ".uvTransform", kind.uv_code, warnings, picture.uv_transform);
}

std::optional<HeightTag> read_height(const Json& json, const std::string& place, std::vector<HapticWarning>& warnings) {
  constexpr const char* k_code = k_height.code;
  const Members in(json, place, warnings);
  HeightTag height;
  if (!in.number("scale", k_code, -1, 1, height.scale_m) ||
      (in.has("offset") && !in.number("offset", k_code, -1, 1, height.offset_m))) {
    warnings.push_back({k_code, place + ": scale and offset must be numbers within a metre, the relief is dropped"});
    return std::nullopt;
  }
  read_picture(in, k_height, warnings, height);
  double bits = 16;
  if (in.number("bits", "tag_height_bits", 1, 64, bits)) height.bits = static_cast<int>(bits);
  if (height.bits != 16) in.warn("tag_height_bits", "bits", "steps of an 8-bit map can be felt, 16 is expected");
  in.text("channel", k_code, height.channel);
  std::string outward = "white";
  in.text("outward", k_code, outward);
  if (outward != "white" && outward != "black") in.warn(k_code, "outward", "is neither white nor black, white is used");
  height.white_is_outward = outward != "black";
  in.number("rms", k_code, 0, 1, height.rms_m);
  in.pair("metresPerUV", k_height.uv_code, 1e-9, k_any, height.metres_per_uv);
  return height;
}

constexpr std::array k_channel_names{"r", "g", "b"};

std::optional<MapChannel> read_channel(const Json& json, const std::string& place,
                                       std::vector<HapticWarning>& warnings) {
  const Members in(json, place, warnings);
  std::string name;
  in.text("quantity", k_maps.code, name);
  const auto quantity = papilla::quantity(name);
  MapChannel channel;
  if (!quantity || !in.number("scale", k_maps.code, -k_any, k_any, channel.scale) ||
      (in.has("offset") && !in.number("offset", k_maps.code, -k_any, k_any, channel.offset))) {
    warnings.push_back({k_maps.code, place + ": needs a quantity and the numbers scale and offset, it is dropped"});
    return std::nullopt;
  }
  channel.quantity = *quantity;
  if (channel.least() >= 0 && channel.most() <= largest_value(*quantity)) return channel;
  warnings.push_back({k_maps.code, place + ": leads from " + Json(channel.least()).dump() + " to " +
                                       Json(channel.most()).dump() + ", beyond 0 to " +
                                       Json(largest_value(*quantity)).dump() + ", it is dropped"});
  return std::nullopt;
}

std::optional<MapsTag> read_maps(const Json& json, const std::string& place, std::vector<HapticWarning>& warnings) {
  const Members in(json, place, warnings);
  MapsTag maps;
  read_picture(in, k_maps, warnings, maps);
  maps.bits = 8;
  double bits = 8;
  if (in.number("bits", k_maps.code, 1, 64, bits)) maps.bits = static_cast<int>(bits);
  bool any = false;
  if (const Json* channels = in.object("channels", k_maps.code)) {
    const Members of(*channels, place + ".channels", warnings);
    for (std::size_t c = 0; c < k_channel_names.size(); ++c) {
      const char* const name = k_channel_names[c];
      const Json* const json_channel = of.object(name, k_maps.code);
      if (json_channel == nullptr) continue;
      auto channel = read_channel(*json_channel, place + ".channels." + name, warnings);
      const bool is_known = channel && std::any_of(maps.channels.begin(), maps.channels.end(), [&](const auto& other) {
                              return other && other->quantity == channel->quantity;
                            });
      if (is_known) of.warn(k_maps.code, name, "has the quantity of another channel, it is dropped");
      if (!channel || is_known) continue;
      maps.channels[c] = channel;
      any = true;
    }
  }
  if (any) return maps;
  warnings.push_back({k_maps.code, place + ": has no channel, the constants are used"});
  return std::nullopt;
}

std::optional<BackingTag> read_backing(const Json& json, const std::string& place,
                                       std::vector<HapticWarning>& warnings) {
  constexpr const char* k_code = "tag_backing";
  const Members in(json, place, warnings);
  BackingTag backing;
  const bool has_stiffness = in.number("stiffness", k_code, 0, largest_value(Quantity::stiffness), backing.stiffness);
  if (has_stiffness && in.number("depth", k_code, 0, 1, backing.depth_m)) return backing;
  warnings.push_back({k_code, place + ": needs stiffness and depth, the surface is felt without it"});
  return std::nullopt;
}

std::optional<RoughnessTag> read_roughness(const Json& json, const std::string& place,
                                           std::vector<HapticWarning>& warnings) {
  constexpr const char* k_code = "tag_roughness";
  const Members in(json, place, warnings);
  RoughnessTag roughness;
  in.flag("overlay", k_code, roughness.overlay);
  // Version 2 has names and a range of its own; version 1 can't say them.
  const bool two = in.has("rms");
  const char* const wavelengths = two ? "wavelength_range" : "wavelengthRange";
  double value = two ? 0.5 : 2.5;
  if (two ? in.number("hurst", k_code, 0, 1, value) : in.number("fractalDimension", k_code, 2, 3, value))
    roughness.fractal_dimension = two ? 3 - value : value;
  if (!in.number(two ? "rms" : "rmsHeight", k_code, 0, 0.1, roughness.rms_height_m)) return std::nullopt;
  const Vec2 before = roughness.wavelength_range_m;
  if (in.pair(wavelengths, k_code, 1e-9, 100, roughness.wavelength_range_m) &&
      roughness.wavelength_range_m.x > roughness.wavelength_range_m.y) {
    in.warn(k_code, wavelengths, "goes from long to short, the default is used");
    roughness.wavelength_range_m = before;
  }
  if (const Json* anisotropy = in.object("anisotropy", k_code)) {
    const Members of(*anisotropy, place + ".anisotropy", warnings);
    of.number("ratio", k_code, 1, 100, roughness.anisotropy);
    of.number("direction", k_code, -10, 10, roughness.direction);
  }
  return roughness;
}

std::optional<ForceModelTag> read_force_model(const Json& json, const std::string& place,
                                              std::vector<HapticWarning>& warnings) {
  constexpr const char* k_code = "tag_force_model";
  const Members in(json, place, warnings);
  ForceModelTag model;
  in.text("name", k_code, model.name);
  if (!force_model(model.name)) {
    warnings.push_back({k_code, place + ".name: is no force model, the relief is felt as what it is"});
    return std::nullopt;
  }
  in.number("amplitude", k_code, 0, 100, model.amplitude);
  std::string sign = "downhill";
  in.text("sign", k_code, sign);
  if (sign != "downhill" && sign != "physical" && sign != "literal")
    in.warn(k_code, "sign", "is neither downhill nor literal");
  model.literal = sign == "literal";
  in.text("form", k_code, model.form);
  if (!model.form.empty() && !stimulus_form(*force_model(model.name), model.form)) {
    in.warn(k_code, "form", "is no form of " + model.name + ", its first one is used");
    model.form.clear();
  }
  double level = model.level;
  if (in.number("level", k_code, 1, GreyGraph::k_finest_level, level))
    model.level = static_cast<int>(std::lround(level));
  return model;
}

std::optional<FrictionTag> read_friction_model(const Json& json, const std::string& place,
                                               std::vector<HapticWarning>& warnings) {
  constexpr const char* k_code = "tag_friction_model";
  const Members in(json, place, warnings);
  FrictionTag friction;
  in.text("name", k_code, friction.name);
  if (!friction_model(friction.name)) {
    warnings.push_back({k_code, place + ".name: is no friction model, coulomb is used"});
    return std::nullopt;
  }
  in.number("stiffness", k_code, 0, 1e7, friction.stiffness);
  return friction;
}

std::optional<SymmetryTag> read_symmetry(const Json& json, const std::string& place,
                                         std::vector<HapticWarning>& warnings) {
  const Members in(json, place, warnings);
  SymmetryTag symmetry;
  in.text("group", "tag_symmetry", symmetry.group);
  if (!in.has("period")) return symmetry;
  const Json& period = in.at("period");
  bool fits = period.is_array() && period.size() == 2;
  for (std::size_t i = 0; fits && i < 2; ++i)
    fits = period[i].is_array() && period[i].size() == 2 && period[i][0].is_number() && period[i][1].is_number();
  if (!fits) {
    in.warn("tag_symmetry", "period", "is not two vectors and is ignored");
    return symmetry;
  }
  for (std::size_t i = 0; i < 2; ++i) symmetry.period_m[i] = {period[i][0].get<double>(), period[i][1].get<double>()};
  return symmetry;
}

ProvenanceTag read_provenance(const Json& json, const std::string& place, std::vector<HapticWarning>& warnings) {
  const Members in(json, place, warnings);
  ProvenanceTag provenance;
  in.text("tool", "tag_provenance", provenance.tool);
  in.text("source", "tag_provenance", provenance.source);
  in.text("plan", "tag_provenance", provenance.plan);
  return provenance;
}

void read_friction(const Members& in, MaterialTag& tag) {
  constexpr const char* k_code = "tag_friction";
  const bool has_static = in.number("staticFriction", k_code, 0, 100, tag.static_friction, "dynamicFriction");
  const bool has_dynamic = in.number("dynamicFriction", k_code, 0, 100, tag.dynamic_friction, "staticFriction");
  if (has_static && !has_dynamic) tag.dynamic_friction = tag.static_friction;
  if (has_dynamic && !has_static) tag.static_friction = tag.dynamic_friction;
  if (tag.dynamic_friction > tag.static_friction) {
    in.warn(k_code, "dynamicFriction", "is larger than staticFriction, which is used for both");
    tag.dynamic_friction = tag.static_friction;
  }
}

constexpr std::array k_members{"version",          "stiffness",     "damping",      "staticFriction", "dynamicFriction",
                               "stribeckVelocity", "frictionModel", "forceShading", "height",         "maps",
                               "backing",          "roughness",     "forceModel",   "symmetry",       "provenance"};

MaterialTag read_tag(const Json& json, std::vector<HapticWarning>& warnings) {
  const std::string place = "haptic";
  if (!json.is_object()) throw InvalidInput("haptic tag: is no JSON object");
  const auto version = json.find("version");
  const double number = version != json.end() && version->is_number() ? version->get<double>() : 0;
  if (number != 1 && number != MaterialTag::k_newest_version)
    throw InvalidInput("haptic tag: version " + (version == json.end() ? "is missing" : version->dump()) +
                       ", expected 1 or 2");
  const Members in(json, place, warnings);
  if (!in.has("stiffness") && !in.has("height")) throw InvalidInput("haptic tag: has neither stiffness nor height");
  MaterialTag tag;
  in.number("stiffness", "tag_stiffness", 0, 1e7, tag.stiffness);
  in.number("damping", "tag_damping", 0, 1e5, tag.damping);
  read_friction(in, tag);
  in.number("stribeckVelocity", "tag_stribeck", 1e-9, 1e3, tag.stribeck_velocity);
  if (const Json* friction = in.object("frictionModel", "tag_friction_model"))
    tag.friction_model = read_friction_model(*friction, place + ".frictionModel", warnings);
  in.flag("forceShading", "tag_force_shading", tag.force_shading);
  if (const Json* height = in.object("height", "tag_height"))
    tag.height = read_height(*height, place + ".height", warnings);
  if (const Json* maps = in.object("maps", k_maps.code)) tag.maps = read_maps(*maps, place + ".maps", warnings);
  if (tag.maps && tag.height && tag.maps->tex_coord != tag.height->tex_coord) {
    warnings.push_back(
        {k_maps.code, place + ".maps.texCoord: is another one than that of the height, the constants are used"});
    tag.maps.reset();
  }
  if (const Json* backing = in.object("backing", "tag_backing"))
    tag.backing = read_backing(*backing, place + ".backing", warnings);
  if (const Json* roughness = in.object("roughness", "tag_roughness"))
    tag.roughness = read_roughness(*roughness, place + ".roughness", warnings);
  if (const Json* model = in.object("forceModel", "tag_force_model"))
    tag.force_model = read_force_model(*model, place + ".forceModel", warnings);
  if (const Json* symmetry = in.object("symmetry", "tag_symmetry"))
    tag.symmetry = read_symmetry(*symmetry, place + ".symmetry", warnings);
  if (const Json* provenance = in.object("provenance", "tag_provenance"))
    tag.provenance = read_provenance(*provenance, place + ".provenance", warnings);
  limit_relief(tag, warnings);
  Json other = json;
  for (const char* known : k_members) other.erase(known);
  if (!other.empty()) tag.other_json = other.dump(-1, ' ', false, Json::error_handler_t::replace);
  return tag;
}

Json pair_json(Vec2 v) { return Json::array({v.x, v.y}); }

Json picture_json(const PlacedPicture& p) {
  Json json = Json::object();
  if (!p.uri.empty()) json["uri"] = p.uri;
  if (!p.image.empty()) json["image"] = p.image;
  if (!p.sha256.empty()) json["sha256"] = p.sha256;
  json["bits"] = p.bits;
  if (p.size[0] > 0) json["size"] = p.size;
  return json;
}

void add_place(const PlacedPicture& p, Json& json) {
  json["texCoord"] = p.tex_coord;
  json["uvTransform"] = {{"offset", pair_json(p.uv_transform.offset)},
                         {"rotation", p.uv_transform.rotation},
                         {"scale", pair_json(p.uv_transform.scale)}};
  json["wrap"] = {name_of(p.wrap[0]), name_of(p.wrap[1])};
}

Json height_json(const HeightTag& h) {
  Json json = picture_json(h);
  json["channel"] = h.channel;
  json["scale"] = h.scale_m;
  json["offset"] = h.offset_m;
  json["outward"] = h.white_is_outward ? "white" : "black";
  add_place(h, json);
  json["metresPerUV"] = pair_json(h.metres_per_uv);
  if (h.rms_m > 0) json["rms"] = h.rms_m;
  return json;
}

Json maps_json(const MapsTag& maps) {
  Json json = picture_json(maps);
  for (std::size_t c = 0; c < k_channel_names.size(); ++c)
    if (const auto& channel = maps.channels[c])
      json["channels"][k_channel_names[c]] = {
          {"quantity", name_of(channel->quantity)}, {"scale", channel->scale}, {"offset", channel->offset}};
  add_place(maps, json);
  return json;
}

Json roughness_json(const RoughnessTag& roughness) {
  Json json = Json::object();
  if (!roughness.overlay) {
    if (roughness.fractal_dimension) json["fractalDimension"] = *roughness.fractal_dimension;
    json["rmsHeight"] = roughness.rms_height_m;
    json["wavelengthRange"] = pair_json(roughness.wavelength_range_m);
  } else {
    if (roughness.fractal_dimension) json["hurst"] = 3 - *roughness.fractal_dimension;
    json["rms"] = roughness.rms_height_m;
    json["wavelength_range"] = pair_json(roughness.wavelength_range_m);
  }
  if (roughness.anisotropy != 1)
    json["anisotropy"] = {{"ratio", roughness.anisotropy}, {"direction", roughness.direction}};
  if (roughness.overlay) json["overlay"] = true;
  return json;
}

Json tag_json(const MaterialTag& tag) {
  const bool two = (tag.roughness && tag.roughness->overlay) || tag.maps || tag.backing;
  Json json = {{"version", two ? MaterialTag::k_newest_version : 1},
               {"stiffness", tag.stiffness},
               {"damping", tag.damping},
               {"staticFriction", tag.static_friction},
               {"dynamicFriction", tag.dynamic_friction},
               {"stribeckVelocity", tag.stribeck_velocity}};
  if (tag.friction_model)
    json["frictionModel"] = {{"name", tag.friction_model->name}, {"stiffness", tag.friction_model->stiffness}};
  if (tag.force_shading) json["forceShading"] = true;
  if (tag.height) json["height"] = height_json(*tag.height);
  if (tag.maps) json["maps"] = maps_json(*tag.maps);
  if (tag.backing) json["backing"] = {{"stiffness", tag.backing->stiffness}, {"depth", tag.backing->depth_m}};
  if (tag.roughness) json["roughness"] = roughness_json(*tag.roughness);
  if (tag.force_model)
    json["forceModel"] = {{"name", tag.force_model->name},
                          {"amplitude", tag.force_model->amplitude},
                          {"sign", tag.force_model->literal ? "literal" : "downhill"}};
  if (tag.force_model && !tag.force_model->form.empty()) json["forceModel"]["form"] = tag.force_model->form;
  if (tag.force_model && tag.force_model->level != ForceModelTag().level)
    json["forceModel"]["level"] = tag.force_model->level;
  if (tag.symmetry)
    json["symmetry"] = {
        {"group", tag.symmetry->group},
        {"period", Json::array({pair_json(tag.symmetry->period_m[0]), pair_json(tag.symmetry->period_m[1])})}};
  if (tag.provenance)
    json["provenance"] = {
        {"tool", tag.provenance->tool}, {"source", tag.provenance->source}, {"plan", tag.provenance->plan}};
  if (!tag.other_json.empty())
    json.update(Json::parse(std::string_view(tag.other_json)));  // A view as for the others: one parser.
  return json;
}

std::string data_uri_of(std::span<const std::byte> png) { return "data:image/png;base64," + encode_base64(png); }

Json parse(std::string_view text) { return Json::parse(text, nullptr, false); }

}  // namespace

std::vector<PlacedPicture*> pictures_of(MaterialTag& tag) {
  std::vector<PlacedPicture*> pictures;
  if (tag.height) pictures.push_back(&*tag.height);
  if (tag.maps) pictures.push_back(&*tag.maps);
  return pictures;
}

std::optional<int> tex_coord_of(const MaterialTag& tag) noexcept {
  if (tag.height) return tag.height->tex_coord;
  if (tag.maps) return tag.maps->tex_coord;
  return std::nullopt;
}

double largest_static_friction(const MaterialTag& tag) noexcept {
  double largest = tag.static_friction;
  if (!tag.maps) return largest;
  for (const auto& channel : tag.maps->channels) {
    if (!channel) continue;
    if (channel->quantity == Quantity::static_friction) return channel->most();
    if (channel->quantity == Quantity::dynamic_friction)
      largest =
          tag.dynamic_friction > 0 ? tag.static_friction * channel->most() / tag.dynamic_friction : channel->most();
  }
  return largest;
}

MapsTag make_maps_tag(const EncodedMaps& encoded) {
  MapsTag tag;
  tag.uri = data_uri_of(encoded.png);
  tag.sha256 = sha256_hex(encoded.png);
  tag.size = {encoded.width, encoded.height};
  tag.bits = encoded.bits;
  tag.channels = encoded.channels;
  return tag;
}

HeightTag make_height_tag(const HeightMap& relief, const EncodedRelief& encoded) {
  HeightTag tag;
  tag.uri = encoded.uri.empty() ? data_uri_of(encoded.png) : encoded.uri;
  tag.sha256 = sha256_hex(encoded.png);
  tag.size = {relief.width, relief.height};
  tag.scale_m = k_metres_per_mm * encoded.scale_mm;
  tag.offset_m = k_metres_per_mm * encoded.offset_mm;
  tag.metres_per_uv = {k_metres_per_mm * relief.pitch_mm_x * relief.width,
                       k_metres_per_mm * relief.pitch_mm_y * relief.height};
  tag.rms_m = k_metres_per_mm * encoded.rms_mm;
  return tag;
}

MaterialTag parse_material_tag(std::string_view json, std::vector<HapticWarning>& warnings) {
  return read_tag(parse(json), warnings);
}

std::optional<MaterialTag> take_material_tag(std::string& extras_json, std::vector<HapticWarning>& warnings) {
  if (extras_json.empty()) return std::nullopt;
  Json extras = parse(extras_json);
  if (extras.is_discarded()) {
    warnings.push_back({"tag_refused", "extras: are no JSON"});
    return std::nullopt;
  }
  if (!extras.is_object() || !extras.contains("haptic")) return std::nullopt;
  try {
    MaterialTag tag = read_tag(extras.at("haptic"), warnings);
    extras.erase("haptic");
    extras_json = extras.empty() ? "" : extras.dump(-1, ' ', false, Json::error_handler_t::replace);
    return tag;
  } catch (const InvalidInput& error) {
    warnings.push_back({"tag_refused", error.what()});
    return std::nullopt;
  }
}

std::string to_json(const MaterialTag& tag) {
  return tag_json(tag).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace papilla
