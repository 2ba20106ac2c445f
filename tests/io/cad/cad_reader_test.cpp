// SPDX-License-Identifier: MIT
#include "papilla/io/cad_reader.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <TopoDS_CompSolid.hxx>
#include <TopoDS_Compound.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

#include "io/cad/cad_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/units.hpp"

namespace papilla::test {
namespace {

constexpr double k_pi = std::numbers::pi;

TopoDS_Shape box() { return BRepPrimAPI_MakeBox(10, 20, 30).Shape(); }

CadReadOptions options(double chord_mm, double angle_deg = 30) {
  CadReadOptions result;
  result.chord_mm = chord_mm;
  result.angle_deg = angle_deg;
  return result;
}

class CadReader : public ::testing::Test {
 protected:
  Scene read_as_step(const TopoDS_Shape& shape, const CadReadOptions& how = {}) {
    write_step(shape, folder_ / "shape.step");
    return read_cad(folder_ / "shape.step", how, &report_);
  }
  Scene read_as_brep(const TopoDS_Shape& shape, const CadReadOptions& how = {}) {
    write_brep(shape, folder_ / "shape.brep");
    return read_cad(folder_ / "shape.brep", how, &report_);
  }

  TemporaryFolder folder_;
  CadReport report_;
};

Vec3 normal_of(const TriangleMesh& mesh, std::size_t i) {
  return normalized(cross(mesh.corner(i, 1) - mesh.corner(i, 0), mesh.corner(i, 2) - mesh.corner(i, 0)));
}

const Vec3& corner_normal(const TriangleMesh& mesh, std::size_t i, std::size_t k) {
  return mesh.normals.values[mesh.normals.indices[i][k]];
}

TEST_F(CadReader, BoxIsTwelveTrianglesClosedAndOutward) {
  const Scene scene = read_as_step(box());
  ASSERT_EQ(scene.parts.size(), 1u);
  const TriangleMesh& mesh = scene.parts[0].mesh;
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 6000, 1e-9);
  EXPECT_EQ(scene.format, "STEP");
  EXPECT_EQ(scene.unit, "mm");
  EXPECT_EQ(scene.up, UpAxis::z);
  EXPECT_EQ(report_.solids, 1u);
  EXPECT_EQ(report_.faces, 6u);
  EXPECT_EQ(report_.triangles, 12u);
  EXPECT_TRUE(report_.failed_faces.empty());
  EXPECT_EQ(std::set<std::uint32_t>(mesh.face.begin(), mesh.face.end()), (std::set<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST_F(CadReader, BoxNormalsAreTheFacesOwn) {
  const Scene scene = read_as_step(box());
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(dot(corner_normal(mesh, i, k), normal_of(mesh, i)), 1, 1e-12);
}

TEST_F(CadReader, AllSchemasOfStepGiveTheSameBox) {
  for (const char* schema : {"AP203", "AP214IS", "AP242DIS"}) {
    write_step(box(), folder_ / "box.stp", schema);
    EXPECT_NEAR(volume(read_cad(folder_ / "box.stp").parts.at(0).mesh), 6000, 1e-9) << schema;
  }
}

TEST_F(CadReader, CylinderCornersHaveAngleAndHeight) {
  const Scene scene = read_as_step(BRepPrimAPI_MakeCylinder(5, 20).Shape());
  const TriangleMesh& mesh = scene.parts[0].mesh;
  ASSERT_EQ(mesh.cad_uv.indices.size(), mesh.triangles.size());
  std::size_t on_side = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (std::abs(normal_of(mesh, i).z) > 0.5) continue;
    ++on_side;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 uv = mesh.cad_uv.values[mesh.cad_uv.indices[i][k]];
      const Vec3 p = mesh.corner(i, static_cast<int>(k));
      EXPECT_NEAR(p.x, 5 * std::cos(uv.x), 1e-9);
      EXPECT_NEAR(p.y, 5 * std::sin(uv.x), 1e-9);
      EXPECT_NEAR(p.z, uv.y, 1e-9);
    }
  }
  EXPECT_GT(on_side, 30u);
  EXPECT_TRUE(is_closed(mesh));  // Also along the seam, where u jumps by 2π.
}

TEST_F(CadReader, FinerChordAndAngleGiveMoreTriangles) {
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(20, 5).Shape();
  const auto count = [&](double chord, double angle) {
    read_as_step(torus, options(chord, angle));
    return report_.triangles;
  };
  EXPECT_LT(count(0.5, 30), count(0.05, 30));
  EXPECT_LT(count(0.5, 30), count(0.5, 5));
}

TEST_F(CadReader, ReversedFaceIsTurned) {
  const TopoDS_Face bottom = face_of(box(), 4);
  const Scene as_is = read_as_brep(bottom), reversed = read_as_brep(bottom.Reversed());
  const Vec3 a = normal_of(as_is.parts[0].mesh, 0), b = normal_of(reversed.parts[0].mesh, 0);
  EXPECT_NEAR(dot(a, b), -1, 1e-12);
  EXPECT_NEAR(dot(corner_normal(reversed.parts[0].mesh, 0, 0), b), 1, 1e-12);
}

TEST_F(CadReader, IgesSolid) {
  write_iges(box(), folder_ / "box.igs");
  const Scene scene = read_cad(folder_ / "box.igs");
  EXPECT_EQ(scene.format, "IGES");
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_TRUE(is_closed(scene.parts[0].mesh));
  EXPECT_NEAR(std::abs(volume(scene.parts[0].mesh)), 6000, 1e-6);
}

TEST_F(CadReader, BrepCarriesNoUnit) {
  CadReadOptions centimetres;
  centimetres.millimetres_per_unit = 10;
  const Scene scene = read_as_brep(box(), centimetres);
  EXPECT_EQ(scene.format, "BREP");
  EXPECT_EQ(scene.millimetres_per_unit, 10);
  EXPECT_NEAR(volume(scene.parts.at(0).mesh), 6e6, 1e-6);
}

TEST_F(CadReader, GivenUnitReplacesTheFilesAndKeepsTheTolerance) {
  CadFile file;
  const TDF_Label part = file.add("torus", BRepPrimAPI_MakeTorus(20, 5).Shape());
  const TDF_Label assembly = file.add_assembly("whole");
  gp_Trsf moved;
  moved.SetTranslation(gp_Vec(25.4, 0, 0));
  file.place(assembly, part, moved, "ring");
  file.write_step(folder_ / "torus.step", "AP214IS", "INCH");
  CadReadOptions how = options(0.1);
  how.millimetres_per_unit = 10;
  const Scene scene = read_cad(folder_ / "torus.step", how, &report_);
  EXPECT_EQ(scene.millimetres_per_unit, 10);
  EXPECT_EQ(scene.unit, "cm");
  double widest = 0;
  for (const Vec3& p : scene.parts.at(0).mesh.positions) widest = std::max(widest, p.x);
  EXPECT_NEAR(widest, 25 / 25.4 * 10, 1e-9);
  EXPECT_NEAR(instances(scene).at(0).world[3], 10, 1e-9);
  EXPECT_LE(report_.max_deviation_mm, 0.1);
  EXPECT_GT(report_.max_deviation_mm, 0.02);
}

TEST_F(CadReader, InchesBecomeMillimetres) {
  CadFile file;
  file.add("box", box());
  file.write_step(folder_ / "box.step", "AP214IS", "INCH");
  const Scene scene = read_cad(folder_ / "box.step");
  EXPECT_EQ(scene.unit, "inch");
  EXPECT_EQ(scene.millimetres_per_unit, 25.4);
  EXPECT_NEAR(volume(scene.parts.at(0).mesh), 6000, 1e-6);
}

TEST_F(CadReader, UnitsAreToldAndCounted) {
  const struct {
    const char *name, *unit;
    double mm;
  } cases[] = {{"CM", "cm", 10}, {"FT", "ft", 304.8}, {"INCH", "inch", 25.4}, {"M", "m", 1000}};
  for (const auto& [name, unit, mm] : cases) {
    CadFile file;
    file.add("box", box());
    file.write_step(folder_ / "box.step", "AP214IS", name);
    const Scene scene = read_cad(folder_ / "box.step");
    EXPECT_EQ(scene.unit, unit);
    EXPECT_EQ(scene.millimetres_per_unit, mm) << name;
    EXPECT_NEAR(volume(scene.parts.at(0).mesh), 6000, 1e-6) << name;
  }
}

TEST_F(CadReader, FaceColoursBecomeMaterialSlots) {
  const TopoDS_Shape shape = box();
  CadFile file;
  const TDF_Label part = file.add("painted", shape);
  file.colour(part, 0x808080);
  file.colour_face(part, face_of(shape, 2), 0xFF0000);
  file.write_step(folder_ / "painted.step");
  const Scene scene = read_cad(folder_ / "painted.step");
  const Part& read = scene.parts.at(0);
  ASSERT_EQ(read.materials.size(), 2u);
  ASSERT_EQ(read.mesh.material.size(), 12u);
  int red = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    if (scene.materials[read.materials[read.mesh.material[i]]].name != "#FF0000") continue;
    ++red;
    EXPECT_EQ(read.mesh.face[i], 2u);
  }
  EXPECT_EQ(red, 2);
}

TEST_F(CadReader, TranslucentColour) {
  CadFile file;
  file.colour(file.add("glass", box()), 0xA0C4E0, 0.25f);
  file.write_step(folder_ / "glass.step");
  const Material material = read_cad(folder_ / "glass.step").materials.at(0);
  EXPECT_NEAR(material.base_color[3], 0.25, 1e-6);
  EXPECT_EQ(material.alpha_mode, "BLEND");
  EXPECT_EQ(material.name, "#A0C4E040");
  EXPECT_EQ(nlohmann::json::parse(material.extras_json).at("cad_colour"), "#A0C4E0");
}

TEST_F(CadReader, ShapeWithoutColourHasNoMaterial) {
  const Scene scene = read_as_step(box());
  EXPECT_TRUE(scene.materials.empty());
  EXPECT_TRUE(scene.parts[0].materials.empty());
  EXPECT_TRUE(scene.parts[0].mesh.material.empty());
}

TEST_F(CadReader, LayersGoIntoExtras) {
  CadFile file;
  const TDF_Label part = file.add("box", box());
  file.layer(part, "visible skin");
  file.write_step(folder_ / "layers.step");
  const Scene scene = read_cad(folder_ / "layers.step");
  EXPECT_EQ(nlohmann::json::parse(scene.parts.at(0).extras_json).at("layers"), nlohmann::json({"visible skin"}));
}

TEST_F(CadReader, RepeatedShapesInABrepAreInstances) {
  const TopoDS_Shape shape = box();
  gp_Trsf moved;
  moved.SetTranslation(gp_Vec(50, 0, 0));
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, shape);
  builder.Add(two, shape.Located(TopLoc_Location(moved)));
  const Scene scene = read_as_brep(two);
  EXPECT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.nodes.at(scene.roots.at(0)).children.size(), 2u);
  ASSERT_EQ(instances(scene).size(), 2u);
  EXPECT_EQ(instances(scene)[0].world[3], 0);
  EXPECT_EQ(instances(scene)[1].world[3], 50);
}

