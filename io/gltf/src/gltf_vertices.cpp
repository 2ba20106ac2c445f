// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "draco_mesh.hpp"
#include "gltf_document.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using gltf::AccessorReader;

constexpr const char* k_draco = "KHR_draco_mesh_compression";

template <class T>
void store(double value, std::byte* at) {
  const T narrow = static_cast<T>(value);
  std::memcpy(at, &narrow, sizeof narrow);
}

/// The inverse of reading one component of that type.
void store(double value, int component_type, std::byte* at) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return store<std::int8_t>(value, at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return store<std::uint8_t>(value, at);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return store<std::int16_t>(value, at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return store<std::uint16_t>(value, at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return store<std::uint32_t>(value, at);
    default: return store<float>(value, at);
  }
}

/// The integer that stands for 1 where a type is normalized.
double one_of(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
    default: return 65535;
  }
}

std::size_t components_of(const tinygltf::Accessor& accessor) {
  return static_cast<std::size_t>(
      std::max(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)), 0));
}

/// Decoded numbers in the type that the accessor promises.
std::vector<std::byte> encode(const gltf::DracoMesh::Attribute& source, std::size_t stride, std::size_t count,
                              const tinygltf::Accessor& accessor) {
  const std::size_t width = components_of(accessor), step = gltf::component_size(accessor.componentType);
  const bool is_float = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const double factor = !is_float && !source.is_integer && accessor.normalized ? one_of(accessor.componentType) : 1;
  std::vector<std::byte> bytes(count * width * step);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < width; ++k) {
      const double value = factor * source.numbers[i * stride + k];
      store(is_float ? value : std::round(value), accessor.componentType, &bytes[(i * width + k) * step]);
    }
  return bytes;
}

}  // namespace

struct GltfVertexReader::File {
  gltf::Document document;
  AccessorReader reader;

  explicit File(const std::filesystem::path& path) : document(gltf::load_document(path)), reader(document) {}

  GltfAttribute attribute(const std::string& name, int number, const std::string& where) {
    const tinygltf::Accessor& accessor = reader.accessor(number, where);
    return {name, static_cast<std::uint32_t>(number),
            components_of(accessor) * gltf::component_size(accessor.componentType),
            reader.bytes(number, where + ", " + name)};
  }

  /// The attributes that the primitive's Draco stream holds; nothing when it has none.
  std::vector<GltfAttribute> compressed_attributes(const tinygltf::Primitive& primitive, const std::string& where,
                                                   std::size_t& count) {
    std::vector<GltfAttribute> attributes;
    const auto extension = primitive.extensions.find(k_draco);
    if (extension == primitive.extensions.end() || !gltf::has_draco()) return attributes;
    const tinygltf::Value& ids = extension->second.Get("attributes");
    const tinygltf::Accessor& position = reader.accessor(primitive.attributes.at("POSITION"), where);
    gltf::DracoRequest request;
    request.max_points = position.count;
    const std::size_t corners =
        primitive.indices >= 0 ? reader.accessor(primitive.indices, where).count : position.count;
    request.max_triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
    for (const auto& [name, number] : primitive.attributes) {
      const int id = gltf::index_in(ids, name);
      if (id < 0) continue;
      int& components = request.components[id];
      components = std::max(components, static_cast<int>(components_of(reader.accessor(number, where))));
      reader.spend(request.max_points, where);
    }
    const int view = gltf::index_in(extension->second, "bufferView");
    const gltf::DracoMesh mesh =
        gltf::decode_draco(reader.view(view, where + ", Draco"), request, document.file + ": " + where);
    count = mesh.points;
    for (const auto& [name, number] : primitive.attributes) {
      const int id = gltf::index_in(ids, name);
      if (id < 0) continue;
      const tinygltf::Accessor& accessor = reader.accessor(number, where);
      attributes.push_back(
          {name, static_cast<std::uint32_t>(number),
           components_of(accessor) * gltf::component_size(accessor.componentType),
           encode(mesh.attributes.at(id), static_cast<std::size_t>(request.components.at(id)), mesh.points, accessor)});
    }
    return attributes;
  }
};

GltfVertexReader::GltfVertexReader(const std::filesystem::path& file) : file_(std::make_unique<File>(file)) {}
GltfVertexReader::~GltfVertexReader() = default;

GltfVertices GltfVertexReader::read(std::uint32_t mesh, std::uint32_t number) {
  const std::string where = "mesh " + std::to_string(mesh) + ", primitive " + std::to_string(number);
  const tinygltf::Primitive& primitive = file_->document.model.meshes.at(mesh).primitives.at(number);
  GltfVertices vertices;
  vertices.count = file_->reader.accessor(primitive.attributes.at("POSITION"), where).count;
  vertices.attributes = file_->compressed_attributes(primitive, where, vertices.count);
  for (const auto& [name, accessor] : primitive.attributes) {
    const auto known = std::find_if(vertices.attributes.begin(), vertices.attributes.end(),
                                    [&](const GltfAttribute& a) { return a.name == name; });
    if (known == vertices.attributes.end()) vertices.attributes.push_back(file_->attribute(name, accessor, where));
  }
  for (const auto& target : primitive.targets) {
    vertices.targets.emplace_back();
    for (const auto& [name, accessor] : target)
      vertices.targets.back().push_back(file_->attribute(name, accessor, where + ", morph target"));
  }
  const auto check = [&](const GltfAttribute& attribute) {
    if (attribute.bytes.size() != vertices.count * attribute.element_bytes)
      throw InvalidInput(file_->document.file + ": " + where + ", " + attribute.name +
                         ": has not as many elements as POSITION");
  };
  std::for_each(vertices.attributes.begin(), vertices.attributes.end(), check);
  for (const auto& target : vertices.targets) std::for_each(target.begin(), target.end(), check);
  return vertices;
}

}  // namespace papilla
