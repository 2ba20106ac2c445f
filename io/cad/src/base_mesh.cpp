// SPDX-License-Identifier: MIT
#include "base_mesh.hpp"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <IMeshData_Status.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeFix_Face.hxx>
#include <ShapeFix_Wire.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "cad_parallel.hpp"
#include "polygon_patch.hpp"

namespace papilla::cad {
namespace {

std::vector<TopoDS_Edge> edges_of(const TopoDS_Face& face) {
  std::vector<TopoDS_Edge> result;
  for (TopExp_Explorer edges(face, TopAbs_EDGE); edges.More(); edges.Next())
    result.push_back(TopoDS::Edge(edges.Current()));
  return result;
}

/// The triangles of the mesher, or the reason why there are none.
std::string take_triangles(const Handle(Poly_Triangulation) & source, const TopLoc_Location& location, FaceMesh& mesh) {
  if (source.IsNull() || source->NbTriangles() == 0) return "no triangles";
  if (!source->HasUVNodes()) return "triangles without parameters";
  const FaceSurface surface(mesh.face);
  const gp_Trsf trsf = location.Transformation();
  FacePatch& patch = mesh.patch;
  for (int i = 1; i <= source->NbNodes(); ++i) {
    const gp_Pnt2d uv = source->UVNode(i);
    PatchNode node = surface_node(surface, {uv.X(), uv.Y()});
    gp_XYZ p = source->Node(i).XYZ();
    trsf.Transforms(p);
    node.gap = to_vec(p) - node.position;
    node.position = to_vec(p);
    if (!is_finite(node.position) || !is_finite(node.gap)) return "coordinates that are not finite";
    patch.nodes.push_back(node);
  }
  for (int i = 1; i <= source->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    source->Triangle(i).Get(a, b, c);
    patch.triangles.push_back({static_cast<Index>(a - 1), static_cast<Index>(b - 1), static_cast<Index>(c - 1)});
  }
  return {};
}

using Polygon = Handle(Poly_PolygonOnTriangulation);

/// How far the nodes of a polygon are from the edge's curve in the face's parameters.
double misfit(const Polygon& polygon, const EdgeUse& use, const FacePatch& patch) {
  double sum = 0;
  for (int k = 1; k <= polygon->NbNodes(); ++k) {
    const gp_Pnt2d on_curve = use.curve->Value(use.offset + use.factor * polygon->Parameter(k));
    const Vec2 node = patch.nodes[static_cast<std::size_t>(polygon->Node(k) - 1)].uv;
    sum += norm(node - Vec2{on_curve.X(), on_curve.Y()});
  }
  return sum;
}

/// The nodes along an edge of the face. A seam has two rows of them; the mesher gives those of the other side where the
/// surface runs against the face, as on a cone.
Polygon polygon_along(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & source,
                      const TopLoc_Location& location, const EdgeUse& use, const FacePatch& patch) {
  const Polygon named = BRep_Tool::PolygonOnTriangulation(edge, source, location);
  const Polygon other = BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Reversed()), source, location);
  if (named.IsNull() || other.IsNull() || named == other || !named->HasParameters() || !other->HasParameters())
    return named;
  return misfit(other, use, patch) < misfit(named, use, patch) ? other : named;
}

std::string take_uses(const Handle(Poly_Triangulation) & source, const TopLoc_Location& location, const EdgeNet& net,
                      FaceMesh& mesh, std::vector<std::vector<double>>& parameters) {
  for (const TopoDS_Edge& edge : edges_of(mesh.face)) {
    EdgeUse use;
    if (!make_use(net, edge, mesh.face, use)) return "an edge has no curve in the face's parameters";
    const Polygon polygon = polygon_along(edge, source, location, use, mesh.patch);
    if (polygon.IsNull() || !polygon->HasParameters()) return "an edge has no polygon";
    std::vector<double> along;
    for (int k = 1; k <= polygon->NbNodes(); ++k) {
      use.nodes.push_back(static_cast<Index>(polygon->Node(k) - 1));
      along.push_back(polygon->Parameter(k));
    }
    mesh.uses.push_back(std::move(use));
    parameters.push_back(std::move(along));
  }
  return {};
}

