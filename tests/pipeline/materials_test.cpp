// SPDX-License-Identifier: MIT
#include "papilla/pipeline/materials.hpp"
#include "one_material_scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/pipeline/assignment.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla_test/json_schema.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class MaterialsTest : public testing::Test {
 protected:
  MaterialsTest() { fs::create_directories(folder_); }
  ~MaterialsTest() override { fs::remove_all(folder_); }

  Materials read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_materials(path_);
  }
  /// The message that reading `text` ends with.
  std::string complaint(const std::string& text) {
    try {
      read(text);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-materials-" + std::to_string(::getpid()));
  const fs::path path_ = folder_ / "materials.json";
};

TEST_F(MaterialsTest, ReadsTheDocumentedExample) {
  const Materials file = read(R"({"materials": {
      "grain": {"texture": "grain.png", "size_mm": [40, 30], "stiffness": 900, "damping": 0.4, "staticFriction": 0.45,
                "dynamicFriction": 0.35, "height": {"method": "auto", "depth_mm": 0.3, "scale": 2, "max_slope": 0.8},
                "unwrap": "auto"},
      "chrome": {"stiffness": 2000}},
    "assign": [{"part": "dash*", "material": "grain"}, {"cad_colour": "#20FFa0", "material": "grain"},
               {"gltf_material": "Leather", "material": null}]})");
  const MaterialRule& grain = file.materials.at("grain");
  EXPECT_EQ(grain.texture, folder_ / "grain.png");
  EXPECT_EQ(grain.size_mm[0], 40);
  EXPECT_EQ(grain.size_mm[1], 30);
  EXPECT_EQ(grain.stiffness, 900);
  EXPECT_EQ(grain.height.depth_mm, 0.3);
  EXPECT_EQ(grain.height.scale, 2);
  EXPECT_EQ(grain.height.max_slope, 0.8);
  EXPECT_TRUE(file.materials.at("chrome").texture.empty());
  ASSERT_EQ(file.assign.size(), 3U);
  EXPECT_EQ(file.assign[1].cad_colour, "#20ffa0");
  EXPECT_TRUE(file.assign[2].material.empty());
}

TEST_F(MaterialsTest, HeightTakesTheOptionsOfTheVerb) {
  const Materials file = read(R"({"materials": {
      "a": {"texture": "a.png", "height": {"method": "pentland", "depth": 0.25, "pitch": 0.08, "light": [1, -2, 3],
            "periodic": false, "roughness": "residual", "cut": "auto", "rate": 500, "speed": 40, "tile": true,
            "alternative": true, "source": "synthesis", "seed": 7}},
      "b": {"texture": "b.png", "height": {"light": "auto", "periodic": "auto", "roughness": "auto", "cut": 0.4,
            "tile": "auto", "source": "auto"}}}})");
  const HeightRule& a = file.materials.at("a").height;
  EXPECT_EQ(a.relief.height.method, HeightMethod::pentland);
  EXPECT_EQ(a.depth_mm, 0.25);
  EXPECT_EQ(a.pitch_mm, 0.08);
  ASSERT_TRUE(a.relief.height.light);
  EXPECT_EQ(a.relief.height.light->y, -2);
  EXPECT_EQ(a.relief.height.periodic, false);
  EXPECT_EQ(a.relief.roughness, HeightRoughness::residual);
  EXPECT_DOUBLE_EQ(a.relief.height.shortest_wavelength_mm, 2 * 40.0 / 500);
  EXPECT_EQ(a.relief.tile, true);
  EXPECT_TRUE(a.opposite);
  EXPECT_EQ(a.relief.source, ReliefSource::synthesis);
  EXPECT_EQ(a.relief.height.seed, 7U);
  const HeightRule& b = file.materials.at("b").height;
  EXPECT_FALSE(b.relief.height.light || b.relief.height.periodic || b.relief.roughness || b.relief.tile);
  EXPECT_EQ(b.relief.height.shortest_wavelength_mm, 0.4);
  EXPECT_NE(complaint(R"({"materials": {"a": {"height": {"light": [0, 0, -1]}}}})")
                .find("/materials/a/height/light: must have z > 0"),
            std::string::npos);
  EXPECT_NE(
      complaint(R"({"materials": {"a": {"height": {"depth": 1, "depth_mm": 1}}}})").find("/materials/a/height/depth"),
      std::string::npos);
}

