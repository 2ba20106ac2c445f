// SPDX-License-Identifier: MIT
#include "gltf_mutator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <span>

#include "papilla/haptic/sha256.hpp"

namespace papilla::fuzz {
namespace {

constexpr double k_repaired_share = 0.9, k_bytes_share = 0.02;
constexpr std::array k_lists = {"buffers",  "bufferViews", "accessors", "meshes", "nodes",      "scenes", "materials",
                                "textures", "images",      "samplers",  "skins",  "animations", "cameras"};
constexpr std::array<const char*, 4> k_types = {"SCALAR", "VEC2", "VEC3", "VEC4"};
constexpr std::array<std::size_t, 6> k_component_types = {5120, 5121, 5122, 5123, 5125, 5126};

std::size_t component_bytes(std::int64_t type) { return type >= 5125 ? 4 : type >= 5122 ? 2 : 1; }

/// A whole number of at least 0 under a key, else the fallback.
std::size_t whole(const Json& object, const char* key, std::size_t fallback) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_integer() || found->get<std::int64_t>() < 0) return fallback;
  return found->get<std::size_t>();
}

class Repair {
 public:
  Repair(BlobDocument& document, Json& gltf) : document_(document), gltf_(gltf) {}

  void run() {
    if (!gltf_.is_object()) gltf_ = Json::object();
    if (!gltf_["asset"].is_object()) gltf_["asset"] = Json::object();
    gltf_["asset"]["version"] = "2.0";
    for (const char* name : k_lists) keep_objects(name);
    gltf_.erase("extensionsRequired");
    buffers();
    views();
    for (Json& accessor : list("accessors")) mend_accessor(accessor);
    for (Json& mesh : list("meshes")) mend_mesh(mesh);
    materials();
    nodes();
    scenes();
  }

 private:
  /// The elements of a list; none where there is no list.
  Json& list(const char* name) {
    static Json none;
    none = Json::array();
    const auto found = gltf_.find(name);
    return found == gltf_.end() ? none : *found;
  }

  void keep_objects(const char* name) {
    const auto found = gltf_.find(name);
    if (found == gltf_.end()) return;
    if (found->is_array())
      for (std::size_t i = found->size(); i-- > 0;)
        if (!(*found)[i].is_object()) found->erase(i);
    if (!found->is_array() || found->empty()) gltf_.erase(name);
  }

  /// Brings a number into the range of a list, or leaves it out.
  void point_into(Json& object, const char* key, const char* target) {
    if (!object.contains(key)) return;
    const std::size_t count = list(target).size();
    if (count == 0)
      object.erase(key);
    else
      object[key] = whole(object, key, 0) % count;
  }

  void buffers() {
    for (Json& buffer : list("buffers"))
      if (const auto* blob = buffer.contains("uri") ? document_.blob_of(buffer["uri"]) : nullptr)
        buffer["byteLength"] = blob->bytes.size();
      else if (!document_.blobs.empty())
        buffer = {{"uri", "blob:0"}, {"byteLength", document_.blobs[0].bytes.size()}};
  }

  void views() {
    if (list("buffers").empty()) gltf_.erase("bufferViews");
    for (Json& view : list("bufferViews")) {
      if (view.contains("extensions")) continue;  // Compressed: what it needs is not known here.
      view["buffer"] = whole(view, "buffer", 0) % list("buffers").size();
      const std::size_t bytes = whole(gltf_["buffers"][view["buffer"].get<std::size_t>()], "byteLength", 0);
      const std::size_t offset = std::min(whole(view, "byteOffset", 0), bytes) / 4 * 4;
      view["byteOffset"] = offset;
      view["byteLength"] = std::clamp<std::size_t>(whole(view, "byteLength", bytes),
                                                   std::min<std::size_t>(1, bytes - offset), bytes - offset);
      if (view.contains("byteStride"))
        view["byteStride"] = std::clamp<std::size_t>(whole(view, "byteStride", 4) / 4 * 4, 4, 252);
    }
  }

  static std::size_t components(const Json& accessor) {
    const auto found = std::find(k_types.begin(), k_types.end(), accessor.at("type").get<std::string>());
    return static_cast<std::size_t>(found - k_types.begin()) + 1;
  }

