// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {
namespace {

using nlohmann::ordered_json;
using test::content_of;
using test::message_of;
using test::TemporaryFolder;

constexpr const char* k_names[] = {"leather", "oak", "felt", "paint"};
constexpr double k_stiffness[] = {300, 900, 100, 0};  ///< 0: no tag.

/// Four cubes of unlike size in a row, each of a material of its own; leather and oak look alike, paint has no tag.
Scene four_cubes() {
  Scene scene;
  scene.format = "test";
  for (std::uint32_t i = 0; i < 4; ++i) {
    Material material;
    material.name = k_names[i];
    material.base_color = {0.1 * std::max(i, 1U), 0.5, 0.5, 1};
    if (k_stiffness[i] > 0) {
      material.haptic.emplace();
      material.haptic->stiffness = k_stiffness[i];
      material.haptic->static_friction = material.haptic->dynamic_friction = 0.1 * (i + 1);
    }
    scene.materials.push_back(std::move(material));
    Part part;
    part.name = std::string("part ") + k_names[i];
    part.mesh = test::cube(10 + 5 * i);
    part.materials = {i};
    scene.parts.push_back(std::move(part));
    Node node;
    node.name = std::string("node ") + k_names[i];
    node.part = i;
    node.local[3] = 100.0 * i;
    scene.roots.push_back(i);
    scene.nodes.push_back(std::move(node));
  }
  HeightTag height;
  height.uri = "data:image/png;base64,iVBORw==";
  height.sha256 = std::string(64, 'a');
  height.scale_m = 1e-4;
  scene.materials[0].haptic->height = height;
  assign_part_ids(scene);
  return scene;
}

class TagSurvivalTest : public testing::Test {
 protected:
  /// Writes the scene, changes the document as another program would, and reads it.
  Scene after(const std::function<void(ordered_json&)>& change, const GltfReadOptions& options = {}) const {
    return after(four_cubes(), change, options);
  }

  Scene after(const Scene& scene, const std::function<void(ordered_json&)>& change,
              const GltfReadOptions& options = {}) const {
    write_glb(scene, folder_ / "before.glb");
    const std::string bytes = content_of(folder_ / "before.glb");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    ordered_json json = ordered_json::parse(bytes.substr(20, length));
    change(json);
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string rest = bytes.substr(20 + length);
    const auto word = [](std::size_t value) {
      const auto narrow = static_cast<std::uint32_t>(value);
      return std::string(reinterpret_cast<const char*>(&narrow), 4);
    };
    return read_gltf(folder_.write("after.glb", bytes.substr(0, 8) + word(20 + text.size() + rest.size()) +
                                                    word(text.size()) + "JSON" + text + rest),
                     options);
  }

  /// The stiffness that each part in its own place is felt with; 0: no tag.
  static std::map<std::uint32_t, double> stiffness_by_place(const Scene& scene) {
    std::map<std::uint32_t, double> felt;
    for (const Instance& instance : instances(scene)) {
      const Part& part = scene.parts[instance.part];
      const auto& haptic = scene.materials[part.materials.at(0)].haptic;
      felt[static_cast<std::uint32_t>(std::lround(instance.world[3] / 100))] = haptic ? haptic->stiffness : 0;
    }
    return felt;
  }

  static std::map<std::uint32_t, double> all_as_before() { return {{0, 300}, {1, 900}, {2, 100}, {3, 0}}; }

  static void drop_material_extras(ordered_json& gltf) {
    for (ordered_json& material : gltf["materials"]) material.erase("extras");
  }

  static void drop_names(ordered_json& gltf, const char* list) {
    for (ordered_json& entry : gltf[list]) entry.erase("name");
  }

  /// One material, a copy of that of the first mesh with its extras, as gltf-transform's palette makes.
  static void merge_materials(ordered_json& gltf) {
    gltf["materials"] = ordered_json::array({gltf["materials"][0]});
    gltf["materials"][0]["name"] = "PaletteMaterial001";
    for (ordered_json& mesh : gltf["meshes"]) mesh["primitives"][0]["material"] = 0;
  }

