// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/meshing/simplify.hpp"

namespace papilla {

/// A chain of ever coarser meshes, one per tolerance, each made from the one before and measured against the input, so
/// that every level holds its own tolerance. Levels share positions: each one's vertices are a subset of the
/// previous one's. A level may equal the one before when the tolerance allows nothing more.
/// @param tolerances_mm Positive and finite, ascending. @param options Its tolerance and target do not matter.
/// @throws InvalidInput as simplify(), and when the tolerances are not ascending.
std::vector<SimplifyResult> levels_of_detail(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                             const SimplifyOptions& options = {});

}  // namespace papilla
