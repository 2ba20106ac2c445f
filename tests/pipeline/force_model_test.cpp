// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/pipeline/bake_file.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// From MATERIALS.json through the baked file to the hand.
class ForceModelFile : public testing::Test {
 protected:
  ForceModelFile() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "plate.obj") << "o plate\nv 0 0 0\nv 80 0 0\nv 80 60 0\nv 0 60 0\nf 1 2 3\nf 1 3 4\n";
  }
  ~ForceModelFile() override { fs::remove_all(folder_); }

  MaterialTag bake(const std::string& members) {
    std::ofstream(folder_ / "m.json") << R"({"materials": {"grain": {"texture": "fbm|h=.8", "size_mm": [40, 30],
        "stiffness": 400, "height": {"depth_mm": 0.2}, )" +
                                             members + R"(}}, "assign": [{"part": "*", "material": "grain"}]})";
    BakeFileOptions options;
    bake_file(folder_ / "plate.obj", glb(), read_materials(folder_ / "m.json"), options, {});
    for (const Material& material : read_gltf(glb(), {.tag_channel = true}).materials)
      if (material.haptic && material.haptic->height) return *material.haptic;
    ADD_FAILURE() << "no tag";
    return {};
  }
  fs::path glb() const { return folder_ / "plate.glb"; }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-force-model-" + std::to_string(::getpid()));
};

/// A stroke 0.4 mm below the plate: the force of the tick, and the one put together from its proxy.
void expect_stimulus(const HapticScene& scene) {
  const ContactSurface surface(scene.mesh, scene.materials, scene.heights, scene.probe_radius_m, scene.channels);
  const auto tick = std::make_unique<HapticTick>(
      surface, SafetyLimits{.max_force_n = 100, .slew_n_per_s = 1e9, .soft_start_s = 0}, 1e-3);
  Stimulus stimulus(surface);
  BristleFriction bristles;
  DeviceState device;
  // Face up along y: the file has its z axis there.
  const Vec3 middle = 0.5 * (surface.low() + surface.high());
  const auto near = surface.closest_point(middle, 1);
  ASSERT_TRUE(near);
  const Vec3 up = near->face_normal, way = normalized(cross(up, {0.3, 0.5, 0.8}));
  device.position = middle + 0.01 * up;
  tick->reset(device.position);
  Vec3 last = device.position, velocity;
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    device.position = middle + (scene.probe_radius_m - 4e-4) * up + (5e-5 * i) * way;
    const Vec3 force = (*tick)(device);
    const Vec3 moved = device.position - last;
    velocity = velocity + 0.5 * (1e3 * moved - velocity);
    last = device.position;
    const ProxyState& state = tick->proxy();
    ASSERT_TRUE(state.in_contact) << i;
    const ContactMaterial& material = surface.material(state.material);
    Vec3 expected;
    if (material.model == ForceModel::textured_normal) {
      const Vec3 to = way_to_textured_surface(surface, state, device.position);
      expected = textured_normal_force(material, to, velocity);
      expected = expected + bristles.force(material, normalized(to), norm(expected), moved, 1e-3);
      most = std::max(most, norm(expected - dot(expected, up) * up));
    } else {
      const Vec3 smooth = heightfield_force(surface, state, device.position, velocity);
      expected = stimulus.force(state, device.position, velocity, 1e-3, smooth);
      most = std::max(most, norm(expected - smooth));
    }
    EXPECT_LT(norm(force - expected), 1e-9) << i;
  }
  EXPECT_GT(most, 1e-3);
}

TEST_F(ForceModelFile, ReachesTheHandThroughTheBakedFile) {
  struct Case {
    const char* members;
    ForceModelTag tag;
    ForceModel model;
    StimulusForm form;
  };
  for (const auto& [members, tag, model, form] :
       {Case{R"("forceModel": {"name": "lateral", "amplitude": 0.012, "sign": "literal", "form": "displacement"})",
             {"lateral", 0.012, true, "displacement", 8},
             ForceModel::lateral,
             StimulusForm::displacement},
        Case{R"("forceModel": {"name": "graph", "sign": "physical", "form": "place", "level": 6})",
             {"graph-orthogonal", 0.01, false, "place", 6},
             ForceModel::graph_orthogonal,
             StimulusForm::place},
        Case{R"("forceModel": {"name": "orthogonal", "amplitude": 0.02})",
             {"orthogonal", 0.02, false, "", 8},
             ForceModel::orthogonal,
             StimulusForm::usual},
        Case{R"("staticFriction": 0.4, "frictionModel": {"name": "bristle", "stiffness": 200},
                "forceModel": {"name": "textured-normal"})",
             {"textured-normal", 0.01, false, "", 8},
             ForceModel::textured_normal,
             StimulusForm::usual}}) {
    const MaterialTag found = bake(members);
    ASSERT_TRUE(found.force_model) << members;
    EXPECT_EQ(*found.force_model, tag) << members;
    const HapticScene scene = load_haptic_scene(glb(), {});
    ASSERT_EQ(scene.materials.size(), 1U);
    const ContactMaterial& material = scene.materials.front();
    EXPECT_EQ(material.model, model);
    EXPECT_EQ(material.form, form);
    EXPECT_EQ(material.amplitude, tag.amplitude);
    EXPECT_EQ(material.literal_sign, tag.literal);
    EXPECT_EQ(material.level, tag.level);
    EXPECT_EQ(material.stimulus.has_value(), is_stimulus(model));
    EXPECT_EQ(material.height.has_value(), !is_stimulus(model));
    expect_stimulus(scene);
  }
}

TEST_F(ForceModelFile, TheGraphHasTheExponentOfTheTag) {
  bake(R"("forceModel": {"name": "graph"})");
  Scene scene = read_gltf(glb(), {.tag_channel = true});
  for (const std::optional<double> dimension : {std::optional<double>(), std::optional(2.2), std::optional(2.9)}) {
    for (Material& material : scene.materials)
      if (material.haptic) {
        material.haptic->roughness = RoughnessTag{};
        material.haptic->roughness->fractal_dimension = dimension;
      }
    const HapticScene haptic = haptic_scene(scene, glb());
    EXPECT_NEAR(haptic.materials.front().hurst, dimension ? 3 - *dimension : 0.5, 1e-12);
    expect_stimulus(haptic);
  }
}

TEST_F(ForceModelFile, WrongModelsAreRefused) {
  const auto complaint = [&](const std::string& model) -> std::string {
    try {
      bake(R"("forceModel": )" + model);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& model, const std::string& words) {
    EXPECT_NE(complaint(model).find(words), std::string::npos) << complaint(model);
  };
  expect(R"({"name": "laterel"})", "did you mean 'lateral'");
  expect(R"({"amplitud": 1})", "did you mean 'amplitude'");
  expect(R"({"name": "lateral", "form": "place"})",
         "/materials/grain/forceModel/form: 'place' is no form of 'lateral'");
  expect(R"({"name": "graph", "form": "gradient"})", "is no form of 'graph-orthogonal'");
  expect(R"({"name": "graph", "level": 9})", "/materials/grain/forceModel/level");
  expect(R"({"name": "graph", "level": 2.5})", "must be a whole number");
  expect(R"({"amplitude": -1})", "/materials/grain/forceModel/amplitude");
  expect(R"("lateral")", "/materials/grain/forceModel");
}

}  // namespace
}  // namespace papilla
