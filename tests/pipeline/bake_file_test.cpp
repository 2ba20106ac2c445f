// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "io/glb_fixture.hpp"
#include "io/gltf_comparison.hpp"
#include "io/gltf_feature_files.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"
#include "pipeline/room_fixture.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// What the Khronos validator said of a file, where that stands beside it.
bool is_known_as_invalid(const fs::path& file) {
  const fs::path report = file.string() + ".report.json";
  return fs::exists(report) && nlohmann::json::parse(read_file(report)).at("issues").at("numErrors") > 0;
}

/// GltfFeatureFiles and what other programs wrote: files of data/exchange, and of the folder named by
/// PAPILLA_SHARED_DATA.
/// @param valid  false: those that are invalid and read nonetheless.
std::vector<fs::path> gltf_files(bool valid = true) {
  static const test::TemporaryFolder generated;
  std::vector<fs::path> files;
  if (valid) {
    files = test::GltfFeatureFiles::write(generated.path());
    for (const char* name : {"exchange/vent.glb", "exchange/vent.gltf"}) files.push_back(fs::path(PAPILLA_DATA) / name);
  }
  const char* shared = std::getenv("PAPILLA_SHARED_DATA");
  if (shared == nullptr) return files;
  for (const auto& entry : fs::recursive_directory_iterator(shared)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".glb" && file.extension() != ".gltf") continue;
    if (is_known_as_invalid(file) == valid) continue;
    try {
      read_gltf(file);
      files.push_back(file);
    } catch (const Error&) {  // Invalid ones are refused, which others test.
    }
  }
  return files;
}

class BakeFileTest : public testing::Test {
 protected:
  BakeFileTest() {
    GrainOptions options;
    options.size_px = 32;
    write_grey_image(folder_ / "grain.png", synthesize_grain(GrainKind::spheres6, options).picture, 8);
    MaterialRule grain;
    grain.name = "grain";
    grain.texture = folder_ / "grain.png";
    grain.size_mm[0] = grain.size_mm[1] = 40;
    grain.stiffness = 900;
    MaterialRule hard;
    hard.name = "hard";
    hard.stiffness = 2000;
    rules_.materials = {{"grain", grain}, {"hard", hard}};
  }

  void assign(const std::string& part, const std::string& material) {
    AssignRule rule;
    rule.part = part;
    rule.material = material;
    rules_.assign.push_back(rule);
  }

  void assign_node(const std::string& path, const std::string& material) {
    AssignRule rule;
    rule.node = path;
    rule.material = material;
    rules_.assign.push_back(rule);
  }

  /// One of GltfFeatureFiles.
  fs::path feature(const std::string& name) const {
    test::GltfFeatureFiles::write(folder_.path());
    return folder_ / (name + ".glb");
  }

  fs::path out() const { return folder_ / "out.glb"; }

  BakeFileResult bake(const fs::path& file) { return bake(file, out()); }

  BakeFileResult bake(const fs::path& file, const fs::path& output) {
    BakeFileResult result = bake_file(file, output, rules_, {});
    EXPECT_TRUE(result.way.in_place);
    EXPECT_TRUE(result.scene.losses.empty());
    const auto differences = test::unlisted_differences(file, output, result.changes);
    EXPECT_TRUE(differences.empty()) << file << ": " << differences.front();
    return result;
  }

  const test::TemporaryFolder folder_;
  Materials rules_;
};

/// Where a file becomes one GLB, buffers and pictures move into it.
const std::string k_container =
    R"(/buffers.*|/bufferViews(/\d+(/(buffer|byteOffset|extensions/.*))?)?|/images/\d+/\w+)";

