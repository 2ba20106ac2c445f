// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/bake_plan.hpp"
#include "papilla/pipeline/library_material.hpp"

namespace papilla {

/// A material of the library that may suit a surface. Nothing applies it.
struct MaterialSuggestion {
  std::string surface;   ///< As plans list it.
  std::string material;  ///< Its id.
  std::string reason;    ///< "part name 'seat_cushion' has 'seat'"
};

/// For every surface that gets no material, the materials that suit it best, at most `most`, the best first.
///
/// What a surface is called is compared with what materials are called, word by word, English and German, a word of
/// four letters or more also within a longer one ("Lederlenkrad"): the names of its physical and visible materials
/// count most, then the part's. Of a material a name in full counts most, then its categories, then its uses; of these
/// the one of more words. Among those that suit equally well the one of the nearest colour is taken. Where no name
/// fits, the materials whose colour is nearest are, when that is less than 10 by CIE 1976 ΔE*ab and the colour is no
/// grey (C*ab ≥ 10): colour alone says little, and the reason says that it is the colour. Cost: surfaces x words of the
/// library.
std::vector<MaterialSuggestion> suggest_materials(const Scene& scene, const std::vector<PartSurface>& surfaces,
                                                  const std::vector<LibraryMaterial>& library, std::size_t most = 3);

}  // namespace papilla
