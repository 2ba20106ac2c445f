// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_library.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

const fs::path k_materials = fs::path(PAPILLA_DATA) / "materials";

const std::vector<LibraryMaterial>& all() {
  static const std::vector<LibraryMaterial> materials = MaterialLibrary(k_materials).materials();
  return materials;
}

std::vector<std::string> found(const std::string& words) {
  std::vector<std::string> ids;
  for (const MaterialHit& hit : search_materials(all(), words)) ids.push_back(all()[hit.material].id);
  return ids;
}

bool has(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

TEST(MaterialLibrary, HasTheMaterialsOfInteriors) {
  EXPECT_GE(all().size(), 60U);
  const std::map<std::string, std::size_t> least{
      {"leather", 3},       {"soft-touch skin", 3}, {"hard plastic", 3},    {"textile", 3},
      {"carpet", 3},        {"suede-like", 2},      {"open-pored wood", 3}, {"varnished wood", 3},
      {"brushed metal", 3}, {"knurled metal", 2},   {"polished metal", 3},  {"glass", 3},
      {"rubber", 3},        {"foam under skin", 3}, {"paper", 2},           {"stone", 3}};
  for (const auto& [category, count] : least) {
    const auto in = std::count_if(all().begin(), all().end(), [&](const LibraryMaterial& m) {
      return std::find(m.categories.en.begin(), m.categories.en.end(), category) != m.categories.en.end();
    });
    EXPECT_GE(static_cast<std::size_t>(in), count) << category;
  }
  EXPECT_TRUE(has(found("piano black"), "gloss/piano-black"));
}

TEST(MaterialLibrary, EveryFileIsRightAndSharesItsNameWithNone) {
  const LibraryCheck check = check_materials(k_materials);
  for (const LibraryProblem& problem : check.problems) ADD_FAILURE() << problem.file << ": " << problem.reason;
  EXPECT_EQ(check.materials, all().size());
  EXPECT_GT(check.cited, 100U);
  EXPECT_GT(check.estimated, check.cited);
  for (const LibraryMaterial& m : all()) {
    EXPECT_FALSE(m.categories.de.empty()) << m.id;
    EXPECT_TRUE(m.roughness) << m.id;
    if (m.backing) EXPECT_GT(m.backing->stiffness.value, m.stiffness.value) << m.id;
  }
}

TEST(MaterialLibrary, StiffnessFollowsFromYoungsModulus) {
  for (const LibraryMaterial& m : all()) {
    ASSERT_TRUE(m.youngs_modulus) << m.id;
    const double k = rendered_stiffness(m.youngs_modulus->value);
    EXPECT_NEAR(m.stiffness.value, k, .05 * k) << m.id;
  }
}

TEST(MaterialLibrary, EveryReliefIsARecipeAGrainOrAPictureThatCanBeMade) {
  std::set<std::string> made;
  for (const LibraryMaterial& m : all()) {
    if (!m.relief || m.relief->grain || !made.insert(m.relief->recipe).second) continue;
    EXPECT_EQ(plan_grain(rule_of(m, m.id)).problem, "") << m.id;
    // The recipe's stiffness would multiply that of the file.
    RenderOptions render;
    render.width = render.height = 16;
    render.channels = 1U << static_cast<unsigned>(Channel::stiffness);
    const RenderedTexture texture = render_texture(compile_texture(m.relief->recipe, RecipeLibrary::builtin()), render);
    for (const float factor : texture.values[Channel::stiffness]) ASSERT_EQ(factor, 1.0F) << m.id;
  }
  EXPECT_GT(made.size(), 20U);
}

TEST(MaterialLibrary, WordsAreComparedWithoutCaseUmlautsAndSigns) {
  EXPECT_EQ(folded("Gebürstet"), "geburstet");
  EXPECT_EQ(folded("GEBUERSTET"), "geburstet");
  EXPECT_EQ(folded("Rändel"), folded("Raendel"));
  EXPECT_EQ(folded("Fußmatte"), "fussmatte");
  EXPECT_EQ(folded("Höhe"), folded("hoehe"));
  EXPECT_EQ(folded("soft-touch/1"), "soft touch 1");
  EXPECT_EQ(folded("Café"), "cafe");
}

TEST(MaterialLibrary, SearchKnowsBothLanguages) {
  EXPECT_TRUE(has(found("leather perforated"), "leather/perforated"));
  EXPECT_TRUE(has(found("PERFORIERT leder"), "leather/perforated"));
  EXPECT_TRUE(has(found("gebuerstetes aluminium"), "metal/aluminium-brushed"));
  EXPECT_TRUE(has(found("gebürstetes Aluminium"), "metal/aluminium-brushed"));
  EXPECT_TRUE(has(found("Fussmatte"), "carpet/tufted-cut")) << "a use";
  EXPECT_TRUE(has(found("soft-touch grain"), "soft-skin/slush-grained"));
  EXPECT_TRUE(has(found("alcantara"), "microfibre/suede-classic"));
  EXPECT_TRUE(has(found("old dashboard"), "hard-grain/leather-coarse"));
  EXPECT_TRUE(found("").empty());
  EXPECT_TRUE(found("xyzzyqwert").empty());
}

TEST(MaterialLibrary, TheBestHitsComeFirst) {
  EXPECT_EQ(found("Kork").front(), "wood/cork");
  EXPECT_EQ(found("nappa").front().substr(0, 13), "leather/nappa");
  // A name in full before one that has the word.
  const std::vector<MaterialHit> hits = search_materials(all(), "suede");
  ASSERT_GT(hits.size(), 1U);
  EXPECT_EQ(all()[hits.front().material].id, "leather/suede");
  EXPECT_EQ(hits.front().score, 4);
  EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end(), [](auto a, auto b) { return a.score > b.score; }));
}

