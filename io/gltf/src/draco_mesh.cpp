// SPDX-License-Identifier: MIT
#include "draco_mesh.hpp"

#include <memory>
#include <new>
#include <utility>

#include "papilla/core/error.hpp"

#ifdef PAPILLA_HAVE_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#endif

namespace papilla::gltf {
#ifdef PAPILLA_HAVE_DRACO
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& reason) {
  throw InvalidInput(where + ", Draco: " + reason);
}

/// The counts at a stream's beginning; a part of the Draco bitstream specification 2.2, 3.2 to 4 and 6.
struct Claims {
  std::uint32_t points = 0, triangles = 0, splits = 0;
};

bool read_claims(draco::DecoderBuffer& buffer, std::uint8_t method, Claims& claims) {
  if (method == draco::MESH_SEQUENTIAL_ENCODING)
    return draco::DecodeVarint(&claims.triangles, &buffer) && draco::DecodeVarint(&claims.points, &buffer);
  std::uint8_t traversal = 0, attributes = 0;
  std::uint32_t symbols = 0;
  return buffer.Decode(&traversal) && draco::DecodeVarint(&claims.points, &buffer) &&
         draco::DecodeVarint(&claims.triangles, &buffer) && buffer.Decode(&attributes) &&
         draco::DecodeVarint(&symbols, &buffer) && draco::DecodeVarint(&claims.splits, &buffer);
}

/// libdraco allocates memory for the counts that a stream claims, so the claims are checked first.
void check_claims(std::span<const unsigned char> bytes, const DracoRequest& request, const std::string& where) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) fail(where, "the stream has no header");
  if (header.encoder_type != draco::TRIANGULAR_MESH) fail(where, "the stream holds no mesh");
  if (header.version_major != 2 || header.version_minor < 2)
    fail(where, "bitstream " + std::to_string(header.version_major) + "." + std::to_string(header.version_minor) +
                    " is not supported (2.2 is)");
  buffer.set_bitstream_version(
      static_cast<std::uint16_t>(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor)));
  if ((header.flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) fail(where, "the metadata is damaged");
  }
  Claims claims;
  if (!read_claims(buffer, header.encoder_method, claims)) fail(where, "the stream is truncated");
  if (claims.points > request.max_points || claims.triangles > request.max_triangles ||
      claims.splits > request.max_triangles)
    fail(where, "the stream claims " + std::to_string(claims.points) + " vertices and " +
                    std::to_string(claims.triangles) + " triangles, the accessors " +
                    std::to_string(request.max_points) + " and " + std::to_string(request.max_triangles));
}

bool is_integer(draco::DataType type) { return type < draco::DT_FLOAT32 && type != draco::DT_INVALID; }

DracoMesh::Attribute numbers_of(const draco::Mesh& mesh, const draco::PointAttribute& source, int components) {
  DracoMesh::Attribute attribute;
  const auto width = static_cast<std::size_t>(components);
  attribute.is_integer = is_integer(source.data_type()) && !source.normalized();
  attribute.numbers.resize(mesh.num_points() * width);
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i)
    source.ConvertValue<double>(source.mapped_index(i), static_cast<std::int8_t>(components),
                                &attribute.numbers[i.value() * width]);
  return attribute;
}

std::unique_ptr<draco::Mesh> decode(std::span<const unsigned char> bytes, const std::string& where) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    auto result = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) fail(where, "the stream is damaged: " + result.status().error_msg_string());
    return std::move(result).value();
  } catch (const std::bad_alloc&) {
    fail(where, "the stream needs more memory than there is");
  }
}

}  // namespace

bool has_draco() noexcept { return true; }

DracoMesh decode_draco(std::span<const unsigned char> bytes, const DracoRequest& request, const std::string& where) {
  check_claims(bytes, request, where);
  const auto mesh = decode(bytes, where);
  if (mesh->num_points() > request.max_points || mesh->num_faces() > request.max_triangles)
    fail(where, std::to_string(mesh->num_points()) + " vertices and " + std::to_string(mesh->num_faces()) +
                    " triangles are more than the accessors name");
  DracoMesh result;
  result.points = mesh->num_points();
  for (const auto& [id, components] : request.components) {
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (attribute == nullptr) fail(where, "the stream has no attribute " + std::to_string(id));
    result.attributes[id] = numbers_of(*mesh, *attribute, components);
  }
  result.corners.reserve(3 * std::size_t{mesh->num_faces()});
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh->face(f)) {
      if (corner.value() >= result.points) fail(where, "vertex " + std::to_string(corner.value()) + " does not exist");
      result.corners.push_back(corner.value());
    }
  return result;
}

#else

bool has_draco() noexcept { return false; }

DracoMesh decode_draco(std::span<const unsigned char>, const DracoRequest&, const std::string& where) {
  throw InvalidInput(where + " is compressed with Draco, which this build was made without");
}

#endif
}  // namespace papilla::gltf