TEST_F(MaterialsTest, HeightTakesSeveralPhotographs) {
  std::ofstream(folder_ / "LIGHTS.json") << R"({"lights": [[1, 0, 1], [0, 1, 1], [-1, 0, 1]]})";
  std::ofstream(folder_ / "REF.json") << R"({"ruler_mm": 5, "from_px": [1, 2], "to_px": [3, 4]})";
  const Materials file = read(R"({"materials": {
      "files": {"height": {"images": ["a.jpg", "b.jpg", "c.jpg"], "lights": "LIGHTS.json", "reference": "REF.json"}},
      "here": {"texture": "t.png", "height": {"images": ["a.jpg", "b.jpg", "c.jpg"],
               "lights": [[1, 0, 1], [0, 1, 1], [-1, 0, 2]], "reference": [{"grid_mm": 2}], "alternative": true}},
      "ball": {"height": {"images": ["a.jpg", "b.jpg", "c.jpg"],
               "lights": {"sphere": {"centre_px": [30, 20], "radius_px": 9, "kind": "matte"}}}},
      "open": {"height": {"images": ["a.jpg", "b.jpg", "c.jpg"], "lights": "unknown"}}}})");
  const MaterialRule& files = file.materials.at("files");
  EXPECT_EQ(files.texture, folder_ / "a.jpg");
  ASSERT_EQ(files.height.images.size(), 3U);
  EXPECT_EQ(files.height.images[2], folder_ / "c.jpg");
  EXPECT_EQ(files.height.lights.directions.size(), 3U);
  EXPECT_EQ(files.height.references.size(), 1U);
  const MaterialRule& here = file.materials.at("here");
  EXPECT_EQ(here.texture, folder_ / "t.png");
  EXPECT_EQ(here.height.lights.directions.at(2).z, 2);
  EXPECT_EQ(here.height.references.at(0).kind, HeightReference::Kind::grid);
  EXPECT_TRUE(here.height.opposite);
  EXPECT_TRUE(file.materials.at("ball").height.lights.sphere);
  EXPECT_TRUE(file.materials.at("open").height.lights.directions.empty());

  const auto refused = [&](const std::string& height, const std::string& reason) {
    const std::string said = complaint(R"({"materials": {"a": {"height": )" + height + "}}}");
    EXPECT_NE(said.find("/materials/a/height" + reason), std::string::npos) << said;
  };
  refused(R"({"images": ["a.jpg", "b.jpg"]})", "/images: must be three photographs or more");
  refused(R"({"images": ["a.jpg", "b.jpg", ""]})", "/images/2: must not be empty");
  refused(R"({"images": ["a.jpg", "b.jpg", "c.jpg"], "method": "pentland"})", "/method: is for one picture");
  refused(R"({"lights": "LIGHTS.json"})", "/lights: needs 'images'");
  refused(R"({"images": ["a.jpg", "b.jpg", "c.jpg", "d.jpg"], "lights": "LIGHTS.json"})", "/lights: ");
  refused(R"({"images": ["a.jpg", "b.jpg", "c.jpg"], "lights": [[1, 0, 1]]})", "/lights: 1 lights for 3 photographs");
  refused(R"({"images": ["a.jpg", "b.jpg", "c.jpg"], "lights": "NONE.json"})", "/lights: ");
  refused(R"({"images": ["a.jpg", "b.jpg", "c.jpg"], "reference": {"ruler": 5}})", "/reference");
}

TEST_F(MaterialsTest, ReadsMapsAndBacking) {
  const Materials file = read(R"({"materials": {"rust": {
      "texture": "fbm", "size_mm": [40, 40],
      "backing": {"stiffness": 1800, "depth_mm": 2.5},
      "fineRoughness": {"hurst": 0.6, "rms": 6e-6, "wavelength_range": [1e-5, 4e-4]},
      "maps": {"stiffness": "hard.png", "friction": {"picture": "noise", "range": [1, 2]}, "range": [0.25, 4]}}}})");
  const MaterialRule& rule = file.materials.at("rust");
  ASSERT_TRUE(rule.backing);
  EXPECT_EQ(rule.backing->stiffness, 1800);
  EXPECT_DOUBLE_EQ(rule.backing->depth_m, 2.5e-3);
  ASSERT_TRUE(rule.fine_roughness);
  EXPECT_EQ(rule.fine_roughness->hurst, 0.6);
  EXPECT_DOUBLE_EQ(rule.fine_roughness->rms_mm, 6e-3);
  EXPECT_DOUBLE_EQ(rule.fine_roughness->longest_mm, 0.4);
  ASSERT_EQ(rule.maps.size(), 2U);
  const MapRule &stiffness = rule.maps.at(Quantity::stiffness), &friction = rule.maps.at(Quantity::dynamic_friction);
  EXPECT_EQ(stiffness.recipe, "hard.png");
  EXPECT_EQ(stiffness.picture.filename(), "hard.png");
  EXPECT_EQ(stiffness.range[0], 0.25);
  EXPECT_EQ(stiffness.range[1], 4);
  EXPECT_EQ(friction.recipe, "noise");
  EXPECT_EQ(friction.range[0], 1);
  EXPECT_EQ(friction.range[1], 2);
}

