// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla::detail {

/// Charts and maps a part as keep_bound() does, on coarser meshes first where the effort and its size allow it.
/// @param o with max_distortion. @param part gets what became of the bound, and choices.
Flattening chart_within_bound(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context,
                              FlattenedPart& part);

}  // namespace papilla::detail
