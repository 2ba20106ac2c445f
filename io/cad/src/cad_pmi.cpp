// SPDX-License-Identifier: MIT
#include "cad_metadata.hpp"

#include <TDF_LabelSequence.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <XCAFDimTolObjects_DatumObject.hxx>
#include <XCAFDimTolObjects_DimensionObject.hxx>
#include <XCAFDimTolObjects_GeomToleranceObject.hxx>
#include <XCAFDoc_Datum.hxx>
#include <XCAFDoc_DimTolTool.hxx>
#include <XCAFDoc_Dimension.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GeomTolerance.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <array>
#include <cmath>
#include <utility>

namespace papilla::cad {
namespace {

/// In the order of XCAFDimTolObjects_DimensionType.
constexpr std::array<const char*, 32> k_dimension_types = {"location",
                                                           "curved distance",
                                                           "linear distance",
                                                           "linear distance from center to outer",
                                                           "linear distance from center to inner",
                                                           "linear distance from outer to center",
                                                           "linear distance from outer to outer",
                                                           "linear distance from outer to inner",
                                                           "linear distance from inner to center",
                                                           "linear distance from inner to outer",
                                                           "linear distance from inner to inner",
                                                           "angular location",
                                                           "oriented location",
                                                           "location with path",
                                                           "curve length",
                                                           "diameter",
                                                           "spherical diameter",
                                                           "radius",
                                                           "spherical radius",
                                                           "toroidal minor diameter",
                                                           "toroidal major diameter",
                                                           "toroidal minor radius",
                                                           "toroidal major radius",
                                                           "toroidal high major diameter",
                                                           "toroidal low major diameter",
                                                           "toroidal high major radius",
                                                           "toroidal low major radius",
                                                           "thickness",
                                                           "angle",
                                                           "size with path",
                                                           "common label",
                                                           "presentation"};

/// In the order of XCAFDimTolObjects_GeomToleranceType.
constexpr std::array<const char*, 16> k_tolerance_types = {
    "tolerance",          "angularity",   "circular runout", "circularity",      "coaxiality", "concentricity",
    "cylindricity",       "flatness",     "parallelism",     "perpendicularity", "position",   "profile of line",
    "profile of surface", "straightness", "symmetry",        "total runout"};

template <std::size_t N>
const char* name_in(const std::array<const char*, N>& names, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < N ? names[static_cast<std::size_t>(index)] : "unknown";
}

void add_text(Json& json, const char* key, const std::string& text) {
  if (!text.empty()) json[key] = text;
}

void add_number(Json& json, const char* key, double value) {
  if (std::isfinite(value)) json[key] = value;
}

Json describe(const Handle(XCAFDimTolObjects_DimensionObject) & dimension) {
  Json json = {{"kind", "dimension"}, {"type", name_in(k_dimension_types, dimension->GetType())}};
  add_text(json, "name", text_of(dimension->GetSemanticName()));
  add_text(json, "presentation", text_of(dimension->GetPresentationName()));
  if (!dimension->GetValues().IsNull()) add_number(json, "value", dimension->GetValue());
  if (dimension->IsDimWithRange()) {
    add_number(json, "upper_bound", dimension->GetUpperBound());
    add_number(json, "lower_bound", dimension->GetLowerBound());
  }
  if (dimension->IsDimWithPlusMinusTolerance()) {
    add_number(json, "upper_tolerance", dimension->GetUpperTolValue());
    add_number(json, "lower_tolerance", dimension->GetLowerTolValue());
  }
  for (int i = 0; i < dimension->NbDescriptions(); ++i)
    if (std::string text = text_of(dimension->GetDescription(i)); !text.empty()) json["notes"].push_back(text);
  return json;
}

Json describe(const Handle(XCAFDimTolObjects_GeomToleranceObject) & tolerance) {
  Json json = {{"kind", "tolerance"}, {"type", name_in(k_tolerance_types, tolerance->GetType())}};
  add_text(json, "name", text_of(tolerance->GetSemanticName()));
  add_text(json, "presentation", text_of(tolerance->GetPresentationName()));
  add_number(json, "value", tolerance->GetValue());
  return json;
}

Json describe(const Handle(XCAFDimTolObjects_DatumObject) & datum) {
  Json json = {{"kind", "datum"}};
  add_text(json, "name", text_of(datum->GetName()));
  add_text(json, "presentation", text_of(datum->GetPresentationName()));
  return json;
}

/// The part that a shape's label belongs to: itself or the label above a face's.
TDF_Label part_of(const TDF_Label& shape) { return XCAFDoc_ShapeTool::IsSubShape(shape) ? shape.Father() : shape; }

class PmiReader {
 public:
  PmiReader(const Handle(XCAFDoc_DimTolTool) & tool, CadPmi& pmi) : tool_(tool), pmi_(pmi) {}