TEST_F(BakeFileTest, ConstantsChangeExtrasAndNothingElse) {
  assign("*", "hard");
  const std::regex allowed(
      R"(/materials/\d+/extras(/haptic|/papilla)?(/\w+)*|/(nodes/\d+|asset)/extras(/haptic\w+)?(/.*)?)");
  const std::regex new_material(R"(/materials(/\d+)?|/meshes/\d+/primitives/\d+/material)"), container(k_container);
  std::size_t number = 0;
  for (const fs::path& file : gltf_files())
    for (const std::string extension : {".glb", ".gltf"}) {
      // A folder each: files of one name belong to different scenes.
      const fs::path output = folder_ / std::to_string(number++) / ("out" + extension);
      fs::create_directories(output.parent_path());
      for (const GltfChange& change : bake(file, output).changes)
        EXPECT_TRUE(
            std::regex_match(change.pointer, allowed) || std::regex_match(change.pointer, new_material) ||
            (file.extension() == ".gltf" && extension == ".glb" && std::regex_match(change.pointer, container)) ||
            (file.extension() == ".glb" && extension == ".gltf" && change.pointer == "/buffers/0/uri"))
            << file << ": " << change.kind << " " << change.pointer;
      fs::remove_all(output.parent_path());
    }
}

/// The corners of every triangle of a part, as far as both files must agree.
void expect_same_triangles(const Part& before, const Part& after, const fs::path& file) {
  const TriangleMesh &a = before.mesh, &b = after.mesh;
  ASSERT_EQ(a.triangles.size(), b.triangles.size()) << file << ": " << before.name;
  for (std::size_t t = 0; t < a.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(a.corner(t, static_cast<int>(k)), b.corner(t, static_cast<int>(k))) << file;
      const auto expect_same = [&](const auto& x, const auto& y) {
        if (x.has_value(t)) {
          ASSERT_TRUE(y.has_value(t)) << file;
          ASSERT_EQ(x.values[x.indices[t][k]], y.values[y.indices[t][k]]) << file;
        }
      };
      expect_same(a.normals, b.normals);
      expect_same(a.uv, b.uv);
      expect_same(a.colors, b.colors);
    }
}

bool is_flat(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a) == 0; }

/// A flag a triangle of the part.
std::vector<std::uint8_t> turned_triangles(const BakeFileResult& result, std::uint32_t part, std::size_t count) {
  std::vector<std::uint8_t> turned(count, 0);
  for (const PartSurface& surface : result.plan.surfaces)
    for (std::size_t i = 0; surface.part == part && i < surface.turned.size(); ++i)
      turned[surface.triangles[i]] = surface.turned[i];
  return turned;
}

/// What the reader leaves out, beside the new channel; of all meshes once, for some may be copies.
std::set<std::string> losses_of(const fs::path& file) {
  std::set<std::string> losses;
  for (const std::string& loss : read_gltf(file).losses)
    if (!loss.starts_with("TEXCOORD_")) losses.insert(loss.substr(0, loss.find(" of mesh ")));
  return losses;
}

TEST_F(BakeFileTest, NewUvBecomeOneMoreChannelAndAllElseStays) {
  rules_.materials.at("grain").unwrap = "triplanar";
  assign("*", "grain");
  for (const fs::path& file : gltf_files()) {
    const BakeFileResult result = bake(file);
    Scene before = read_gltf(file, {.coarser_parts = true});
    const Scene after = read_gltf(out(), {.tag_channel = true, .coarser_parts = true});
    for (std::uint32_t p = 0; p < before.parts.size(); ++p)
      turn_triangles(before.parts[p].mesh, turned_triangles(result, p, before.parts[p].mesh.triangles.size()));
    ASSERT_EQ(before.parts.size(), after.parts.size()) << file;
    EXPECT_EQ(before.nodes.size(), after.nodes.size()) << file;
    EXPECT_EQ(losses_of(file), losses_of(out())) << file;
    for (std::size_t p = 0; p < before.parts.size(); ++p) {
      const Part& part = after.parts[p];
      expect_same_triangles(before.parts[p], part, file);
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        const Vec3 a = part.mesh.corner(t, 0), b = part.mesh.corner(t, 1), c = part.mesh.corner(t, 2);
        const Material& material =
            after.materials[part.materials[part.mesh.material.empty() ? 0 : part.mesh.material[t]]];
        ASSERT_TRUE(material.haptic && material.haptic->height) << file << ": " << part.name;
        const auto& uv = material.haptic->height->tex_coord == 1 ? part.mesh.uv1 : part.mesh.uv;
        ASSERT_TRUE(uv.has_value(t)) << file << ": " << part.name;
        const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
        const bool is_degenerate = norm(cross(b - a, c - a)) <= std::max(1e-3, 1e-4 * longest) * longest;
        const Triangle& i = uv.indices[t];
        EXPECT_TRUE(is_degenerate || !is_flat(uv.values[i[0]], uv.values[i[1]], uv.values[i[2]]))
            << file << ": " << part.name;
      }
    }
  }
}

