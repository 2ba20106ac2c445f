// SPDX-License-Identifier: MIT
// What a CAD file says beside geometry: names, places, colours, properties, PMI.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/cad/cad_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::test {
namespace {

using nlohmann::json;

TopoDS_Shape box() { return BRepPrimAPI_MakeBox(10, 20, 30).Shape(); }

gp_Trsf shifted(double x) {
  gp_Trsf trsf;
  trsf.SetTranslation(gp_Vec(x, 0, 0));
  return trsf;
}

class CadMetadata : public ::testing::Test {
 protected:
  Scene write_and_read(CadFile& file, const std::string& schema = "AP214IS") {
    file.write_step(folder_ / "file.step", schema);
    return read_cad(folder_ / "file.step");
  }
  /// Adds entities before the end of the last section, their numbers from 900000.
  Scene read_with(const std::string& entities) {
    std::string text = read_text(folder_ / "file.step");
    text.insert(text.rfind("ENDSEC;"), entities);
    folder_.write("file.step", text);
    return read_cad(folder_ / "file.step");
  }
  TemporaryFolder folder_;
};

const Node& node_of(const Scene& scene, const std::string& id) {
  for (const Node& node : scene.nodes)
    if (!node.extras_json.empty() && json::parse(node.extras_json).value("id", "") == id) return node;
  throw std::runtime_error("no node has the id " + id);
}

TEST_F(CadMetadata, AssemblyKeepsNamesInstancesPlacesAndIds) {
  CadFile file;
  const TDF_Label panel = file.add("panel", box());
  const TDF_Label door = file.add_assembly("door"), car = file.add_assembly("car");
  file.place(door, panel, gp_Trsf(), "upper");
  file.place(door, panel, shifted(50), "lower");
  file.place(car, door, gp_Trsf(), "left door");
  file.place(car, door, shifted(1000), "right door");
  file.write_step(folder_ / "file.step");
  // The library's writer forgets the name of each assembly's first component, and counts on from file to file.
  std::string text = read_text(folder_ / "file.step");
  std::map<int, std::string> nameless;
  const std::regex nameless_use("NEXT_ASSEMBLY_USAGE_OCCURRENCE\\('([0-9]+)',''");
  for (std::sregex_iterator i(text.begin(), text.end(), nameless_use), end; i != end; ++i)
    nameless[std::stoi((*i)[1])] = i->str();
  ASSERT_EQ(nameless.size(), 2u);
  for (const auto& [was, name] :
       {std::pair(nameless.begin()->second, "'upper'"), std::pair(nameless.rbegin()->second, "'left door'")})
    text.replace(text.find(was), was.size(), was.substr(0, was.size() - 2) + name);
  folder_.write("file.step", text);
  const Scene scene = read_cad(folder_ / "file.step");
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.parts[0].name, "panel");
  EXPECT_EQ(scene.parts[0].id, "car/left door/upper");
  const std::vector<Instance> uses = instances(scene);
  ASSERT_EQ(uses.size(), 4u);
  std::vector<double> x;
  for (const Instance& use : uses) x.push_back(use.world[3]);
  EXPECT_EQ(x, (std::vector<double>{0, 50, 1000, 1050}));
  for (const char* id : {"car", "car/left door", "car/left door/lower", "car/right door/upper", "car/right door/lower"})
    EXPECT_NO_THROW(node_of(scene, id)) << id;
}

TEST_F(CadMetadata, SiblingsOfOneNameGetNumbers) {
  CadFile file;
  const TDF_Label bolt = file.add("bolt", box());
  const TDF_Label plate = file.add_assembly("plate");
  for (int i = 0; i < 3; ++i) file.place(plate, bolt, shifted(20 * i), "");
  const Scene scene = write_and_read(file);
  EXPECT_EQ(scene.parts.at(0).id, "plate/bolt");
  EXPECT_NO_THROW(node_of(scene, "plate/bolt#2"));
  EXPECT_NO_THROW(node_of(scene, "plate/bolt#3"));
}