std::vector<std::string> first(std::vector<std::string> ids, std::size_t count) {
  ids.resize(std::min(ids.size(), count));
  return ids;
}

TEST(MaterialLibrary, SoftAndHardAreSaidByTheStiffness) {
  EXPECT_EQ(found("gummi weich").front(), "rubber/foam-seal");
  EXPECT_EQ(found("weicher Gummi"), found("gummi weich"));
  EXPECT_EQ(found("soft rubber").front(), "rubber/foam-seal");
  EXPECT_FALSE(has(found("soft rubber"), "rubber/smooth")) << "2100 N/m";
  EXPECT_TRUE(has(found("harter Gummi"), "rubber/smooth"));
  EXPECT_FALSE(has(found("harter Gummi"), "rubber/foam-seal"));
  for (const char* words : {"soft leather", "weiches Leder", "Leder weich"}) {
    const std::vector<std::string> ids = found(words);
    ASSERT_GT(ids.size(), 6U) << words;
    EXPECT_EQ(ids.front(), "leather/quilted") << words << ": the softest";
    EXPECT_TRUE(has(first(ids, 8), "leather/nappa-fine")) << words;
    EXPECT_FALSE(has(ids, "leather/saddle")) << words << ": 2000 N/m";
    EXPECT_FALSE(has(ids, "hard-grain/leather-fine")) << words;
  }
  EXPECT_EQ(found("hard leather").front(), "leather/saddle") << "the hardest";
  EXPECT_TRUE(has(found("soft-touch"), "soft-skin/paint")) << "so called, at 2300 N/m";
  EXPECT_DOUBLE_EQ(k_soft_stiffness, rendered_stiffness(1e30) / 2);
}

TEST(MaterialLibrary, WhatIsOfTheKindComesBeforeWhatIsLikeIt) {
  EXPECT_EQ(found("leder fein").front(), "leather/nappa-fine");
  EXPECT_EQ(found("feines Leder").front(), "leather/nappa-fine");
  EXPECT_TRUE(has(found("leder fein"), "hard-grain/leather-fine")) << "a grain like leather, later";
  EXPECT_EQ(found("glas").front().substr(0, 6), "glass/");
}