  void mend_accessor(Json& accessor) {
    const std::size_t type = whole(accessor, "componentType", 5126);
    const bool known = std::find(k_component_types.begin(), k_component_types.end(), type) != k_component_types.end();
    accessor["componentType"] = known ? type : k_component_types[type % k_component_types.size()];
    const Json kind = accessor.value("type", Json());
    if (std::find(k_types.begin(), k_types.end(), kind) == k_types.end()) accessor["type"] = "VEC3";
    accessor["count"] = std::clamp<std::size_t>(whole(accessor, "count", 3), 1, 4096);
    point_into(accessor, "bufferView", "bufferViews");
    if (accessor.contains("sparse") && !is_sound_sparse(accessor)) accessor.erase("sparse");
    if (!accessor.contains("bufferView")) return;
    const Json& view = gltf_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    if (view.contains("extensions")) return;
    const std::size_t component = component_bytes(accessor["componentType"].get<std::int64_t>());
    std::size_t size = component * components(accessor), bytes = whole(view, "byteLength", 0);
    if (bytes < 4) return void(accessor.erase("bufferView"));
    if (size > bytes) accessor["type"] = "SCALAR", size = component;
    const std::size_t stride = std::max(whole(view, "byteStride", size), size);
    if (view.contains("byteStride") && whole(view, "byteStride", 0) < size)
      gltf_["bufferViews"][accessor["bufferView"].get<std::size_t>()].erase("byteStride");
    const std::size_t offset = std::min(whole(accessor, "byteOffset", 0), bytes - size) / component * component;
    if (accessor.contains("byteOffset")) accessor["byteOffset"] = offset;
    const std::size_t most = (bytes - offset - size) / stride + 1;
    accessor["count"] = std::min(whole(accessor, "count", 1), most);
  }

  bool is_sound_sparse(const Json& accessor) {
    const Json& sparse = accessor["sparse"];
    const auto names_view = [&](const char* key) {
      return sparse.contains(key) && sparse[key].is_object() &&
             whole(sparse[key], "bufferView", list("bufferViews").size()) < list("bufferViews").size();
    };
    return sparse.is_object() && whole(sparse, "count", 0) >= 1 &&
           whole(sparse, "count", 0) <= whole(accessor, "count", 0) && names_view("indices") && names_view("values");
  }

  /// Whether an accessor can be the attribute of as many vertices.
  bool fits(std::size_t number, const std::string& name, std::size_t count) {
    if (number >= list("accessors").size()) return false;
    const Json& accessor = gltf_["accessors"][number];
    const std::size_t width = components(accessor);
    const bool of_type = name.starts_with("TEXCOORD") ? width == 2
                         : name.starts_with("COLOR")  ? width == 3 || width == 4
                         : name == "TANGENT"          ? width == 4
                         : name[0] == '_'             ? true
                                                      : width == 3;
    return of_type && (count == 0 || whole(accessor, "count", 0) == count);
  }

