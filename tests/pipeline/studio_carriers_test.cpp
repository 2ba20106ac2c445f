// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "pipeline/half_opaque.hpp"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;
using Kind = StudioEdit::Kind;

Json edited(const std::string& document, Kind kind, std::size_t number,
            const std::map<std::string, std::string>& values = {}, std::optional<SurfaceSelector> onto = {}) {
  StudioEdit edit;
  edit.kind = kind;
  edit.number = number;
  edit.values = values;
  edit.onto = std::move(onto);
  return Json::parse(edited_document(document, edit, "m.json"));
}

TEST(StudioCarrierEdits, AreThoseOfTheListReplace) {
  SurfaceSelector knob;
  knob.part = "knob";
  const Json one = edited(R"({"materials": {}, "decals": [{"picture": "d.png"}]})", Kind::add_carrier, 0,
                          {{"/picture", R"({"render": true})"}}, knob);
  EXPECT_EQ(one["replace"], Json::parse(R"([{"part": "knob", "picture": {"render": true}}])"));
  EXPECT_EQ(one["decals"], Json::parse(R"([{"picture": "d.png"}])"));
  const Json two = edited(one.dump(), Kind::add_carrier, 0, {{"/picture", "\"b.png\""}}, knob);
  const Json set = edited(two.dump(), Kind::set_carrier, 1, {{"/crop", "[0,0,1,0.5]"}, {"/cut_out/color", "\"#fff\""}});
  EXPECT_EQ(set["replace"][0], one["replace"][0]);
  EXPECT_EQ(set["replace"][1]["crop"], Json::parse("[0,0,1,0.5]"));
  EXPECT_EQ(set["replace"][1]["cut_out"]["color"], "#fff");
  const Json removed = edited(two.dump(), Kind::remove_carrier, 0);
  ASSERT_EQ(removed["replace"].size(), 1U);
  EXPECT_EQ(removed["replace"][0]["picture"], "b.png");
  EXPECT_FALSE(edited(one.dump(), Kind::remove_carrier, 0).contains("replace"));
  EXPECT_THROW(edited(one.dump(), Kind::set_carrier, 1), InvalidInput);
  EXPECT_THROW(edited(R"({"materials": {}})", Kind::remove_carrier, 0), InvalidInput);
}

/// A vector in the scene by 1/1024: the bake moves copies, which rounds.
std::array<double, 3> rounded(Vec3 v) {
  constexpr double k_grid = 1024;
  return {std::round(k_grid * v.x) / k_grid + 0.0, std::round(k_grid * v.y) / k_grid + 0.0,
          std::round(k_grid * v.z) / k_grid + 0.0};
}

Vec3 vec3_at(const std::vector<float>& values, std::size_t i) {
  return {double{values[3 * i]}, double{values[3 * i + 1]}, double{values[3 * i + 2]}};
}

using Corners = std::vector<std::array<double, 3>>;

/// Corners of triangles in the scene.
Corners corners(const ShownMesh& mesh, const Transform& world) {
  Corners places;
  for (const std::uint32_t i : mesh.indices)
    places.push_back(rounded(transform_point(world, vec3_at(mesh.positions, i))));
  return places;
}

/// Their normals there.
Corners normals(const ShownMesh& mesh, const Transform& world) {
  Corners found;
  for (const std::uint32_t i : mesh.indices)
    found.push_back(rounded(transform_point(world, vec3_at(mesh.normals, i)) - transform_point(world, {})));
  return found;
}

void expect_same_tag(const MaterialTag& a, const MaterialTag& b) {
  Json one = Json::parse(to_json(a)), other = Json::parse(to_json(b));
  if (one.contains("height") && other.contains("height"))
    for (std::size_t i = 0; i < 2; ++i) {
      const double size = other["height"]["metresPerUV"][i];
      EXPECT_NEAR(one["height"]["metresPerUV"][i].get<double>(), size, 1e-9 * size);
      one["height"]["metresPerUV"][i] = size;
    }
  EXPECT_EQ(one, other);
}

