// SPDX-License-Identifier: MIT
// Triangles against the exact surface, by formula or by the CAD kernel's own projection.
#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax1.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "io/cad/cad_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/sample_solids.hpp"
#include "papilla/io/tessellation_trace.hpp"

namespace papilla::test {
namespace {

CadReadOptions options(double chord_mm, double angle_deg = 90) {
  CadReadOptions result;
  result.chord_mm = chord_mm;
  result.angle_deg = angle_deg;
  return result;
}

class CadExactness : public ::testing::Test {
 protected:
  TriangleMesh read(const TopoDS_Shape& shape, const CadReadOptions& how) {
    write_brep(shape, folder_ / "shape.brep");
    return read_cad(folder_ / "shape.brep", how, &report_).parts.at(0).mesh;
  }
  TemporaryFolder folder_;
  CadReport report_;
};

/// Largest value of f over a lattice of points on every triangle, corners and edges included.
double largest(const TriangleMesh& mesh, const std::function<double(Vec3)>& f) {
  constexpr int k_steps = 8;
  double worst = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i <= k_steps; ++i)
      for (int j = 0; i + j <= k_steps; ++j) {
        const double a = double(i) / k_steps, b = double(j) / k_steps;
        worst = std::max(worst, f(a * mesh.corner(t, 0) + b * mesh.corner(t, 1) + (1 - a - b) * mesh.corner(t, 2)));
      }
  return worst;
}

TEST_F(CadExactness, SphereKeepsTheChord) {
  for (const double chord : {0.5, 0.05}) {
    const TriangleMesh mesh = read(BRepPrimAPI_MakeSphere(50).Shape(), options(chord));
    const double deviation = largest(mesh, [](Vec3 p) { return std::abs(norm(p) - 50); });
    EXPECT_LE(deviation, chord);
    EXPECT_GT(deviation, 0.2 * chord);  // Not bought with far too many triangles.
    EXPECT_LE(report_.max_deviation_mm, chord);
    EXPECT_NEAR(report_.max_deviation_mm, deviation, 0.35 * deviation);
    EXPECT_TRUE(report_.off_faces.empty());
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_GT(report_.added_nodes, 0u);
    EXPECT_EQ(report_.parts.at(0).added_nodes, report_.added_nodes);
    EXPECT_EQ(report_.parts.at(0).max_deviation_mm, report_.max_deviation_mm);
  }
}

TEST_F(CadExactness, TheMesherAloneDoesNotKeepTheChord) {
  CadReadOptions how = options(0.02, 20);
  how.meshing = CadMeshing::mesher;
  const TriangleMesh mesh = read(BRepPrimAPI_MakeSphere(1).Shape(), how);
  EXPECT_GT(largest(mesh, [](Vec3 p) { return std::abs(norm(p) - 1); }), 0.02);
  EXPECT_GT(report_.max_deviation_mm, 0.02);
  EXPECT_EQ(report_.off_faces.size(), 1u);
  EXPECT_EQ(report_.added_nodes, 0u);
}

TEST_F(CadExactness, TorusKeepsTheChord) {
  const TriangleMesh mesh = read(BRepPrimAPI_MakeTorus(40, 12).Shape(), options(0.2));
  EXPECT_LE(largest(mesh, [](Vec3 p) { return std::abs(std::hypot(std::hypot(p.x, p.y) - 40, p.z) - 12); }), 0.2);
  EXPECT_TRUE(is_closed(mesh));
}

TEST_F(CadExactness, ConeKeepsTheChordUpToItsApex) {
  const TriangleMesh mesh = read(BRepPrimAPI_MakeCone(20, 0, 30).Shape(), options(0.1));
  const double along = 30 / std::hypot(20.0, 30.0);
  // Distance from the mantle; points of the base have none of their own.
  EXPECT_LE(
      largest(mesh,
              [&](Vec3 p) { return p.z < 1e-9 ? 0 : std::abs((std::hypot(p.x, p.y) - 20 * (1 - p.z / 30)) * along); }),
      0.1);
  EXPECT_TRUE(is_closed(mesh));
}

TEST_F(CadExactness, ApexOfAConeHasTheNormalsOfItsGenerators) {
  const TriangleMesh mesh = read(BRepPrimAPI_MakeCone(20, 0, 30).Shape(), options(0.1, 20));
  std::size_t apex_corners = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (norm(mesh.corner(t, k) - Vec3{0, 0, 30}) > 1e-9) continue;
      ++apex_corners;
      const Vec3 n = mesh.normals.values[mesh.normals.indices[t][std::size_t(k)]];
      const Vec3 middle = (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
      const double u = std::atan2(middle.y, middle.x);
      const Vec3 expected = normalized(Vec3{30 * std::cos(u), 30 * std::sin(u), 20});
      EXPECT_GT(dot(n, expected), std::cos(0.5 * 20 * k_radians_per_degree));
      EXPECT_NEAR(n.z, expected.z, 1e-6);
    }
  EXPECT_GT(apex_corners, 10u);
}

TEST_F(CadExactness, PolesOfASphereHaveTheirNormalAndParameters) {
  const TriangleMesh mesh = read(BRepPrimAPI_MakeSphere(10).Shape(), options(0.1, 20));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, int(k));
      EXPECT_GT(dot(mesh.normals.values[mesh.normals.indices[t][k]], normalized(p)), 0.9999);
      const Vec2 uv = mesh.cad_uv.values[mesh.cad_uv.indices[t][k]];
      EXPECT_NEAR(p.z, 10 * std::sin(uv.y), 1e-9);
      EXPECT_NEAR(p.x, 10 * std::cos(uv.y) * std::cos(uv.x), 1e-9);
    }
    // In the parameters, too, every triangle runs counter-clockwise and none spans the seam.
    const auto uv = [&](std::size_t k) { return mesh.cad_uv.values[mesh.cad_uv.indices[t][k]]; };
    EXPECT_GT(cross(uv(1) - uv(0), uv(2) - uv(0)), 0);
    EXPECT_LT(std::abs(uv(1).x - uv(0).x), std::numbers::pi / 2);
  }
}