  void add(const TDF_Label& label, Json json) {
    TDF_LabelSequence first, second;
    tool_->GetRefShapeLabel(label, first, second);
    TDF_LabelSequence all = first;
    for (const TDF_Label& shape : second) all.Append(shape);
    if (all.IsEmpty()) {
      ++without_part_;
      return;
    }
    std::map<std::string, Json> faces;
    for (const TDF_Label& shape : all) {
      Json& list = faces[entry_of(part_of(shape))];
      for (const int face : face_numbers(shape)) list.push_back(face);
    }
    for (const auto& [entry, list] : faces) {
      Json own = json;
      if (!list.is_null()) own["faces"] = list;
      pmi_.of_part[entry].push_back(std::move(own));
    }
    ++count_;
  }

  void finish() {
    if (count_ > 0)
      pmi_.losses.push_back("PMI: the drawing of " + std::to_string(count_) +
                            " dimensions, tolerances and datums is not kept, their text is");
    if (without_part_ > 0)
      pmi_.losses.push_back("PMI: " + std::to_string(without_part_) +
                            " dimensions, tolerances or datums name no part and are not kept");
  }

 private:
  std::vector<int> face_numbers(const TDF_Label& shape_label) {
    std::vector<int> result;
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(shape_label),
                       part = XCAFDoc_ShapeTool::GetShape(part_of(shape_label));
    if (shape.IsNull() || part.IsNull() || shape.IsSame(part)) return result;
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    int number = 0;
    for (TopExp_Explorer all(part, TopAbs_FACE); all.More(); all.Next(), ++number)
      if (faces.Contains(all.Current())) result.push_back(number);
    return result;
  }

  Handle(XCAFDoc_DimTolTool) tool_;
  CadPmi& pmi_;
  std::size_t count_ = 0, without_part_ = 0;
};

}  // namespace

CadPmi read_pmi(const Handle(TDocStd_Document) & document) {
  CadPmi pmi;
  const Handle(XCAFDoc_DimTolTool) tool = XCAFDoc_DocumentTool::DimTolTool(document->Main());
  PmiReader reader(tool, pmi);
  TDF_LabelSequence labels;
  tool->GetDimensionLabels(labels);
  for (const TDF_Label& label : labels) {
    Handle(XCAFDoc_Dimension) attribute;
    if (label.FindAttribute(XCAFDoc_Dimension::GetID(), attribute)) reader.add(label, describe(attribute->GetObject()));
  }
  labels.Clear();
  tool->GetGeomToleranceLabels(labels);
  for (const TDF_Label& label : labels) {
    Handle(XCAFDoc_GeomTolerance) attribute;
    if (!label.FindAttribute(XCAFDoc_GeomTolerance::GetID(), attribute)) continue;
    Json json = describe(attribute->GetObject());
    TDF_LabelSequence datums;
    tool->GetDatumOfTolerLabels(label, datums);
    for (const TDF_Label& datum_label : datums) {
      Handle(XCAFDoc_Datum) datum;
      if (datum_label.FindAttribute(XCAFDoc_Datum::GetID(), datum))
        json["datums"].push_back(text_of(datum->GetObject()->GetName()));
    }
    reader.add(label, std::move(json));
  }
  labels.Clear();
  tool->GetDatumLabels(labels);
  for (const TDF_Label& label : labels) {
    Handle(XCAFDoc_Datum) attribute;
    if (label.FindAttribute(XCAFDoc_Datum::GetID(), attribute)) reader.add(label, describe(attribute->GetObject()));
  }
  reader.finish();
  return pmi;
}

}  // namespace papilla::cad
