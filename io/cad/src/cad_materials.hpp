// SPDX-License-Identifier: MIT
#pragma once

#include <Quantity_ColorRGBA.hxx>
#include <TDF_Label.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla::cad {

using CadColour = std::optional<Quantity_ColorRGBA>;

/// "#RRGGBB" in sRGB, or "#RRGGBBAA" when translucent.
std::string colour_name(const Quantity_ColorRGBA& colour);

/// The colour set on a label itself: the surface's, else the general one, else the curves'.
CadColour label_colour(const TDF_Label& label);

/// The scene's materials, one per colour, in order of first use.
class MaterialTable {
 public:
  explicit MaterialTable(std::vector<Material>& materials) : materials_(materials) {}
  std::uint32_t index_of(const CadColour& colour);

 private:
  std::vector<Material>& materials_;
  std::map<std::string, std::uint32_t> by_name_;
};

/// The colour of each face of `body`, which is the shape on `label` or a part of it, in TopExp_Explorer's order: the
/// face's own, else that of the smallest coloured sub-shape around it, else `instance`, else the shape's, else
/// `inherited`.
std::vector<CadColour> face_colours(const TDF_Label& label, const TopoDS_Shape& body, const CadColour& instance,
                                    const CadColour& inherited);

}  // namespace papilla::cad