/// The room, its left and right wall facing out.
fs::path room_file(const fs::path& folder) {
  Scene scene = test::room();
  for (const std::size_t wall : {2U, 3U}) test::turn_all(scene.parts[wall].mesh);
  write_glb(scene, folder / "room.glb");
  return folder / "room.glb";
}

Vec3 first_normal(const Scene& scene, const std::string& name) {
  const auto part = std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return p.name == name; });
  const TriangleMesh& m = part->mesh;
  const Vec3 flat = normalized(cross(m.corner(0, 1) - m.corner(0, 0), m.corner(0, 2) - m.corner(0, 0)));
  EXPECT_GT(dot(flat, m.normals.values[m.normals.indices[0][0]]), 0.99) << name;
  return flat;
}

TEST_F(BakeFileTest, SheetsAreTurnedWhereTheyGetRelief) {
  assign("left", "grain");
  assign("*", "hard");
  const fs::path file = room_file(folder_.path());
  const BakeFileResult result = bake(file);
  const Scene before = read_gltf(file), after = read_gltf(out());
  EXPECT_EQ(first_normal(after, "left"), -1.0 * first_normal(before, "left"));
  EXPECT_EQ(first_normal(after, "right"), first_normal(before, "right"));
  EXPECT_EQ(result.plan.sides.facing_away, 2U);
  for (const PartSides& part : result.plan.sides.parts) {
    EXPECT_EQ(part.left_facing_away, part.part == "right" ? 1U : 0U) << part.part;
    EXPECT_EQ(part.turned_triangles, part.part == "left" ? 32U : 0U) << part.part;
  }
  const auto is_listed = [&](const std::string& pointer) {
    return std::any_of(result.changes.begin(), result.changes.end(),
                       [&](const GltfChange& change) { return change.pointer == pointer; });
  };
  EXPECT_TRUE(is_listed("/meshes/2/primitives/0/indices"));
  EXPECT_FALSE(is_listed("/meshes/3/primitives/0/indices"));
}

/// The coarser mesh has other vertices; who looks at the wall from afar sees it from the same side.
TEST_F(BakeFileTest, CoarserLevelsOfASheetThatIsTurnedAreTurned) {
  Scene scene = test::room();
  for (const std::size_t wall : {2U, 3U}) {
    Part& part = scene.parts[wall];
    PartLevel level;
    level.mesh = part.mesh;
    level.mesh.triangles.resize(20);
    level.mesh.material.clear(), level.mesh.normals = {};
    level.screen_coverage = 0.1;
    part.levels = {level};
    test::turn_all(part.mesh);
    test::turn_all(part.levels[0].mesh);
  }
  const fs::path file = folder_ / "room.glb";
  write_glb(scene, file);
  assign("left", "grain");
  assign("*", "hard");
  const BakeFileResult result = bake(file);
  const Scene before = read_gltf(file, {.coarser_parts = true}), after = read_gltf(out(), {.coarser_parts = true});
  ASSERT_EQ(before.parts.size(), 8U);
  ASSERT_EQ(after.parts.size(), 8U);
  std::size_t levels = 0;
  for (std::size_t p = 0; p < 8; ++p) {
    const bool is_turned = before.parts[p].name == "left";
    levels += before.parts[p].mesh.triangles.size() == 20;
    const TriangleMesh &a = before.parts[p].mesh, &b = after.parts[p].mesh;
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
      EXPECT_EQ(a.corner(t, 0), b.corner(t, 0));
      EXPECT_EQ(a.corner(t, 1), b.corner(t, is_turned ? 2 : 1)) << before.parts[p].name;
      const Vec3 normal = normalized(cross(b.corner(t, 1) - b.corner(t, 0), b.corner(t, 2) - b.corner(t, 0)));
      EXPECT_GT(dot(normal, b.normals.values[b.normals.indices[t][0]]), 0.99) << before.parts[p].name;
    }
    const std::string pointer = "/meshes/" + std::to_string(p) + "/primitives/0/indices";
    EXPECT_EQ(std::any_of(result.changes.begin(), result.changes.end(),
                          [&](const GltfChange& change) { return change.pointer == pointer; }),
              is_turned);
  }
  EXPECT_EQ(levels, 2U);
}