TEST_F(CadExactness, AReversedFaceHasItsParametersAndNormalsAtTheirCorners) {
  const TriangleMesh mesh = read(face_of(BRepPrimAPI_MakeCylinder(5, 20).Shape(), 0).Reversed(), options(0.1, 20));
  ASSERT_GT(mesh.triangles.size(), 10u);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, int(k));
      const Vec2 uv = mesh.cad_uv.values[mesh.cad_uv.indices[t][k]];
      EXPECT_LT(norm(p - Vec3{5 * std::cos(uv.x), 5 * std::sin(uv.x), uv.y}), 1e-9);
      EXPECT_LT(norm(mesh.normals.values[mesh.normals.indices[t][k]] + 0.2 * Vec3{p.x, p.y, 0}), 1e-9);
    }
    const Vec3 a = mesh.corner(t, 0), across = cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
    EXPECT_LT(dot(across, Vec3{a.x, a.y, 0}), 0);  // Seen from the axis.
  }
}

/// z over the square of side 60 with x = u and y = v exactly, since the control points stand at the knots' means.
Handle(Geom_BSplineSurface) waves() {
  constexpr int k_poles = 13, k_degree = 3, k_spans = k_poles - k_degree;
  TColStd_Array1OfReal knots(1, k_spans + 1);
  TColStd_Array1OfInteger multiplicities(1, k_spans + 1);
  std::vector<double> all(k_degree, 0.0);
  for (int i = 0; i <= k_spans; ++i) {
    knots.SetValue(i + 1, 60.0 * i / k_spans);
    multiplicities.SetValue(i + 1, i == 0 || i == k_spans ? k_degree + 1 : 1);
    all.push_back(60.0 * i / k_spans);
  }
  all.insert(all.end(), k_degree, 60.0);
  const auto mean = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    return (all[at] + all[at + 1] + all[at + 2]) / 3;
  };
  TColgp_Array2OfPnt poles(1, k_poles, 1, k_poles);
  for (int i = 1; i <= k_poles; ++i)
    for (int k = 1; k <= k_poles; ++k)
      poles.SetValue(i, k, gp_Pnt(mean(i), mean(k), 3 * std::sin(2.1 * i) * std::cos(1.3 * k)));
  return new Geom_BSplineSurface(poles, knots, knots, multiplicities, multiplicities, k_degree, k_degree);
}

