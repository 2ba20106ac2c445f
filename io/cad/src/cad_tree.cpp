// SPDX-License-Identifier: MIT
#include "cad_tree.hpp"

#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DimTolTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "cad_materials.hpp"
#include "papilla/core/error.hpp"

namespace papilla::cad {
namespace {

constexpr std::size_t k_max_nodes = 4'000'000;
constexpr int k_max_depth = 500;

using Json = nlohmann::ordered_json;

std::string utf8(const TCollection_ExtendedString& text) {
  std::string result(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  char* data = result.data();
  result.resize(static_cast<std::size_t>(text.ToUTF8CString(data)));
  return result;
}

std::string label_name(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  return label.FindAttribute(TDataStd_Name::GetID(), name) ? utf8(name->Get()) : std::string();
}

/// Names the library or the exporting system makes up for a use of a part that the designer didn't name.
bool is_made_up(const std::string& name) {
  return name.empty() || name.starts_with("=>[") || name.starts_with("NAUO") ||
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

Transform to_transform(const TopLoc_Location& location) {
  const gp_Trsf trsf = location.Transformation();
  Transform result = k_identity;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      result[static_cast<std::size_t>(4 * row + column)] = trsf.Value(row + 1, column + 1);
  return result;
}

Json layers_of(const TDF_Label& label) {
  Json layers = Json::array();
  Handle(TColStd_HSequenceOfExtendedString) names;
  if (XCAFDoc_DocumentTool::LayerTool(label)->GetLayers(label, names) && !names.IsNull())
    for (const TCollection_ExtendedString& name : *names) layers.push_back(utf8(name));
  return layers;
}

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

/// The physical material assigned in the CAD system. Density as the file gives it (STEP through this reader: g/cm³).
Json material_of(const TDF_Label& label) {
  Handle(TDataStd_TreeNode) link;
  if (!label.FindAttribute(XCAFDoc::MaterialRefGUID(), link) || !link->HasFather()) return {};
  Handle(XCAFDoc_Material) material;
  if (!link->Father()->Label().FindAttribute(XCAFDoc_Material::GetID(), material)) return {};
  Json result = {{"name", text_of(material->GetName())}};
  if (const std::string text = text_of(material->GetDescription()); !text.empty()) result["description"] = text;
  if (material->GetDensity() > 0) {
    result["density"] = material->GetDensity();
    result["density_unit"] = text_of(material->GetDensName());
  }
  return result;
}

std::string extras_of(const TDF_Label& label) {
  Json extras = Json::object();
  if (Json layers = layers_of(label); !layers.empty()) extras["layers"] = std::move(layers);
  if (Json material = material_of(label); !material.is_null()) extras["cad_material"] = std::move(material);
  if (!XCAFDoc_DocumentTool::ColorTool(label)->IsVisible(label)) extras["hidden"] = true;
  return extras.empty() ? std::string() : extras.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// What a node hands down to its children.
struct Inherited {
  CadColour colour;
  std::string path;
  int depth = 0;
};

class TreeBuilder {
 public:
  explicit TreeBuilder(CadTree& tree) : tree_(tree), materials_(tree.scene.materials) {}

  /// @return whether there is a node: shapes without faces have none.
  std::optional<std::uint32_t> add(const TDF_Label& use, const Inherited& from) {
    if (tree_.scene.nodes.size() >= k_max_nodes)
      throw InvalidInput("assembly tree: over " + std::to_string(k_max_nodes) + " nodes");
    if (from.depth > k_max_depth)
      throw InvalidInput("assembly tree: nested over " + std::to_string(k_max_depth) + " deep");
    TDF_Label definition = use;
    const bool is_use = XCAFDoc_ShapeTool::GetReferredShape(use, definition);

    Node node;
    const std::string own = label_name(use), defined = label_name(definition);
    node.name = is_made_up(own) ? defined : own;
    if (is_use) node.local = to_transform(XCAFDoc_ShapeTool::GetLocation(use));
    if (is_use) node.extras_json = extras_of(use);
    Inherited down{from.colour, unique_path(from.path, node.name), from.depth + 1};
    const CadColour instance = is_use ? label_colour(use) : CadColour();

    if (XCAFDoc_ShapeTool::IsAssembly(definition)) {
      if (const CadColour colour = instance ? instance : label_colour(definition)) down.colour = colour;
      if (node.extras_json.empty()) node.extras_json = extras_of(definition);
      return add_assembly(definition, std::move(node), down);
    }
    node.part = part_of(definition, instance, down, defined.empty() ? node.name : defined);
    if (!node.part) return std::nullopt;
    tree_.scene.nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(tree_.scene.nodes.size() - 1);
  }

 private:
  std::optional<std::uint32_t> add_assembly(const TDF_Label& definition, Node node, const Inherited& down) {
    const std::size_t index = tree_.scene.nodes.size();
    tree_.scene.nodes.push_back(std::move(node));
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(definition, components);
    std::vector<std::uint32_t> children;
    for (const TDF_Label& component : components)
      if (const auto child = add(component, down)) children.push_back(*child);
    if (children.empty()) {
      tree_.scene.nodes.resize(index);
      return std::nullopt;
    }
    tree_.scene.nodes[index].children = std::move(children);
    return static_cast<std::uint32_t>(index);
  }

  std::string unique_path(const std::string& parent, const std::string& name) {
    const std::string wanted = parent.empty() ? name : parent + "/" + name;
    std::string path = wanted;
    for (int k = 2; !paths_.insert(path).second; ++k) path = wanted + "#" + std::to_string(k);
    return path;
  }

  std::optional<std::uint32_t> part_of(const TDF_Label& definition, const CadColour& instance, const Inherited& from,
                                       const std::string& name) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(definition, entry);
    const auto text = [](const CadColour& colour) { return colour ? colour_name(*colour) : std::string(); };
    const std::string key = std::string(entry.ToCString()) + "|" + text(instance) + "|" + text(from.colour);
    const auto known = parts_.find(key);
    if (known != parts_.end()) return known->second;
    const auto index = add_part(definition, instance, from, name);
    parts_.emplace(key, index);
    return index;
  }

  std::optional<std::uint32_t> add_part(const TDF_Label& definition, const CadColour& instance, const Inherited& from,
                                        const std::string& name) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(definition);
    if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_FACE).More()) {
      tree_.scene.losses.push_back("shape '" + name + "' has no faces (curves or points only) and was left out");
      return std::nullopt;
    }
    Part part;
    part.name = name;
    part.id = from.path;
    part.extras_json = extras_of(definition);
    tree_.face_materials.push_back(slots(face_colours(definition, shape, instance, from.colour), part.materials));
    tree_.shapes.push_back(shape);
    tree_.scene.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(tree_.scene.parts.size() - 1);
  }

