// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/pipeline/studio/allowed_folders.hpp"
#include "papilla/pipeline/studio/shown_levels.hpp"
#include "papilla/pipeline/studio/shown_mesh.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* k_document = R"({"materials": {"grain": {"texture": "grain:spheres6", "size_mm": [10, 10]},
  "hard": {"stiffness": 2000}}, "assign": [{"part": "a", "material": "hard"}, {"part": "*", "material": "hard"}]})";

SurfaceSelector part(const std::string& name) {
  SurfaceSelector selector;
  selector.part = name;
  return selector;
}

Json edited(const std::string& document, StudioEdit::Kind kind, const std::vector<std::string>& parts,
            const std::string& material, const std::map<std::string, std::string>& values = {}) {
  StudioEdit edit;
  edit.kind = kind;
  for (const std::string& name : parts) edit.surfaces.push_back(part(name));
  edit.material = material;
  edit.values = values;
  return Json::parse(edited_document(document, edit, "m.json"));
}

TEST(StudioDocument, AnAssignmentGoesFirstAndReplacesThatOfTheSameSurfaces) {
  const Json json = edited(k_document, StudioEdit::Kind::assign, {"a", "b"}, "grain");
  EXPECT_EQ(json["assign"], Json::parse(R"([{"part": "a", "material": "grain"}, {"part": "b", "material": "grain"},
    {"part": "*", "material": "hard"}])"));
  EXPECT_EQ(json["materials"], Json::parse(k_document)["materials"]);
  EXPECT_TRUE(edited(k_document, StudioEdit::Kind::assign, {"a"}, "")["assign"][0]["material"].is_null());
}

TEST(StudioDocument, AVariationIsOfTheSurfacesAloneAndIsVariedItselfNextTime) {
  const Json once = edited(k_document, StudioEdit::Kind::vary, {"a"}, "grain", {{"/size_mm", "[5,5]"}});
  EXPECT_EQ(once["materials"]["grain"]["size_mm"], Json::parse("[10,10]"));
  EXPECT_EQ(once["materials"]["grain on a"]["size_mm"], Json::parse("[5,5]"));
  EXPECT_EQ(once["assign"][0], Json::parse(R"({"part": "a", "material": "grain on a"})"));
  const Json twice = edited(once.dump(), StudioEdit::Kind::vary, {"a"}, "grain on a", {{"/unwrap/grain", "[1,0,0]"}});
  EXPECT_EQ(twice["materials"].size(), 3U);
  EXPECT_EQ(twice["materials"]["grain on a"]["unwrap"]["grain"], Json::parse("[1,0,0]"));
}

TEST(StudioDocument, ValuesGoToTheirPlaceAndNullTakesThemAway) {
  Json json = edited(k_document, StudioEdit::Kind::set, {}, "grain", {{"/unwrap", "\"lscm\""}});
  json = edited(json.dump(), StudioEdit::Kind::set, {}, "grain", {{"/unwrap/grain", "[1,0,0]"}});
  EXPECT_EQ(json["materials"]["grain"]["unwrap"], Json::parse(R"({"method": "lscm", "grain": [1, 0, 0]})"));
  json =
      edited(json.dump(), StudioEdit::Kind::set, {}, "grain", {{"/unwrap/grain", "null"}, {"/unwrap/method", "null"}});
  EXPECT_FALSE(json["materials"]["grain"].contains("unwrap"));
}

TEST(StudioDocument, MaterialsComeAndGoWithTheirRules) {
  const Json json = edited(k_document, StudioEdit::Kind::add, {}, "new", {{"/material", "\"library:metal/chrome\""}});
  EXPECT_EQ(json["materials"]["new"], Json::parse(R"({"material": "library:metal/chrome"})"));
  EXPECT_THROW(edited(k_document, StudioEdit::Kind::add, {}, "hard"), InvalidInput);
  EXPECT_EQ(edited(k_document, StudioEdit::Kind::remove, {}, "hard")["assign"].size(), 0U);
}