TEST_F(MaterialsTest, RefusesMapsAndBackingsWithTheirPlace) {
  const auto refused = [&](const std::string& rest, const std::string& reason) {
    const std::string said = complaint(R"({"materials": {"m": {"texture": "fbm", )" + rest + "}}}");
    EXPECT_NE(said.find("/materials/m/" + reason), std::string::npos) << said;
  };
  refused(R"("backing": {"stiffness": 1800})", "backing: ");
  refused(R"("backing": {"stiffness": 1800, "depth": 2})", "backing: unknown key 'depth'; did you mean 'depth_mm'?");
  refused(R"("backing": {"stiffness": -1, "depth_mm": 2})", "backing/stiffness: ");
  refused(R"("backing": 5)", "backing: ");
  refused(R"("maps": {"stifness": "a.png"})", "maps: unknown key 'stifness'; did you mean 'stiffness'?");
  refused(R"("maps": {})", "maps: needs one of");
  refused(R"("maps": {"range": [0, 1]})", "maps: needs one of");
  refused(R"("maps": {"friction": ""})", "maps/friction: must not be empty");
  refused(R"("maps": {"friction": 0.5})", "maps/friction: ");
  refused(R"("maps": {"friction": {"range": [0, 1]}})", "maps/friction: ");
  refused(R"("maps": {"friction": {"picture": "a.png", "rang": [0, 1]}})", "maps/friction: unknown key 'rang'");
  refused(R"("maps": {"friction": "grain:lether"})", "maps/friction: there is no grain 'lether'");
  refused(R"("maps": {"friction": "a.png", "range": [-1, 1]})", "maps/range/0: ");
  refused(R"("maps": {"friction": "a.png", "range": [1]})", "maps/range: must be [black, white]");
  refused(R"("fineRoughness": {"hurst": 0.5, "rms": 1e-6, "wavelength_range": [2e-4, 1e-4]})",
          "fineRoughness/wavelength_range: must go from short to long");
  EXPECT_NE(complaint(R"({"materials": {"m": {"maps": {"friction": "a.png"}}}})")
                .find("/materials/m/maps: needs a 'texture'"),
            std::string::npos);
}

TEST_F(MaterialsTest, ReadsHowASurfaceHoldsAndShades) {
  const Materials file = read(R"({"materials": {
      "cloth": {"frictionModel": {"name": "bristle", "stiffness": 400}, "forceShading": true}, "plain": {}}})");
  const MaterialRule& cloth = file.materials.at("cloth");
  ASSERT_TRUE(cloth.friction_model);
  EXPECT_EQ(cloth.friction_model->name, "bristle");
  EXPECT_EQ(cloth.friction_model->stiffness, 400);
  EXPECT_EQ(cloth.force_shading, true);
  EXPECT_FALSE(file.materials.at("plain").friction_model);
  EXPECT_FALSE(file.materials.at("plain").force_shading);

  MaterialTag tag;
  apply_constants(cloth, tag);
  std::vector<HapticWarning> warnings;
  const MaterialTag read_back = parse_material_tag(to_json(tag), warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(read_back.friction_model, cloth.friction_model);
  EXPECT_TRUE(read_back.force_shading);

  const auto of = [&](const std::string& rule) { return complaint(R"({"materials": {"m": )" + rule + "}}"); };
  EXPECT_NE(of(R"({"frictionModel": {"name": "glue"}})").find("/materials/m/frictionModel/name"), std::string::npos);
  EXPECT_NE(of(R"({"frictionModel": {"stiffness": -1}})").find("/materials/m/frictionModel/stiffness"),
            std::string::npos);
  EXPECT_NE(of(R"({"frictionModel": "bristle"})").find("/materials/m/frictionModel"), std::string::npos);
  EXPECT_NE(of(R"({"forceShading": 1})").find("must be true or false"), std::string::npos);
}