TEST_F(CadReader, BodiesOfOneProductLieWhereTheyDo) {
  const TopoDS_Shape shape = box();
  gp_Trsf moved;
  moved.SetTranslation(gp_Vec(-40, 7, 100));
  TopoDS_CompSolid two;
  BRep_Builder builder;
  builder.MakeCompSolid(two);
  builder.Add(two, shape);
  builder.Add(two, shape.Located(TopLoc_Location(moved)));
  const Scene scene = read_as_brep(two);
  const std::vector<Instance> uses = instances(scene);
  ASSERT_EQ(uses.size(), 2u);
  for (const Instance& use : uses) {
    Vec3 middle;
    for (const Vec3& p : scene.parts[use.part].mesh.positions)
      middle = middle + 1.0 / 8 * transform_point(use.world, p);
    EXPECT_LT(norm(middle - (use.node == uses[0].node ? Vec3{5, 10, 15} : Vec3{-35, 17, 115})), 1e-9);
  }
  EXPECT_EQ(uses[0].part, uses[1].part);
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles && a.face == b.face && a.material == b.material &&
         a.normals.values == b.normals.values && a.normals.indices == b.normals.indices &&
         a.cad_uv.values == b.cad_uv.values && a.cad_uv.indices == b.cad_uv.indices;
}