struct Taken {
  FaceMesh mesh;
  std::vector<std::vector<double>> parameters;  ///< Of each use.
  std::string refused;
};

Taken take(const TopoDS_Face& face, const EdgeNet& net) {
  Taken taken;
  taken.mesh.face = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  // A mirrored face keeps its sense in the file, but its tangents turn the other way.
  const bool mirrored = face.Location().Transformation().VectorialPart().Determinant() < 0;
  taken.mesh.reversed = (face.Orientation() == TopAbs_REVERSED) != mirrored;
  if (BRep_Tool::Surface(face).IsNull()) {
    taken.refused = "no surface";
    return taken;
  }
  TopLoc_Location location;
  const Handle(Poly_Triangulation) source = BRep_Tool::Triangulation(face, location);
  taken.refused = take_triangles(source, location, taken.mesh);
  if (taken.refused.empty()) taken.refused = take_uses(source, location, net, taken.mesh, taken.parameters);
  return taken;
}

/// Ties the nodes on edges to the shared points, and makes one node of each collapsed edge.
/// @return what is wrong with the triangles.
std::string tie(FaceMesh& mesh, const EdgeNet& net) {
  for (EdgeUse& use : mesh.uses) {
    const EdgeLine& line = net.lines()[use.edge];
    if (line.parameters.size() != use.nodes.size()) return "its edges are cut otherwise by its neighbours";
    for (std::size_t k = 0; k < use.nodes.size(); ++k) {
      PatchNode& node = mesh.patch.nodes[use.nodes[k]];
      node.shared = line.shared[k];
      node.gap = node.gap + (net.points()[node.shared] - node.position);
      node.position = net.points()[node.shared];
    }
    if (!line.degenerate) continue;
    const PatchNode &first = mesh.patch.nodes[use.nodes.front()], &last = mesh.patch.nodes[use.nodes.back()];
    const Vec2 along = last.uv - first.uv;
    const bool along_u = std::abs(along.x) > std::abs(along.y);
    for (const Index node : use.nodes) (along_u ? mesh.patch.nodes[node].free_u : mesh.patch.nodes[node].free_v) = true;
  }
  for (const EdgeUse& collapsed : mesh.uses) {
    if (!net.lines()[collapsed.edge].degenerate) continue;
    const std::vector<Index> same = collapsed.nodes;
    mesh.patch.merge(same);
    for (EdgeUse& use : mesh.uses)
      for (Index& node : use.nodes)
        if (std::find(same.begin(), same.end(), node) != same.end()) node = same.front();
  }
  std::vector<std::uint8_t> collapsed;
  for (const Triangle& t : mesh.patch.triangles)
    collapsed.push_back(t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ? 1 : 0);
  return mesh.patch.remove(collapsed) ? std::string() : "its triangles overlap";
}

/// Whether the triangles' boundary is the face's: each segment of its edges once, nothing else. Edges inside of the
/// face are marked.
bool covers_boundary(FaceMesh& mesh, const EdgeNet& net) {
  FacePatch& patch = mesh.patch;
  std::vector<std::pair<std::pair<Index, Index>, HalfEdge>> sides;
  std::size_t open = 0;
  for (HalfEdge h = 0; h < 3 * patch.triangles.size(); ++h) {
    sides.push_back({{patch.from(h), patch.to(h)}, h});
    if (patch.is_boundary(h)) ++open;
  }
  std::sort(sides.begin(), sides.end());
  const auto find = [&](Index a, Index b) {
    const auto found = std::lower_bound(sides.begin(), sides.end(), std::make_pair(std::make_pair(a, b), HalfEdge{0}));
    return found != sides.end() && found->first == std::make_pair(a, b) ? found->second : k_no_value;
  };
  for (const EdgeUse& use : mesh.uses) {
    if (net.lines()[use.edge].degenerate) continue;
    for (std::size_t k = 0; k + 1 < use.nodes.size(); ++k) {
      const Index a = use.nodes[k], b = use.nodes[k + 1];
      if (a == b) continue;
      HalfEdge h = find(a, b);
      if (h == k_no_value) h = find(b, a);
      if (h == k_no_value) return false;
      if (patch.is_boundary(h))
        --open;
      else
        patch.fix(h);
    }
  }
  return open == 0;
}