TEST_F(MaterialsTest, TheFirstMatchingRuleWinsAndAllItsFieldsMustMatch) {
  const Materials file = read(R"({"materials": {"a": {}, "b": {}, "c": {}}, "assign": [
      {"part": "dash*", "cad_colour": "#000000", "material": "a"}, {"part": "dash_?", "material": "b"},
      {"gltf_material": "Lea*", "material": "c"}]})");
  const auto material_of = [&](const char* part, double grey, const char* material) -> std::string {
    Scene scene = test::one_material_scene(part, material, {grey, grey, grey, 1});
    const MaterialRule* rule = assign_materials(scene, file).parts.at(0).rule_of(0);
    return rule != nullptr ? rule->name : "none";
  };
  EXPECT_EQ(material_of("dash_1", 0, ""), "a");
  EXPECT_EQ(material_of("dash_1", 1, ""), "b");
  EXPECT_EQ(material_of("dash_12", 1, "Leather"), "c");
  EXPECT_EQ(material_of("seat", 0, "Wood"), "none");
}

TEST_F(MaterialsTest, ReadsAllThatARuleCanSelectBy) {
  const Materials file = read(R"({"materials": {"a": {}}, "assign": [
      {"mesh": "m", "node": "a/**/b", "instance": "i", "assembly": "s", "layer": "l", "cad_material": "steel",
       "not": {"part": "p"}, "material": "a"},
      {"not": [{"part": "p"}, {"layer": "hidden"}], "material": null}]})");
  EXPECT_EQ(text_of(file.assign.at(0)),
            "mesh 'm', node 'a/**/b', instance 'i', assembly 's', layer 'l', cad_material 'steel', not part 'p'");
  EXPECT_EQ(text_of(file.assign.at(1)), "not part 'p', not layer 'hidden'");
  const auto of = [&](const std::string& rule) {
    return complaint(R"({"materials": {"leather": {}}, "assign": [)" + rule + "]}");
  };
  EXPECT_NE(of(R"({"not": {}, "material": null})").find("at /assign/0/not: selects nothing"), std::string::npos);
  EXPECT_NE(of(R"({"not": {"not": {"part": "a"}}, "material": null})").find("/assign/0/not: unknown key 'not'"),
            std::string::npos);
  EXPECT_NE(of(R"({"nodes": "a", "material": null})").find("unknown key 'nodes'; did you mean 'node'?"),
            std::string::npos);
  EXPECT_NE(of(R"({"part": "a", "material": "lether"})").find("no material 'lether'; did you mean 'leather'?"),
            std::string::npos);
}

