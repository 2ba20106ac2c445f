// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "meshopt_view.hpp"
#include "papilla/core/error.hpp"

namespace papilla::gltf {
namespace {

/// Most elements read from one file, all uses of an accessor counted: 2^28 are 90 million triangles. A small file gets
/// less: each of its bytes may be used 64 times.
constexpr std::size_t k_max_elements = std::size_t{1} << 28;
constexpr std::size_t k_elements_per_byte = 64;
constexpr std::size_t k_free_elements = std::size_t{1} << 20;

template <class T>
double load(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double load(const unsigned char* at, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return load<std::int8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return load<std::int16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<std::uint16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return load<std::uint32_t>(at);
    default: return load<float>(at);
  }
}

std::size_t size_or(const tinygltf::Value& object, const char* name, std::size_t fallback) {
  if (!object.Has(name) || !object.Get(name).IsNumber()) return fallback;
  const double value = object.Get(name).GetNumberAsDouble();
  return value >= 0 && value < 1e15 ? static_cast<std::size_t>(value) : std::numeric_limits<std::size_t>::max();
}

/// The description of a compressed view; numbers out of range stay out of every range.
std::optional<MeshoptView> meshopt_view(const tinygltf::BufferView& view) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto found = view.extensions.find(name);
    if (found == view.extensions.end() || !found->second.IsObject()) continue;
    const tinygltf::Value& source = found->second;
    MeshoptView result;
    const std::size_t buffer = size_or(source, "buffer", std::numeric_limits<std::size_t>::max());
    result.buffer = buffer <= k_max_elements ? static_cast<int>(buffer) : -1;
    result.byte_offset = size_or(source, "byteOffset", 0);
    result.byte_length = size_or(source, "byteLength", 0);
    result.byte_stride = size_or(source, "byteStride", 0);
    result.count = size_or(source, "count", 0);
    if (source.Has("mode") && source.Get("mode").IsString()) result.mode = source.Get("mode").Get<std::string>();
    if (source.Has("filter") && source.Get("filter").IsString())
      result.filter = source.Get("filter").Get<std::string>();
    return result;
  }
  return std::nullopt;
}

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

int index_in(const tinygltf::Value& object, const std::string& name) {
  return object.Has(name) && object.Get(name).IsInt() ? object.Get(name).GetNumberAsInt() : -1;
}

std::size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    default: return 0;
  }
}

double normalize(double value, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return std::max(value / 127, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return value / 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return std::max(value / 32767, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return value / 65535;
    default: return value;
  }
}

/// A checked window on a buffer.
struct AccessorReader::Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  const unsigned char* at(std::size_t i) const { return first + i * stride; }
};

void AccessorReader::fail(const std::string& where, const std::string& reason) const {
  throw InvalidInput(document_.file + ": " + where + ": " + reason);
}

AccessorReader::AccessorReader(const Document& document) : document_(document) {
  std::size_t bytes = 0;
  for (const auto& buffer : document.buffers) bytes += buffer.size();
  budget_ = std::min(k_max_elements, k_free_elements + k_elements_per_byte * bytes);
}

void AccessorReader::spend(std::size_t elements, const std::string& where) {
  if (elements > budget_) fail(where, "the file expands to more elements than its size and 2^28 allow");
  budget_ -= elements;
}

const tinygltf::Accessor& AccessorReader::accessor(int number, const std::string& where) const {
  const auto& accessors = document_.model.accessors;
  if (number < 0 || static_cast<std::size_t>(number) >= accessors.size())
    fail(where, "accessor " + std::to_string(number) + " does not exist");
  return accessors[static_cast<std::size_t>(number)];
}