TEST(StudioDocument, WhatHasNoPlaceIsRefused) {
  using Kind = StudioEdit::Kind;
  EXPECT_THROW(edited("[]", Kind::remove, {}, "hard"), InvalidInput);
  EXPECT_THROW(edited("{", Kind::remove, {}, "hard"), InvalidInput);
  EXPECT_THROW(edited(k_document, Kind::assign, {"a"}, "gone"), InvalidInput);
  EXPECT_THROW(edited(k_document, Kind::set, {}, "hard", {{"stiffness", "1"}}), InvalidInput);
  EXPECT_THROW(edited(k_document, Kind::set, {}, "hard", {{"/stiffness", "{"}}), InvalidInput);
  EXPECT_THROW(edited(k_document, Kind::set, {}, "hard", {{"/stiffness/x/y", "1"}, {"", "1"}}), InvalidInput);
}

TEST(StudioHistory, GoesBackAndForthAndForgetsWhatWasUndone) {
  StudioHistory history("0");
  history.add("1", "one");
  history.add("1", "the same");
  history.add("2", "two");
  EXPECT_EQ(history.undo_title(), "two");
  history.undo();
  EXPECT_EQ(history.document(), "1");
  EXPECT_EQ(history.redo_title(), "two");
  history.undo();
  history.undo();
  EXPECT_EQ(history.document(), "0");
  history.redo();
  history.add("3", "three");
  EXPECT_FALSE(history.can_redo());
  history.undo();
  EXPECT_EQ(history.document(), "1");
  for (int i = 0; i < 3000; ++i) history.add(std::to_string(i + 10), "many");
  while (history.can_undo()) history.undo();
  EXPECT_EQ(history.document(), "2010") << "a thousand documents are kept";
}

class StudioFolders : public testing::Test {
 protected:
  StudioFolders() {
    fs::create_directories(folder_ / "in/deep");
    write_atomically(folder_ / "in/a.txt", "a");
    write_atomically(folder_ / "out.txt", "o");
    fs::create_symlink(folder_ / "out.txt", folder_ / "in/link");
    fs::create_directory_symlink(folder_, folder_ / "in/up");
  }
  ~StudioFolders() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::canonical(fs::temp_directory_path()) / ("studio-" + std::to_string(::getpid()));
};

TEST_F(StudioFolders, PathsStayInThem) {
  const AllowedFolders folders({folder_ / "in"});
  EXPECT_EQ(folders.file("a.txt", folder_ / "in"), folder_ / "in/a.txt");
  EXPECT_EQ(folders.file("deep/../new.txt", folder_ / "in"), folder_ / "in/new.txt");
  EXPECT_EQ(folders.file(folder_ / "in/deep/x", "/"), folder_ / "in/deep/x");
  for (const char* path : {"../out.txt", "link", "up/out.txt", "up/in/../out.txt", "/etc/passwd", "", ".", "deep",
                           "../in2/x", "deep/../../out.txt"})
    EXPECT_THROW(folders.file(path, folder_ / "in"), InvalidInput) << path;
  EXPECT_THROW(folders.file(fs::path(std::string("a\0b", 3)), folder_ / "in"), InvalidInput);
  EXPECT_THROW(AllowedFolders({folder_ / "none"}), IoError);
  // No file has a name of 300 letters; a recipe may be as long.
  const std::string recipe = "fbm|" + std::string(300, 'x') + "/2";
  EXPECT_EQ(folders.file(recipe, folder_ / "in"), folder_ / "in" / recipe);
  EXPECT_THROW(folders.file(recipe + "/../../../out.txt", folder_ / "in"), InvalidInput);
}

TEST(StudioPaths, AreAllThatMayNameFiles) {
  const std::string document = R"({"materials": {"m": {"texture": "t.png", "environment": "e.hdr", "color": "#000000",
    "maps": {"friction": "f.png", "stiffness": {"picture": "s.png", "range": [0, 1]}},
    "height": {"method": "auto", "images": ["1.jpg"], "lights": "l.json", "reference": [{"profile_csv": "p.csv"}]}}},
    "decals": [{"picture": "d.png", "relief": {"picture": "r.png", "depth_mm": 1}}]})";
  EXPECT_EQ(paths_of_materials(document, "m"),
            (std::set<std::string>{"1.jpg", "d.png", "e.hdr", "f.png", "l.json", "p.csv", "r.png", "s.png", "t.png"}));
}