TEST_F(CadMetadata, MirroredPlacementStaysOutward) {
  // A mirrored location turns the outside in unless the reader minds it.
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(), gp::DX()));
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  constexpr bool k_refuse_mirrors = false;
  TopoDS_Compound pair;
  BRep_Builder builder;
  builder.MakeCompound(pair);
  builder.Add(pair, cylinder);
  builder.Add(pair, cylinder.Located(TopLoc_Location(shifted(-40)) * TopLoc_Location(mirror), k_refuse_mirrors));
  write_brep(pair, folder_ / "pair.brep");
  const Scene scene = read_cad(folder_ / "pair.brep");
  ASSERT_EQ(instances(scene).size(), 2u);
  for (const Instance& use : instances(scene)) {
    const Transform& t = use.world;
    const double determinant =
        t[0] * (t[5] * t[10] - t[6] * t[9]) - t[1] * (t[4] * t[10] - t[6] * t[8]) + t[2] * (t[4] * t[9] - t[5] * t[8]);
    const TriangleMesh& mesh = scene.parts[use.part].mesh;
    EXPECT_TRUE(is_closed(mesh));
    // glTF turns the winding where the determinant is negative; the part itself is outward.
    EXPECT_GT(volume(mesh), 1000) << determinant;
    EXPECT_NEAR(std::abs(determinant), 1, 1e-12);
  }
}

TEST_F(CadMetadata, ColoursAreLinearAndNamedInSrgb) {
  CadFile file;
  file.colour(file.add("box", box()), 0xBC8F40);
  const Scene scene = write_and_read(file);
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.name, "#BC8F40");
  const auto linear = [](double srgb) { return std::pow((srgb / 255 + 0.055) / 1.055, 2.4); };
  EXPECT_NEAR(material.base_color[0], linear(0xBC), 1e-4);
  EXPECT_NEAR(material.base_color[1], linear(0x8F), 1e-4);
  EXPECT_NEAR(material.base_color[2], linear(0x40), 1e-4);
  EXPECT_EQ(json::parse(material.extras_json).at("cad_colour"), "#BC8F40");
}

TEST_F(CadMetadata, InstanceColourMakesAPartOfItsOwn) {
  CadFile file;
  const TDF_Label panel = file.add("panel", box());
  file.colour(panel, 0x202020);
  const TDF_Label car = file.add_assembly("car");
  file.place(car, panel, gp_Trsf(), "dark");
  file.colour(file.place(car, panel, shifted(50), "red"), 0xFF0000);
  const Scene scene = write_and_read(file);
  ASSERT_EQ(scene.parts.size(), 2u);
  const auto colour = [&](std::size_t part) { return scene.materials.at(scene.parts[part].materials.at(0)).name; };
  EXPECT_EQ(colour(0), "#202020");
  EXPECT_EQ(colour(1), "#FF0000");
}

TEST_F(CadMetadata, PartsWithoutAColourTakeThatOfTheirAssembly) {
  CadFile file;
  const TDF_Label panel = file.add("panel", box());
  const TDF_Label door = file.add_assembly("door"), car = file.add_assembly("car");
  file.place(door, panel, gp_Trsf(), "panel");
  file.colour(file.place(car, door, shifted(50), "red"), 0xFF0000);
  const Scene scene = write_and_read(file);
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.materials.at(scene.parts[0].materials.at(0)).name, "#FF0000");
}

TEST_F(CadMetadata, SolidsOfOneProductAreParts) {
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, box());
  builder.Add(two, BRepPrimAPI_MakeBox(gp_Pnt(10, 0, 0), 10, 20, 30).Shape());
  CadFile file;
  file.add("pair", two);
  const Scene scene = write_and_read(file);
  ASSERT_EQ(scene.parts.size(), 2u);
  for (const Part& part : scene.parts) {
    EXPECT_TRUE(part.name.starts_with("pair/")) << part.name;
    EXPECT_TRUE(is_closed(part.mesh));
    EXPECT_NEAR(volume(part.mesh), 6000, 1e-9);
  }
  EXPECT_EQ(scene.nodes.at(scene.roots.at(0)).name, "pair");
  EXPECT_EQ(scene.nodes.at(scene.roots.at(0)).children.size(), 2u);
}

