// SPDX-License-Identifier: MIT
#include "papilla/pipeline/stereo_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/picture_memory.hpp"
#include "papilla/texture/shading.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class StereoFile : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) {
    const fs::path path = folder_.path() / name;
    write_atomically(path, text);
    return path;
  }

  /// Linear photographs of a relief of 0.4 mm under four lights, 96 × 72 pixels of 0.1 mm.
  std::vector<fs::path> photographs() {
    HeightMap relief{96, 72, {}, 0.1, 0.1, false};
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 96; ++x)
        relief.mm.push_back(static_cast<float>(0.2 * std::sin(0.21 * x + 0.1 * y) * std::cos(0.17 * y)));
    std::vector<fs::path> files;
    for (const Vec3 light : {Vec3{0.6, 0.1, 0.8}, Vec3{-0.5, 0.4, 0.8}, Vec3{-0.1, -0.7, 0.7}, Vec3{0.3, 0.6, 0.7}}) {
      files.push_back(folder_.path() / ("light" + std::to_string(files.size()) + ".tif"));
      write_grey_image(files.back(), render_lambert(relief, light), 32);
    }
    return files;
  }

  fs::path lights() {
    return write("LIGHTS.json",
                 R"({"lights": [[0.6, 0.1, 0.8], [-0.5, 0.4, 0.8], [-0.1, -0.7, 0.7], [0.3, 0.6, 0.7]]})");
  }

  template <class Work>
  void refused(const Work& work, const std::string& reason) {
    try {
      work();
      FAIL() << reason;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  TemporaryFolder folder_{"stereo"};
};

TEST_F(StereoFile, MeasuresDepth) {
  StereoFileOptions options;
  options.lights = read_lights(lights(), 4);
  options.files.height.pitch_mm = 0.1;
  options.files.pictures = folder_.path() / "report";
  const fs::path output = folder_.path() / "relief.tif";
  const StereoFiles found = height_of_picture_files(photographs(), output, options);
  EXPECT_EQ(found.depth_source, "measured");
  EXPECT_NEAR(found.files.result.depth_mm, 0.4, 0.06);
  EXPECT_GT(found.mean_confidence, 0.9);
  EXPECT_TRUE(fs::exists(output));
  EXPECT_TRUE(fs::exists(found.confidence_picture));
  options.is_depth_given = true;
  options.files.height.depth_mm = 0.25;
  EXPECT_NEAR(height_of_picture_files(photographs(), output, options).files.result.depth_mm, 0.25, 1e-6);
}

TEST_F(StereoFile, RulerAndProfileScaleIt) {
  StereoFileOptions options;
  options.lights = read_lights(lights(), 4);
  std::string csv = "mm_along,mm_height\n";
  for (int x = 0; x < 90; ++x)
    csv += std::to_string(0.1 * x) + "," + std::to_string(0.2 * std::sin(0.21 * x + 3) * std::cos(0.17 * 30)) + "\n";
  write("line.csv", csv);
  options.references = read_references(write("REF.json", R"([{"ruler_mm": 5, "from_px": [10, 10], "to_px": [60, 10]},
                                             {"profile_csv": "line.csv", "from_px": [0, 30], "to_px": [89, 30]}])"));
  const StereoFiles found = height_of_picture_files(photographs(), folder_.path() / "relief.tif", options);
  ASSERT_EQ(found.references.size(), 2U);
  EXPECT_DOUBLE_EQ(found.files.result.map.pitch_mm_x, 0.1);
  EXPECT_EQ(found.depth_source, "profile");
  EXPECT_GT(*found.references[1].correlation, 0.95);
  EXPECT_NEAR(found.files.result.depth_mm, 0.4, 0.06);
}

TEST_F(StereoFile, LightsSayWhatIsWrongWhere) {
  refused([&] { read_lights(lights(), 3); }, "/lights: 4 lights for 3 photographs");
  refused([&] { read_lights(write("a.json", R"({"light": []})"), 3); }, "did you mean 'lights'");
  refused([&] { read_lights(write("a.json", R"({"lights": [[1, 2, -1]]})"), 1); }, "/lights/0");
  refused([&] { read_lights(write("a.json", R"({"lights": "unkown"})"), 1); }, "unknown");
  EXPECT_TRUE(read_lights(write("a.json", R"({"lights": "unknown"})"), 4).directions.empty());
  EXPECT_TRUE(read_lights(write("a.json", R"("unknown")"), 4).directions.empty());
  const StereoLights ball =
      read_lights(write("a.json", R"({"sphere": {"centre_px": [30, 20], "radius_px": 9, "kind": "mirror"}})"), 4);
  ASSERT_TRUE(ball.sphere);
  EXPECT_TRUE(ball.sphere->mirror);
}

TEST_F(StereoFile, ReferencesSayWhatIsWrongWhere) {
  refused([&] { read_references(write("a.json", "{}")); }, "is needed");
  refused([&] { read_references(write("a.json", R"({"ruler_mm": 5, "from_px": [1, 2]})")); }, "'to_px' is missing");
  refused([&] { read_references(write("a.json", R"({"step_m": 5})")); }, "did you mean 'step_mm'");
  refused([&] { read_references(write("a.json", R"({"profile_csv": "no.csv", "from_px": [1, 2], "to_px": [3, 4]})")); },
          "no.csv");
  EXPECT_EQ(
      read_references(write("a.json", R"([{"grid_mm": 5}, {"shadow": {"from_px": [1, 2], "to_px": [3, 4]}}])")).size(),
      2U);
}

TEST_F(StereoFile, RefusesPhotographsThatDoNotFit) {
  std::vector<fs::path> files = photographs();
  const fs::path output = folder_.path() / "relief.tif";
  refused([&] { height_of_picture_files({files[0], files[1]}, output, {}); }, "at least 3");
  GreyImage small{40, 30, Values<float>(1200, 0.5F)};
  write_grey_image(files[2], small, 32);
  refused([&] { height_of_picture_files(files, output, {}); }, files[2].string() + ": is 40 x 30");
  set_picture_memory(1 << 20);
  refused([&] { height_of_picture_files(files, output, {}); }, "--max-memory");
  set_picture_memory(0);
}

}  // namespace
}  // namespace papilla