TEST_F(CadReader, SameResultWithOneThreadAndMany) {
  TopoDS_Compound several;
  BRep_Builder builder;
  builder.MakeCompound(several);
  for (int i = 0; i < 8; ++i) builder.Add(several, BRepPrimAPI_MakeTorus(10 + i, 3).Shape());
  const Scene many = read_as_brep(several, options(0.02)), again = read_as_brep(several, options(0.02));
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Scene one = read_as_brep(several, options(0.02));
  ASSERT_EQ(one.parts.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_TRUE(same_mesh(many.parts[i].mesh, again.parts[i].mesh));
    EXPECT_TRUE(same_mesh(many.parts[i].mesh, one.parts[i].mesh));
  }
}

std::string brep_text(const TopoDS_Shape& shape, TopTools_FormatVersion version) {
  std::ostringstream out;
  BRepTools::Write(shape, out, true, true, version);
  return out.str();
}

std::string brep_binary(const TopoDS_Shape& shape, BinTools_FormatVersion version) {
  std::ostringstream out;
  BinTools::Write(shape, out, true, true, version);
  return out.str();
}

std::string with_crlf(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

/// A solid of curved and flat faces, placed by a location of its own.
TopoDS_Shape placed_cone() {
  gp_Trsf place;
  place.SetTranslation(gp_Vec(50, -20, 7));
  return BRepPrimAPI_MakeCone(5, 2, 12).Shape().Located(TopLoc_Location(place));
}

/// The layout of DRAW's `save`: the class of the object, the shape, a line `0`, an empty line.
std::string as_draw_saves(const std::string& brep) { return "DBRep_DrawableShape\n" + brep + "\n0\n\n"; }

TEST_F(CadReader, EveryBrepThatOpenCascadeWritesIsRead) {
  const TopoDS_Shape shape = placed_cone();
  const std::string v1 = brep_text(shape, TopTools_FormatVersion_VERSION_1);
  const std::vector<std::pair<const char*, std::string>> files = {
      {"text 1", v1},
      {"text 2", brep_text(shape, TopTools_FormatVersion_VERSION_2)},
      {"text 3", brep_text(shape, TopTools_FormatVersion_VERSION_3)},
      {"DRAW 1", as_draw_saves(v1)},
      {"DRAW 3", as_draw_saves(brep_text(shape, TopTools_FormatVersion_VERSION_3))},
      {"text, CRLF", with_crlf(v1)},
      {"DRAW, CRLF", with_crlf(as_draw_saves(v1))},
      {"text after blank lines", "\n\n\r\n" + v1},
      {"text and blank lines", v1 + "\n\n \n"},
      {"DRAW after blank lines", "\n\n" + as_draw_saves(v1)},
      {"binary 1", brep_binary(shape, BinTools_FormatVersion_VERSION_1)},
      {"binary 2", brep_binary(shape, BinTools_FormatVersion_VERSION_2)},
      {"binary 3", brep_binary(shape, BinTools_FormatVersion_VERSION_3)},
      {"binary 4", brep_binary(shape, BinTools_FormatVersion_VERSION_4)}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    CadReport report;
    const Scene scene = read_cad(folder_.write("file.brep", bytes), {}, &report);
    EXPECT_EQ(scene.format, "BREP");
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_TRUE(is_closed(scene.parts[0].mesh));
    EXPECT_NEAR(volume(scene.parts[0].mesh), k_pi * 12 * (25 + 10 + 4) / 3, 0.02 * k_pi * 12 * 13);
    EXPECT_EQ(report.faces, 3u);
  }
}

/// CAD files that other programs wrote: those of data/exchange, and those of the folder named by PAPILLA_SHARED_DATA.
std::vector<std::filesystem::path> real_files() {
  const std::filesystem::path ours = PAPILLA_EXCHANGE_FILES;
  std::vector<std::filesystem::path> files = {ours / "handle.brep", ours / "handle.step", ours / "handle_solid.igs",
                                              ours / "knobs.step"};
  if (const char* shared = std::getenv("PAPILLA_SHARED_DATA"))
    for (const char* name :
         {"MINI-knob.stp", "featuretype.STEP", "voron_Bowden_Module.step", "nist_mbe_pmi_1.stp", "i3-fan-shroud.stp",
          "linkrods.step", "kicad_USB_C_Receptacle_GCT_USB4105-xx-A_16P_TopMnt_Horizontal.step",
          "occt_MODERN_Chair_1.brep", "occt_MODERN_Chair_1_ap242.step"})
      files.push_back(std::filesystem::path(shared) / "step" / name);
  return files;
}

/// All faces, chord and angle kept, every solid closed.
TEST(RealCadFiles, AreClosedCompleteAndExact) {
  constexpr double k_chord = 0.1;
  for (const std::filesystem::path& file : real_files()) {
    SCOPED_TRACE(file);
    CadReport report;
    const Scene scene = read_cad(file, options(k_chord, 20), &report);
    EXPECT_GT(report.solids, 0u);
    EXPECT_TRUE(report.failed_faces.empty());
    EXPECT_TRUE(report.off_faces.empty());
    EXPECT_LE(report.max_deviation_mm, k_chord);
    EXPECT_LE(report.max_angle_deg, 20 * (1 + 1e-9));
    for (const Part& part : scene.parts) EXPECT_TRUE(is_closed(part.mesh)) << part.id;
  }
}

/// A chord as coarse as the part takes few triangles, and an end.
TEST(RealCadFiles, AChordAsCoarseAsThePartTakesFewTriangles) {
  for (const double chord : {20.0, 50.0, 500.0}) {
    CadReport report;
    const Scene scene =
        read_cad(std::filesystem::path(PAPILLA_EXCHANGE_FILES) / "handle.step", options(chord, 20), &report);
    EXPECT_LT(scene.parts.at(0).mesh.triangles.size(), 10000u) << chord;
    EXPECT_LE(report.max_deviation_mm, chord) << chord;
  }
}

/// One solid, as other programs write it in different formats.
TEST(RealCadFiles, HoldTheSameSolidInEveryFormat) {
  const std::filesystem::path ours = PAPILLA_EXCHANGE_FILES;
  const double expected = volume(read_cad(ours / "handle.step", options(0.05)).parts.at(0).mesh);
  EXPECT_GT(expected, 0);
  for (const char* name : {"handle.brep", "handle_solid.igs"}) {
    CadReport report;
    const Scene scene = read_cad(ours / name, options(0.05), &report);
    ASSERT_EQ(scene.parts.size(), 1u) << name;
    EXPECT_EQ(report.faces, 3u) << name;
    EXPECT_NEAR(volume(scene.parts[0].mesh), expected, 1e-3 * expected) << name;
  }
  CadReport surfaces;
  read_cad(ours / "handle.igs", options(0.1), &surfaces);
  EXPECT_EQ(surfaces.solids, 0u);
  EXPECT_EQ(surfaces.faces, 3u);
  EXPECT_TRUE(surfaces.failed_faces.empty());
}

TEST(RealCadFiles, KeepInstancesNamesAndColours) {
  const Scene scene = read_cad(std::filesystem::path(PAPILLA_EXCHANGE_FILES) / "knobs.step");
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[0].name, "knob_cap");
  EXPECT_EQ(scene.parts[1].name, "steering_column");
  EXPECT_EQ(scene.materials.size(), 2u);
  const std::vector<Instance> all = instances(scene);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].part, all[1].part);
  EXPECT_NEAR(all[1].world[3] - all[0].world[3], 124, 1e-9);  // 62 mm to either side
}

}  // namespace
}  // namespace papilla::test