  void mend_mesh(Json& mesh) {
    if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) mesh["primitives"] = Json::array();
    for (Json& primitive : mesh["primitives"]) {
      if (!primitive.is_object()) primitive = Json::object();
      Json& attributes = primitive["attributes"];
      if (!attributes.is_object()) attributes = Json::object();
      const std::size_t position = whole(attributes, "POSITION", 0);
      if (!fits(position, "POSITION", 0)) {
        attributes = Json::object();
        for (std::size_t i = 0; i < list("accessors").size(); ++i)
          if (fits(i, "POSITION", 0)) attributes["POSITION"] = i;
      }
      const std::size_t count =
          attributes.contains("POSITION") ? whole(gltf_["accessors"][whole(attributes, "POSITION", 0)], "count", 0) : 0;
      std::vector<std::string> unfit;
      for (const auto& [name, number] : attributes.items())
        if (name.empty() || !number.is_number_unsigned() || !fits(number.get<std::size_t>(), name, count))
          unfit.push_back(name);
      for (const std::string& name : unfit) attributes.erase(name);
      point_into(primitive, "material", "materials");
      if (primitive.contains("mode")) primitive["mode"] = whole(primitive, "mode", 4) % 7;
      if (primitive.contains("indices") && !mend_indices(primitive, count)) primitive.erase("indices");
    }
  }

  /// Vertex numbers below the count. @returns false when the accessor holds no vertex numbers.
  bool mend_indices(Json& primitive, std::size_t count) {
    point_into(primitive, "indices", "accessors");
    if (!primitive.contains("indices") || count == 0) return false;
    const Json& accessor = gltf_["accessors"][primitive["indices"].get<std::size_t>()];
    const auto type = accessor["componentType"].get<std::int64_t>();
    if (components(accessor) != 1 || (type != 5121 && type != 5123 && type != 5125) || accessor.contains("sparse"))
      return false;
    if (!accessor.contains("bufferView")) return true;
    const Json& view = gltf_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    if (view.contains("extensions")) return true;
    auto* const blob = document_.blob_of(gltf_["buffers"][view["buffer"].get<std::size_t>()]["uri"]);
    if (blob == nullptr) return false;
    const std::size_t width = component_bytes(type), stride = std::max(whole(view, "byteStride", width), width);
    std::size_t at = whole(view, "byteOffset", 0) + whole(accessor, "byteOffset", 0);
    for (std::size_t i = 0; i < whole(accessor, "count", 0) && at + width <= blob->bytes.size(); ++i, at += stride) {
      std::uint32_t index = 0;
      std::memcpy(&index, blob->bytes.data() + at, width);
      index %= static_cast<std::uint32_t>(count);
      std::memcpy(blob->bytes.data() + at, &index, width);
    }
    return true;
  }

  void mend_reference(Json& object, const char* key) {
    if (!object.contains(key)) return;
    if (!object[key].is_object() || list("textures").empty()) {
      object.erase(key);
      return;
    }
    object[key]["index"] = whole(object[key], "index", 0) % list("textures").size();
    if (object[key].contains("texCoord")) object[key]["texCoord"] = whole(object[key], "texCoord", 0) % 3;
  }

  void materials() {
    for (Json& texture : list("textures")) {
      point_into(texture, "source", "images");
      point_into(texture, "sampler", "samplers");
    }
    for (Json& material : list("materials")) {
      for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) mend_reference(material, key);
      if (material.contains("pbrMetallicRoughness") && material["pbrMetallicRoughness"].is_object())
        for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"})
          mend_reference(material["pbrMetallicRoughness"], key);
      if (material.contains("extras") && material["extras"].is_object()) mend_tag(material["extras"]);
    }
  }

  void mend_tag(Json& extras) {
    if (!extras.contains("haptic") || !extras["haptic"].is_object()) return;
    Json& tag = extras["haptic"];
    repair_tag(tag);
    for (const char* picture : {"height", "maps"}) {
      if (!tag.contains(picture) || !tag[picture].is_object() || !tag[picture].contains("uri")) continue;
      if (const auto* blob = document_.blob_of(tag[picture]["uri"]))
        tag[picture]["sha256"] = sha256_hex(std::as_bytes(std::span(blob->bytes)));
    }
  }

  /// Every node has one parent at most, with a lower number than its own.
  void nodes() {
    constexpr std::array<std::pair<const char*, std::size_t>, 4> k_numbers = {
        {{"translation", 3}, {"rotation", 4}, {"scale", 3}, {"matrix", 16}}};
    std::set<std::size_t> children;
    const std::size_t count = list("nodes").size();
    for (std::size_t i = 0; i < count; ++i) {
      Json& node = gltf_["nodes"][i];
      point_into(node, "mesh", "meshes");
      for (const auto& [key, size] : k_numbers) {
        if (!node.contains(key)) continue;
        const Json& numbers = node[key];
        const bool sound = numbers.is_array() && numbers.size() == size &&
                           std::all_of(numbers.begin(), numbers.end(),
                                       [](const Json& n) { return n.is_number() && std::abs(n.get<double>()) < 1e30; });
        if (!sound) node.erase(key);
      }
      if (node.contains("matrix"))
        for (const std::size_t k : {3U, 7U, 11U, 15U}) node["matrix"][k] = k == 15 ? 1 : 0;
      if (node.contains("extensions") && node["extensions"].is_object() && node["extensions"].contains("MSFT_lod")) {
        if (count < 2)
          node["extensions"].erase("MSFT_lod");
        else
          node["extensions"]["MSFT_lod"] = {{"ids", {(i + 1) % count}}};
      }
      if (!node.contains("children")) continue;
      Json kept = Json::array();
      if (node["children"].is_array())
        for (const Json& child : node["children"])
          if (child.is_number_unsigned() && child.get<std::size_t>() > i && child.get<std::size_t>() < count &&
              children.insert(child.get<std::size_t>()).second)
            kept.push_back(child);
      if (kept.empty())
        node.erase("children");
      else
        node["children"] = kept;
    }
    roots_.clear();
    for (std::size_t i = 0; i < count; ++i)
      if (!children.contains(i)) roots_.push_back(i);
  }

  void scenes() {
    point_into(gltf_, "scene", "scenes");
    for (Json& scene : list("scenes")) scene["nodes"] = roots_;
  }

  BlobDocument& document_;
  Json& gltf_;
  std::vector<std::size_t> roots_;
};

