// SPDX-License-Identifier: MIT
#include "meshopt_view.hpp"

#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

#ifdef PAPILLA_HAVE_MESHOPT
#include <meshoptimizer.h>
#endif

namespace papilla::gltf {
#ifdef PAPILLA_HAVE_MESHOPT
namespace {

/// No stream of meshopt is smaller than this part of its result: 2 bits of header for 16 bytes of vertices, a byte for
/// a triangle of 12 bytes, and as much again for short streams.
constexpr std::size_t k_max_ratio = 128, k_free_bytes = 1 << 16;

[[noreturn]] void fail(const std::string& where, const std::string& reason) {
  throw InvalidInput(where + ", meshopt: " + reason);
}

void check(const MeshoptView& view, std::size_t bytes, const std::string& where) {
  const std::size_t stride = view.byte_stride;
  const bool is_attributes = view.mode == "ATTRIBUTES";
  if (!is_attributes && view.mode != "TRIANGLES" && view.mode != "INDICES")
    fail(where, "mode '" + printable(view.mode) + "' is unknown");
  if (is_attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
    fail(where, "byteStride " + std::to_string(stride) + " is not allowed in mode " + view.mode);
  if (view.mode == "TRIANGLES" && view.count % 3 != 0)
    fail(where, "count " + std::to_string(view.count) + " is no whole number of triangles");
  if (view.count > (k_max_ratio * bytes + k_free_bytes) / stride)
    fail(where, "count " + std::to_string(view.count) + " is more than " + std::to_string(bytes) + " bytes can hold");
  const bool is_filter_good =
      view.filter == "NONE" ||
      (is_attributes && ((view.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                         (view.filter == "QUATERNION" && stride == 8) || view.filter == "EXPONENTIAL"));
  if (!is_filter_good)
    fail(where, "filter '" + printable(view.filter) + "' is not supported with byteStride " + std::to_string(stride));
}

int decode(std::span<const unsigned char> bytes, const MeshoptView& view, std::vector<unsigned char>& out) {
  if (view.mode == "ATTRIBUTES")
    return meshopt_decodeVertexBuffer(out.data(), view.count, view.byte_stride, bytes.data(), bytes.size());
  if (view.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out.data(), view.count, view.byte_stride, bytes.data(), bytes.size());
  return meshopt_decodeIndexSequence(out.data(), view.count, view.byte_stride, bytes.data(), bytes.size());
}

void apply_filter(const MeshoptView& view, std::vector<unsigned char>& out) {
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.byte_stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.byte_stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.byte_stride);
}

}  // namespace

bool has_meshopt() noexcept { return true; }

std::vector<unsigned char> decode_meshopt(std::span<const unsigned char> bytes, const MeshoptView& view,
                                          const std::string& where) {
  check(view, bytes.size(), where);
  std::vector<unsigned char> out(view.count * view.byte_stride);
  if (view.count == 0) return out;
  if (decode(bytes, view, out) != 0) fail(where, "the stream is damaged or of a later version");
  apply_filter(view, out);
  return out;
}

#else

bool has_meshopt() noexcept { return false; }

std::vector<unsigned char> decode_meshopt(std::span<const unsigned char>, const MeshoptView&,
                                          const std::string& where) {
  throw InvalidInput(where + " is compressed with meshopt, which this build was made without");
}

#endif
}  // namespace papilla::gltf
