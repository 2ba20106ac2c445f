// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "object_textures/carrier_frame.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"
#include "pictures/mip_pyramid.hpp"

namespace papilla {

/// What is seen of triangles through a frame from far away.
struct PartPicture {
  RgbaImage color;     ///< Base colours without light; alpha is the share of a pixel that is covered.
  ColorImage normals;  ///< Of the geometry, as normal_map() codes them; out of the picture where nothing is.
  HeightMap relief;    ///< Above the frame's plane; as low as the lowest place where nothing is.
};

/// An orthographic picture of the triangles of `mesh`, whose slots name `materials` of the scene, 3 × 3 samples a
/// pixel. Triangles that look away are seen where their material is double sided only. The nearest one along
/// `forward` is seen, however far from the frame's plane it is. Colours of pixels that nothing covers are those of
/// their neighbours, so that filters don't darken the edge.
/// @param pixels  of the longer side, >= 1; the shorter one has pixels of the same size, as near as whole ones are.
PartPicture picture_of_part(const Scene& scene, Pyramids& pyramids, const TriangleMesh& mesh,
                            const std::vector<Index>& triangles, const std::vector<std::uint32_t>& materials,
                            const CarrierFrame& frame, int pixels);

}  // namespace papilla
