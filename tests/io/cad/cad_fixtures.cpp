// SPDX-License-Identifier: MIT
#include "io/cad/cad_fixtures.hpp"

#include <BRepTools.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFDimTolObjects_DimensionObject.hxx>
#include <XCAFDimTolObjects_GeomToleranceObject.hxx>
#include <XCAFDoc_Area.hxx>
#include <XCAFDoc_Centroid.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DimTolTool.hxx>
#include <XCAFDoc_Dimension.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GeomTolerance.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFDoc_Volume.hxx>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

namespace papilla::test {
namespace {

void require(bool done, const std::filesystem::path& path) {
  if (!done) throw std::runtime_error("fixture can't be written: " + path.string());
}

Quantity_Color to_colour(unsigned srgb) {
  const auto channel = [srgb](unsigned shift) { return ((srgb >> shift) & 0xFFu) / 255.0; };
  return {channel(16), channel(8), channel(0), Quantity_TOC_sRGB};
}

}  // namespace

CadFile::CadFile() : document_(new TDocStd_Document("BinXCAF")) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPCAFControl_Controller::Init();
  XCAFDoc_DocumentTool::Set(document_->Main());
}

TDF_Label CadFile::add(const std::string& name, const TopoDS_Shape& shape) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddShape(shape, false);
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
  return label;
}

TDF_Label CadFile::add_assembly(const std::string& name) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->NewShape();
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
  return label;
}

TDF_Label CadFile::place(const TDF_Label& assembly, const TDF_Label& part, const gp_Trsf& where,
                         const std::string& name) {
  const TDF_Label label =
      XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddComponent(assembly, part, TopLoc_Location(where));
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
  return label;
}

void CadFile::colour(const TDF_Label& label, unsigned srgb, float alpha) {
  XCAFDoc_DocumentTool::ColorTool(document_->Main())
      ->SetColor(label, Quantity_ColorRGBA(to_colour(srgb), alpha), XCAFDoc_ColorSurf);
}

void CadFile::colour_face(const TDF_Label& part, const TopoDS_Shape& face, unsigned srgb) {
  colour(XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddSubShape(part, face), srgb);
}

void CadFile::layer(const TDF_Label& label, const std::string& name) {
  XCAFDoc_DocumentTool::LayerTool(document_->Main())->SetLayer(label, TCollection_ExtendedString(name.c_str(), true));
}

void CadFile::material(const TDF_Label& label, const std::string& name, double density_g_per_cm3) {
  const auto text = [](const char* t) { return Handle(TCollection_HAsciiString)(new TCollection_HAsciiString(t)); };
  XCAFDoc_DocumentTool::MaterialTool(document_->Main())
      ->SetMaterial(label, text(name.c_str()), text("of a test"), density_g_per_cm3, text("g/cm3"),
                    text("POSITIVE_RATIO_MEASURE"));
}

void CadFile::dimension(const TDF_Label& part, const TopoDS_Shape& face, const TopoDS_Shape& other,
                        const std::function<void(XCAFDimTolObjects_DimensionObject&)>& fill) {
  const Handle(XCAFDoc_DimTolTool) tool = XCAFDoc_DocumentTool::DimTolTool(document_->Main());
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  TDF_LabelSequence from, to;
  from.Append(shapes->AddSubShape(part, face));
  if (!other.IsNull()) to.Append(shapes->AddSubShape(part, other));
  const TDF_Label label = tool->AddDimension();
  Handle(XCAFDoc_Dimension) attribute;
  label.FindAttribute(XCAFDoc_Dimension::GetID(), attribute);
  const Handle(XCAFDimTolObjects_DimensionObject) object = attribute->GetObject();
  object->SetType(XCAFDimTolObjects_DimensionType_Size_Diameter);
  fill(*object);
  attribute->SetObject(object);
  tool->SetDimension(from, to, label);
}