std::string usable(FaceMesh& mesh, const EdgeNet& net) {
  std::string wrong = tie(mesh, net);
  if (wrong.empty() && mesh.patch.triangles.empty()) wrong = "no triangles";
  if (wrong.empty() && !covers_boundary(mesh, net)) wrong = "its triangles miss part of the boundary";
  return wrong;
}

std::string mesher_status(const TopoDS_Face& face, const RefineLimits& limits) {
  static constexpr std::array<std::pair<int, const char*>, 5> k_reasons = {
      {{IMeshData_SelfIntersectingWire, "self-intersecting boundary"},
       {IMeshData_OpenWire, "open boundary"},
       {IMeshData_UnorientedWire, "boundary without orientation"},
       {IMeshData_TooFewPoints, "too few boundary points"},
       {IMeshData_Failure, "mesher failed"}}};
  std::string reason;
  try {
    const TopoDS_Face alone = TopoDS::Face(BRepBuilderAPI_Copy(face, true, false).Shape());
    BRepMesh_IncrementalMesh mesher(alone, limits.chord, false, limits.angle, false);
    for (const auto& [flag, text] : k_reasons)
      if (mesher.GetStatusFlags() & flag) reason += (reason.empty() ? "" : ", ") + std::string(text);
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(face, properties);
    std::ostringstream area;
    area << " (area " << properties.Mass() << " mm2)";
    reason += area.str();
  } catch (const Standard_Failure& failure) {
    reason = failure.DynamicType()->Name();
  }
  return reason;
}

/// The face between the polylines of its edges.
bool try_polygon(BaseFace& base, const TopoDS_Face& face, const EdgeNet& net) {
  try {
    std::optional<FaceMesh> mesh = polygon_patch(face, net);
    if (!mesh || !usable(*mesh, net).empty()) return false;
    mesh->reversed = base.mesh.reversed;
    base.mesh = std::move(*mesh);
    return true;
  } catch (const Standard_Failure&) {
    return false;  // The next way may do.
  }
}

/// A copy of the face with its wires put in order; its edges are those of the shape.
TopoDS_Face reordered(const TopoDS_Face& face) {
  ShapeFix_Face fix(face);
  fix.FixWireMode() = 1;
  fix.FixOrientationMode() = 1;
  fix.FixMissingSeamMode() = 0;
  fix.FixSmallAreaWireMode() = 0;
  fix.FixIntersectingWiresMode() = 0;
  fix.FixLoopWiresMode() = 0;
  fix.FixSplitFaceMode() = 0;
  fix.FixAddNaturalBoundMode() = 0;
  fix.FixWireTool()->FixSelfIntersectionMode() = 0;
  fix.FixWireTool()->FixSmallMode() = 0;
  fix.FixWireTool()->FixConnectedMode() = 0;
  fix.FixWireTool()->FixLackingMode() = 0;
  fix.FixWireTool()->FixDegeneratedMode() = 0;
  fix.Perform();
  return fix.Face();
}

TopoDS_Face healed(const TopoDS_Face& face) {
  ShapeFix_Face fix(TopoDS::Face(BRepBuilderAPI_Copy(face, true, false).Shape()));
  fix.FixWireMode() = 1;
  fix.FixOrientationMode() = 1;
  fix.FixMissingSeamMode() = 1;
  fix.FixSmallAreaWireMode() = 1;
  fix.FixWireTool()->FixSelfIntersectionMode() = 1;
  fix.Perform();
  return fix.Face();
}