TEST(ShownMesh, SharesWhatAgreesAndFindsSeams) {
  TriangleMesh square;  // Two triangles, folded flat: four vertices, no seam but the border.
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {5, 5}};
  square.uv.indices = square.triangles;
  const ShownMesh whole = shown_mesh(square);
  EXPECT_EQ(whole.positions.size(), 12U);
  EXPECT_EQ(whole.seams.size(), 4U * 6U);
  for (std::size_t c = 0; c < 6; ++c)  // Every corner is where it was.
    EXPECT_EQ(static_cast<double>(whole.positions[3 * whole.indices[c]]),
              square.corner(c / 3, static_cast<int>(c % 3)).x);
  square.uv.indices[1] = {4, 2, 3};
  const ShownMesh cut = shown_mesh(square);
  EXPECT_EQ(cut.positions.size(), 15U);
  EXPECT_EQ(cut.seams.size(), 5U * 6U);
  EXPECT_EQ(cut.measured, std::vector<float>(10, -1.0F));
}

Vec3 vec3_at(const std::vector<float>& list, std::size_t i) { return {list[3 * i], list[3 * i + 1], list[3 * i + 2]}; }

/// 100 mm x 100 mm, folded upright along x = 50; uv are the millimetres of the flat sheet, but for u, which jumps by
/// 700 at y = 50.
TriangleMesh folded_plate(Index cells) {
  TriangleMesh plate = test::plane(100, 100, cells, cells);
  const auto values = static_cast<Index>(plate.uv.values.size());
  for (Index i = 0; i < values; ++i) plate.uv.values.push_back(plate.uv.values[i] + Vec2{700, 0});
  for (Triangle& t : plate.uv.indices) {
    const bool is_beyond = plate.uv.values[t[0]].y + plate.uv.values[t[1]].y + plate.uv.values[t[2]].y > 150;
    for (Index& i : t) i += is_beyond ? values : 0;
  }
  for (Vec3& p : plate.positions) p = {std::min(p.x, 50.0), p.y, std::max(p.x - 50, 0.0)};
  return plate;
}

TEST(ShownLevels, LeaveSeamsFoldsAndUvWhereTheyAre) {
  const ShownMesh plate = shown_mesh(folded_plate(20));
  const std::vector<ShownLevel> levels = shown_levels(plate);
  ASSERT_EQ(levels.size(), 1U);  // Flat: nothing is left for the others.
  EXPECT_EQ(levels[0].screen_coverage, 1);
  EXPECT_EQ(levels[0].indices.size(), 3U * 8U) << "two triangles each of four squares";
  double area = 0;
  for (std::size_t c = 0; c < levels[0].indices.size(); c += 3) {
    const std::uint32_t* corner = &levels[0].indices[c];
    const Vec3 a = vec3_at(plate.positions, corner[0]), b = vec3_at(plate.positions, corner[1]),
               d = vec3_at(plate.positions, corner[2]), upright = cross(b - a, d - a);
    area += norm(upright) / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = vec3_at(plate.positions, corner[k]);
      EXPECT_NEAR(norm(vec3_at(plate.normals, corner[k]) - normalized(upright)), 0, 1e-6) << "the fold stays sharp";
      const double u = static_cast<double>(plate.uv[2 * corner[k]]), jump = a.y + b.y + d.y > 150 ? 700 : 0;
      EXPECT_NEAR(u, p.x + p.z + jump, 1e-3) << "no triangle has corners on both sides of the seam";
    }
  }
  EXPECT_NEAR(area, 1e4, 1e-2);
}