class StudioCarrierScenes : public testing::Test {
 protected:
  StudioCarrierScenes() { test::write_half_opaque(folder_.path() / "logo.png"); }

  /// A plate of 4 × 4 squares, 100 mm wide, that looks up, its last row of another slot and raised by 10 mm.
  static TriangleMesh plate() {
    TriangleMesh mesh;
    for (int y = 0; y <= 4; ++y)
      for (int x = 0; x <= 4; ++x) mesh.positions.push_back({25.0 * x, 25.0 * y, y == 4 ? 10.0 : 0.0});
    for (Index y = 0; y < 4; ++y)
      for (Index x = 0; x < 4; ++x) {
        const Index a = 5 * y + x;
        mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, a + 6}, {a, a + 6, a + 5}});
        mesh.material.insert(mesh.material.end(), 2, y == 3 ? 1U : 0U);
      }
    return mesh;
  }

  /// The plate shown twice, and its copy, turned by a quarter.
  static Scene plates() {
    Part part;
    part.name = "plate";
    part.mesh = plate();
    part.materials = {0, 1};
    Scene scene = single_part_scene(std::move(part), "test");
    scene.up = UpAxis::z;
    scene.nodes[0].name = "left";
    scene.nodes.resize(3, scene.nodes[0]);
    scene.nodes[1].name = "right";
    scene.nodes[1].local[3] = 400;
    scene.nodes[2].name = "copy";
    scene.nodes[2].local[7] = 500;
    scene.nodes[2].part = 1;
    scene.roots = {0, 1, 2};
    scene.parts.push_back(scene.parts[0]);
    scene.parts[1].name = "copy";
    for (Vec3& p : scene.parts[1].mesh.positions) p = {-p.y, p.x, p.z};
    scene.materials.resize(2);
    scene.materials[0].name = "skin";
    scene.materials[1].name = "edge";
    scene.materials[0].base_color = {0.5, 0.25, 0.125, 1};
    assign_part_ids(scene);
    return scene;
  }

  /// The same, standing: the copy is turned about what looks to the side.
  static Scene standing_plates() {
    Scene scene = plates();
    for (Part& part : scene.parts)
      for (Vec3& p : part.mesh.positions) p = {p.x, -p.z, p.y};
    assign_part_ids(scene);
    return scene;
  }

  /// Two closed boxes of different widths far above each other, and one beside them.
  static Scene boxes() {
    Scene scene;
    scene.format = "test";
    scene.up = UpAxis::z;
    scene.materials.resize(1);
    scene.materials[0].name = "skin";
    for (std::uint32_t i = 0; i < 3; ++i) {
      Part part;
      part.name = "box" + std::to_string(i);
      part.materials = {0};
      const double width = 100 + 10.0 * i;
      for (int corner = 0; corner < 8; ++corner)
        part.mesh.positions.push_back(
            {width * (corner & 1), 80.0 * (corner >> 1 & 1), 10.0 * (corner >> 2 & 1) + (i == 1 ? 1000 : 0)});
      part.mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                             {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
      scene.parts.push_back(std::move(part));
      Node node;
      node.part = i;
      node.local[3] = i == 2 ? 500 : 0;
      scene.nodes.push_back(std::move(node));
      scene.roots.push_back(i);
    }
    assign_part_ids(scene);
    return scene;
  }

  static Json document(const std::string& replace) {
    return Json::parse(
        R"({"materials": {"hard": {"stiffness": 777, "roughness": 0.25}, "soft": {"stiffness": 100}},
            "assign": [{"gltf_material": "skin", "material": "hard"}, {"gltf_material": "edge", "material": "soft"}],
            "replace": [)" +
        replace + "]}");
  }

  StudioPlan plan_of(const StudioScene& studio, const Json& json) const {
    return studio.plan(json.dump(), folder_.path() / "m.json", {});
  }

  static BakeOptions options() {
    BakeOptions options;
    options.plan.sides.keep = true;
    return options;
  }

  static StudioCarriers made(StudioScene& studio, const StudioPlan& plan) {
    std::map<std::string, std::shared_ptr<const StudioSurface>> surfaces;
    for (const StudioWish& wish : plan.wishes)
      if (!wish.carriers.empty()) surfaces[wish.key] = std::make_shared<const StudioSurface>(studio.bake(plan, wish));
    return studio.carriers(plan, surfaces);
  }

  static std::vector<std::byte> bytes(const Scene& scene, const std::optional<TextureReference>& reference) {
    if (!reference) return {};
    return scene.images.at(scene.textures.at(reference->texture).image.value()).bytes;
  }

  /// The studio draws what the bake writes: every triangle, and of carriers material and pictures.
  void expect_as_baked(const Json& json, std::size_t carriers, const Scene& scene = plates()) const {
    StudioScene studio(scene, options(), false);
    const StudioPlan plan = plan_of(studio, json);
    const BakeResult baked = bake_scene(scene, plan.rules, options());
    std::multiset<std::array<double, 3>> seen, written;
    for (const StudioWish& wish : plan.wishes) {
      const StudioSurface surface = studio.bake(plan, wish);
      for (const std::uint32_t use : wish.uses)
        for (const auto& corner : corners(surface.mesh, studio.uses()[use].world)) seen.insert(corner);
    }
    const StudioCarriers made_carriers = made(studio, plan);
    const auto is_carrier = [](const Material& material) {
      return material.extras_json.find("carrier") != std::string::npos;
    };
    std::size_t found = 0;
    for (const Instance& use : instances(baked.scene)) {
      const Part& part = baked.scene.parts[use.part];
      if (part.mesh.triangles.empty()) continue;
      const ShownMesh shown = shown_mesh(part.mesh);
      const Material& material = baked.scene.materials.at(part.materials.at(0));
      if (!is_carrier(material)) {
        for (const auto& corner : corners(shown, use.world)) written.insert(corner);
        continue;
      }
      ++found;
      const Corners places = corners(shown, use.world);
      const auto same = std::find_if(made_carriers.rectangles.begin(), made_carriers.rectangles.end(),
                                     [&](const auto& r) { return corners(r.surface->mesh, r.world) == places; });
      ASSERT_NE(same, made_carriers.rectangles.end()) << "carrier " << found;
      EXPECT_EQ(same->surface->mesh.uv, shown.uv);
      EXPECT_EQ(normals(same->surface->mesh, same->world), normals(shown, use.world));
      const Scene& look = *same->surface->look;
      const Material& own = look.materials.at(0);
      EXPECT_EQ(own.alpha_mode, material.alpha_mode);
      EXPECT_EQ(own.roughness, material.roughness);
      EXPECT_EQ(own.metallic, material.metallic);
      EXPECT_EQ(bytes(look, own.base_color_texture), bytes(baked.scene, material.base_color_texture));
      EXPECT_FALSE(bytes(look, own.base_color_texture).empty());
      EXPECT_EQ(bytes(look, own.normal_texture), bytes(baked.scene, material.normal_texture));
      ASSERT_EQ(own.haptic.has_value(), material.haptic.has_value());
      if (own.haptic) expect_same_tag(*own.haptic, *material.haptic);
    }
    EXPECT_EQ(found, carriers);
    EXPECT_EQ(made_carriers.rectangles.size(), carriers);
    EXPECT_EQ(seen, written);
    ASSERT_EQ(made_carriers.reports.size(), baked.object_textures.carriers.size());
    for (std::size_t i = 0; i < made_carriers.reports.size(); ++i)
      EXPECT_EQ(made_carriers.reports[i].saved(), baked.object_textures.carriers[i].saved());
  }

  const TemporaryFolder folder_{"papilla-studio-carriers"};
};