TEST_F(CadExactness, FreeFormSurfaceKeepsTheChord) {
  const Handle(Geom_BSplineSurface) surface = waves();
  for (const double chord : {0.3, 0.03}) {
    const TriangleMesh mesh = read(BRepBuilderAPI_MakeFace(surface, 1e-7).Face(), options(chord));
    const double deviation = largest(mesh, [&](Vec3 p) {
      gp_Pnt q;
      gp_Vec du, dv;
      surface->D1(p.x, p.y, q, du, dv);
      return std::abs(p.z - q.Z()) / std::sqrt(1 + du.Z() * du.Z() + dv.Z() * dv.Z());
    });
    EXPECT_LE(deviation, chord);
    EXPECT_GT(deviation, 0.3 * chord);
    EXPECT_LE(report_.max_deviation_mm, chord);
    EXPECT_GT(report_.max_deviation_mm, 0.6 * deviation);
  }
}

TEST_F(CadExactness, AngleIsKept) {
  for (const double angle : {30.0, 10.0}) {
    const TriangleMesh mesh = read(BRepPrimAPI_MakeTorus(20, 5).Shape(), options(5, angle));
    double largest_turn = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = mesh.normals.values[mesh.normals.indices[t][k]],
                   b = mesh.normals.values[mesh.normals.indices[t][(k + 1) % 3]];
        if (norm(mesh.corner(t, int(k)) - mesh.corner(t, int((k + 1) % 3))) > 0.5)
          largest_turn = std::max(largest_turn, std::acos(std::min(1.0, dot(a, b))) * k_degrees_per_radian);
      }
    EXPECT_LE(largest_turn, angle * (1 + 1e-9));
    EXPECT_LE(report_.max_angle_deg, angle * (1 + 1e-9));
    EXPECT_GT(report_.max_angle_deg, 0.3 * angle);
  }
}

TEST_F(CadExactness, RoundingAtPolesAndApexesTurnsNoNormal) {
  gp_Trsf turned;
  turned.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(0.3, -0.7, 0.2)), 1.1);
  for (const TopoDS_Shape& shape : {BRepPrimAPI_MakeSphere(4).Shape(), BRepPrimAPI_MakeCone(20, 0, 30).Shape()}) {
    read(BRepBuilderAPI_Transform(shape, turned, true).Shape(), options(0.1, 20));
    EXPECT_LE(report_.max_angle_deg, 20 * (1 + 1e-9));
  }
}

TEST_F(CadExactness, LongestEdgeIsKept) {
  CadReadOptions how = options(1);
  how.max_edge_mm = 4;
  const TriangleMesh mesh = read(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), how);
  double longest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) longest = std::max(longest, norm(mesh.corner(t, k) - mesh.corner(t, (k + 1) % 3)));
  EXPECT_LE(longest, 4);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 6000, 1e-9);
}

/// Seams that are straight, or fine enough for the chord, are cut only for this.
TEST_F(CadExactness, LongestEdgeIsKeptAcrossSeams) {
  CadReadOptions how = options(0.1, 20);
  how.max_edge_mm = 2.5;
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeCone(20, 8, 40).Shape(), BRepPrimAPI_MakeCone(8, 20, 40).Shape(),
        BRepPrimAPI_MakeCylinder(15, 30).Shape(), BRepPrimAPI_MakeTorus(30, 8).Shape(),
        BRepPrimAPI_MakeSphere(20).Shape(), BRepPrimAPI_MakeCylinder(15, 30).Shape().Reversed()}) {
    const TriangleMesh mesh = read(shape, how);
    EXPECT_LE(report_.max_deviation_mm, 0.1);
    EXPECT_LT(mesh.triangles.size(), 20000U);
    EXPECT_TRUE(is_closed(mesh));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) ASSERT_LE(norm(mesh.corner(t, k) - mesh.corner(t, (k + 1) % 3)), 2.5);
  }
}

