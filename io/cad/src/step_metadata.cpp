// SPDX-License-Identifier: MIT
#include "cad_metadata.hpp"

#include <APIHeaderSection_MakeHeader.hxx>
#include <STEPConstruct_ValidationProps.hxx>
#include <StepBasic_MeasureValueMember.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_CharacterizedDefinition.hxx>
#include <StepRepr_DescriptiveRepresentationItem.hxx>
#include <StepRepr_IntegerRepresentationItem.hxx>
#include <StepRepr_MeasureRepresentationItem.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_PropertyDefinitionRepresentation.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepRepr_RepresentedDefinition.hxx>
#include <StepRepr_ValueRepresentationItem.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepVisual_AnnotationOccurrence.hxx>
#include <StepVisual_DraughtingCallout.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <set>

namespace papilla::cad {
namespace {

Json header_of(const Handle(StepData_StepModel) & model) {
  const APIHeaderSection_MakeHeader header(model);
  Json json = Json::object();
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) json[key] = text;
  };
  if (header.HasFs() && header.NbSchemaIdentifiers() > 0) add("schema", text_of(header.SchemaIdentifiersValue(1)));
  if (!header.HasFn()) return json;
  add("name", text_of(header.Name()));
  add("time_stamp", text_of(header.TimeStamp()));
  if (header.NbAuthor() > 0) add("author", text_of(header.AuthorValue(1)));
  if (header.NbOrganization() > 0) add("organization", text_of(header.OrganizationValue(1)));
  add("system", text_of(header.OriginatingSystem()));
  return json;
}

/// A property's value: text or number; null when it is neither.
Json value_of(const Handle(StepRepr_RepresentationItem) & item) {
  if (const auto text = Handle(StepRepr_DescriptiveRepresentationItem)::DownCast(item); !text.IsNull())
    return text_of(text->Description());
  if (const auto whole = Handle(StepRepr_IntegerRepresentationItem)::DownCast(item); !whole.IsNull())
    return whole->Value();
  if (const auto value = Handle(StepRepr_ValueRepresentationItem)::DownCast(item);
      !value.IsNull() && !value->ValueComponentMember().IsNull())
    return value->ValueComponentMember()->Real();
  if (const auto measure = Handle(StepRepr_MeasureRepresentationItem)::DownCast(item);
      !measure.IsNull() && !measure->Measure().IsNull())
    return measure->Measure()->ValueComponent();
  return {};
}

/// Properties that are read into the document already, under their own keys.
bool is_read_elsewhere(const std::string& name) {
  return name == "material property" || name.find("validation property") != std::string::npos;
}

class PropertyReader {
 public:
  PropertyReader(STEPCAFControl_Reader& reader, const Handle(TDocStd_Document) & document, StepMetadata& result)
      : session_(reader.ChangeReader().WS()),
        validation_(session_),
        shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        result_(result) {}

  void read(const Handle(StepData_StepModel) & model) {
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const Handle(Standard_Transient) entity = model->Value(i);
      if (entity->IsKind(STANDARD_TYPE(StepShape_ShapeDefinitionRepresentation))) continue;
      if (const auto property = Handle(StepRepr_PropertyDefinitionRepresentation)::DownCast(entity); !property.IsNull())
        add_property(property);
      add_annotation(entity);
    }
  }

 private:
  void add_property(const Handle(StepRepr_PropertyDefinitionRepresentation) & property) {
    const Handle(StepRepr_PropertyDefinition) definition = property->Definition().PropertyDefinition();
    const Handle(StepRepr_Representation) values = property->UsedRepresentation();
    if (definition.IsNull() || values.IsNull() || values->Items().IsNull()) return;
    const std::string name = text_of(definition->Name());
    if (is_read_elsewhere(name)) return;
    const TDF_Label label = label_of(definition);
    if (label.IsNull()) return;
    for (int i = 1; i <= values->NbItems(); ++i) {
      const Handle(StepRepr_RepresentationItem) item = values->ItemsValue(i);
      if (item.IsNull()) continue;
      const Json value = value_of(item);
      if (value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>()))) continue;
      std::string key = text_of(item->Name());
      if (key.empty()) key = name;
      if (!key.empty()) result_.properties[entry_of(label)][key] = value;
    }
  }

  TDF_Label label_of(const Handle(StepRepr_PropertyDefinition) & definition) const {
    TDF_Label label;
    const StepRepr_CharacterizedDefinition of = definition->Definition();
    Handle(StepBasic_ProductDefinition) product = of.ProductDefinition();
    if (product.IsNull() && !of.ProductDefinitionShape().IsNull())
      product = of.ProductDefinitionShape()->Definition().ProductDefinition();
    if (product.IsNull()) return label;
    const TopoDS_Shape shape = validation_.GetPropShape(product);
    if (!shape.IsNull()) shapes_->FindShape(shape.Located(TopLoc_Location()), label);
    return label;
  }

  void add_annotation(const Handle(Standard_Transient) & entity) {
    if (!entity->IsKind(STANDARD_TYPE(StepVisual_AnnotationOccurrence)) &&
        !entity->IsKind(STANDARD_TYPE(StepVisual_DraughtingCallout)))
      return;
    const std::string name = text_of(Handle(StepRepr_RepresentationItem)::DownCast(entity)->Name());
    if (!name.empty() && annotations_.insert(name).second) result_.annotations.push_back(name);
  }

  Handle(XSControl_WorkSession) session_;
  STEPConstruct_ValidationProps validation_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  StepMetadata& result_;
  std::set<std::string> annotations_;
};

}  // namespace

StepMetadata read_step_metadata(STEPCAFControl_Reader& reader, const Handle(TDocStd_Document) & document) {
  StepMetadata result;
  result.annotations = Json::array();
  const Handle(StepData_StepModel) model = Handle(StepData_StepModel)::DownCast(reader.ChangeReader().WS()->Model());
  if (model.IsNull()) return result;
  result.header = header_of(model);
  PropertyReader(reader, document, result).read(model);
  return result;
}

}  // namespace papilla::cad
