// SPDX-License-Identifier: MIT
#include "cad_mesh.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <GeomLib.hxx>
#include <NCollection_DataMap.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_GTrsf2d.hxx>
#include <limits>

namespace papilla::cad {
namespace {

constexpr Index k_none = std::numeric_limits<Index>::max();

Vec3 to_vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

/// One face's triangulation in the frame of its shape, wound outward.
struct FaceMesh {
  Handle(Poly_Triangulation) source;
  TopLoc_Location location;
  bool flipped = false;
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  std::vector<Triangle> triangles;
  double max_deviation = 0;
};

/// The triangulation's (u, v) in the parameters of the CAD face's surface, which a scaled copy may stretch.
std::vector<Vec2> parameters_of(const NumberedFace& face, const Poly_Triangulation& source) {
  std::vector<Vec2> result;
  if (!source.HasUVNodes()) return result;
  result.reserve(static_cast<std::size_t>(source.NbNodes()));
  gp_GTrsf2d to_cad;
  TopLoc_Location location;
  const Handle(Geom_Surface)& surface = BRep_Tool::Surface(face.cad, location);
  if (face.scale != 1 && !surface.IsNull()) {
    gp_Trsf enlarge;
    enlarge.SetScaleFactor(face.scale);
    to_cad = surface->ParametricTransformation(enlarge).Inverted();
  }
  for (int i = 1; i <= source.NbNodes(); ++i) {
    gp_XY uv = source.UVNode(i).XY();
    to_cad.Transforms(uv);
    result.push_back({uv.X(), uv.Y()});
  }
  return result;
}

void copy_triangulation(const NumberedFace& face, FaceMesh& mesh) {
  const gp_Trsf trsf = mesh.location.Transformation();
  mesh.positions.reserve(static_cast<std::size_t>(mesh.source->NbNodes()));
  for (int i = 1; i <= mesh.source->NbNodes(); ++i) {
    gp_XYZ p = mesh.source->Node(i).XYZ();
    trsf.Transforms(p);
    mesh.positions.push_back((1 / face.scale) * to_vec(p));
  }
  mesh.uv = parameters_of(face, *mesh.source);
  mesh.triangles.reserve(static_cast<std::size_t>(mesh.source->NbTriangles()));
  for (int i = 1; i <= mesh.source->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    mesh.source->Triangle(i).Get(a, b, c);
    if (mesh.flipped) std::swap(b, c);
    mesh.triangles.push_back({static_cast<Index>(a - 1), static_cast<Index>(b - 1), static_cast<Index>(c - 1)});
  }
}

Vec3 triangle_normal(const FaceMesh& mesh, const Triangle& t) {
  return cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
}

/// Area-weighted means of the triangles around each node.
std::vector<Vec3> mean_normals(const FaceMesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = triangle_normal(mesh, t);
    for (const Index node : t) sums[node] = sums[node] + n;
  }
  return sums;
}

/// The surface's normal at (u, v), not yet oriented; zero where it has none.
Vec3 surface_normal(const BRepAdaptor_Surface& surface, const gp_Trsf& trsf, Vec2 uv) {
  gp_Pnt p;
  gp_Vec du, dv;
  surface.D1(uv.x, uv.y, p, du, dv);
  const gp_Vec n = du.Crossed(dv);
  // Below this sine the tangents are parallel for all that double precision can tell.
  constexpr double k_parallel = 1e-9;
  if (n.Magnitude() > k_parallel * du.Magnitude() * dv.Magnitude()) return normalized(to_vec(n.XYZ()));
  gp_Dir limit;
  const Handle(Geom_Surface) geometry = BRep_Tool::Surface(TopoDS::Face(surface.Face().Located(TopLoc_Location())));
  if (GeomLib::NormEstim(geometry, gp_Pnt2d(uv.x, uv.y), 1e-7, limit) > 1) return {};
  gp_Vec turned(limit);
  turned.Transform(trsf);
  return normalized((trsf.IsNegative() ? -1.0 : 1.0) * to_vec(turned.XYZ()));
}

void add_normals(FaceMesh& mesh, const BRepAdaptor_Surface* surface) {
  std::vector<Vec3> means = mean_normals(mesh);
  mesh.normals.resize(mesh.positions.size());
  const gp_Trsf trsf = mesh.location.Transformation();
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    Vec3 n = surface ? surface_normal(*surface, trsf, mesh.uv[i]) : Vec3{};
    if (mesh.flipped) n = -n;
    const bool usable = is_finite(n) && norm(n) > 0.5;
    // The library's estimate at singular points doesn't know the side.
    if (usable && dot(n, means[i]) >= 0)
      mesh.normals[i] = n;
    else
      mesh.normals[i] = norm(means[i]) > 0 ? normalized(means[i]) : (usable ? n : Vec3{0, 0, 1});
  }
}