TEST_F(CadMetadata, AFaceHasItsOwnColourWithinAColouredBody) {
  const TopoDS_Shape coloured = box();
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, coloured);
  builder.Add(two, BRepPrimAPI_MakeBox(gp_Pnt(10, 0, 0), 10, 20, 30).Shape());
  CadFile file;
  const TDF_Label pair = file.add("pair", two);
  file.colour_face(pair, coloured, 0xFF0000);
  file.colour_face(pair, face_of(coloured, 2), 0x0000FF);
  const Scene scene = write_and_read(file);
  ASSERT_EQ(scene.parts.size(), 2u);
  const Part& part = scene.parts[0];
  const auto blue = std::find_if(part.materials.begin(), part.materials.end(),
                                 [&](std::uint32_t m) { return scene.materials.at(m).name == "#0000FF"; });
  ASSERT_NE(blue, part.materials.end());
  EXPECT_EQ(part.materials.size(), 2u);
  std::set<std::uint32_t> blue_faces;
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
    if (part.mesh.material[t] == static_cast<std::uint32_t>(blue - part.materials.begin()))
      blue_faces.insert(part.mesh.face[t]);
  EXPECT_EQ(blue_faces, (std::set<std::uint32_t>{2}));
}

TEST_F(CadMetadata, MappedBodiesOfOneShapeKeepTheirColours) {
  CadFile file;
  file.add("box", box());
  file.write_step(folder_ / "file.step");
  std::string text = read_text(folder_ / "file.step");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      text, found, std::regex("ADVANCED_BREP_SHAPE_REPRESENTATION\\('',\\((#[0-9]+),(#[0-9]+)\\),(#[0-9]+)\\)")));
  const std::string whole = found[0], axes = found[1], solid = found[2], context = found[3];
  text.replace(text.find(whole), whole.size(),
               "SHAPE_REPRESENTATION('',(" + axes + ",#900010,#900020)," + context + ")");
  folder_.write("file.step", text);
  // A use of the solid with its place and its colour.
  const auto use = [&](int first, const std::string& place, const std::string& colour) {
    const auto number = [&](int i) { return "#" + std::to_string(first + i); };
    return number(0) + " = MAPPED_ITEM('',#900000," + place + ");\n" +          //
           number(1) + " = COLOUR_RGB(''," + colour + ");\n" +                  //
           number(2) + " = FILL_AREA_STYLE_COLOUR(''," + number(1) + ");\n" +   //
           number(3) + " = FILL_AREA_STYLE('',(" + number(2) + "));\n" +        //
           number(4) + " = SURFACE_STYLE_FILL_AREA(" + number(3) + ");\n" +     //
           number(5) + " = SURFACE_SIDE_STYLE('',(" + number(4) + "));\n" +     //
           number(6) + " = SURFACE_STYLE_USAGE(.BOTH.," + number(5) + ");\n" +  //
           number(7) + " = PRESENTATION_STYLE_ASSIGNMENT((" + number(6) + "));\n" + number(8) +
           " = STYLED_ITEM('color',(" + number(7) + ")," + number(0) + ");\n";
  };
  const Scene scene = read_with(
      "#900000 = REPRESENTATION_MAP(" + axes + ",#900001);\n#900001 = ADVANCED_BREP_SHAPE_REPRESENTATION('',(" + axes +
      "," + solid + ")," + context + ");\n#900002 = CARTESIAN_POINT('',(-40.,7.,100.));\n" +
      "#900003 = AXIS2_PLACEMENT_3D('',#900002,$,$);\n" + use(900010, axes, "1.,0.,0.") +
      use(900020, "#900003", "0.,0.,1.") + "#900030 = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(" +
      "#900018,#900028)," + context + ");\n");
  std::map<std::string, Vec3> places;
  for (const Instance& one : instances(scene))
    for (const std::uint32_t material : scene.parts[one.part].materials)
      places[scene.materials.at(material).name] = transform_point(one.world, {});
  EXPECT_EQ(places, (std::map<std::string, Vec3>{{"#FF0000", {}}, {"#0000FF", {-40, 7, 100}}}));
}

