// SPDX-License-Identifier: MIT
#pragma once

#include "glb_buffer.hpp"
#include "glb_material.hpp"
#include "papilla/io/glb_writer.hpp"

namespace papilla {

/// The glTF mesh of a part: one primitive per material slot that has triangles. Null when the part has no triangles.
GlbBuffer::Json glb_mesh(const Part& part, const std::vector<MaterialNeeds>& materials, const GlbWriteOptions& options,
                         GlbBuffer& buffer);

}  // namespace papilla