  /// Nothing of materials and names: places alone tell what was where.
  static void leave_only_places(ordered_json& gltf) {
    merge_materials(gltf);
    drop_material_extras(gltf);
    drop_names(gltf, "nodes");
    drop_names(gltf, "meshes");
  }

  static std::set<std::string> ways(const Scene& scene) {
    std::set<std::string> ways;
    for (const MissingTag& tag : scene.tags.missing) ways.insert(tag.restored_by);
    return ways;
  }

  const TemporaryFolder folder_;
};

TEST_F(TagSurvivalTest, AFileOfOurOwnMissesNothing) {
  const Scene scene = after([](ordered_json& gltf) {
    const ordered_json& manifest = gltf["asset"]["extras"]["hapticManifest"];
    EXPECT_EQ(manifest["materials"].size(), 3U);
    EXPECT_EQ(manifest["surfaces"].size(), 3U);
    EXPECT_EQ(manifest.dump().find("data:"), std::string::npos) << "the map is not stored twice";
    EXPECT_EQ(gltf["nodes"][1]["extras"]["hapticMaterials"][0]["tag"]["stiffness"], 900);
    EXPECT_FALSE(gltf["nodes"][3].contains("extras"));
  });
  EXPECT_EQ(scene.tags.expected, 3U);
  EXPECT_TRUE(scene.tags.missing.empty());
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.asset.extras_json, "");
  EXPECT_EQ(scene.nodes[0].extras_json, "");
  write_glb(scene, folder_ / "second.glb");
  write_glb(read_gltf(folder_ / "second.glb"), folder_ / "third.glb");
  EXPECT_EQ(content_of(folder_ / "second.glb"), content_of(folder_ / "third.glb")) << "nothing piles up";
}

TEST_F(TagSurvivalTest, TheManifestHasAreaAndBox) {
  const TagManifest manifest = tag_manifest(four_cubes());
  ASSERT_EQ(manifest.surfaces.size(), 3U);
  EXPECT_NEAR(manifest.surfaces[1].area_m2, 6 * 0.015 * 0.015, 1e-12);
  EXPECT_NEAR(manifest.surfaces[1].box_m->low.x, 0.1 - 0.0075, 1e-12);
  EXPECT_EQ(manifest.surfaces[1].part, "part oak");
  EXPECT_EQ(manifest.surfaces[1].node, "node oak");
}

TEST_F(TagSurvivalTest, NoTwoTaggedMaterialsLookExactlyAlike) {
  after([](ordered_json& gltf) {
    std::set<std::string> looks;
    for (ordered_json material : gltf["materials"]) {
      material.erase("name");
      material.erase("extras");
      looks.insert(material.dump());
      for (const ordered_json& light : material.value("emissiveFactor", ordered_json::array()))
        EXPECT_LE(light.get<double>(), 1e-4) << "nobody sees it";
    }
    EXPECT_EQ(looks.size(), 4U);
    EXPECT_FALSE(gltf["materials"][3].contains("emissiveFactor")) << "paint has no tag";
  });
}

TEST_F(TagSurvivalTest, DroppedExtrasAreFoundByTheNameOfTheMaterial) {
  const Scene scene = after(drop_material_extras);
  EXPECT_EQ(stiffness_by_place(scene), all_as_before());
  EXPECT_EQ(ways(scene), std::set<std::string>{"material name"});
  EXPECT_EQ(scene.materials[0].haptic_warnings.at(0).code, "tag_restored");
  EXPECT_NE(scene.materials[0].haptic_warnings[0].message.find("without its height map"), std::string::npos);
  EXPECT_TRUE(scene.materials[0].haptic->height->uri.empty());
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0], "3 of 3 haptic tags were missing: 3 found again by material name, 0 lost");
}

TEST_F(TagSurvivalTest, MergedMaterialsArePartedByTheNamesOfParts) {
  const Scene scene = after(merge_materials);
  EXPECT_EQ(stiffness_by_place(scene), all_as_before()) << "paint does not feel like the first of the palette";
  EXPECT_EQ(ways(scene), std::set<std::string>{"part"});
  EXPECT_EQ(scene.tags.missing.size(), 2U) << "the palette has the tag of leather";
}