std::span<const unsigned char> AccessorReader::range(int number, std::size_t offset, std::size_t length,
                                                     const std::string& what, const std::string& where) const {
  if (number < 0 || static_cast<std::size_t>(number) >= document_.buffers.size())
    fail(where, what + " names buffer " + std::to_string(number) + ", which does not exist");
  const auto buffer = document_.buffers[static_cast<std::size_t>(number)];
  if (document_.empty_buffers.contains(number)) fail(where, "buffer " + std::to_string(number) + " has no data");
  if (offset > buffer.size() || length > buffer.size() - offset)
    fail(where, what + " (offset " + std::to_string(offset) + ", length " + std::to_string(length) +
                    ") exceeds its buffer of " + std::to_string(buffer.size()) + " bytes");
  return buffer.subspan(offset, length);
}

std::span<const unsigned char> AccessorReader::view(int number, const std::string& where) {
  const tinygltf::Model& model = document_.model;
  const std::string what = "bufferView " + std::to_string(number);
  if (number < 0 || static_cast<std::size_t>(number) >= model.bufferViews.size()) fail(where, what + " does not exist");
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(number)];
  const auto compressed = meshopt_view(view);
  if (!compressed || (!has_meshopt() && !document_.empty_buffers.contains(view.buffer)))
    return range(view.buffer, view.byteOffset, view.byteLength, what, where);
  if (const auto known = decoded_.find(number); known != decoded_.end()) return known->second;
  const auto bytes = range(compressed->buffer, compressed->byte_offset, compressed->byte_length, what, where);
  return decoded_[number] = decode_meshopt(bytes, *compressed, document_.file + ": " + what);
}

AccessorReader::Elements AccessorReader::elements(int view_number, std::size_t offset, std::size_t count,
                                                  int component_type, int components, bool strided,
                                                  const std::string& where) {
  const std::size_t component = component_size(component_type);
  if (component == 0) fail(where, "componentType " + std::to_string(component_type) + " is not supported");
  const std::size_t size = component * static_cast<std::size_t>(components);
  const auto bytes = view(view_number, where);
  const std::size_t declared = document_.model.bufferViews[static_cast<std::size_t>(view_number)].byteStride;
  const std::size_t stride = strided && declared != 0 ? declared : size;
  if (stride < size)
    fail(where,
         "byteStride " + std::to_string(stride) + " is smaller than an element of " + std::to_string(size) + " bytes");
  if (offset > bytes.size() || bytes.size() - offset < size || count - 1 > (bytes.size() - offset - size) / stride)
    fail(where, std::to_string(count) + " elements of " + std::to_string(size) + " bytes at offset " +
                    std::to_string(offset) + ", stride " + std::to_string(stride) + " exceed bufferView " +
                    std::to_string(view_number) + " of " + std::to_string(bytes.size()) + " bytes");
  return {bytes.data() + offset, stride};
}

/// Calls take(index, element) for the elements that replace others.
void AccessorReader::for_each_sparse(const tinygltf::Accessor& accessor, int components, const std::string& where,
                                     const Take& take) {
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  const std::string place = where + ", sparse";
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor.count)
    fail(place, "count " + std::to_string(sparse.count) + " is not in 1.." + std::to_string(accessor.count));
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) fail(place, "byteOffset is negative");
  if (!is_unsigned(sparse.indices.componentType)) fail(place, "the indices are not unsigned integers");
  const auto count = static_cast<std::size_t>(sparse.count);
  const Elements where_to = elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                                     count, sparse.indices.componentType, 1, false, place);
  const Elements what = elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                                 accessor.componentType, components, false, place);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(load(where_to.at(i), sparse.indices.componentType));
    if (index >= accessor.count)
      fail(place, "index " + std::to_string(index) + " is not below " + std::to_string(accessor.count));
    take(index, what.at(i));
  }
}

/// Calls take(index, element) for the stored elements and then for those that replace some of them.
void AccessorReader::for_each(const tinygltf::Accessor& accessor, int components, const std::string& where,
                              const Take& take) {
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
    fail(where, "the accessor's type has not " + std::to_string(components) + " components");
  if (accessor.count == 0) fail(where, "the accessor's count is 0");
  if (component_size(accessor.componentType) == 0)
    fail(where, "componentType " + std::to_string(accessor.componentType) + " is not supported");
  std::optional<Elements> source;
  if (accessor.bufferView >= 0)
    source = elements(accessor.bufferView, accessor.byteOffset, accessor.count, accessor.componentType, components,
                      true, where);
  spend(accessor.count, where);
  for (std::size_t i = 0; source && i < accessor.count; ++i) take(i, source->at(i));
  for_each_sparse(accessor, components, where, take);
}