void CadFile::diameter(const TDF_Label& part, const TopoDS_Shape& face, double value, double upper, double lower) {
  dimension(part, face, {}, [&](XCAFDimTolObjects_DimensionObject& object) {
    object.SetValue(value);
    object.SetUpperTolValue(upper);
    object.SetLowerTolValue(lower);
  });
}

void CadFile::range(const TDF_Label& part, const TopoDS_Shape& face, double low, double high) {
  dimension(part, face, {}, [&](XCAFDimTolObjects_DimensionObject& object) {
    object.SetUpperBound(high);
    object.SetLowerBound(low);
  });
}

void CadFile::distance(const TDF_Label& part, const TopoDS_Shape& face, const TopoDS_Shape& other, double value) {
  dimension(part, face, other, [&](XCAFDimTolObjects_DimensionObject& object) {
    object.SetType(XCAFDimTolObjects_DimensionType_Location_LinearDistance);
    object.SetValue(value);
  });
}

void CadFile::flatness(const TDF_Label& part, const TopoDS_Shape& face, double value) {
  const Handle(XCAFDoc_DimTolTool) tool = XCAFDoc_DocumentTool::DimTolTool(document_->Main());
  const TDF_Label on = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddSubShape(part, face);
  const TDF_Label label = tool->AddGeomTolerance();
  Handle(XCAFDoc_GeomTolerance) attribute;
  label.FindAttribute(XCAFDoc_GeomTolerance::GetID(), attribute);
  const Handle(XCAFDimTolObjects_GeomToleranceObject) object = attribute->GetObject();
  object->SetType(XCAFDimTolObjects_GeomToleranceType_Flatness);
  object->SetValue(value);
  attribute->SetObject(object);
  tool->SetGeomTolerance(on, label);
}

void CadFile::validation(const TDF_Label& part, double area, double volume, const gp_Pnt& centroid) {
  XCAFDoc_Centroid::Set(part, centroid);
  XCAFDoc_Area::Set(part, area);
  XCAFDoc_Volume::Set(part, volume);
}

void CadFile::write_step(const std::filesystem::path& path, const std::string& schema, const std::string& unit) {
  XCAFDoc_DocumentTool::ShapeTool(document_->Main())->UpdateAssemblies();
  Interface_Static::SetCVal("write.step.schema", schema.c_str());
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  STEPCAFControl_Writer writer;
  writer.SetDimTolMode(true);
  writer.SetPropsMode(true);
  writer.SetMaterialMode(true);
  require(writer.Transfer(document_, STEPControl_AsIs), path);
  require(writer.Write(path.c_str()) == IFSelect_RetDone, path);
}

void CadFile::write_step_with_part_files(const std::filesystem::path& path) {
  XCAFDoc_DocumentTool::ShapeTool(document_->Main())->UpdateAssemblies();
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  STEPCAFControl_Writer writer;
  require(writer.Transfer(document_, STEPControl_AsIs, "file_"), path);
  require(writer.Write(path.c_str()) == IFSelect_RetDone, path);
}

void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path, const std::string& schema) {
  CadFile file;
  file.add("shape", shape);
  file.write_step(path, schema);
}

void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  IGESControl_Controller::Init();
  constexpr int k_solids = 1;
  IGESControl_Writer writer("MM", k_solids);
  require(writer.AddShape(shape), path);
  writer.ComputeModel();
  require(writer.Write(path.c_str()), path);
}

void write_brep(const TopoDS_Shape& shape, const std::filesystem::path& path) {
  require(BRepTools::Write(shape, path.c_str()), path);
}

TopoDS_Face face_of(const TopoDS_Shape& shape, int number) {
  TopExp_Explorer faces(shape, TopAbs_FACE);
  for (; number > 0; --number) faces.Next();
  return TopoDS::Face(faces.Current());
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    sum += dot(mesh.corner(i, 0), cross(mesh.corner(i, 1), mesh.corner(i, 2))) / 6;
  return sum;
}

bool is_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<Index, Index>> edges, opposite;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      opposite.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(opposite.begin(), opposite.end());
  return !edges.empty() && edges == opposite && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

}  // namespace papilla::test
