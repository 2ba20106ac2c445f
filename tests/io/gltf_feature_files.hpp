// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "io/glb_fixture.hpp"

namespace papilla::test {

/// Valid files, one for each thing that a glTF file can hold and a scene can't: what edits have to leave alone.
class GltfFeatureFiles {
 public:
  /// Writes them into the folder.
  static std::vector<std::filesystem::path> write(const std::filesystem::path& folder) {
    const GlbFixture glb = geometry();
    std::vector<std::filesystem::path> files;
    for (const auto& [name, members] : documents()) {
      files.push_back(folder / (name + ".glb"));
      std::ofstream(files.back(), std::ios::binary) << glb.glb(members);
    }
    return files;
  }

 private:
  static constexpr int k_side = 4, k_vertices = k_side * k_side;

  /// A bent sheet of 3 × 3 quads with everything that vertices can carry. Accessors: 0 positions, 1 normals, 2 uv,
  /// 3 indices, 4 times, 5 places, 6 joints, 7 weights, 8 morph target, 9 matrix, 10 quantized positions, 11 indices of
  /// a strip, 12 positions with a sparse one.
  static GlbFixture geometry() {
    std::vector<float> points, normals, corners, deltas, weight;
    std::vector<std::int16_t> quantized;
    std::vector<std::uint8_t> joint;
    for (int i = 0; i < k_vertices; ++i) {
      const float u = static_cast<float>(i % k_side) / 3, v = static_cast<float>(i / k_side) / 3;
      points.insert(points.end(), {u, v, 0.3F * u * u});
      const float length = std::sqrt(1 + 0.36F * u * u);
      normals.insert(normals.end(), {-0.6F * u / length, 0, 1 / length});
      corners.insert(corners.end(), {u, v});
      deltas.insert(deltas.end(), {0, 0, v});
      weight.insert(weight.end(), {1, 0, 0, 0});
      joint.insert(joint.end(), {0, 0, 0, 0});
      quantized.insert(quantized.end(), {static_cast<std::int16_t>(300 * u), static_cast<std::int16_t>(300 * v),
                                         static_cast<std::int16_t>(90 * u * u), 0});
    }
    std::vector<std::uint16_t> triangles;
    for (int y = 0; y + 1 < k_side; ++y)
      for (int x = 0; x + 1 < k_side; ++x) {
        const auto at = [&](int dx, int dy) { return static_cast<std::uint16_t>((y + dy) * k_side + x + dx); };
        for (const std::uint16_t i : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)})
          triangles.push_back(i);
      }
    const std::string box = R"(,"min":[0,0,0],"max":[1,1,)";
    GlbFixture glb;
    glb.accessor(glb.view(points), 5126, k_vertices, "VEC3", box + "0.30000001192092896]");
    glb.accessor(glb.view(normals), 5126, k_vertices, "VEC3");
    glb.accessor(glb.view(corners), 5126, k_vertices, "VEC2");
    glb.accessor(glb.view(triangles), 5123, triangles.size(), "SCALAR");
    glb.accessor(glb.view(std::vector<float>{0, 1}), 5126, 2, "SCALAR", R"(,"min":[0],"max":[1])");
    glb.accessor(glb.view(std::vector<float>{0, 0, 0, 3, 0, 0}), 5126, 2, "VEC3");
    glb.accessor(glb.view(joint), 5121, k_vertices, "VEC4");
    glb.accessor(glb.view(weight), 5126, k_vertices, "VEC4");
    glb.accessor(glb.view(deltas), 5126, k_vertices, "VEC3", R"(,"min":[0,0,0],"max":[0,0,1])");
    glb.accessor(glb.view(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), 5126, 1, "MAT4");
    glb.accessor(glb.view(quantized, R"(,"byteStride":8)"), 5122, k_vertices, "VEC3",
                 R"(,"min":[0,0,0],"max":[300,300,90])");
    glb.accessor(glb.view(std::vector<std::uint16_t>{0, 1, 4, 5, 8, 9, 12, 13}), 5123, 8, "SCALAR");
    const int number = glb.view(std::vector<std::uint16_t>{15}), value = glb.view(std::vector<float>{1, 1, 1});
    glb.accessor(0, 5126, k_vertices, "VEC3",
                 box + R"(1],"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(number) +
                     R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(value) + "}}");
    return glb;
  }

  static std::string primitive(const std::string& attributes = {}, const std::string& more = R"(,"material":0)") {
    return R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2)" + attributes + R"(},"indices":3)" + more + "}";
  }

  static std::string mesh(const std::string& primitives, const std::string& more = "") {
    return R"({"name":"sheet","primitives":[)" + primitives + "]" + more + "}";
  }

  /// Nodes and meshes without their brackets.
  static std::string scene(const std::string& nodes, const std::string& meshes, const std::string& roots = "0") {
    return R"("scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes + R"(],"meshes":[)" + meshes + "],";
  }

  static std::string with_extension(const std::string& name) { return R"("extensionsUsed":[")" + name + "\"],"; }

  static std::vector<std::pair<std::string, std::string>> documents() {
    const std::string one = scene(R"({"name":"a","mesh":0})", mesh(primitive()));
    const std::string paint = R"("materials":[{"name":"paint"}],)";
    const auto channel = [](const std::string& target) {
      return R"("animations":[{"samplers":[{"input":4,"output":5}],"channels":[{"sampler":0,"target":)" + target +
             "}]}],";
    };
    return {
        {"plain", one + paint},
        {"no-material", scene(R"({"mesh":0})", mesh(primitive("", "")))},
        {"camera-and-light",
         scene(R"({"mesh":0},{"camera":0},{"extensions":{"KHR_lights_punctual":{"light":0}}})", mesh(primitive()),
               "0,1,2") +
             R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"extensions":{)"
             R"("KHR_lights_punctual":{"lights":[{"type":"point","name":"lamp"}]}},)" +
             with_extension("KHR_lights_punctual") + paint},
        {"animation", one + paint + channel(R"({"node":0,"path":"translation"})")},
        {"animation-pointer",
         scene(R"({"name":"a","mesh":0},{"name":"b","mesh":1})", mesh(primitive()) + "," + mesh(primitive()), "0,1") +
             R"("materials":[{"name":"paint","emissiveFactor":[1,1,1]}],)" +
             channel(R"({"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":)"
                     R"("/materials/0/emissiveFactor"}}})") +
             with_extension("KHR_animation_pointer")},
        {"skin",
         scene(R"({"mesh":0,"skin":0},{"name":"bone"})", mesh(primitive(R"(,"JOINTS_0":6,"WEIGHTS_0":7)")), "0,1") +
             R"("skins":[{"joints":[1],"inverseBindMatrices":9}],)" + paint},
        {"morph", scene(R"({"mesh":0,"weights":[0.25]})",
                        mesh(primitive("", R"(,"material":0,"targets":[{"POSITION":8}])"), R"(,"weights":[0.5])")) +
                      paint},
        {"variants",
         scene(R"({"mesh":0})",
               mesh(primitive("", R"(,"material":0,"extensions":{"KHR_materials_variants":{"mappings":[)"
                                  R"({"material":1,"variants":[0]}]}})"))) +
             R"("extensions":{"KHR_materials_variants":{"variants":[{"name":"night"}]}},"materials":[{"name":"day"},)"
             R"({"name":"dark"}],)" +
             with_extension("KHR_materials_variants")},
        {"two-scenes", R"("scene":1,"scenes":[{"name":"x","nodes":[0]},{"nodes":[1]}],"nodes":[{"mesh":0},)"
                       R"({"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,2,1]}],"meshes":[)" +
                           mesh(primitive()) + "," + mesh(primitive()) + "]," + paint},
        {"instances", scene(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":5}}}})",
                            mesh(primitive())) +
                          with_extension("EXT_mesh_gpu_instancing") + paint},
        {"levels", scene(R"({"mesh":0,"extensions":{"MSFT_lod":{"ids":[1]}},"extras":{"MSFT_screencoverage":[0.5,0]}},)"
                         R"({"mesh":1})",
                         mesh(primitive()) + "," + mesh(primitive())) +
                       with_extension("MSFT_lod") + paint},
        {"shared-levels",
         scene(R"({"name":"a","mesh":0,"extensions":{"MSFT_lod":{"ids":[2]}}},)"
               R"({"name":"b","mesh":0,"extensions":{"MSFT_lod":{"ids":[3]}}},{"mesh":1},{"mesh":1})",
               mesh(primitive()) + R"(,{"name":"sheet_LOD1","primitives":[)" + primitive() + "]}", "0,1") +
             with_extension("MSFT_lod") + paint},
        {"shared-mesh",
         scene(
             R"({"name":"a","mesh":0,"skin":0,"weights":[0.25]},{"name":"b","mesh":0,"skin":0,"translation":[2,0,0]},)"
             R"({"name":"c","mesh":0,"skin":0},{"name":"bone"},{"name":"eye","camera":0},)"
             R"({"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}})",
             mesh(primitive(R"(,"JOINTS_0":6,"WEIGHTS_0":7)",
                            R"(,"material":0,"targets":[{"POSITION":8}],"extensions":{"KHR_materials_variants":)"
                            R"({"mappings":[{"material":1,"variants":[0]}]}})"),
                  R"(,"weights":[0.5],"extras":{"id":7})"),
             "0,1,2,3,4,5") +
             R"("skins":[{"joints":[3],"inverseBindMatrices":9}],"materials":[{"name":"day"},{"name":"dark"}],)"
             R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"extensions":{)"
             R"("KHR_lights_punctual":{"lights":[{"type":"point","name":"lamp"}]},)"
             R"("KHR_materials_variants":{"variants":[{"name":"night"}]}},)"
             R"("animations":[{"samplers":[{"input":4,"output":5},{"input":4,"output":4}],"channels":[)"
             R"({"sampler":0,"target":{"node":1,"path":"translation"}},{"sampler":1,"target":{"path":"pointer",)"
             R"("extensions":{"KHR_animation_pointer":{"pointer":"/meshes/0/weights/0"}}}},)"
             R"({"sampler":1,"target":{"node":0,"path":"weights"}}]}],)"
             R"("extensionsUsed":["KHR_lights_punctual","KHR_materials_variants","KHR_animation_pointer"],)"},
        {"material-levels", one + R"("materials":[{"name":"fine","extensions":{"MSFT_lod":{"ids":[1]}}},{}],)" +
                                with_extension("MSFT_lod")},
        {"vendor",
         scene(R"({"mesh":0,"extensions":{"ACME_seat":{"row":[1,2.50]}},"extras":"text"})",
               mesh(primitive("", R"(,"material":0,"extensions":{"ACME_weld":{"edges":3}},"extras":[1])"),
                    R"(,"extras":{"id":7})")) +
             R"("extensions":{"ACME_seat":{}},"extras":{"a~b":{"c/d":null}},"materials":[{"extensions":)"
             R"({"ACME_weld":{"k":1e-7}},"extras":{"own":true}},{"name":"unused"}],"extensionsUsed":["ACME_seat",)"
             R"("ACME_weld"],)"},
        {"xmp", one + R"("extensions":{"KHR_xmp_json_ld":{"packets":[{"@context":{},"dc:title":"sheet"}]}},)" +
                    with_extension("KHR_xmp_json_ld") + paint},
        {"quantized", R"("extensionsRequired":["KHR_mesh_quantization"],)" + with_extension("KHR_mesh_quantization") +
                          scene(R"({"mesh":0,"scale":[0.01,0.01,0.01]})",
                                mesh(R"({"attributes":{"POSITION":10,"NORMAL":1},"indices":3,"material":0})")) +
                          paint},
        {"strip", scene(R"({"mesh":0})", mesh(R"({"attributes":{"POSITION":0},"indices":11,"mode":5})"))},
        {"sparse", scene(R"({"mesh":0})", mesh(R"({"attributes":{"POSITION":12},"indices":3})"))},
        {"shared-vertices", scene(R"({"mesh":0})", mesh(primitive() + "," + primitive("", R"(,"material":1)"))) +
                                R"("materials":[{"name":"x"},{"name":"y"}],)"},
        {"points",
         scene(R"({"mesh":0})", mesh(primitive() + R"(,{"attributes":{"POSITION":0},"mode":0,"material":0})")) + paint},
    };
  }
};

}  // namespace papilla::test