/// A strip with one side is seen from both.
TEST_F(BakeFileTest, CoarserLevelsOfASheetThatBecomesDoubleSidedDoSo) {
  Scene scene = test::room();
  PartLevel level;
  level.mesh = test::moebius_strip(50, 20, 12, 1);
  level.screen_coverage = 0.1;
  test::add_part(scene, "strip", test::moebius_strip(50, 20, 24, 2), {0});
  for (TriangleMesh* mesh : {&level.mesh, &scene.parts.back().mesh})
    for (Vec3& position : mesh->positions) position = position + Vec3{500, 500, 500};
  scene.parts.back().levels = {level};
  const fs::path file = folder_ / "room.glb";
  write_glb(scene, file);
  rules_.materials.at("grain").unwrap = "triplanar";
  assign("strip", "grain");
  assign("*", "hard");
  bake(file);
  const auto json = test::RawGltf(out()).json;
  std::size_t double_sided = 0;
  for (const auto& mesh : json["meshes"]) {
    const bool is_strip = mesh["name"].get<std::string>().starts_with("strip");
    EXPECT_EQ(json["materials"][mesh["primitives"][0]["material"].get<std::size_t>()].value("doubleSided", false),
              is_strip)
        << mesh["name"];
    double_sided += is_strip;
  }
  EXPECT_EQ(double_sided, 2U);
}

/// The stiffness that a node of the file shows, with its only primitive.
double stiffness_of(const nlohmann::ordered_json& json, std::size_t node) {
  const auto& primitive = json["meshes"][json["nodes"][node]["mesh"].get<std::size_t>()]["primitives"][0];
  return json["materials"][primitive["material"].get<std::size_t>()]["extras"]["haptic"]["stiffness"];
}

void expect_only_b_is_hard(const Scene& scene) {
  for (const Node& node : scene.nodes) {
    if (!node.part) continue;
    const Material& material = scene.materials[scene.parts[*node.part].materials[0]];
    EXPECT_EQ(material.haptic.value().stiffness, node.name == "b" ? 2000 : 900) << node.name;
  }
}

TEST_F(BakeFileTest, UsesOfAMeshThatGetDifferentMaterialsGetMeshesOfTheirOwn) {
  assign_node("b", "hard");
  assign("*", "grain");
  rules_.materials.at("grain").unwrap = "triplanar";
  const fs::path file = feature("shared-mesh");
  const BakeFileResult result = bake(file);
  const auto before = test::RawGltf(file).json, after = test::RawGltf(out()).json;
  ASSERT_EQ(before["meshes"].size(), 1U);
  ASSERT_EQ(after["meshes"].size(), 2U);
  EXPECT_EQ(after["meshes"][1]["name"], "sheet");
  EXPECT_EQ(after["meshes"][1]["weights"], before["meshes"][0]["weights"]);
  EXPECT_EQ(after["meshes"][1]["extras"], before["meshes"][0]["extras"]);
  const auto &was = before["meshes"][0]["primitives"][0], &copy = after["meshes"][1]["primitives"][0];
  for (const char* member : {"attributes", "indices", "targets"}) EXPECT_EQ(copy[member], was[member]) << member;
  for (const std::size_t node : {0U, 1U, 2U}) {
    EXPECT_EQ(after["nodes"][node]["mesh"], node == 1 ? 1 : 0);
    EXPECT_EQ(stiffness_of(after, node), node == 1 ? 2000 : 900);
  }
  // The variant of each has the tag, too.
  for (const std::size_t mesh : {0U, 1U}) {
    const auto& mapping = after["meshes"][mesh]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][0];
    EXPECT_EQ(after["materials"][mapping["material"].get<std::size_t>()]["extras"]["haptic"]["stiffness"],
              mesh == 1 ? 2000 : 900);
  }
  for (const char* member : {"skins", "cameras", "extensions", "scenes"}) EXPECT_EQ(after[member], before[member]);
  for (std::size_t i = 0; i < before["nodes"].size(); ++i) {
    auto node = after["nodes"][i];
    node.erase("extras"), node["mesh"] = before["nodes"][i].value("mesh", nlohmann::ordered_json());
    if (node["mesh"].is_null()) node.erase("mesh");
    EXPECT_EQ(node, before["nodes"][i]);
  }
  auto channels = after["animations"][0]["channels"];
  ASSERT_EQ(channels.size(), 4U);
  EXPECT_EQ(channels[3]["target"]["extensions"]["KHR_animation_pointer"]["pointer"], "/meshes/1/weights/0");
  channels.erase(3);
  EXPECT_EQ(channels, before["animations"][0]["channels"]);
  const auto lists = [&](const std::string& change) {
    return std::any_of(result.changes.begin(), result.changes.end(),
                       [&](const GltfChange& c) { return c.kind + " " + c.pointer == change; });
  };
  EXPECT_TRUE(lists("added /meshes/1"));
  EXPECT_TRUE(lists("changed /nodes/1/mesh"));
  EXPECT_FALSE(lists("changed /nodes/0/mesh"));

  const Scene scene = read_gltf(out());
  EXPECT_TRUE(scene.tags.missing.empty());
  expect_only_b_is_hard(scene);

  // With the same rules once more nothing is split.
  fs::rename(out(), folder_ / "once.glb");
  for (const GltfChange& change : bake(folder_ / "once.glb").changes)
    EXPECT_FALSE(change.kind == "added" && !change.pointer.starts_with("/bufferViews") &&
                 !change.pointer.starts_with("/accessors"))
        << change.pointer;
}