TEST_F(MaterialsTest, RangesAreWrittenAsPeopleDo) {
  EXPECT_NE(complaint(R"({"materials": {"a": {"stiffness": 1e9}}})").find("1000000000 must be from 0.001 to 1000000"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"stribeckVelocity": 0}}})").find("0 must be from 0.000001 to 10"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"unwrap": "lscn"}}})").find("; did you mean 'lscm'?"), std::string::npos);
  const auto expect = [&](const std::string& unwrap, const std::string& words) {
    const std::string text = complaint(R"({"materials": {"a": {"unwrap": )" + unwrap + "}}}");
    EXPECT_NE(text.find(words), std::string::npos) << unwrap << ": " << text;
  };
  expect(R"({"method": "best", "phi": 0.5})", "at /materials/a/unwrap/phi: is of maillot, not of best");
  expect(R"({"phi": 0.5})", "is of maillot, not of auto");
  expect(R"({"method": "maillot", "distortion_limit": 0.5})", "/distortion_limit: must be 0 or at least 1");
  expect(R"({"method": "maillot", "solver": "direct"})", "maillot has no solver 'direct'");
  expect(R"({"method": "planar", "charts": "keep"})", "/charts: planar makes its own charts");
  expect(R"({"method": "levy", "coupling": "conformal", "border": "convex"})",
         "/coupling: can't be conformal: the border is not free");
  expect(R"("environment")", "moves with the eye");
  expect(R"({"method": "environment"})", "/unwrap/method: 'environment' moves with the eye");
  expect(R"({"method": "keep"})", "must be one of");
  expect(R"({"max_distortion": 3.9})", "/max_distortion");
  expect(R"({"max_distortion": "p95"})", "/max_distortion: must be a number from 4 on, or \"pNN=D\"");
  expect(R"({"max_distortion": 4.1, "seam_cost": 0.1})", "/max_distortion: finds the seam cost");
  expect(R"({"max_distortion": 4.1, "charts": "keep"})", "/max_distortion: finds charts");
  expect(R"({"method": "levy", "max_distortion": 4.1})", "/max_distortion: is of auto, best, not of levy");
  expect(R"({"grain": "sideways"})", "must be one of up, longest");
  expect(R"({"grain": [0, 0, 0]})", "/grain: has no length");
  expect(R"({"grain": 3})", "/grain: must be");
  expect(R"({"grain_of": {"rim": {"edge": [1, 2]}}})", "/grain_of/rim/edge: must be [x, y, z]");
  expect(R"({"method": "levy", "pins": [{"at": [0, 0, 0]}]})", "/pins/0: 'uv' is missing");
  expect(R"({"method": "levy", "iso_lines": [{"of": "u", "through": [[0, 0, 0]]}]})", "two places or more");
  expect("3", "must be a word or an object");
}

TEST_F(MaterialsTest, NamesTheJsonPointerOfWhatIsWrong) {
  EXPECT_NE(complaint(R"({"materials": {"a/b": {"stiffness": -3}}})").find("/materials/a~1b/stiffness"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"size_mm": [40]}}})").find("/materials/a/size_mm"), std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"textur": "x"}}})").find("unknown key 'textur'"), std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {}, "assign": [{"part": "x", "material": "a"}]})").find("/assign/0/material"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {}, "assign": [{"material": null}]})").find("/assign/0"), std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"height": {"method": "magic"}}}})").find("/materials/a/height/method"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"materials": {"a": {"staticFriction": 0.2, "dynamicFriction": 0.3}}})").find("/materials/a"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"version": 2, "materials": {}})").find("/version"), std::string::npos);
  EXPECT_NE(complaint("[1, 2").find("is no valid JSON"), std::string::npos);
  EXPECT_NE(complaint("[]").find("must be an object"), std::string::npos);
}

TEST_F(MaterialsTest, TheSchemaKnowsMaterialsOfTheLibrary) {
  const test::JsonSchema schema(
      nlohmann::ordered_json::parse(read_file(fs::path(PAPILLA_SCHEMAS) / "materials.schema.json")));
  const auto agree = [&](const std::string& material) {
    const std::string text = R"({"materials": {"m": )" + material + "}}";
    EXPECT_EQ(schema.accepts(nlohmann::ordered_json::parse(text)), complaint(text).empty()) << text;
    return complaint(text).empty();
  };
  EXPECT_TRUE(agree(R"({"material": "library:leather/nappa-fine"})"));
  EXPECT_TRUE(agree(R"({"material": "library:wood/cork", "stiffness": 900, "height": {"scale": 2}})"));
  for (const char* wrong : {"\"wood/cork\"", "\"library:\"", "\"library:Wood\"", "\"library:a/\"", "null", "3"})
    EXPECT_FALSE(agree("{\"material\": " + std::string(wrong) + "}"));
  EXPECT_TRUE(
      schema.accepts(nlohmann::ordered_json::parse(read_file(fs::path(PAPILLA_DATA) / "cockpit.materials.json"))));
}

TEST_F(MaterialsTest, DeepNestingIsRefusedBeforeItIsRead) {
  std::string deep = "{\"materials\": ";
  constexpr int levels = 200'000;
  for (int i = 0; i < levels; ++i) deep += "{\"a\":";
  deep += '1';
  for (int i = 0; i < levels; ++i) deep += ",\"b\":0}";
  EXPECT_EQ(complaint(deep + "}"), path_.string() + ": is nested deeper than 64 levels");
}

TEST_F(MaterialsTest, AMissingFileOrAFolderIsAnIoError) {
  EXPECT_THROW(read_materials(folder_ / "none.json"), IoError);
  EXPECT_THROW(read_materials(folder_), IoError);
}

}  // namespace
}  // namespace papilla