TEST_F(StudioCarrierScenes, StandWhereThePartWasThatIsGone) {
  StudioScene studio(plates(), options(), false);
  const StudioPlan plan = plan_of(studio, document(R"({"node": "left", "picture": "logo.png"})"));
  const StudioCarriers carriers = made(studio, plan);
  ASSERT_EQ(carriers.rectangles.size(), 1U);
  EXPECT_EQ(carriers.rectangles[0].use, 0U);
  EXPECT_EQ(carriers.reports.at(0).triangles, 32U);
  EXPECT_EQ(carriers.rectangles[0].surface->mesh.indices.size(), 6U);
  EXPECT_EQ(carriers.rectangles[0].surface->look->materials.at(0).alpha_mode, "MASK");
  for (const StudioWish& wish : plan.wishes)
    EXPECT_EQ(studio.bake(plan, wish).mesh.indices.empty(), wish.uses == std::vector<std::uint32_t>{0}) << wish.label;
}

TEST_F(StudioCarrierScenes, OfPartsAreThoseOfTheBake) {
  expect_as_baked(document(R"({"part": "plate", "picture": "logo.png", "scale": [0.9, 1], "contrast": 0.5,
                               "height": {"depth_mm": 0.5}})"),
                  2);
}

TEST_F(StudioCarrierScenes, OfCopiesLieAsInTheBake) {
  expect_as_baked(document(R"({"part": "*", "picture": {"render": true, "pixels": 32}})"), 3);
  expect_as_baked(document(R"({"part": "copy", "picture": {"render": true, "pixels": 32}})"), 1);
}