TEST_F(CadExactness, RelativeChordIsAFractionOfThePartsDiagonal) {
  CadReadOptions how = options(0.002);
  how.relative = true;
  const TriangleMesh mesh = read(BRepPrimAPI_MakeSphere(50).Shape(), how);
  const double chord = 0.002 * 100 * std::sqrt(3.0);
  const double deviation = largest(mesh, [](Vec3 p) { return std::abs(norm(p) - 50); });
  EXPECT_LE(deviation, chord * 1.001);  // The box around the shape has a small margin.
  EXPECT_GT(deviation, 0.2 * chord);
}

TEST_F(CadExactness, NoTriangleIsFlat) {
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeCone(20, 0, 30).Shape(), BRepPrimAPI_MakeSphere(20).Shape(),
        BRepPrimAPI_MakeCone(20, 3, 30, 1.5).Shape(), BRepPrimAPI_MakeTorus(20, 5).Shape()}) {
    const TriangleMesh mesh = read(shape, options(0.3, 20));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
      const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
      EXPECT_GT(norm(cross(b - a, c - a)), 1e-4 * longest * longest);
    }
    EXPECT_TRUE(is_closed(mesh));
  }
}

/// A square with a slit whose sides cross by a thousandth of a millimetre, as inexact CAD files have it. The mesher
/// leaves part of the boundary without triangles.
TopoDS_Face crossed_slit() {
  BRepBuilderAPI_MakePolygon outline;
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), {10.0, 0.0}, {10.0, 10.0}, {4.999, 10.0}, {5.0, 5.0}, {5.001, 10.0}, {0.0, 10.0}})
    outline.Add(gp_Pnt(x, y, 0));
  outline.Close();
  return BRepBuilderAPI_MakeFace(gp_Pln(), outline.Wire(), true).Face();
}

TEST_F(CadExactness, RefusedFaceIsTriangulatedBetweenItsEdges) {
  const TriangleMesh mesh = read(crossed_slit(), options(0.1));
  ASSERT_EQ(report_.repaired_faces.size(), 1u);
  EXPECT_EQ(report_.repaired_faces[0].face, 0u);
  EXPECT_FALSE(report_.repaired_faces[0].reason.empty());
  EXPECT_FALSE(report_.repaired_faces[0].tried.empty());
  EXPECT_TRUE(report_.failed_faces.empty());
  EXPECT_EQ(mesh.triangles.size(), 5u);  // Seven corners, each side once.
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area += 0.5 * cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)).z;
  EXPECT_NEAR(area, 100 + 0.005, 1e-9);
}

TEST_F(CadExactness, EdgesOffTheirSurfaceAreNamed) {
  // A cylinder of radius 5 between circles of radius 5.02: no triangles can make that good.
  BRep_Builder builder;
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  for (TopExp_Explorer edges(shape, TopAbs_EDGE); edges.More(); edges.Next()) {
    double first = 0, last = 0;
    const TopoDS_Edge& edge = TopoDS::Edge(edges.Current());
    const Handle(Geom_Circle) circle = Handle(Geom_Circle)::DownCast(BRep_Tool::Curve(edge, first, last));
    if (circle.IsNull()) continue;
    const Handle(Geom_Circle) wider = Handle(Geom_Circle)::DownCast(circle->Copy());
    wider->SetRadius(5.02);
    builder.UpdateEdge(edge, wider, 0.03);
  }
  const TriangleMesh mesh = read(shape, options(0.01, 20));
  EXPECT_FALSE(report_.off_faces.empty());
  EXPECT_NEAR(report_.max_deviation_mm, 0.02, 1e-3);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_LT(mesh.triangles.size(), 2000u);  // Refinement does not run after what it can't reach.
}

