// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/measure.hpp"

namespace papilla::app {

/// The triangles of one material slot of a part, as the page gets them: streams of meshoptimizer's codecs.
///
/// A vertex takes 24 bytes, little endian: position as 4 x u16 (the fourth is 0) over [low, high], uv as 2 x u16 over
/// [uv_low, uv_high], normal as 4 x i8 (divided by 127; the fourth is 0), and 4 x u16 of k_page_no_value or stretch
/// (2^(c / 2048 - 16)), angle error (180 c / 65534 degrees), uv units per millimetre (coded as the stretch), 0.
struct PageMesh {
  std::uint32_t slot = 0;
  std::size_t triangles = 0, shown = 0, vertices = 0;
  std::size_t coarse = 0;  ///< Triangles of `coarse_stream`, over the same vertices; shown while the camera moves.
  double error_mm = 0;     ///< Of the simplification, as the simplifier estimates it; 0 when nothing was left out.
  bool has_uv = false;
  Vec3 low, high;
  Vec2 uv_low, uv_high, uv1_low, uv1_high;
  std::vector<std::byte> vertex_stream, index_stream, coarse_stream;
  std::vector<std::byte> uv1_stream;  ///< Channel 1 as 2 x u16 over [uv1_low, uv1_high]; empty when nothing needs it.
};

/// "Not measured" in the streams of a PageMesh.
inline constexpr std::uint16_t k_page_no_value = 65535;

/// The part's triangles by material slot, at most about `keep` of them (in (0, 1]) by quadric simplification that
/// leaves borders and seams of uv in place, or by clustering where these allow too little. Distortion is that of the
/// full mesh, averaged by area at the vertices that are kept.
/// @param uv the channel to show; entries without value give uv (0, 0) and no distortion.
/// @param needs_uv1 by material slot: something lies on channel 1 of the mesh. Slots beyond its end need nothing.
/// @param report of measure_distortion(mesh, uv); without triangles when there is no uv.
std::vector<PageMesh> page_meshes(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                                  const std::vector<bool>& needs_uv1, const DistortionReport& report, double keep);

}  // namespace papilla::app
