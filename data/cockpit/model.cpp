// SPDX-License-Identifier: MIT
#include "cockpit/model.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <Interface_Protocol.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <utility>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace cockpit {
namespace {

Quantity_ColorRGBA colour_of(unsigned srgb, double alpha) {
  const auto channel = [srgb](unsigned shift) { return static_cast<double>((srgb >> shift) & 0xFFu) / 255.0; };
  const Quantity_Color rgb(channel(16), channel(8), channel(0), Quantity_TOC_sRGB);
  return {rgb, static_cast<float>(alpha)};
}

Handle(TCollection_HAsciiString) text(const char* value) { return new TCollection_HAsciiString(value); }

void fill_header(const Handle(StepData_StepModel) & model) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text("cockpit"));
  header.SetTimeStamp(text("2000-01-01T00:00:00"));
  header.SetAuthorValue(1, text("papilla"));
  header.SetOrganizationValue(1, text("papilla"));
  header.SetAuthorisation(text("papilla"));
  header.SetOriginatingSystem(text("papilla-make-cockpit"));
  header.SetDescriptionValue(1, text("car cockpit, sample scene"));
}

bool is_style_list(const Handle(Standard_Transient) & entity) {
  return entity->IsKind(STANDARD_TYPE(StepVisual_MechanicalDesignGeometricPresentationRepresentation));
}

/// The number of the shape that a list of styles belongs to.
int styled_shape(const StepData_StepModel& model, const Handle(Standard_Transient) & entity) {
  const auto list = Handle(StepVisual_MechanicalDesignGeometricPresentationRepresentation)::DownCast(entity);
  for (int i = 1; i <= list->NbItems(); ++i) {
    const auto styled = Handle(StepVisual_StyledItem)::DownCast(list->ItemsValue(i));
    if (!styled.IsNull()) return model.Number(styled->Item());
  }
  return 0;
}

/// The library appends the styles in the order of shapes' addresses, which differs from run to run:
/// puts them into the order of the shapes' numbers.
void sort_styles(const Handle(StepData_StepModel) & model) {
  std::vector<Handle(Standard_Transient)> others;
  std::vector<std::pair<int, Handle(Standard_Transient)>> styles;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (is_style_list(entity))
      styles.emplace_back(styled_shape(*model, entity), entity);
    else if (styles.empty())
      others.push_back(entity);
  }
  std::sort(styles.begin(), styles.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const Handle(Interface_Protocol) protocol = model->Protocol();
  model->ClearEntities();
  for (const auto& entity : others) model->AddEntity(entity);
  for (const auto& [number, entity] : styles) model->AddWithRefs(entity, protocol);
}

}  // namespace

Model::Model() : document_(new TDocStd_Document("BinXCAF")) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPCAFControl_Controller::Init();
  XCAFDoc_DocumentTool::Set(document_->Main());
}

TDF_Label Model::add_part(const std::string& name, const TopoDS_Shape& shape, unsigned srgb, double alpha) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddShape(shape, false);
  TDataStd_Name::Set(label, name.c_str());
  XCAFDoc_DocumentTool::ColorTool(document_->Main())->SetColor(label, colour_of(srgb, alpha), XCAFDoc_ColorSurf);
  return label;
}

TDF_Label Model::add_assembly(const std::string& name) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->NewShape();
  TDataStd_Name::Set(label, name.c_str());
  return label;
}

void Model::place(const TDF_Label& assembly, const TDF_Label& what, const gp_Trsf& where, const std::string& name) {
  const TDF_Label label =
      XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddComponent(assembly, what, TopLoc_Location(where));
  TDataStd_Name::Set(label, name.c_str());
}

void Model::write(const std::filesystem::path& path) {
  XCAFDoc_DocumentTool::ShapeTool(document_->Main())->UpdateAssemblies();
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  // Readers compute the curves in the surfaces' parameters anew; left out, the file is a fifth of the size.
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document_, STEPControl_AsIs)) throw papilla::IoError(path.string() + ": can't be converted");
  sort_styles(writer.ChangeWriter().Model());
  fill_header(writer.ChangeWriter().Model());
  const papilla::TemporaryFolder folder("papilla-cockpit");  // The library writes to names only.
  const std::filesystem::path file = folder / "cockpit.step";
  if (writer.Write(file.c_str()) != IFSelect_RetDone) throw papilla::IoError(path.string() + ": can't be written");
  papilla::write_atomically(path, papilla::read_file(file));
}

}  // namespace cockpit