TEST_F(CadExactness, TraceFallsWithTheChord) {
  write_brep(BRepPrimAPI_MakeTorus(20, 5).Shape(), folder_ / "torus.brep");
  const std::vector<double> chords = chord_ladder(0.5, 0.02, 4);
  ASSERT_EQ(chords.size(), 4u);
  EXPECT_EQ(chords.front(), 0.5);
  EXPECT_EQ(chords.back(), 0.02);
  EXPECT_NEAR(chords[1] / chords[0], chords[2] / chords[1], 1e-12);
  const std::vector<TessellationSample> trace = trace_tessellation(folder_ / "torus.brep", chords, options(1));
  ASSERT_EQ(trace.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(trace[i].chord_mm, chords[i]);
    EXPECT_LE(trace[i].deviation_mm, chords[i]);
    EXPECT_GT(trace[i].seconds, 0);
  }
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_GT(trace[i].triangles, trace[i - 1].triangles);
    EXPECT_LT(trace[i].deviation_mm, trace[i - 1].deviation_mm);
  }
  EXPECT_THROW(chord_ladder(0.1, 0.5, 3), InvalidInput);
  EXPECT_THROW(chord_ladder(0.5, 0.1, 1), InvalidInput);
}

TEST_F(CadExactness, SampleSolidsHaveTheirAreas) {
  using namespace sample_solids;
  write_sample_solids(folder_ / "solids.brep");
  const Scene scene = read_cad(folder_ / "solids.brep", options(0.005));
  double area = 0;
  for (const Part& part : scene.parts)
    for (const Triangle& t : part.mesh.triangles)
      area += 0.5 * norm(cross(part.mesh.positions[t[1]] - part.mesh.positions[t[0]],
                               part.mesh.positions[t[2]] - part.mesh.positions[t[0]]));
  const double pi = std::numbers::pi;
  const double slant = std::hypot(k_cone_radius - k_cone_top_radius, k_cone_height);
  const double expected = 4 * pi * k_ball_radius * k_ball_radius + 4 * pi * pi * k_ring_radius * k_tube_radius +
                          pi * (k_cone_radius * k_cone_radius + k_cone_top_radius * k_cone_top_radius) +
                          pi * (k_cone_radius + k_cone_top_radius) * slant;
  EXPECT_NEAR(area / expected, 1, 2e-3);
}

/// A blade lofted through ellipses, whose long triangles between sharply turning ends take many splits.
TopoDS_Shape blade() {
  BRepOffsetAPI_ThruSections loft(true);
  struct Section {
    double x, z, half_width, half_height;
  };
  for (const Section& s : {Section{40, -22, 26, 9}, {75, -19, 22, 7}, {120, -11, 17, 6}, {182, 0, 19, 7}}) {
    const gp_Elips ellipse(gp_Ax2(gp_Pnt(s.x, 0, s.z), gp::DX(), gp::DY()), s.half_width, s.half_height);
    loft.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(ellipse).Edge()).Wire());
  }
  loft.Build();
  return loft.Shape();
}

TEST_F(CadExactness, NodesKeepClearOfEachOther) {
  for (const double chord : {0.05, 0.1}) {
    const TriangleMesh mesh = read(blade(), options(chord, 20));
    EXPECT_LE(report_.max_deviation_mm, chord);
    EXPECT_TRUE(report_.off_faces.empty());
    EXPECT_TRUE(is_closed(mesh));
    double shortest = chord;
    std::size_t without_area = 0;  // as glTF stores it: metres in single precision
    const auto stored = [](const Vec3& p) {
      const auto number = [](double mm) { return static_cast<double>(static_cast<float>(k_metres_per_mm * mm)); };
      return Vec3{number(p.x), number(p.y), number(p.z)};
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) shortest = std::min(shortest, norm(mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)));
      const Vec3 a = stored(mesh.corner(t, 0)), b = stored(mesh.corner(t, 1)), c = stored(mesh.corner(t, 2));
      without_area += norm(cross(b - a, c - a)) > 0 ? 0u : 1u;
    }
    EXPECT_GE(shortest, 0.01 * chord);
    EXPECT_EQ(without_area, 0u);
  }
}

}  // namespace
}  // namespace papilla::test