  /// Fills the part's material list; empty when nothing of it is coloured.
  std::vector<std::uint32_t> slots(const std::vector<CadColour>& colours, std::vector<std::uint32_t>& materials) {
    if (std::none_of(colours.begin(), colours.end(), [](const CadColour& c) { return c.has_value(); })) return {};
    std::vector<std::uint32_t> result;
    for (const CadColour& colour : colours) {
      const std::uint32_t material = materials_.index_of(colour);
      const auto found = std::find(materials.begin(), materials.end(), material);
      result.push_back(static_cast<std::uint32_t>(found - materials.begin()));
      if (found == materials.end()) materials.push_back(material);
    }
    return result;
  }

  CadTree& tree_;
  MaterialTable materials_;
  std::map<std::string, std::optional<std::uint32_t>> parts_;
  std::set<std::string> paths_;
};

/// Files with PMI: say how much is not carried over.
void note_pmi(const Handle(TDocStd_Document) & document, Scene& scene) {
  const Handle(XCAFDoc_DimTolTool) tool = XCAFDoc_DocumentTool::DimTolTool(document->Main());
  TDF_LabelSequence dimensions, tolerances, datums;
  tool->GetDimensionLabels(dimensions);
  tool->GetGeomToleranceLabels(tolerances);
  tool->GetDatumLabels(datums);
  const int count = dimensions.Length() + tolerances.Length() + datums.Length();
  if (count == 0) return;
  scene.losses.push_back("PMI: " + std::to_string(dimensions.Length()) + " dimensions, " +
                         std::to_string(tolerances.Length()) + " tolerances, " + std::to_string(datums.Length()) +
                         " datums are not kept");
}

}  // namespace

CadTree build_tree(const CadDocument& document) {
  CadTree tree;
  tree.scene.format = document.format;
  tree.scene.unit = document.unit;
  tree.scene.millimetres_per_unit = document.millimetres_per_unit;
  tree.scene.up = UpAxis::z;
  TDF_LabelSequence free_shapes;
  XCAFDoc_DocumentTool::ShapeTool(document.document->Main())->GetFreeShapes(free_shapes);
  TreeBuilder builder(tree);
  for (const TDF_Label& label : free_shapes)
    if (const auto root = builder.add(label, {})) tree.scene.roots.push_back(*root);
  note_pmi(document.document, tree.scene);
  return tree;
}

}  // namespace papilla::cad
