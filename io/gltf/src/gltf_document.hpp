// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "papilla/io/gltf_origin.hpp"
#include "papilla/io/gltf_triangles.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// A parsed file: everything but the accessors' content, which tinygltf does not check. Buffers are not copied: they
/// stay where the file was read to.
struct Document {
  Document() = default;
  Document(Document&&) = default;
  Document(const Document&) = delete;

  std::string file;  ///< As messages name it.
  bool binary = false;
  tinygltf::Model model;
  std::vector<std::string> storage;                     ///< The file, and those that buffers name.
  std::vector<std::span<const unsigned char>> buffers;  ///< The content of model.buffers, in `storage` or in them.
  std::set<int> empty_buffers;                          ///< Those without data, as extensions allow them.
  std::vector<std::string> warnings;
};

/// Reads and parses; pictures stay encoded in Image::image (those in buffer views stay there).
/// @throws IoError, InvalidInput as read_gltf().
Document load_document(const std::filesystem::path& path);

/// Bytes of one component; 0 when the type is unknown.
std::size_t component_size(int component_type);

/// glTF 2.0, 3.11: how a normalized integer becomes a real number. Floats stay as they are.
double normalize(double value, int component_type);

/// The whole number that a member of an extension is; -1 where it is none.
int index_in(const tinygltf::Value& object, const std::string& name);

/// Reads accessors; every offset, stride and count is checked against the buffers before anything is
/// allocated. One object serves a whole file and limits the total number of elements that it returns.
class AccessorReader {
 public:
  explicit AccessorReader(const Document& document);

  /// Components of all elements, one after the other, as numbers: normalized integers become [0, 1] or [−1, 1].
  /// @param components  what the accessor's type must have (VEC3: 3).
  /// @param where       how messages name the use, for example "mesh 0, primitive 1, POSITION".
  /// @throws InvalidInput naming file, use, accessor and reason; also when a number is not finite.
  std::vector<double> numbers(int accessor, int components, const std::string& where);

  /// The elements as they are stored, one after the other without gaps, those of sparse accessors at their places.
  /// @pre no matrices.
  std::vector<std::byte> bytes(int accessor, const std::string& where);

  /// numbers() in single precision, element by element; k_components is 2 or 3.
  template <std::size_t k_components>
  std::vector<std::array<float, k_components>> floats(int accessor, const std::string& where);

  /// The elements of a scalar accessor of unsigned integers.
  std::vector<std::uint32_t> indices(int accessor, const std::string& where);

  /// @throws InvalidInput when the accessor does not exist.
  const tinygltf::Accessor& accessor(int number, const std::string& where) const;

  /// The bytes of a buffer view, decoded when they are compressed with meshopt.
  std::span<const unsigned char> view(int number, const std::string& where);

  /// Counts elements against the limit of the file.
  /// @throws InvalidInput when the limit is exceeded.
  void spend(std::size_t elements, const std::string& where);

 private:
  struct Elements;
  using Take = std::function<void(std::size_t index, const unsigned char* element)>;
  [[noreturn]] void fail(const std::string& where, const std::string& reason) const;
  std::span<const unsigned char> range(int buffer, std::size_t offset, std::size_t length, const std::string& what,
                                       const std::string& where) const;
  Elements elements(int view, std::size_t offset, std::size_t count, int component_type, int components, bool strided,
                    const std::string& where);
  void for_each_sparse(const tinygltf::Accessor& accessor, int components, const std::string& where, const Take& take);
  void for_each(const tinygltf::Accessor& accessor, int components, const std::string& where, const Take& take);

  const Document& document_;
  std::size_t budget_ = 0;
  std::map<int, std::vector<unsigned char>> decoded_;  ///< By the number of the view.
};

/// Element i of numbers() of three components.
inline Vec3 vec3_at(const std::vector<double>& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

/// Copies images, textures and materials of a document to a scene, in the same order.
void read_materials(const Document& document, AccessorReader& reader, Scene& scene);

/// Turns the meshes of a document into the parts of a scene, in the same order.
/// Adds a default material when a primitive names none. @pre `scene.materials` have been read.
/// @param tag_channel, cad_uv  of GltfReadOptions.
/// @returns GltfOrigin::parts.
std::vector<GltfOrigin::Part> read_parts(const Document& document, AccessorReader& reader, bool tag_channel,
                                         bool cad_uv, Scene& scene);

/// The same without their meshes: names, materials and which primitives draw triangles.
std::vector<GltfOrigin::Part> list_parts(const Document& document, AccessorReader& reader, Scene& scene);

/// Vertices and triangles of a primitive that list_parts() names.
/// @param channel, normals  as of GltfTriangles::read().
GltfPrimitive read_primitive(const Document& document, AccessorReader& reader, std::uint32_t mesh, std::uint32_t number,
                             std::optional<int> channel, bool normals, Scene& scene);

}  // namespace papilla::gltf