TEST_F(StudioCarrierScenes, OfCopiesThatAreTurnedAreTurnedWithThem) {
  const Json json = document(R"({"part": "*", "picture": "logo.png"})");
  expect_as_baked(json, 3, standing_plates());
  // What is upright on the first one lies on its side on the copy: its lines run up.
  StudioScene studio(standing_plates(), options(), false);
  const StudioCarriers carriers = made(studio, plan_of(studio, json));
  ASSERT_EQ(carriers.rectangles.size(), 3U);
  for (const StudioCarriers::Rectangle& rectangle : carriers.rectangles) {
    const ShownMesh& mesh = rectangle.surface->mesh;
    const bool is_copy = rectangle.use == 2U;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
      if (std::abs(mesh.uv[2 * a + 1] - mesh.uv[2 * b + 1]) > 1e-6) continue;
      const Vec3 edge = transform_point(rectangle.world, vec3_at(mesh.positions, b)) -
                        transform_point(rectangle.world, vec3_at(mesh.positions, a));
      EXPECT_GT(std::abs(is_copy ? edge.z : edge.x), 1);
      EXPECT_LT(std::abs(is_copy ? edge.x : edge.z), 1e-3);
      ++edges;
    }
    EXPECT_EQ(edges, 2U);
  }
}

TEST_F(StudioCarrierScenes, OfClosedBodiesLookAtTheMiddleOfTheWholeScene) {
  expect_as_baked(document(R"({"part": "box0", "picture": "logo.png"})"), 1, boxes());
  expect_as_baked(document(R"({"part": "box1", "picture": "logo.png"})"), 1, boxes());
}

TEST_F(StudioCarrierScenes, OfOneSlotLeaveTheOther) {
  expect_as_baked(document(R"({"gltf_material": "edge", "node": "right", "picture": "logo.png"})"), 1);
}

TEST_F(StudioCarrierScenes, OfRegionsTakeWhatLiesWithinThem) {
  expect_as_baked(document(R"({"picture": "logo.png", "at": [37.5, 37.5, 0], "direction": [0, 0, -1], "up": [0, 1, 0],
                               "size_mm": [25, 25], "depth_mm": 5})"),
                  1);
}