TEST(MaterialLibrary, OfASentenceMostWordsAreFound) {
  const std::vector<MaterialHit> hits = search_materials(all(), "soft-touch grain, like the old dashboard");
  ASSERT_FALSE(hits.empty());
  EXPECT_TRUE(hits.front().is_near);
  EXPECT_EQ(all()[hits.front().material].id, "soft-skin/slush-grained");
  EXPECT_TRUE(has(found("wie das alte Armaturenbrett"), "soft-skin/slush-grained"));
  EXPECT_TRUE(found("xyzzyqwert leather").empty()) << "less than half";
  EXPECT_EQ(found("soft wood").front(), "wood/cork") << "none is soft: the softest";
  for (const std::string& id : found("soft wood")) EXPECT_EQ(id.substr(0, 5), "wood/");
}

TEST(MaterialLibrary, NearWordsAreFoundWhereNoneFits) {
  const std::vector<MaterialHit> hits = search_materials(all(), "velurs");
  ASSERT_FALSE(hits.empty());
  EXPECT_TRUE(hits.front().is_near);
  EXPECT_TRUE(has(found("velurs"), "textile/velour"));
  EXPECT_TRUE(has(found("walnutt"), "wood/walnut-open"));
}

TEST(MaterialLibrary, AnUnknownIdNamesANearOne) {
  const MaterialLibrary library(k_materials);
  const auto complaint = [&](const std::string& id) -> std::string {
    try {
      library.material(id);
    } catch (const UnknownMaterial& unknown) {
      return unknown.what();
    }
    return "";
  };
  EXPECT_NE(complaint("leather/napa-fine").find("did you mean 'leather/nappa-fine'?"), std::string::npos);
  EXPECT_NE(complaint("piano-blak").find("did you mean 'gloss/piano-black'?"), std::string::npos);
  EXPECT_NE(complaint("../materials/leather/nappa-fine"), "") << "a path is no id";
  EXPECT_NE(complaint(""), "");
  EXPECT_THROW(MaterialLibrary(k_materials / "nowhere"), IoError);
}

class OwnLibrary : public testing::Test {
 protected:
  OwnLibrary() { fs::create_directories(folder_ / "a"); }
  ~OwnLibrary() override {
    fs::remove_all(folder_);
    ::unsetenv("PAPILLA_MATERIAL_LIBRARY");
  }
  const fs::path folder_ = fs::temp_directory_path() / ("papilla-own-library-" + std::to_string(::getpid()));
};

TEST_F(OwnLibrary, IsCheckedFileByFile) {
  fs::copy_file(k_materials / "wood/cork.json", folder_ / "a" / "cork.json");
  fs::copy_file(k_materials / "wood/cork.json", folder_ / "a" / "twin.json");
  std::ofstream(folder_ / "a" / "wrong.json") << R"({"version": 1})";
  std::ofstream(folder_ / "a" / "Upper.json") << read_file(k_materials / "wood/cork.json");
  const LibraryCheck check = check_materials(folder_);
  EXPECT_EQ(check.materials, 1U);
  ASSERT_EQ(check.problems.size(), 3U);
  EXPECT_NE(check.problems[0].reason.find("'a/Upper' must be of a-z"), std::string::npos);
  EXPECT_NE(check.problems[1].reason.find("'Cork' is a name of a/cork, too"), std::string::npos);
  EXPECT_NE(check.problems[2].reason.find("'names' is missing"), std::string::npos);
  EXPECT_EQ(check_materials(folder_ / "a" / "cork.json").materials, 1U);
  EXPECT_THROW(check_materials(folder_ / "b"), IoError);
}

TEST_F(OwnLibrary, IsFoundByTheEnvironment) {
  EXPECT_TRUE(fs::equivalent(find_material_library(), k_materials)) << "that of the build tree";
  ::setenv("PAPILLA_MATERIAL_LIBRARY", folder_.c_str(), 1);
  EXPECT_EQ(find_material_library(), folder_);
  ::setenv("PAPILLA_MATERIAL_LIBRARY", "", 1);
  EXPECT_TRUE(fs::equivalent(find_material_library(), k_materials));
}