TEST_F(BakeFileTest, TagsOfASplitMeshAreFoundAgainByPlace) {
  assign_node("b", "hard");
  assign("*", "grain");
  bake(feature("shared-mesh"), folder_ / "out.gltf");
  auto json = nlohmann::ordered_json::parse(read_file(folder_ / "out.gltf"));
  for (auto& material : json["materials"]) material.erase("extras"), material["name"] = "lost";
  folder_.write("out.gltf", json.dump());
  const Scene scene = read_gltf(folder_ / "out.gltf");
  EXPECT_EQ(scene.tags.missing.size(), 2U);
  expect_only_b_is_hard(scene);
}

/// Levels of a use get what the use gets, by whatever name the rule means it.
TEST_F(BakeFileTest, CoarserLevelsOfUsesThatGetDifferentMaterialsAreSplitWithThem) {
  assign_node("b", "hard");
  assign_node("a", "grain");
  bake(feature("shared-levels"));
  const auto json = test::RawGltf(out()).json;
  ASSERT_EQ(json["meshes"].size(), 4U);
  for (const std::size_t node : {0U, 1U, 2U, 3U})
    EXPECT_EQ(stiffness_of(json, node), node % 2 == 1 ? 2000 : 900) << node;
  EXPECT_EQ(json["nodes"][0]["mesh"], 0);
  EXPECT_EQ(json["nodes"][2]["mesh"], 1);
  EXPECT_EQ(json["meshes"][json["nodes"][3]["mesh"].get<std::size_t>()]["name"], "sheet_LOD1");
}

TEST_F(BakeFileTest, InstancesOfOneNodeThatGetDifferentMaterialsAreWrittenAnew) {
  const fs::path file = feature("instances");
  assign_node("**/#1", "hard");
  BakeFileResult result = bake_file(file, out(), rules_, {});
  EXPECT_FALSE(result.way.in_place);
  EXPECT_NE(result.way.reason.find("EXT_mesh_gpu_instancing"), std::string::npos) << result.way.reason;
  EXPECT_EQ(plan_file(file, rules_, {}).way.reason, result.way.reason);
  rules_.assign.clear();
  assign_node("**/#*", "hard");
  bake(file);
}