TEST_F(TagSurvivalTest, WithoutNamesThePlaceTells) {
  const Scene scene = after([](ordered_json& gltf) {
    merge_materials(gltf);
    drop_names(gltf, "nodes");
    drop_names(gltf, "meshes");
  });
  EXPECT_EQ(stiffness_by_place(scene), all_as_before());
  EXPECT_EQ(ways(scene), std::set<std::string>{"place"});
}

/// Leather and oak begin at one place of the file, whose z is our -y, and have as much surface, but do not end at one.
TEST_F(TagSurvivalTest, APlaceEndsSomewhere) {
  Scene scene = four_cubes();
  for (std::uint32_t i = 0; i < 2; ++i) {
    scene.parts[i].mesh = test::cube(10);
    for (Vec3& p : scene.parts[i].mesh.positions) {
      const Vec3 q = p + Vec3{5, 5, 5};
      p = i == 0 ? Vec3{q.x, 2 * (q.y - 10), 3 * q.z} : Vec3{3 * q.x, q.y - 10, 2 * q.z};
    }
  }
  scene.nodes[1].local = scene.nodes[0].local;
  const Scene read = after(scene, leave_only_places);
  EXPECT_EQ(ways(read), std::set<std::string>{"place"});
  int seen = 0;
  for (const Instance& use : instances(read)) {
    const Part& part = read.parts[use.part];
    double depth = 0;
    for (const Vec3& p : part.mesh.positions) depth = std::max(depth, -p.y);
    const auto& haptic = read.materials[part.materials.at(0)].haptic;
    if (use.world[3] >= 50) continue;  // The other two cubes.
    EXPECT_EQ(haptic.value().stiffness, depth > 15 ? 300 : 900);
    ++seen;
  }
  EXPECT_EQ(seen, 2);
}

TEST_F(TagSurvivalTest, AMergedTagThatNothingMissesIsTakenFromTheOthers) {
  Scene scene = four_cubes();
  scene.materials[1].haptic.reset();
  scene.materials[2].haptic.reset();
  const Scene read = after(scene, merge_materials);
  EXPECT_EQ(stiffness_by_place(read), (std::map<std::uint32_t, double>{{0, 300}, {1, 0}, {2, 0}, {3, 0}}));
  EXPECT_TRUE(read.tags.missing.empty());
}

TEST_F(TagSurvivalTest, ARenamedMaterialKeepsItsTag) {
  const Scene scene = after([](ordered_json& gltf) { gltf["materials"][1]["name"] = "Eiche"; });
  EXPECT_EQ(stiffness_by_place(scene), all_as_before());
  EXPECT_TRUE(scene.tags.missing.empty());
}

TEST_F(TagSurvivalTest, WhatIsAmbiguousIsLost) {
  Scene scene = four_cubes();
  scene.parts[1].mesh = scene.parts[0].mesh;  // Leather and oak in one place.
  scene.nodes[1].local = scene.nodes[0].local;
  const Scene read = after(scene, leave_only_places);
  ASSERT_EQ(read.tags.missing.size(), 3U);
  EXPECT_EQ(read.tags.missing[0].restored_by, "");
  EXPECT_EQ(read.tags.missing[1].restored_by, "");
  EXPECT_EQ(read.tags.missing[2].restored_by, "place");
  EXPECT_EQ(read.warnings.at(0), "3 of 3 haptic tags were missing: 1 found again by place, 2 lost: leather, oak");
}

TEST_F(TagSurvivalTest, NodesTellWhereTheAssetIsDropped) {
  const Scene scene = after([](ordered_json& gltf) {
    gltf["asset"].erase("extras");
    merge_materials(gltf);
    drop_material_extras(gltf);
  });
  EXPECT_EQ(stiffness_by_place(scene), all_as_before());
  EXPECT_EQ(scene.tags.expected, 3U);
}

