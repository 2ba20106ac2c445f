// SPDX-License-Identifier: MIT
#include "cad_tree.hpp"

#include <BRep_Builder.hxx>
#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_Area.hxx>
#include <XCAFDoc_Centroid.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GraphNode.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFDoc_ViewTool.hxx>
#include <XCAFDoc_Volume.hxx>
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "cad_materials.hpp"
#include "cad_metadata.hpp"
#include "cad_text.hpp"
#include "papilla/core/error.hpp"

namespace papilla::cad {
namespace {

constexpr std::size_t k_max_nodes = 4'000'000;
constexpr std::size_t k_max_depth = 500;

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

/// What the exporting system computed, to compare with.
Json validation_of(const TDF_Label& label) {
  Json result = Json::object();
  Handle(XCAFDoc_Area) area;
  if (label.FindAttribute(XCAFDoc_Area::GetID(), area)) result["area_mm2"] = area->Get();
  Handle(XCAFDoc_Volume) volume;
  if (label.FindAttribute(XCAFDoc_Volume::GetID(), volume)) result["volume_mm3"] = volume->Get();
  Handle(XCAFDoc_Centroid) centroid;
  if (label.FindAttribute(XCAFDoc_Centroid::GetID(), centroid)) {
    const gp_Pnt p = centroid->Get();
    result["centroid_mm"] = {p.X(), p.Y(), p.Z()};
  }
  return result;
}

/// Adds what `other` has and `json` lacks.
void merge_missing(Json& json, const Json& other) {
  for (const auto& [key, value] : other.items())
    if (!json.contains(key)) json[key] = value;
}

/// What a node hands down to its children.
struct Inherited {
  CadColour colour;
  std::string path;
  std::vector<TDF_Label> uses;  ///< From the root; for colours set on one occurrence deep in the tree.
};

/// A solid of a product, or what is not solid of it.
struct Body {
  TopoDS_Shape shape;
  std::string name;  ///< Of its own; empty when the product has only this one.
};

/// One use of a part within a product.
struct PlacedPart {
  std::uint32_t part = 0;
  std::string name;
  Transform local = k_identity;
};

class TreeBuilder {
 public:
  TreeBuilder(CadTree& tree, const CadDocument& document)
      : tree_(tree),
        metadata_(document.metadata),
        pmi_(read_pmi(document.document)),
        shapes_(XCAFDoc_DocumentTool::ShapeTool(document.document->Main())),
        materials_(tree.scene.materials) {
    for (std::string& loss : pmi_.losses) tree_.scene.losses.push_back(std::move(loss));
  }