TEST(ShownLevels, StayWithinTheirTolerancesAndClosed) {
  constexpr double k_radius = 50;
  const TriangleMesh sphere = test::uv_sphere(k_radius, 64, 128);
  const double diagonal = bounds_of(sphere).diagonal(), own = k_radius * (1 - std::cos(std::acos(-1.0) / 64));
  const ShownMesh shown = shown_mesh(sphere);
  const std::vector<ShownLevel> levels = shown_levels(shown);
  ASSERT_GE(levels.size(), 3U);
  std::size_t before = shown.indices.size();
  double coverage = 2;
  for (const ShownLevel& level : levels) {
    EXPECT_LE(static_cast<double>(level.indices.size()), 0.9 * static_cast<double>(before));
    EXPECT_LT(level.screen_coverage, coverage);
    before = level.indices.size();
    coverage = level.screen_coverage;
    std::map<std::pair<Vec3, Vec3>, int> sides;
    for (std::size_t c = 0; c < level.indices.size(); c += 3) {
      Vec3 middle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = vec3_at(shown.positions, level.indices[c + k]),
                   q = vec3_at(shown.positions, level.indices[c + (k + 1) % 3]);
        middle = middle + 1.0 / 3 * p;
        ++sides[p < q ? std::pair(p, q) : std::pair(q, p)];
      }
      EXPECT_GE(norm(middle), k_radius - own - diagonal / (2000 * level.screen_coverage));
    }
    for (const auto& [side, triangles] : sides) EXPECT_EQ(triangles, 2);
  }
}

TEST(ShownLevels, OfNothingAreNone) {
  EXPECT_TRUE(shown_levels({}).empty());
  EXPECT_TRUE(shown_levels(shown_mesh(test::cube(10))).empty()) << "as few triangles as can be";
  EXPECT_THROW(shown_levels(shown_mesh(test::uv_sphere(50, 64, 128)), nullptr, [](const Progress&) { return false; }),
               Cancelled);
}

/// Two plates of one name and size, a third of another, as parts of a scene.
Scene plates() {
  Scene scene;
  scene.format = "OBJ";
  scene.up = UpAxis::y;
  for (const char* name : {"a", "b*", "b*"}) {
    Part plate;
    plate.name = name;
    plate.mesh.positions = {{0, 0, 0}, {20, 0, 0}, {20, 30, 0}, {0, 30, 0}};
    plate.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    plate.materials = {0};
    Node node;
    node.name = "n" + std::to_string(scene.parts.size());
    node.part = static_cast<std::uint32_t>(scene.parts.size());
    scene.roots.push_back(*node.part);
    scene.nodes.push_back(node);
    scene.parts.push_back(plate);
  }
  scene.materials.resize(1);
  scene.materials[0].name = "plain";
  assign_part_ids(scene);
  return scene;
}

TEST(StudioScene, SelectorsMeanOneSurface) {
  const StudioScene studio(plates(), {}, false);
  for (std::uint32_t wanted = 0; wanted < 3; ++wanted) {
    StudioEdit edit;
    edit.surfaces = studio.selectors(wanted, 0);
    edit.material = "grain";
    const std::string document =
        edited_document(R"({"materials": {"grain": {"texture": "grain:spheres6", "size_mm": [10, 10]}}, "assign": []})",
                        edit, "m.json");
    const StudioPlan plan = studio.plan(document, "m.json", {});
    ASSERT_EQ(plan.wishes.size(), 3U);
    for (const StudioWish& wish : plan.wishes) EXPECT_EQ(wish.material, wish.part == wanted ? "grain" : "");
    EXPECT_EQ(plan.uses.front().problem, "");
  }
}

TEST(StudioScene, ASurfaceIsWhatABakeMakesOfIt) {
  const std::string document = R"({"materials": {"grain": {"texture": "grain:spheres6", "size_mm": [10, 10],
    "unwrap": "planar"}}, "assign": [{"part": "a", "material": "grain"}]})";
  BakeOptions options;
  options.plan.sides.keep = true;
  StudioScene studio(plates(), options, false);
  const StudioPlan plan = studio.plan(document, "m.json", {});
  const auto wish = std::find_if(plan.wishes.begin(), plan.wishes.end(), [](const auto& w) { return w.part == 0; });
  const StudioSurface surface = studio.bake(plan, *wish);
  const BakeResult baked = bake_scene(plates(), plan.rules, options);
  const ShownMesh expected = shown_mesh(baked.scene.parts[0].mesh);
  EXPECT_EQ(surface.mesh.positions, expected.positions);
  EXPECT_EQ(surface.mesh.uv, expected.uv);
  EXPECT_EQ(surface.mesh.indices, expected.indices);
  ASSERT_EQ(surface.look->materials.size(), 1U);
  ASSERT_TRUE(surface.look->materials[0].normal_texture);
  EXPECT_EQ(surface.report.method, "planar");
}