/// A square of 60 mm whose uv are millimetres.
Scene square() {
  Part part;
  part.name = "square";
  part.mesh.positions = {{0, 0, 0}, {60, 0, 0}, {60, 60, 0}, {0, 60, 0}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  part.mesh.uv.values = {{0, 0}, {60, 0}, {60, 60}, {0, 60}};
  part.mesh.uv.indices = part.mesh.triangles;
  return single_part_scene(std::move(part), "test");
}

Materials read(const fs::path& folder, const std::string& text) {
  const fs::path file = folder / "rules.json";
  std::ofstream(file) << text;
  return read_materials(file, k_materials);
}

TEST_F(OwnLibrary, AMaterialOfTheLibraryBakesAsItsNumbersWrittenOut) {
  const std::string assign = R"(, "assign": [{"part": "*", "material": "m"}]})";
  const Materials named = read(folder_, R"({"materials": {"m": {"material": "library:leather/perforated"}})" + assign);
  const LibraryMaterial m = MaterialLibrary(k_materials).material("leather/perforated");
  ASSERT_TRUE(m.relief);
  const auto number = [](double value) { return fmt::format("{}", value); };
  const Materials written = read(
      folder_, R"({"materials": {"m": {"texture": ")" + m.relief->recipe + R"(", "size_mm": [50, 50], "show": "relief",
        "height": {"depth_mm": 0.5}, "stiffness": )" +
                   number(m.stiffness.value) + R"(, "damping": )" + number(m.damping.value) +
                   R"(, "staticFriction": )" + number(m.static_friction.value) + R"(, "dynamicFriction": )" +
                   number(m.dynamic_friction.value) + R"(, "stribeckVelocity": )" + number(m.stribeck_velocity.value) +
                   R"(, "backing": {"stiffness": )" + number(m.backing.value().stiffness.value) + R"(, "depth_mm": )" +
                   number(m.backing->depth_mm.value) + R"(}, "fineRoughness": {"hurst": )" +
                   number(m.roughness.value().hurst.value) + R"(, "rms": )" + number(m.roughness->rms_m.value) +
                   R"(, "wavelength_range": [)" + number(m.roughness->wavelength_range_m[0].value) + ", " +
                   number(m.roughness->wavelength_range_m[1].value) + R"(]}, "color": ")" + m.appearance.color.value +
                   R"(", "roughness": )" + number(m.appearance.roughness.value) + R"(, "metallic": )" +
                   number(m.appearance.metallic.value) + "}}" + assign);
  const BakeResult a = bake_scene(square(), named), b = bake_scene(square(), written);
  ASSERT_EQ(a.scene.materials.size(), 1U);
  ASSERT_EQ(b.scene.materials.size(), 1U);
  ASSERT_TRUE(a.scene.materials[0].haptic);
  EXPECT_EQ(a.scene.materials[0].haptic, b.scene.materials[0].haptic);
  EXPECT_EQ(a.scene.materials[0].base_color, b.scene.materials[0].base_color);
  EXPECT_EQ(a.scene.materials[0].roughness, b.scene.materials[0].roughness);
  EXPECT_EQ(a.grains.at("m").height_png.bytes, b.grains.at("m").height_png.bytes);
  EXPECT_EQ(a.scene.materials[0].haptic->stiffness, m.stiffness.value);
  ASSERT_TRUE(a.scene.materials[0].haptic->backing);
  EXPECT_EQ(a.scene.materials[0].haptic->backing->stiffness, m.backing->stiffness.value);
  EXPECT_DOUBLE_EQ(a.scene.materials[0].haptic->backing->depth_m, 1e-3 * m.backing->depth_mm.value);
  // Of the roughness, what a hand at 0.1 m/s and a loop of 1 kHz play.
  const auto& roughness = a.scene.materials[0].haptic->roughness;
  ASSERT_TRUE(roughness);
  EXPECT_TRUE(roughness->overlay);
  EXPECT_DOUBLE_EQ(roughness->fractal_dimension.value(), 3 - m.roughness->hurst.value);
  EXPECT_DOUBLE_EQ(roughness->wavelength_range_m.x, 2e-4);
  EXPECT_DOUBLE_EQ(roughness->wavelength_range_m.y, m.roughness->wavelength_range_m[1].value);
  EXPECT_GT(roughness->rms_height_m, 0);
  EXPECT_LT(roughness->rms_height_m, m.roughness->rms_m.value);
}