/// The face healed and meshed alone, its edges its own. Leaves gaps to its neighbours.
bool try_alone(BaseFace& base, const TopoDS_Face& face, const RefineLimits& limits) {
  try {
    const TopoDS_Face fixed = healed(face);
    if (fixed.IsNull()) return false;
    BRepTools::Clean(fixed);
    BRepMesh_IncrementalMesh(fixed, limits.chord, false, limits.angle, false);
    TopLoc_Location location;
    const Handle(Poly_Triangulation) source = BRep_Tool::Triangulation(fixed, location);
    FaceMesh mesh;
    mesh.face = TopoDS::Face(fixed.Oriented(TopAbs_FORWARD));
    mesh.reversed = base.mesh.reversed;
    if (!take_triangles(source, location, mesh).empty() || !mesh.patch.connect()) return false;
    base.mesh = std::move(mesh);
    return true;
  } catch (const Standard_Failure&) {
    return false;
  }
}

void rescue(BaseFace& base, const EdgeNet& net, const RefineLimits& limits) {
  const TopoDS_Face face = base.mesh.face;
  base.mesh.patch = {};
  base.mesh.uses.clear();
  if (BRep_Tool::Surface(face).IsNull()) {
    base.solved = false;
    return;
  }
  base.refused += ": " + mesher_status(face, limits);
  base.tried.push_back("triangulation between its edges");
  if (try_polygon(base, face, net)) return;
  base.tried.push_back("the same with its wires put in order");
  try {
    if (try_polygon(base, TopoDS::Face(reordered(face).Oriented(TopAbs_FORWARD)), net)) return;
  } catch (const Standard_Failure&) {
    base.tried.back() += " (failed)";
  }
  base.tried.push_back("healed and meshed alone");
  base.solved = false;
  if (try_alone(base, face, limits)) base.tried.back() += ": meshed, with gaps to its neighbours";
}

/// Edges of faces with triangles get the mesher's points, the others their own.
void set_lines(const std::vector<Taken>& taken, EdgeNet& net, const RefineLimits& limits) {
  for (const Taken& face : taken) {
    if (!face.refused.empty()) continue;
    for (std::size_t i = 0; i < face.mesh.uses.size(); ++i) {
      const std::vector<double>& along = face.parameters[i];
      const std::uint32_t edge = face.mesh.uses[i].edge;
      const bool ascending = std::adjacent_find(along.begin(), along.end(), std::greater_equal<>()) == along.end();
      if (net.lines()[edge].parameters.empty() && ascending) net.set_line(edge, along);
    }
  }
  for (std::uint32_t i = 0; i < net.lines().size(); ++i)
    if (net.lines()[i].parameters.empty()) net.set_line(i, net.discretize(i, limits));
}

}  // namespace

std::size_t count_folded(const FacePatch& patch) {
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < patch.triangles.size(); ++t) {
    const Vec2 a = patch.corner_uv(t, 0), b = patch.corner_uv(t, 1), c = patch.corner_uv(t, 2);
    if (cross(b - a, c - a) < 0) ++count;
  }
  return count;
}

std::vector<BaseFace> base_faces(const TopoDS_Shape& shape, EdgeNet& net, const RefineLimits& limits) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer explorer(shape, TopAbs_FACE); explorer.More(); explorer.Next())
    faces.push_back(TopoDS::Face(explorer.Current()));
  std::vector<Taken> taken(faces.size());
  parallel_for(faces.size(), [&](std::size_t i) { taken[i] = take(faces[i], net); });
  set_lines(taken, net, limits);
  std::vector<BaseFace> result(faces.size());
  parallel_for(faces.size(), [&](std::size_t i) {
    BaseFace& base = result[i];
    base.mesh = std::move(taken[i].mesh);
    base.refused = std::move(taken[i].refused);
    if (base.refused.empty()) base.refused = usable(base.mesh, net);
    if (!base.refused.empty()) rescue(base, net, limits);
  });
  return result;
}

}  // namespace papilla::cad