/// Largest distance between the surface and a triangle's plane, sampled at the centroid and the edges' midpoints.
double max_deviation(const FaceMesh& mesh, const BRepAdaptor_Surface& surface) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = normalized(triangle_normal(mesh, t));
    const Vec2 a = mesh.uv[t[0]], b = mesh.uv[t[1]], c = mesh.uv[t[2]];
    const std::array<Vec2, 4> samples = {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (1.0 / 3) * (a + b + c)};
    for (const Vec2 uv : samples) {
      const Vec3 p = to_vec(surface.Value(uv.x, uv.y).XYZ());
      largest = std::max(largest, std::abs(dot(n, p - mesh.positions[t[0]])));
    }
  }
  return largest;
}

FaceMesh mesh_of(const NumberedFace& face) {
  FaceMesh mesh;
  mesh.source = BRep_Tool::Triangulation(face.triangles, mesh.location);
  if (mesh.source.IsNull()) return mesh;
  const bool mirrored = mesh.location.Transformation().VectorialPart().Determinant() < 0;
  mesh.flipped = (face.triangles.Orientation() == TopAbs_REVERSED) != mirrored;
  copy_triangulation(face, mesh);
  const bool on_surface = !BRep_Tool::Surface(face.cad).IsNull() && !mesh.uv.empty();
  if (!on_surface) {
    add_normals(mesh, nullptr);
    return mesh;
  }
  const BRepAdaptor_Surface surface(face.cad, false);
  add_normals(mesh, &surface);
  mesh.max_deviation = max_deviation(mesh, surface);
  return mesh;
}

/// Gives the nodes on edges and vertices shared between faces one position.
class Welder {
 public:
  explicit Welder(std::vector<Vec3>& positions) : positions_(positions) {}

  /// The position of each node of the face.
  std::vector<Index> add(const TopoDS_Face& face, const FaceMesh& mesh) {
    std::vector<Index> result(mesh.positions.size(), k_none);
    for (TopExp_Explorer edges(face, TopAbs_EDGE); edges.More(); edges.Next())
      add_edge(TopoDS::Edge(edges.Current()), mesh, result);
    for (std::size_t i = 0; i < result.size(); ++i)
      if (result[i] == k_none) result[i] = append(mesh.positions[i]);
    return result;
  }