  /// @return whether there is a node: shapes without faces have none.
  std::optional<std::uint32_t> add(const TDF_Label& use, const Inherited& from) {
    if (tree_.scene.nodes.size() >= k_max_nodes)
      throw InvalidInput("assembly tree: over " + std::to_string(k_max_nodes) + " nodes");
    if (from.uses.size() > k_max_depth)
      throw InvalidInput("assembly tree: nested over " + std::to_string(k_max_depth) + " deep");
    TDF_Label definition = use;
    const bool is_use = XCAFDoc_ShapeTool::GetReferredShape(use, definition);

    Node node;
    const std::string own = label_name(use), defined = label_name(definition);
    node.name = is_made_up(own) && !defined.empty() ? defined : own;
    if (is_use) node.local = to_transform(XCAFDoc_ShapeTool::GetLocation(use));
    Inherited down{from.colour, unique_path(from.path, node.name), from.uses};
    if (is_use) down.uses.push_back(use);
    const CadColour instance = is_use ? occurrence_colour(down.uses) : CadColour();
    Json extras = {{"id", down.path}};
    if (is_use) merge_missing(extras, extras_of(use));
    merge_missing(extras, extras_of(definition));
    node.extras_json = dump(extras);

    if (XCAFDoc_ShapeTool::IsAssembly(definition)) {
      if (const CadColour colour = instance ? instance : label_colour(definition)) down.colour = colour;
      return add_assembly(definition, std::move(node), down);
    }
    return add_product(parts_of(definition, instance, down, defined.empty() ? node.name : defined), std::move(node),
                       down.path);
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

  /// A node of one part, or of a child for each of its bodies.
  std::optional<std::uint32_t> add_product(const std::vector<PlacedPart>& parts, Node node, const std::string& path) {
    if (parts.empty()) return std::nullopt;
    const auto index = static_cast<std::uint32_t>(tree_.scene.nodes.size());
    const bool alone = parts.size() == 1 && parts.front().name.empty();
    if (alone) node.part = parts.front().part;
    tree_.scene.nodes.push_back(std::move(node));
    if (alone) return index;
    for (const PlacedPart& part : parts) {
      Node body;
      body.name = part.name;
      body.local = part.local;
      body.part = part.part;
      body.extras_json = dump(Json{{"id", unique_path(path, part.name)}});
      tree_.scene.nodes[index].children.push_back(static_cast<std::uint32_t>(tree_.scene.nodes.size()));
      tree_.scene.nodes.push_back(std::move(body));
    }
    return index;
  }

  Json extras_of(const TDF_Label& label) const {
    Json extras = Json::object();
    if (Json layers = layers_of(label); !layers.empty()) extras["layers"] = std::move(layers);
    if (Json material = material_of(label); !material.is_null()) extras["cad_material"] = std::move(material);
    if (!XCAFDoc_DocumentTool::ColorTool(label)->IsVisible(label)) extras["hidden"] = true;
    const std::string entry = entry_of(label);
    if (const auto found = metadata_.properties.find(entry); found != metadata_.properties.end())
      extras["properties"] = found->second;
    if (Json validation = validation_of(label); !validation.empty()) extras["validation"] = std::move(validation);
    if (const auto found = pmi_.of_part.find(entry); found != pmi_.of_part.end()) extras["pmi"] = found->second;
    return extras;
  }

  /// The colour set on this use: on the chain of uses from any level above, outermost first, else on the use itself.
  static CadColour occurrence_colour(const std::vector<TDF_Label>& uses) {
    for (std::size_t start = 0; start + 1 < uses.size(); ++start) {
      TDF_LabelSequence chain;
      for (std::size_t i = start; i < uses.size(); ++i) chain.Append(uses[i]);
      Handle(XCAFDoc_GraphNode) occurrence;
      if (!XCAFDoc_ShapeTool::FindSHUO(chain, occurrence) || occurrence.IsNull()) continue;
      if (const CadColour colour = label_colour(occurrence->Label())) return colour;
    }
    return label_colour(uses.back());
  }

  std::string unique_path(const std::string& parent, const std::string& name) {
    const std::string wanted = parent.empty() ? name : parent + "/" + name;
    std::string path = wanted;
    for (int k = 2; !paths_.insert(path).second; ++k) path = wanted + "#" + std::to_string(k);
    return path;
  }

  const std::vector<PlacedPart>& parts_of(const TDF_Label& definition, const CadColour& instance, const Inherited& from,
                                          const std::string& name) {
    const auto text = [](const CadColour& colour) { return colour ? colour_name(*colour) : std::string(); };
    const std::string key = entry_of(definition) + "|" + text(instance) + "|" + text(from.colour);
    const auto known = parts_.find(key);
    if (known != parts_.end()) return known->second;
    return parts_.emplace(key, add_parts(definition, instance, from, name)).first->second;
  }

  std::vector<PlacedPart> add_parts(const TDF_Label& definition, const CadColour& instance, const Inherited& from,
                                    const std::string& name) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(definition);
    std::vector<PlacedPart> result;
    if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_FACE).More()) {
      tree_.scene.losses.push_back("shape '" + name + "' has no faces (curves or points only) and was left out");
      return result;
    }
    if (TopExp_Explorer(shape, TopAbs_EDGE, TopAbs_FACE).More())
      tree_.scene.losses.push_back("curves of shape '" + name + "' that bound no face were left out");
    const std::string extras = dump(extras_of(definition));
    for (const Body& body : bodies_of(definition, shape)) {
      Part part;
      part.name = body.name.empty() ? name : name + "/" + body.name;
      part.id = body.name.empty() ? from.path : from.path + "/" + body.name;
      part.extras_json = extras;
      const TopLoc_Location where = body.name.empty() ? TopLoc_Location() : body.shape.Location();
      std::vector<std::uint32_t> faces =
          slots(face_colours(definition, body.shape, instance, from.colour), part.materials);
      const TopoDS_Shape unplaced = body.name.empty() ? body.shape : body.shape.Located(TopLoc_Location());
      result.push_back({add_part(std::move(part), unplaced, std::move(faces), result), body.name, to_transform(where)});
    }
    return result;
  }