TEST_F(CadMetadata, MaterialAndDensity) {
  CadFile file;
  file.material(file.add("box", box()), "PA66-GF30", 1.36);
  const Scene scene = write_and_read(file);
  const json material = json::parse(scene.parts.at(0).extras_json).at("cad_material");
  EXPECT_EQ(material.at("name"), "PA66-GF30");
  EXPECT_NEAR(material.at("density").get<double>(), 1.36, 1e-9);
}

TEST_F(CadMetadata, ValidationProperties) {
  CadFile file;
  file.validation(file.add("box", box()), 2200, 6000, {5, 10, 15});
  const json validation = json::parse(write_and_read(file).parts.at(0).extras_json).at("validation");
  EXPECT_NEAR(validation.at("area_mm2").get<double>(), 2200, 1e-6);
  EXPECT_NEAR(validation.at("volume_mm3").get<double>(), 6000, 1e-6);
  for (const std::size_t i : {0u, 1u, 2u})
    EXPECT_NEAR(validation.at("centroid_mm").at(i).get<double>(), 5.0 * static_cast<double>(i + 1), 1e-9);
}

TEST_F(CadMetadata, UserDefinedProperties) {
  CadFile file;
  file.add("box", box());
  file.write_step(folder_ / "file.step");
  const std::string text = read_text(folder_ / "file.step");
  const std::size_t at = text.find("= PRODUCT_DEFINITION('");
  ASSERT_NE(at, std::string::npos);
  const std::string product = text.substr(text.rfind('#', at), at - text.rfind('#', at) - 1);
  const std::size_t context_at = text.find("GEOMETRIC_REPRESENTATION_CONTEXT");
  const std::size_t context_from = text.rfind('#', context_at);
  const std::string context = text.substr(context_from, text.find(' ', context_from) - context_from);
  const Scene scene =
      read_with("#900001 = PROPERTY_DEFINITION('user defined attribute',''," + product +
                ");\n"
                "#900002 = DESCRIPTIVE_REPRESENTATION_ITEM('Supplier','Weber & S\\X2\\00F6\\X0\\hne');\n"
                "#900003 = REPRESENTATION('',(#900002)," +
                context +
                ");\n"
                "#900004 = PROPERTY_DEFINITION_REPRESENTATION(#900001,#900003);\n");
  EXPECT_EQ(json::parse(scene.parts.at(0).extras_json).at("properties").at("Supplier"), "Weber & Söhne");
  const Node& node = scene.nodes.at(scene.roots.at(0));
  EXPECT_EQ(json::parse(node.extras_json).at("properties").at("Supplier"), "Weber & Söhne");
}

TEST_F(CadMetadata, PmiBecomesText) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  CadFile file;
  const TDF_Label part = file.add("pin", shape);
  file.diameter(part, face_of(shape, 0), 10, 0.05, 0.02);
  file.flatness(part, face_of(shape, 1), 0.01);
  const Scene scene = write_and_read(file, "AP242DIS");
  const json pmi = json::parse(scene.parts.at(0).extras_json).at("pmi");
  ASSERT_EQ(pmi.size(), 2u);
  EXPECT_EQ(pmi[0].at("kind"), "dimension");
  EXPECT_EQ(pmi[0].at("type"), "diameter");
  EXPECT_NEAR(pmi[0].at("value").get<double>(), 10, 1e-9);
  EXPECT_NEAR(pmi[0].at("upper_tolerance").get<double>(), 0.05, 1e-9);
  EXPECT_NEAR(std::abs(pmi[0].at("lower_tolerance").get<double>()), 0.02, 1e-9);
  EXPECT_EQ(pmi[0].at("faces"), json({0}));
  EXPECT_EQ(pmi[1].at("type"), "flatness");
  EXPECT_NEAR(pmi[1].at("value").get<double>(), 0.01, 1e-9);
  EXPECT_EQ(pmi[1].at("faces"), json({1}));
  EXPECT_TRUE(std::any_of(scene.losses.begin(), scene.losses.end(),
                          [](const std::string& loss) { return loss.starts_with("PMI"); }));
}

