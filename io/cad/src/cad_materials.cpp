// SPDX-License-Identifier: MIT
#include "cad_materials.hpp"

#include <NCollection_DataMap.hxx>
#include <Quantity_Color.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFDoc_VisMaterial.hxx>
#include <XCAFPrs.hxx>
#include <XCAFPrs_IndexedDataMapOfShapeStyle.hxx>
#include <XCAFPrs_Style.hxx>
#include <algorithm>

namespace papilla::cad {
namespace {

constexpr const char* k_uncoloured = "uncoloured";

CadColour style_colour(const XCAFPrs_Style& style) {
  if (!style.Material().IsNull()) return style.Material()->BaseColor();
  if (style.IsSetColorSurf()) return style.GetColorSurfRGBA();
  if (style.IsSetColorCurv()) return Quantity_ColorRGBA(style.GetColorCurv());
  return std::nullopt;
}

Material material_of(const CadColour& colour) {
  Material material;
  material.name = colour ? colour_name(*colour) : k_uncoloured;
  if (!colour) {
    material.base_color = {0.6, 0.6, 0.6, 1};
    return material;
  }
  const Quantity_Color& rgb = colour->GetRGB();  // Linear.
  const double alpha = static_cast<double>(colour->Alpha());
  material.base_color = {rgb.Red(), rgb.Green(), rgb.Blue(), alpha};
  if (alpha < 1) material.alpha_mode = "BLEND";
  material.extras_json = "{\"cad_colour\":\"" + material.name.substr(0, 7) + "\"}";
  return material;
}

/// Larger shapes first, so that a smaller one's colour overwrites them.
std::vector<int> order_by_size(const XCAFPrs_IndexedDataMapOfShapeStyle& styles) {
  std::vector<int> order(static_cast<std::size_t>(styles.Extent()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i) + 1;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return styles.FindKey(a).ShapeType() < styles.FindKey(b).ShapeType(); });
  return order;
}

}  // namespace

std::string colour_name(const Quantity_ColorRGBA& colour) {
  const bool opaque = colour.Alpha() >= 1;
  return (opaque ? Quantity_Color::ColorToHex(colour.GetRGB()) : Quantity_ColorRGBA::ColorToHex(colour)).ToCString();
}

CadColour label_colour(const TDF_Label& label) {
  const Handle(XCAFDoc_ColorTool) tool = XCAFDoc_DocumentTool::ColorTool(label);
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen, XCAFDoc_ColorCurv}) {
    Quantity_ColorRGBA colour;
    if (tool->GetColor(label, type, colour)) return colour;
  }
  return std::nullopt;
}

std::uint32_t MaterialTable::index_of(const CadColour& colour) {
  const std::string name = colour ? colour_name(*colour) : k_uncoloured;
  const auto [entry, added] = by_name_.try_emplace(name, static_cast<std::uint32_t>(materials_.size()));
  if (added) materials_.push_back(material_of(colour));
  return entry->second;
}

std::vector<CadColour> face_colours(const TDF_Label& label, const TopoDS_Shape& body, const CadColour& instance,
                                    const CadColour& inherited) {
  XCAFPrs_IndexedDataMapOfShapeStyle styles;
  XCAFPrs::CollectStyleSettings(label, TopLoc_Location(), styles);
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
  CadColour whole = instance ? instance : label_colour(label);
  if (!whole) whole = inherited;

  NCollection_DataMap<TopoDS_Shape, Quantity_ColorRGBA, TopTools_ShapeMapHasher> by_face;
  for (const int i : order_by_size(styles)) {
    const CadColour colour = style_colour(styles.FindFromIndex(i));
    if (!colour || styles.FindKey(i).IsSame(shape)) continue;
    for (TopExp_Explorer faces(styles.FindKey(i), TopAbs_FACE); faces.More(); faces.Next())
      by_face.Bind(faces.Current(), *colour);
  }
  std::vector<CadColour> result;
  for (TopExp_Explorer faces(body, TopAbs_FACE); faces.More(); faces.Next()) {
    const Quantity_ColorRGBA* own = by_face.Seek(faces.Current());
    result.push_back(own ? CadColour(*own) : whole);
  }
  return result;
}

}  // namespace papilla::cad
