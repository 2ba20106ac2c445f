// SPDX-License-Identifier: MIT
#include "missing_member.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace papilla::gltf {
namespace {

using Json = nlohmann::ordered_json;

enum class Kind { index, number, text, array, object, component_type, accessor_type, camera_type, stride };

/// A member that tinygltf insists on. "[]" stands behind an array whose elements have it; what is on the way and not
/// there requires nothing.
struct Required {
  std::string_view path;
  Kind kind;
  bool may_be_missing = false;
};

constexpr std::array k_required = {
    Required{"buffers[].byteLength", Kind::index},
    Required{"bufferViews[].buffer", Kind::index},
    Required{"bufferViews[].byteLength", Kind::index},
    Required{"bufferViews[].byteStride", Kind::stride, true},
    Required{"accessors[].componentType", Kind::component_type},
    Required{"accessors[].count", Kind::index},
    Required{"accessors[].type", Kind::accessor_type},
    Required{"accessors[].sparse.count", Kind::index},
    Required{"accessors[].sparse.indices", Kind::object},
    Required{"accessors[].sparse.indices.bufferView", Kind::index},
    Required{"accessors[].sparse.indices.componentType", Kind::index},
    Required{"accessors[].sparse.values", Kind::object},
    Required{"accessors[].sparse.values.bufferView", Kind::index},
    Required{"meshes[].primitives[].attributes", Kind::object},
    Required{"textures[]", Kind::object},
    Required{"images[]", Kind::object},
    Required{"materials[]", Kind::object},
    Required{"nodes[]", Kind::object},
    Required{"scenes[]", Kind::object},
    Required{"samplers[]", Kind::object},
    Required{"skins[].joints", Kind::array},
    Required{"animations[].samplers[].input", Kind::index},
    Required{"animations[].samplers[].output", Kind::index},
    Required{"cameras[].type", Kind::camera_type},
    Required{"extensions.KHR_lights_punctual.lights[].type", Kind::text},
    Required{"cameras[].perspective.yfov", Kind::number},
    Required{"cameras[].perspective.znear", Kind::number},
    Required{"cameras[].orthographic.xmag", Kind::number},
    Required{"cameras[].orthographic.ymag", Kind::number},
    Required{"cameras[].orthographic.zfar", Kind::number},
    Required{"cameras[].orthographic.znear", Kind::number},
};

bool is_index(const Json& value) { return value.is_number_integer() && value.get<std::int64_t>() >= 0; }

bool is_one_of(const Json& value, std::initializer_list<Json> allowed) {
  return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}

/// Whether a member is what it should be, and else what to say of it.
std::pair<bool, std::string_view> is_of(const Json& value, Kind kind) {
  switch (kind) {
    case Kind::index: return {is_index(value), "is no whole number"};
    case Kind::number: return {value.is_number(), "is no number"};
    case Kind::text: return {value.is_string(), "is no string"};
    case Kind::array: return {value.is_array(), "is no array"};
    case Kind::object: return {value.is_object(), "is no object"};
    case Kind::component_type:
      return {is_one_of(value, {5120, 5121, 5122, 5123, 5124, 5125, 5126, 5130}), "is no component type"};
    case Kind::accessor_type:
      return {is_one_of(value, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}), "is no accessor type"};
    case Kind::camera_type: return {is_one_of(value, {"perspective", "orthographic"}), "is no camera type"};
    case Kind::stride:
      return {is_index(value) && value.get<std::int64_t>() % 4 == 0 && value.get<std::int64_t>() <= 252,
              "is no multiple of 4 up to 252"};
  }
  return {true, ""};
}

/// @param path What is left of the way below `value`, which stands at `place`. @returns a message, or nothing.
std::string find_in(const Json& value, std::string_view path, const Required& required, const std::string& place) {
  if (path.empty()) {
    const auto [good, complaint] = is_of(value, required.kind);
    return good ? "" : place + " " + std::string(complaint);
  }
  if (path.starts_with("[]")) {
    if (!value.is_array()) return place + " is no array";
    path.remove_prefix(path.starts_with("[].") ? 3 : 2);
    for (std::size_t i = 0; i < value.size(); ++i)
      if (std::string found = find_in(value[i], path, required, place + "[" + std::to_string(i) + "]"); !found.empty())
        return found;
    return "";
  }
  if (!value.is_object()) return place + " is no object";
  const std::size_t end = std::min(path.find_first_of(".["), path.size());
  const std::string name(path.substr(0, end));
  path.remove_prefix(end + (end < path.size() && path[end] == '.' ? 1 : 0));
  const std::string member = place.empty() ? name : place + "." + name;
  if (const auto found = value.find(name); found != value.end()) return find_in(*found, path, required, member);
  return path.empty() && !required.may_be_missing ? member + " is missing" : "";
}

/// A camera has the member that its type names.
std::string find_camera_without_lens(const Json& document) {
  const auto cameras = document.find("cameras");
  if (cameras == document.end()) return "";
  for (std::size_t i = 0; i < cameras->size(); ++i) {
    const auto& camera = (*cameras)[i];
    const std::string place = "cameras[" + std::to_string(i) + "]", lens = camera.at("type").get<std::string>();
    if (std::string found = find_in(camera, lens, {"", Kind::object}, place); !found.empty()) return found;
  }
  return "";
}

}  // namespace

std::string find_missing_member(const Json& document) {
  for (const Required& required : k_required)
    if (std::string found = find_in(document, required.path, required, ""); !found.empty()) return found;
  return find_camera_without_lens(document);
}

}  // namespace papilla::gltf