TEST_F(CadMetadata, RangesKeepBothTheirEnds) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  CadFile file;
  file.range(file.add("pin", shape), face_of(shape, 0), 9.5, 10.25);
  const Scene scene = write_and_read(file, "AP242DIS");
  const json pmi = json::parse(scene.parts.at(0).extras_json).at("pmi");
  ASSERT_EQ(pmi.size(), 1u);
  EXPECT_NEAR(pmi[0].at("lower_bound").get<double>(), 9.5, 1e-9);
  EXPECT_NEAR(pmi[0].at("upper_bound").get<double>(), 10.25, 1e-9);
}

TEST_F(CadMetadata, ADistanceIsOfBothItsFaces) {
  const TopoDS_Shape shape = box();
  CadFile file;
  file.distance(file.add("box", shape), face_of(shape, 0), face_of(shape, 1), 10);
  const Scene scene = write_and_read(file, "AP242DIS");
  const json pmi = json::parse(scene.parts.at(0).extras_json).at("pmi");
  ASSERT_EQ(pmi.size(), 1u);
  EXPECT_NEAR(pmi[0].at("value").get<double>(), 10, 1e-9);
  EXPECT_EQ(pmi[0].at("faces"), json({0, 1}));
}

TEST_F(CadMetadata, DrawnAnnotationsKeepTheirNames) {
  CadFile file;
  file.add("box", box());
  file.write_step(folder_ / "file.step");
  const Scene scene = read_with(
      "#900001 = CARTESIAN_POINT('',(0.,0.,0.));\n"
      "#900002 = GEOMETRIC_CURVE_SET('',(#900001));\n"
      "#900003 = ANNOTATION_CURVE_OCCURRENCE('Surface finish Ra 1.6',(),#900002);\n");
  EXPECT_EQ(json::parse(scene.extras_json).at("annotations"), json({"Surface finish Ra 1.6"}));
}

TEST_F(CadMetadata, SourceOfTheFile) {
  CadFile file;
  file.add("box", box());
  file.write_step(folder_ / "file.step", "AP242DIS", "INCH");
  const json source = json::parse(read_cad(folder_ / "file.step").extras_json).at("source");
  EXPECT_EQ(source.at("format"), "STEP");
  EXPECT_EQ(source.at("unit"), "inch");
  EXPECT_EQ(source.at("millimetres_per_unit"), 25.4);
  EXPECT_NE(source.at("schema").get<std::string>().find("AP242"), std::string::npos);
}

TEST_F(CadMetadata, CurvesBesideFacesAreNamedAsLost) {
  TopoDS_Compound mixed;
  BRep_Builder builder;
  builder.MakeCompound(mixed);
  builder.Add(mixed, face_of(box(), 0));
  TopExp_Explorer edges(BRepPrimAPI_MakeBox(gp_Pnt(100, 0, 0), 1, 1, 1).Shape(), TopAbs_EDGE);
  builder.Add(mixed, edges.Current());
  write_brep(mixed, folder_ / "mixed.brep");
  const Scene scene = read_cad(folder_ / "mixed.brep");
  EXPECT_TRUE(std::any_of(scene.losses.begin(), scene.losses.end(),
                          [](const std::string& loss) { return loss.find("curves") != std::string::npos; }));
}

}  // namespace
}  // namespace papilla::test