std::vector<std::byte> AccessorReader::bytes(int number, const std::string& where) {
  const std::string place = where + ", accessor " + std::to_string(number);
  const tinygltf::Accessor& source = accessor(number, where);
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type));
  const std::size_t size = component_size(source.componentType) * static_cast<std::size_t>(std::max(components, 0));
  if (size == 0 || source.count == 0) fail(place, "its type is not supported, or it has no elements");
  std::optional<Elements> stored;
  if (source.bufferView >= 0)
    stored =
        elements(source.bufferView, source.byteOffset, source.count, source.componentType, components, true, place);
  spend(source.count, place);
  std::vector<std::byte> bytes(source.count * size);
  const Take take = [&](std::size_t i, const unsigned char* at) { std::memcpy(bytes.data() + i * size, at, size); };
  for (std::size_t i = 0; stored && i < source.count; ++i) take(i, stored->at(i));
  for_each_sparse(source, components, place, take);
  return bytes;
}

std::vector<double> AccessorReader::numbers(int number, int components, const std::string& where) {
  const std::string place = where + ", accessor " + std::to_string(number);
  const tinygltf::Accessor& source = accessor(number, where);
  const auto width = static_cast<std::size_t>(components);
  const std::size_t step = component_size(source.componentType);
  std::vector<double> values;
  for_each(source, components, place, [&](std::size_t i, const unsigned char* at) {
    if (values.empty()) values.resize(source.count * width);
    for (std::size_t k = 0; k < width; ++k) values[i * width + k] = load(at + k * step, source.componentType);
  });
  values.resize(source.count * width);
  if (source.normalized)
    for (double& value : values) value = normalize(value, source.componentType);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) fail(place, "element " + std::to_string(i / width) + " is not finite");
  return values;
}

template <std::size_t k_components>
std::vector<std::array<float, k_components>> AccessorReader::floats(int number, const std::string& where) {
  const std::string place = where + ", accessor " + std::to_string(number);
  const tinygltf::Accessor& source = accessor(number, where);
  const std::size_t step = component_size(source.componentType);
  std::vector<std::array<float, k_components>> values;
  for_each(source, static_cast<int>(k_components), place, [&](std::size_t i, const unsigned char* at) {
    if (values.empty()) values.resize(source.count);
    if (source.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
      std::memcpy(values[i].data(), at, sizeof values[i]);
      return;
    }
    for (std::size_t k = 0; k < k_components; ++k) {
      const double value = load(at + k * step, source.componentType);
      values[i][k] = static_cast<float>(source.normalized ? normalize(value, source.componentType) : value);
    }
  });
  values.resize(source.count);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (const float value : values[i])
      if (!std::isfinite(value)) fail(place, "element " + std::to_string(i) + " is not finite");
  return values;
}
template std::vector<std::array<float, 2>> AccessorReader::floats<2>(int, const std::string&);
template std::vector<std::array<float, 3>> AccessorReader::floats<3>(int, const std::string&);

std::vector<std::uint32_t> AccessorReader::indices(int number, const std::string& where) {
  const std::string place = where + ", accessor " + std::to_string(number);
  const tinygltf::Accessor& source = accessor(number, where);
  if (!is_unsigned(source.componentType)) fail(place, "indices must be unsigned integers");
  std::vector<std::uint32_t> values;
  for_each(source, 1, place, [&](std::size_t i, const unsigned char* at) {
    if (values.empty()) values.resize(source.count);
    std::memcpy(&values[i], at, component_size(source.componentType));  // Little-endian, the other bytes are zero.
  });
  values.resize(source.count);
  return values;
}

}  // namespace papilla::gltf