TEST_F(OwnLibrary, NullTakesTheBackingOfTheLibraryAway) {
  const Materials file = read(folder_, R"({"materials": {"m": {"material": "library:leather/nappa-fine"},
      "bare": {"material": "library:leather/nappa-fine", "backing": null, "fineRoughness": null}}})");
  EXPECT_TRUE(file.materials.at("m").backing);
  EXPECT_TRUE(file.materials.at("m").fine_roughness);
  EXPECT_FALSE(file.materials.at("bare").backing);
  EXPECT_FALSE(file.materials.at("bare").fine_roughness);
}

TEST_F(OwnLibrary, WhatStandsBesideTheLibrarysMaterialOverridesIt) {
  const Materials file = read(folder_, R"({"materials": {
      "plain": {"material": "library:leather/nappa-fine"},
      "own": {"material": "library:leather/nappa-fine", "stiffness": 1234, "color": "#ff0000", "texture": "fbm",
              "height": {"scale": 2}}}})");
  const MaterialRule &plain = file.materials.at("plain"), &own = file.materials.at("own");
  EXPECT_EQ(plain.library, "leather/nappa-fine");
  EXPECT_EQ(own.name, "own");
  EXPECT_EQ(own.stiffness, 1234);
  EXPECT_EQ(own.color, "#ff0000");
  EXPECT_EQ(own.recipe, "fbm");
  EXPECT_EQ(own.height.scale, 2);
  EXPECT_EQ(own.height.depth_mm, plain.height.depth_mm) << "what is not given stays";
  EXPECT_EQ(own.damping, plain.damping);
}

TEST_F(OwnLibrary, AWrongNameInMaterialsJsonIsReportedWithItsPlace) {
  const auto complaint = [&](const std::string& material) -> std::string {
    try {
      read(folder_, R"({"materials": {"m": )" + material + "}}");
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(complaint(R"({"material": "library:leather/napa-fine"})")
                .find("at /materials/m/material: the library has no material 'leather/napa-fine'; did you mean "
                      "'leather/nappa-fine'?"),
            std::string::npos);
  for (const char* text : {"leather/nappa-fine", "library:", "library:../x", "library", ""})
    EXPECT_NE(complaint("{\"material\": \"" + std::string(text) + "\"}").find("/materials/m/material: must be"),
              std::string::npos)
        << text;
  EXPECT_NE(complaint(R"({"material": "library:leather/nappa-fine", "staticFriction": 0.1})")
                .find("one of them is the library's"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"texture": "grain:lether"})").find("there is no grain 'lether'; did you mean 'leather'?"),
            std::string::npos);
}

TEST_F(OwnLibrary, ATestGrainIsARelief) {
  const Materials file = read(folder_, R"({"materials": {"a": {"texture": "grain:leather", "size_mm": [40, 40],
      "height": {"depth_mm": 0.1, "seed": 3}}, "b": {"texture": "grain:leather", "size_mm": [40, 40],
      "height": {"depth_mm": 0.1, "seed": 4}}}})");
  const Grain a = make_grain(file.materials.at("a")), b = make_grain(file.materials.at("b"));
  EXPECT_EQ(a.height.method, "grain");
  EXPECT_EQ(a.source, "grain:leather");
  EXPECT_NEAR(a.height.unlimited_depth_mm, 0.1, 1e-6);
  EXPECT_EQ(a.relief.width, 512);
  EXPECT_TRUE(a.relief.periodic);
  EXPECT_NE(a.relief.mm, b.relief.mm) << "the seed";
  EXPECT_FALSE(a.picture);
}

}  // namespace
}  // namespace papilla