TEST_F(TagSurvivalTest, TheFileAsItWasGivesAllBack) {
  write_glb(four_cubes(), folder_ / "original.glb");
  const auto drop_all = [](ordered_json& gltf) {
    drop_material_extras(gltf);
    gltf["asset"].erase("extras");
    for (ordered_json& node : gltf["nodes"]) node.erase("extras");
  };
  EXPECT_EQ(after(drop_all).tags.expected, 0U);
  const Scene scene = after(drop_all, {.tags = folder_ / "original.glb"});
  EXPECT_EQ(stiffness_by_place(scene), all_as_before());
  EXPECT_EQ(scene.materials[0].haptic, four_cubes().materials[0].haptic) << "with its height map";
  Scene untagged = four_cubes();
  for (Material& material : untagged.materials) material.haptic.reset();
  write_glb(untagged, folder_ / "untagged.glb");
  EXPECT_NE(message_of<InvalidInput>([&] {
              after(drop_all, {.tags = folder_ / "untagged.glb"});
            }).find("untagged.glb: has no haptic tag"),
            std::string::npos);
}

TEST_F(TagSurvivalTest, AMapIsTakenFromATagWithTheSame) {
  Scene scene = four_cubes();
  scene.materials[1].haptic->height = scene.materials[0].haptic->height;
  const Scene read = after(scene, [](ordered_json& gltf) { gltf["materials"][1].erase("extras"); });
  EXPECT_EQ(read.materials[1].haptic, scene.materials[1].haptic);
}

/// Maps and backing go the way of the height: within the tag, without bytes in the manifest, found by their sum.
TEST_F(TagSurvivalTest, MapsAndBackingSurviveAsTheHeightDoes) {
  Scene scene = four_cubes();
  MapsTag maps;
  maps.uri = "data:image/png;base64,AAAA";
  maps.sha256 = std::string(64, 'e');
  maps.tex_coord = scene.materials[0].haptic->height ? scene.materials[0].haptic->height->tex_coord : 0;
  maps.channels[0] = MapChannel{Quantity::stiffness, 100, 50};
  for (const std::size_t m : {0U, 1U}) {
    scene.materials[m].haptic->maps = maps;
    scene.materials[m].haptic->backing = BackingTag{1800, 2e-3};
  }
  if (scene.materials[1].haptic->height) scene.materials[1].haptic->height->tex_coord = maps.tex_coord;
  EXPECT_EQ(to_json(tag_manifest(scene)).find("base64"), std::string::npos);
  EXPECT_EQ(after(scene, [](ordered_json&) {}).materials[0].haptic, scene.materials[0].haptic);
  const Scene restored = after(scene, [](ordered_json& gltf) { gltf["materials"][1].erase("extras"); });
  ASSERT_TRUE(restored.materials[1].haptic);
  EXPECT_EQ(restored.materials[1].haptic->maps, scene.materials[1].haptic->maps) << "the picture of the other tag";
  EXPECT_EQ(restored.materials[1].haptic->backing, scene.materials[1].haptic->backing);
  const Scene all_gone = after(scene, drop_material_extras);
  ASSERT_TRUE(all_gone.materials[1].haptic && all_gone.materials[1].haptic->maps);
  EXPECT_EQ(all_gone.materials[1].haptic->maps->uri, "");
  EXPECT_EQ(all_gone.materials[1].haptic->maps->channels, maps.channels);
  ASSERT_FALSE(all_gone.materials[1].haptic_warnings.empty());
  EXPECT_NE(all_gone.materials[1].haptic_warnings.back().message.find("without its maps"), std::string::npos);
}

TEST_F(TagSurvivalTest, AManifestThatIsNoneIsIgnored) {
  for (const char* text : {"7", "{}", R"({"version":2})", R"({"version":1,"materials":[{}],"surfaces":[]})",
                           R"({"version":1,"materials":[],"surfaces":[{"material":3,"area":1}]})",
                           R"({"version":1,"materials":[{"name":"a","tag":{}}],"surfaces":[]})"}) {
    const Scene scene = after([&](ordered_json& gltf) {
      gltf["asset"]["extras"]["hapticManifest"] = ordered_json::parse(text);
      for (ordered_json& node : gltf["nodes"])
        node["extras"]["hapticMaterials"] = ordered_json::parse("[{\"area\":1}]");
    });
    EXPECT_EQ(scene.tags.expected, 0U) << text;
    EXPECT_EQ(scene.warnings.size(), 6U) << text << ": the asset's and five nodes'";
    EXPECT_EQ(stiffness_by_place(scene), all_as_before()) << text;
  }
}

}  // namespace
}  // namespace papilla
