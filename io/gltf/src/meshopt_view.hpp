// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

namespace papilla::gltf {

/// EXT_meshopt_compression (and KHR_meshopt_compression) of a bufferView.
struct MeshoptView {
  int buffer = -1;
  std::size_t byte_offset = 0, byte_length = 0, byte_stride = 0, count = 0;
  std::string mode, filter = "NONE";
};

/// Whether this build can decode meshopt.
bool has_meshopt() noexcept;

/// The decoded bytes, count · byte_stride of them.
/// @param bytes  the compressed ones.
/// @param where  begins messages.
/// @throws InvalidInput when the description or the stream is damaged, the stream claims more than its bytes can hold,
///         or this build has no libmeshoptimizer.
std::vector<unsigned char> decode_meshopt(std::span<const unsigned char> bytes, const MeshoptView& view,
                                          const std::string& where);

}  // namespace papilla::gltf