TEST(StudioScene, MapsAreMadeBesideTheGrainAndStayForOtherGrain) {
  const TemporaryFolder folder("papilla-studio-maps");
  const StageCache cache{ContentStore(folder / "cache")};
  BakeOptions options;
  options.plan.sides.keep = true;
  StudioScene plain(plates(), options, false);
  options.unwrap.method.cache = &cache;
  StudioScene studio(plates(), options, false);
  std::size_t found = 0;
  for (const char* size : {"[10, 12]", "[6, 9]"}) {
    const std::string document = R"({"materials": {"grain": {"texture": "grain:spheres6", "size_mm": )" +
                                 std::string(size) + R"(}}, "assign": [{"part": "a", "material": "grain"}]})";
    const StudioPlan plan = studio.plan(document, "m.json", {});
    const auto wish = std::find_if(plan.wishes.begin(), plan.wishes.end(), [](const auto& w) { return w.part == 0; });
    EXPECT_EQ(studio.bake(plan, *wish).mesh.uv, plain.bake(plan, *wish).mesh.uv) << size;
    const CacheCount maps = cache.counts().at("map");
    EXPECT_EQ(maps.made, 1U) << size;
    EXPECT_EQ(maps.found, ++found) << size << ": by the bake";
  }
}

TEST(StudioScene, KeysTellFilesAndScenesApart) {
  const TemporaryFolder folder("papilla-studio-keys");
  const std::string document = R"({"materials": {"g": {"texture": "a.png", "size_mm": [10, 10]}},
    "assign": [{"part": "a", "material": "g"}],
    "decals": [{"picture": "b.png", "at": [10, 10, 0], "direction": [0, 0, -1], "up": [0, 1, 0], "size_mm": [5, 5],
                "depth_mm": 5}],
    "replace": [{"part": "a", "picture": "c.png"}]})";
  const auto keys = [&](const StudioScene& scene) {
    const StudioPlan plan = scene.plan(document, folder / "m.json", {});
    const auto wish = std::find_if(plan.wishes.begin(), plan.wishes.end(), [](const auto& w) { return w.part == 0; });
    return std::array{wish->key, plan.decals.at(0).key, plan.carriers.value().key};
  };
  for (const char* name : {"a.png", "b.png", "c.png"}) write_atomically(folder / name, "one");
  const StudioScene first(plates(), {}, false, "1"), again(plates(), {}, false, "2");
  const auto before = keys(first);
  EXPECT_EQ(before, keys(first));
  const auto other = keys(again);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NE(before[k], other[k]) << k;
  std::array<std::string, 3> last = before;
  for (const auto& [name, changed] : {std::pair("b.png", 1U), std::pair("c.png", 2U), std::pair("a.png", 0U)}) {
    write_atomically(folder / name, "another");
    const auto now = keys(first);
    EXPECT_NE(now[changed], last[changed]) << name;
    EXPECT_EQ(now[0] == last[0], changed != 0) << name << ": a surface has what it is made of in its key";
    last = now;
  }
}

TEST(StudioScene, GivesUpWhenItIsToldTo) {
  StudioScene studio(plates(), {}, false);
  const StudioPlan plan = studio.plan(
      R"({"materials": {"h": {"stiffness": 1}}, "assign": [{"part": "*", "material": "h"}]})", "m.json", {});
  EXPECT_THROW(studio.bake(plan, plan.wishes.front(), [](const Progress&) { return false; }), Cancelled);
}

}  // namespace
}  // namespace papilla