void mutate(BlobDocument& document, const JsonGrammar& grammar, Random& random) {
  if (random.chance(0.35)) mutate_blob(document, random);
  if (random.chance(0.8)) mutate_json(document.json, grammar, random);
}

}  // namespace

const JsonGrammar& gltf_grammar() {
  static const JsonGrammar grammar = [] {
    JsonGrammar made = tag_grammar();
    const Json tag = made.sample;
    made.ranges.insert(made.ranges.end(), {{"metallicFactor", 0, 1},
                                           {"roughnessFactor", 0, 1},
                                           {"baseColorFactor", 0, 1},
                                           {"translation", -1, 1},
                                           {"rotation", -1, 1}});
    made.words.insert(made.words.end(), {{"type", {"SCALAR", "VEC2", "VEC3", "VEC4"}},
                                         {"alphaMode", {"OPAQUE", "MASK", "BLEND"}},
                                         {"mimeType", {"image/png", "image/jpeg", "image/webp"}}});
    made.sample = Json::parse(R"({"asset":{"version":"2.0","generator":"g","copyright":"c",
        "extras":{"generators":["a"],"hapticManifest":{"version":1,"materials":[{"name":"Leather"}],
          "surfaces":[{"part":"p","node":"n","material":0,"area":1,"box":[0,0,0,1,0,1]}]}}},
      "scene":0,"scenes":[{"nodes":[0],"extras":{}}],
      "nodes":[{"name":"n","mesh":0,"children":[1],"translation":[0,0,1],"rotation":[0,0,0.6,0.8],"scale":[1,2,-1],
        "extras":{"hapticMaterials":[{"material":"Leather","area":1}],"MSFT_screencoverage":[0.5,0]},
        "extensions":{"MSFT_lod":{"ids":[1]},"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
      "meshes":[{"name":"p","primitives":[{"attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":2,"TEXCOORD_1":2,
        "COLOR_0":0},"indices":1,"material":0,"mode":5}]}],
      "accessors":[{"bufferView":0,"byteOffset":4,"componentType":5126,"count":4,"type":"VEC3","normalized":true,
        "sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48,"byteStride":16}],
      "materials":[{"name":"Leather","doubleSided":true,"alphaMode":"BLEND","alphaCutoff":0.5,"emissiveFactor":[1,1,1],
        "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"metallicFactor":0,"roughnessFactor":1,
          "baseColorTexture":{"index":0,"texCoord":1,
            "extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1,"scale":[2,2],"texCoord":0}}}},
        "normalTexture":{"index":0,"scale":2},"occlusionTexture":{"index":0,"strength":0.5},"extras":{}}],
      "textures":[{"source":0,"sampler":0,"extensions":{"EXT_texture_webp":{"source":0}}}],
      "samplers":[{"wrapS":33071,"minFilter":9987}],"images":[{"uri":"a.png","name":"h"}],
      "extensionsUsed":["MSFT_lod"]})");
    made.sample["materials"][0]["extras"]["haptic"] = tag;
    made.sample["asset"]["extras"]["hapticManifest"]["materials"][0]["tag"] = tag;
    made.sample["nodes"][0]["extras"]["hapticMaterials"][0]["tag"] = tag;
    return made;
  }();
  return grammar;
}

void repair_gltf(BlobDocument& document, Json& gltf) { Repair(document, gltf).run(); }

std::size_t mutate_gltf(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
  Random random(seed);
  auto document = parse_blob_document({reinterpret_cast<const char*>(data), size});
  if (!document || random.chance(k_bytes_share)) return mutate_bytes(data, size, max_size, random);
  mutate(*document, gltf_grammar(), random);
  if (random.chance(0.01)) document->glb = !document->glb;
  if (random.chance(k_repaired_share)) repair_gltf(*document, document->json);
  return store(to_bytes(*document), data, size, max_size);
}

std::size_t mutate_scene(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                         const JsonGrammar& grammar, void (*repair)(Json&)) {
  Random random(seed);
  auto document = parse_blob_document({reinterpret_cast<const char*>(data), size});
  if (!document || random.chance(k_bytes_share)) return mutate_bytes(data, size, max_size, random);
  mutate(*document, grammar, random);
  if (random.chance(k_repaired_share)) {
    if (!document->json.is_object()) document->json = Json::object();
    repair_gltf(*document, document->json["scene"]);
    repair(document->json);
  }
  return store(to_bytes(*document), data, size, max_size);
}

}  // namespace papilla::fuzz