  /// The part, or one of the same product that has the same shape and colours.
  std::uint32_t add_part(Part part, const TopoDS_Shape& shape, std::vector<std::uint32_t> face_materials,
                         const std::vector<PlacedPart>& product) {
    for (const PlacedPart& other : product)
      if (tree_.shapes[other.part].IsSame(shape) && tree_.face_materials[other.part] == face_materials &&
          tree_.scene.parts[other.part].materials == part.materials)
        return other.part;
    tree_.face_materials.push_back(std::move(face_materials));
    tree_.shapes.push_back(shape);
    tree_.scene.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(tree_.scene.parts.size() - 1);
  }

  /// Solids that touch are two surfaces, not one: each is a body. What belongs to no solid is one body more.
  std::vector<Body> bodies_of(const TDF_Label& definition, const TopoDS_Shape& shape) {
    std::vector<Body> bodies;
    for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next())
      bodies.push_back({solids.Current(), {}});
    TopoDS_Compound rest;
    BRep_Builder builder;
    builder.MakeCompound(rest);
    bool any_rest = false;
    for (TopExp_Explorer faces(shape, TopAbs_FACE, TopAbs_SOLID); faces.More(); faces.Next(), any_rest = true)
      builder.Add(rest, faces.Current());
    if (bodies.size() + (any_rest ? 1u : 0u) < 2) return {{shape, {}}};
    if (any_rest) bodies.push_back({rest, {}});
    std::set<std::string> names;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TDF_Label label;
      std::string name;
      if (shapes_->FindSubShape(definition, bodies[i].shape, label)) name = label_name(label);
      if (name.empty() || !names.insert(name).second) name = "body " + std::to_string(i + 1);
      names.insert(name);
      bodies[i].name = std::move(name);
    }
    return bodies;
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
  const StepMetadata& metadata_;
  CadPmi pmi_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  MaterialTable materials_;
  std::map<std::string, std::vector<PlacedPart>> parts_;
  std::set<std::string> paths_;
};

/// Metadata of the whole file.
Json scene_extras(const CadDocument& document, Scene& scene) {
  Json source = {
      {"format", document.format}, {"unit", document.unit}, {"millimetres_per_unit", document.millimetres_per_unit}};
  merge_missing(source, document.metadata.header);
  Json extras = {{"source", std::move(source)}};
  if (!document.metadata.annotations.empty()) {
    extras["annotations"] = document.metadata.annotations;
    scene.losses.push_back("PMI: of " + std::to_string(document.metadata.annotations.size()) +
                           " drawn annotations only the names are kept");
  }
  TDF_LabelSequence views;
  XCAFDoc_DocumentTool::ViewTool(document.document->Main())->GetViewLabels(views);
  if (!views.IsEmpty()) scene.losses.push_back(std::to_string(views.Length()) + " saved views are not kept");
  return extras;
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
  tree.scene.extras_json = dump(scene_extras(document, tree.scene));
  TreeBuilder builder(tree, document);
  for (const TDF_Label& label : free_shapes)
    if (const auto root = builder.add(label, {})) tree.scene.roots.push_back(*root);
  return tree;
}

}  // namespace papilla::cad