/// The first use of the first part that has several gets another material than all others.
TEST_F(BakeFileTest, AMeshOfAnyFileIsSplitInPlace) {
  rules_.materials.at("grain").unwrap = "triplanar";
  std::size_t split = 0;
  for (const fs::path& file : gltf_files()) {
    GltfOrigin origin;
    const Scene before = read_gltf(file, {}, &origin);
    const std::vector<SurfacePlace> places = surface_places(before);
    const auto is_other_use = [&](const SurfacePlace& a, const SurfacePlace& b) {
      return a.part == b.part && a.node && b.node && a.nodes != b.nodes &&
             origin.nodes[*a.node] != origin.nodes[*b.node];
    };
    const auto first = std::find_if(places.begin(), places.end(), [&](const SurfacePlace& place) {
      const bool has_path = std::count_if(places.begin(), places.end(), [&](const SurfacePlace& other) {
                              return other.nodes == place.nodes && other.node != place.node;
                            }) == 0;
      return has_path && std::any_of(places.begin(), places.end(),
                                     [&](const SurfacePlace& other) { return is_other_use(place, other); });
    });
    if (first == places.end() || first->nodes[0].find_first_of("*?[\\") != std::string::npos) continue;
    rules_.assign.clear();
    assign_node(first->nodes[0], "hard");
    assign("*", "grain");
    const BakeFileResult result = bake(file);
    const auto json = test::RawGltf(out()).json;
    EXPECT_EQ(json["meshes"].size(), test::RawGltf(file).json["meshes"].size() + result.plan.split.size()) << file;
    const Scene after = read_gltf(out());
    ASSERT_EQ(after.nodes.size(), before.nodes.size()) << file;
    EXPECT_EQ(losses_of(file), losses_of(out())) << file;
    for (std::size_t n = 0; n < after.nodes.size(); ++n) {
      if (!after.nodes[n].part) continue;
      const Part& part = after.parts[*after.nodes[n].part];
      const bool is_hard = origin.nodes[n] == origin.nodes[*first->node];
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        const std::uint32_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
        ASSERT_EQ(after.materials[part.materials[slot]].haptic.value().stiffness, is_hard ? 2000 : 900)
            << file << ": " << after.nodes[n].name;
      }
      EXPECT_EQ(part.mesh.triangles.size(), before.parts[*before.nodes[n].part].mesh.triangles.size()) << file;
    }
    ++split;
  }
  EXPECT_GE(split, 3U);
}

TEST_F(BakeFileTest, InvalidFilesAreEditedOrRefused) {
  assign("*", "grain");
  for (const fs::path& file : gltf_files(false)) try {
      bake(file);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << file;
    }
}

TEST_F(BakeFileTest, ABakedFileIsBakedAgainWithoutGrowingChannels) {
  rules_.materials.at("grain").unwrap = "triplanar";
  assign("*", "grain");
  const fs::path once = folder_ / "once.glb";
  bake_file(fs::path(PAPILLA_DATA) / "exchange/vent.glb", once, rules_, {});
  const BakeFileResult twice = bake(once);
  const std::regex grown(R"(/(materials|textures|images|samplers|meshes|nodes|asset)\b.*)");
  for (const GltfChange& change : twice.changes) {
    EXPECT_FALSE(change.kind == "added" && std::regex_match(change.pointer, grown)) << change.pointer;
    EXPECT_FALSE(change.pointer.ends_with("/texCoord")) << change.pointer;
  }
}

TEST_F(BakeFileTest, OtherInputAndWhatChangesMeshesIsWrittenAnew) {
  BakeFileOptions options;
  EXPECT_TRUE(bake_way("a.glb", options).in_place);
  EXPECT_TRUE(bake_way("a.GLTF", options).in_place);
  EXPECT_TRUE(bake_way("a.Gltf", options).in_place);
  EXPECT_FALSE(bake_way("a.step", options).in_place);
  options.bake.plan.budget = 1000;
  EXPECT_FALSE(bake_way("a.glb", options).in_place);
  options.bake.plan.budget.reset();
  options.read.up = UpAxis::z;
  EXPECT_FALSE(bake_way("a.glb", options).in_place);
  options.read.up.reset();
  options.bake.plan.perception.leave_out_unseen = true;
  EXPECT_FALSE(bake_way("a.glb", options).in_place);
  options.bake.plan.perception.leave_out_unseen = false;
  options.write.mirror_khr_physics = true;
  EXPECT_FALSE(bake_way("a.glb", options).in_place);
}

}  // namespace
}  // namespace papilla
