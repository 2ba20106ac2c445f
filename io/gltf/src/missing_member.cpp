// SPDX-License-Identifier: MIT
#include "missing_member.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

namespace papilla::gltf {
namespace {

using Json = nlohmann::ordered_json;

enum class Kind { index, number, text, array, object };

/// A member that glTF 2.0 requires (its JSON schema, "required"). "[]" stands behind an array whose elements have it;
/// what is on the way and not there requires nothing.
struct Required {
  std::string_view path;
  Kind kind;
};

constexpr std::array k_required = {
    Required{"buffers[].byteLength", Kind::index},
    Required{"bufferViews[].buffer", Kind::index},
    Required{"bufferViews[].byteLength", Kind::index},
    Required{"accessors[].componentType", Kind::index},
    Required{"accessors[].count", Kind::index},
    Required{"accessors[].type", Kind::text},
    Required{"accessors[].sparse.count", Kind::index},
    Required{"accessors[].sparse.indices", Kind::object},
    Required{"accessors[].sparse.indices.bufferView", Kind::index},
    Required{"accessors[].sparse.indices.componentType", Kind::index},
    Required{"accessors[].sparse.values", Kind::object},
    Required{"accessors[].sparse.values.bufferView", Kind::index},
    Required{"meshes[].primitives", Kind::array},
    Required{"meshes[].primitives[].attributes", Kind::object},
    Required{"textures[]", Kind::object},
    Required{"images[]", Kind::object},
    Required{"materials[]", Kind::object},
    Required{"nodes[]", Kind::object},
    Required{"scenes[]", Kind::object},
    Required{"samplers[]", Kind::object},
    Required{"skins[].joints", Kind::array},
    Required{"animations[].channels", Kind::array},
    Required{"animations[].channels[].sampler", Kind::index},
    Required{"animations[].channels[].target", Kind::object},
    Required{"animations[].channels[].target.path", Kind::text},
    Required{"animations[].samplers", Kind::array},
    Required{"animations[].samplers[].input", Kind::index},
    Required{"animations[].samplers[].output", Kind::index},
    Required{"cameras[].type", Kind::text},
    Required{"cameras[].perspective.yfov", Kind::number},
    Required{"cameras[].perspective.znear", Kind::number},
    Required{"cameras[].orthographic.xmag", Kind::number},
    Required{"cameras[].orthographic.ymag", Kind::number},
    Required{"cameras[].orthographic.zfar", Kind::number},
    Required{"cameras[].orthographic.znear", Kind::number},
};

bool is_of(const Json& value, Kind kind) {
  switch (kind) {
    case Kind::index: return value.is_number_unsigned();
    case Kind::number: return value.is_number();
    case Kind::text: return value.is_string();
    case Kind::array: return value.is_array();
    case Kind::object: return value.is_object();
  }
  return false;
}

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::index: return "no whole number";
    case Kind::number: return "no number";
    case Kind::text: return "no string";
    case Kind::array: return "no array";
    case Kind::object: return "no object";
  }
  return "";
}

/// @param path What is left of the way below `value`, which stands at `place`. @returns a message, or nothing.
std::string find_in(const Json& value, std::string_view path, Kind kind, const std::string& place) {
  if (path.empty()) return is_of(value, kind) ? "" : place + " is " + std::string(name_of(kind));
  if (path.starts_with("[]")) {
    if (!value.is_array()) return place + " is no array";
    path.remove_prefix(path.starts_with("[].") ? 3 : 2);
    for (std::size_t i = 0; i < value.size(); ++i)
      if (std::string found = find_in(value[i], path, kind, place + "[" + std::to_string(i) + "]"); !found.empty())
        return found;
    return "";
  }
  if (!value.is_object()) return place + " is no object";
  const std::size_t end = std::min(path.find_first_of(".["), path.size());
  const std::string name(path.substr(0, end));
  path.remove_prefix(end + (end < path.size() && path[end] == '.' ? 1 : 0));
  const std::string member = place.empty() ? name : place + "." + name;
  if (const auto found = value.find(name); found != value.end()) return find_in(*found, path, kind, member);
  return path.empty() ? member + " is missing" : "";
}

}  // namespace

std::string find_missing_member(const Json& document) {
  for (const Required& required : k_required)
    if (std::string found = find_in(document, required.path, required.kind, ""); !found.empty()) return found;
  return "";
}

}  // namespace papilla::gltf