TEST_F(StudioCarrierScenes, StandForWhatOthersHaveLeft) {
  const std::string region = R"({"picture": "logo.png", "name": "a", "at": [37.5, 37.5, 0], "direction": [0, 0, -1],
                                 "up": [0, 1, 0], "size_mm": [25, 25], "depth_mm": 5})";
  const std::string part = R"({"node": "left", "name": "b", "picture": {"render": true, "pixels": 32}})";
  expect_as_baked(document(region + "," + part), 2);
  expect_as_baked(document(part + "," + region), 1);
}

TEST_F(StudioCarrierScenes, AreMadeAnewWhereTheyOrWhatTheyTakeHasChanged) {
  const StudioScene studio(plates(), options(), false);
  const auto key_of = [&](const Json& json) { return plan_of(studio, json).carriers.value().key; };
  const auto keys_of = [&](const Json& json) {
    std::set<std::string> keys;
    for (const StudioWish& wish : plan_of(studio, json).wishes) keys.insert(wish.key);
    return keys;
  };
  const Json json = document(R"({"node": "left", "gltf_material": "edge", "picture": "logo.png"})");
  Json elsewhere = json, taken = json, changed = json;
  elsewhere["assign"].insert(elsewhere["assign"].begin(), Json::parse(R"({"node": "copy", "material": "soft"})"));
  EXPECT_EQ(key_of(elsewhere), key_of(json));
  taken["materials"]["soft"]["roughness"] = 0.5;
  EXPECT_NE(key_of(taken), key_of(json));
  changed["replace"][0]["contrast"] = 2;
  EXPECT_NE(key_of(changed), key_of(json));
  EXPECT_EQ(keys_of(changed), keys_of(json)) << "the surfaces stay";
  Json none = json;
  none.erase("replace");
  EXPECT_FALSE(plan_of(studio, none).carriers);
  std::set<std::string> kept;
  std::ranges::set_intersection(keys_of(none), keys_of(json), std::inserter(kept, kept.end()));
  EXPECT_EQ(kept, keys_of(none)) << "what nothing takes stays";
  EXPECT_EQ(keys_of(json).size(), keys_of(none).size() + 1);
}

TEST_F(StudioCarrierScenes, AreGoneByUndoAndBackByRedo) {
  StudioScene studio(plates(), options(), false);
  Json none = document("");
  none.erase("replace");
  StudioHistory history(none.dump());
  StudioEdit edit;
  edit.kind = Kind::add_carrier;
  edit.onto = studio.selector_of_use(0);
  edit.values = {{"/picture", "\"logo.png\""}};
  history.add(edited_document(history.document(), edit, "m.json"), "carrier");
  const auto plan = [&] { return studio.plan(history.document(), folder_.path() / "m.json", {}); };
  const std::string key = plan().carriers.value().key;
  EXPECT_EQ(made(studio, plan()).rectangles.size(), 2U) << "both places of the part";
  history.undo();
  EXPECT_FALSE(plan().carriers);
  for (const StudioWish& wish : plan().wishes) EXPECT_FALSE(studio.bake(plan(), wish).mesh.indices.empty());
  history.redo();
  EXPECT_EQ(plan().carriers.value().key, key);
}

TEST_F(StudioCarrierScenes, SayWhatIsWrong) {
  StudioScene studio(plates(), options(), false);
  const StudioPlan gone = plan_of(studio, document(R"({"part": "plate", "picture": "gone.png"})"));
  try {
    made(studio, gone);
    FAIL() << "there is no such picture";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/replace/0 'gone'"), std::string::npos) << error.what();
  }
  const StudioPlan nothing = plan_of(studio, document(R"({"part": "knob", "picture": "logo.png"})"));
  EXPECT_NE(nothing.carriers.value().selected.at(0).problem, "");
  EXPECT_TRUE(made(studio, nothing).rectangles.empty());
}

}  // namespace
}  // namespace papilla
