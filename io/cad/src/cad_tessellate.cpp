// SPDX-License-Identifier: MIT
#include "cad_tessellate.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <IMeshData_Status.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Wire.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <utility>

#include "occt_session.hpp"
#include "papilla/core/units.hpp"

namespace papilla::cad {
namespace {

IMeshTools_Parameters mesh_parameters(const CadReadOptions& options) {
  IMeshTools_Parameters parameters;
  parameters.Deflection = options.chord_mm;
  parameters.DeflectionInterior = options.chord_mm;
  parameters.Angle = options.angle_deg * k_radians_per_degree;
  parameters.Relative = options.relative;
  parameters.InParallel = true;
  return parameters;
}

bool has_triangles(const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  return !triangulation.IsNull() && triangulation->NbTriangles() > 0;
}

using NodePair = std::pair<int, int>;

NodePair unordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::vector<NodePair> triangle_edges(const Poly_Triangulation& triangulation) {
  std::vector<NodePair> edges;
  edges.reserve(3 * static_cast<std::size_t>(triangulation.NbTriangles()));
  for (int i = 1; i <= triangulation.NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    triangulation.Triangle(i).Get(a, b, c);
    edges.insert(edges.end(), {unordered(a, b), unordered(b, c), unordered(c, a)});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Whether the triangles reach the face's whole boundary, so that no gap to its neighbours is left.
bool is_complete(const TopoDS_Face& face) {
  if (!has_triangles(face)) return false;
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  const std::vector<NodePair> edges = triangle_edges(*triangulation);
  for (TopExp_Explorer explorer(face, TopAbs_EDGE); explorer.More(); explorer.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(explorer.Current());
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
    if (polygon.IsNull() || BRep_Tool::Degenerated(edge)) continue;
    for (int k = 1; k < polygon->NbNodes(); ++k) {
      const NodePair segment = unordered(polygon->Node(k), polygon->Node(k + 1));
      if (segment.first != segment.second && !std::binary_search(edges.begin(), edges.end(), segment)) return false;
    }
  }
  return true;
}

std::string reason_of(int status, const TopoDS_Face& face) {
  static constexpr std::array<std::pair<int, const char*>, 5> k_reasons = {
      {{IMeshData_SelfIntersectingWire, "self-intersecting boundary"},
       {IMeshData_OpenWire, "open boundary"},
       {IMeshData_UnorientedWire, "boundary without orientation"},
       {IMeshData_TooFewPoints, "too few boundary points"},
       {IMeshData_Failure, "mesher failed"}}};
  std::string reason;
  for (const auto& [flag, text] : k_reasons)
    if (status & flag) reason += (reason.empty() ? "" : ", ") + std::string(text);
  if (reason.empty()) reason = "no triangles";
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  std::ostringstream text;
  text << reason << " (area " << properties.Mass() << " mm2)";
  return text.str();
}

/// What the mesher says about the face on its own.
int mesh_alone(const TopoDS_Face& face, IMeshTools_Parameters parameters) {
  parameters.InParallel = false;
  BRepMesh_IncrementalMesh mesher;
  mesher.ChangeParameters() = parameters;
  mesher.SetShape(face);
  mesher.Perform();
  return mesher.GetStatusFlags();
}

TopoDS_Face copy_of(const TopoDS_Face& face) { return TopoDS::Face(BRepBuilderAPI_Copy(face, true, false).Shape()); }

TopoDS_Face healed(const TopoDS_Face& face) {
  ShapeFix_Face fix(face);
  fix.FixWireMode() = 1;
  fix.FixOrientationMode() = 1;
  fix.FixMissingSeamMode() = 1;
  fix.FixSmallAreaWireMode() = 1;
  fix.FixWireTool()->FixSelfIntersectionMode() = 1;
  fix.Perform();
  return fix.Face();
}

std::string message_of(const Standard_Failure& failure) {
  const std::string what = failure.GetMessageString();
  return what.empty() ? failure.DynamicType()->Name() : what;
}

std::string why_refused(const TopoDS_Face& face, const IMeshTools_Parameters& parameters) {
  try {
    const TopoDS_Face alone = copy_of(face);
    BRepTools::Clean(alone);
    return reason_of(mesh_alone(alone, parameters), alone);
  } catch (const Standard_Failure& failure) {
    return message_of(failure);
  }
}

/// @return the face with triangles, or null.
TopoDS_Face heal_alone(const TopoDS_Face& face, const IMeshTools_Parameters& parameters) {
  try {
    const TopoDS_Face fixed = healed(copy_of(face));
    if (fixed.IsNull()) return {};
    BRepTools::Clean(fixed);
    mesh_alone(fixed, parameters);
    return has_triangles(fixed) ? fixed : TopoDS_Face();
  } catch (const Standard_Failure&) {
    return {};
  }
}

void mesh_all(const TopoDS_Shape& shape, const IMeshTools_Parameters& parameters, const Message_ProgressRange& range) {
  BRepTools::Clean(shape);
  BRepMesh_IncrementalMesh mesher;
  mesher.ChangeParameters() = parameters;
  mesher.SetShape(shape);
  mesher.Perform(range);
}

std::vector<NumberedFace> faces_of(const TopoDS_Shape& shape) {
  std::vector<NumberedFace> result;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face& face = TopoDS::Face(faces.Current());
    result.push_back({face, face, static_cast<std::uint32_t>(result.size()), 1});
  }
  return result;
}

/// Numbers of the faces without triangles or with gaps.
std::vector<std::uint32_t> incomplete_faces(const std::vector<NumberedFace>& faces) {
  std::vector<std::uint8_t> complete(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(),
                    [&](std::size_t i) { complete[i] = is_complete(faces[i].triangles) ? 1 : 0; });
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (complete[i] == 0) result.push_back(faces[i].number);
  return result;
}

/// The faces with the triangles of a copy of the shape of another size; empty when there is no such copy.
std::vector<NumberedFace> mesh_scaled(const TopoDS_Shape& shape, std::vector<NumberedFace> faces, double scale,
                                      IMeshTools_Parameters parameters) {
  gp_Trsf enlarge;
  enlarge.SetScaleFactor(scale);
  const TopoDS_Shape copy = BRepBuilderAPI_Transform(shape, enlarge, true).Shape();
  if (!parameters.Relative) {
    parameters.Deflection *= scale;
    parameters.DeflectionInterior *= scale;
  }
  mesh_all(copy, parameters, {});
  std::size_t i = 0;
  for (TopExp_Explorer pieces(copy, TopAbs_FACE); pieces.More(); pieces.Next(), ++i) {
    if (i == faces.size()) return {};
    faces[i].triangles = TopoDS::Face(pieces.Current());
    faces[i].scale = scale;
  }
  return i == faces.size() ? faces : std::vector<NumberedFace>();
}

/// Replaces the faces by those of the scaled copy that leaves the fewest incomplete.
/// @return the numbers of these.
std::vector<std::uint32_t> try_scaled(const TopoDS_Shape& shape, std::vector<NumberedFace>& faces,
                                      std::vector<std::uint32_t> incomplete, const IMeshTools_Parameters& parameters) {
  for (const double scale : {2.0, 0.5, 16.0}) {
    if (incomplete.empty()) break;
    try {
      std::vector<NumberedFace> scaled = mesh_scaled(shape, faces, scale, parameters);
      std::vector<std::uint32_t> remaining = incomplete_faces(scaled);
      if (scaled.empty() || remaining.size() >= incomplete.size()) continue;
      faces = std::move(scaled);
      incomplete = std::move(remaining);
    } catch (const Standard_Failure&) {
      // This size is no better: the next one may be.
      continue;
    }
  }
  return incomplete;
}

void heal_refused(NumberedFace& face, const IMeshTools_Parameters& parameters) {
  if (has_triangles(face.triangles)) return;
  const TopoDS_Face fixed = heal_alone(face.cad, parameters);
  if (!fixed.IsNull()) face = {fixed, fixed, face.number, 1};
}

TessellatedShape collect(const TopoDS_Shape& shape, const IMeshTools_Parameters& parameters) {
  TessellatedShape result;
  result.faces = faces_of(shape);
  const std::vector<std::uint32_t> incomplete = incomplete_faces(result.faces);
  if (incomplete.empty()) return result;
  const std::vector<std::uint32_t> remaining = try_scaled(shape, result.faces, incomplete, parameters);
  for (const std::uint32_t number : incomplete) {
    FaceTrouble trouble{number, "refused at first", true};
    if (std::binary_search(remaining.begin(), remaining.end(), number)) {
      const bool gaps = has_triangles(result.faces[number].triangles);
      trouble.reason = gaps ? "triangles miss part of the boundary" : why_refused(result.faces[number].cad, parameters);
      heal_refused(result.faces[number], parameters);
      trouble.solved = !gaps && has_triangles(result.faces[number].triangles);
    }
    result.troubles.push_back(std::move(trouble));
  }
  return result;
}

}  // namespace

double diagonal_of(const std::vector<TopoDS_Shape>& shapes) {
  Bnd_Box box;
  for (const TopoDS_Shape& shape : shapes) BRepBndLib::Add(shape, box, false);
  return box.IsVoid() || box.IsOpen() ? 0 : std::sqrt(box.SquareExtent());
}

std::vector<TessellatedShape> tessellate(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                         const Progress& progress) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
  const IMeshTools_Parameters parameters = mesh_parameters(options);
  const Handle(OcctProgress) indicator = new OcctProgress(progress, "tessellate", 0.3, 0.9);
  mesh_all(all, parameters, indicator->Start());

  std::vector<TessellatedShape> result;
  for (const TopoDS_Shape& shape : shapes) result.push_back(collect(shape, parameters));
  return result;
}

}  // namespace papilla::cad