 private:
  void add_edge(const TopoDS_Edge& edge, const FaceMesh& mesh, std::vector<Index>& result) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, mesh.source, mesh.location);
    if (polygon.IsNull()) return;
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last, false);
    const int count = polygon->NbNodes();
    std::vector<Index>& shared = edge_nodes_of(edge, count);
    // A face triangulated alone may cut an edge differently: nothing to share then.
    if (static_cast<int>(shared.size()) != count) return;
    for (int k = 0; k < count; ++k) {
      const auto node = static_cast<std::size_t>(polygon->Node(k + 1) - 1);
      const bool degenerated = BRep_Tool::Degenerated(edge);
      const TopoDS_Vertex& end = k == 0 || degenerated ? first : k == count - 1 ? last : TopoDS_Vertex();
      Index& slot = end.IsNull() ? shared[static_cast<std::size_t>(k)] : vertex_of(end);
      if (slot == k_none) slot = result[node] != k_none ? result[node] : append(mesh.positions[node]);
      result[node] = slot;
    }
  }

  std::vector<Index>& edge_nodes_of(const TopoDS_Edge& edge, int count) {
    if (!edges_.IsBound(edge)) edges_.Bind(edge, std::vector<Index>(static_cast<std::size_t>(count), k_none));
    return edges_.ChangeFind(edge);
  }

  Index& vertex_of(const TopoDS_Vertex& vertex) {
    if (!vertices_.IsBound(vertex)) vertices_.Bind(vertex, k_none);
    return vertices_.ChangeFind(vertex);
  }

  Index append(Vec3 p) {
    positions_.push_back(p);
    return static_cast<Index>(positions_.size() - 1);
  }

  std::vector<Vec3>& positions_;
  NCollection_DataMap<TopoDS_Shape, std::vector<Index>, TopTools_ShapeMapHasher> edges_;
  NCollection_DataMap<TopoDS_Shape, Index, TopTools_ShapeMapHasher> vertices_;
};

template <class T>
Index append_all(CornerAttribute<T>& attribute, const std::vector<T>& values) {
  const auto base = static_cast<Index>(attribute.values.size());
  attribute.values.insert(attribute.values.end(), values.begin(), values.end());
  return base;
}

Triangle shifted(const Triangle& t, Index base) { return {t[0] + base, t[1] + base, t[2] + base}; }

bool collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

void append_face(const FaceMesh& face, const std::vector<Index>& position_of, std::uint32_t number, ShapeMesh& result) {
  TriangleMesh& mesh = result.mesh;
  const Index normal_base = append_all(mesh.normals, face.normals);
  // Faces without parameters still need a value for their corners.
  const std::vector<Vec2> no_uv(face.uv.empty() ? face.positions.size() : 0);
  const Index uv_base = append_all(mesh.cad_uv, face.uv.empty() ? no_uv : face.uv);
  for (const Triangle& t : face.triangles) {
    const Triangle welded = {position_of[t[0]], position_of[t[1]], position_of[t[2]]};
    if (collapsed(welded)) {
      ++result.dropped_triangles;
      continue;
    }
    mesh.triangles.push_back(welded);
    mesh.normals.indices.push_back(shifted(t, normal_base));
    mesh.cad_uv.indices.push_back(shifted(t, uv_base));
    mesh.face.push_back(number);
  }
}

bool all_finite(const FaceMesh& face) {
  return std::all_of(face.positions.begin(), face.positions.end(), [](Vec3 p) { return is_finite(p); }) &&
         std::all_of(face.uv.begin(), face.uv.end(), [](Vec2 p) { return is_finite(p); });
}

}  // namespace

ShapeMesh to_mesh(const std::vector<NumberedFace>& faces, const std::vector<std::uint32_t>& face_materials) {
  std::vector<FaceMesh> meshes(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) { meshes[i] = mesh_of(faces[i]); });

  ShapeMesh result;
  Welder welder(result.mesh.positions);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (meshes[i].triangles.empty()) continue;
    const std::uint32_t number = faces[i].number;
    if (!all_finite(meshes[i])) {
      result.not_finite.push_back(number);
      continue;
    }
    append_face(meshes[i], welder.add(faces[i].triangles, meshes[i]), number, result);
    result.max_deviation_mm = std::max(result.max_deviation_mm, meshes[i].max_deviation);
    if (!face_materials.empty()) result.mesh.material.resize(result.mesh.triangles.size(), face_materials[number]);
    meshes[i] = {};
  }
  return result;
}

}  // namespace papilla::cad
