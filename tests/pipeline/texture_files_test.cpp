// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/contact_sheet.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/height_file.hpp"
#include "papilla/pipeline/prepare_file.hpp"
#include "papilla/pipeline/synthesis.hpp"
#include "papilla/pipeline/texture_files.hpp"

namespace papilla {
namespace {

float highest(const HeightMap& map) { return *std::max_element(map.mm.begin(), map.mm.end()); }

TEST(HeightFile, WritesWhatWasAskedForBesideTheOutput) {
  const test::TemporaryFolder folder;
  const Synthesis grain = synthesize_texture({.grain = GrainKind::spheres6, .size_px = 96});
  write_grey_image(folder / "grain.png", grain.picture, 16);
  HeightFileOptions options;
  options.height.depth_mm = 0.5;
  options.opposite = options.deeper = true;
  options.pictures = folder / "pictures";
  const HeightFiles files = height_of_picture_file(folder / "grain.png", folder / "height.exr", options);
  EXPECT_EQ(files.opposite, (folder / "height-opposite.exr").string());
  ASSERT_EQ(files.deeper.size(), 2U);
  EXPECT_EQ(files.deeper[1].file, (folder / "height-x4.exr").string());
  const GreyImage deep = read_grey_image(files.deeper[1].file);
  EXPECT_NEAR(*std::max_element(deep.pixels.begin(), deep.pixels.end()), 2, 1e-5);
  ASSERT_EQ(files.pictures.size(), 3U);
  EXPECT_EQ(files.pictures[0].name, "relief");
  EXPECT_TRUE(std::filesystem::exists(files.pictures[1].file));
}

TEST(HeightFile, ByClassIsWhatBakeMakesOfThePicture) {
  const test::TemporaryFolder folder;
  const Synthesis made = synthesize_texture({.grain = GrainKind::spheres8, .size_px = 256});
  write_grey_image(folder / "grain.png", made.picture, 8);
  HeightFileOptions options;
  options.height.pitch_mm = 0.1;
  options.height.depth_mm = 0.25;
  options.by_class.emplace();
  const HeightFiles files = height_of_picture_file(folder / "grain.png", folder / "tile.exr", options);
  EXPECT_TRUE(step_of(files.plan, "exact_tile").run);
  EXPECT_LT(files.result.map.width, 256);

  MaterialRule rule;
  rule.name = "spheres";
  rule.texture = folder / "grain.png";
  rule.height.pitch_mm = 0.1;
  rule.height.relief = {.height = options.height};
  rule.height.depth_mm = 0.25;
  rule.height.max_slope = 100;
  const Grain grain = make_grain(rule);
  EXPECT_EQ(grain.relief.width, files.result.map.width);
  EXPECT_EQ(grain.relief.height, files.result.map.height);
  EXPECT_EQ(grain.relief.mm, files.result.map.mm);
}

TEST(HeightFile, InBandsWritesTheSameFiles) {
  const test::TemporaryFolder folder;
  const Synthesis grain = synthesize_texture({.grain = GrainKind::spheres6, .size_px = 300});
  write_grey_image(folder / "grain.png", grain.picture, 16);
  HeightFileOptions options;
  options.height.pitch_mm = 0.1;
  options.opposite = options.deeper = true;
  for (const char* extension : {".png", ".exr", ".tif"})
    for (const HeightMethod method : {HeightMethod::automatic, HeightMethod::intensity, HeightMethod::tsai_shah}) {
      options.height.method = method;
      options.largest_px = 4096;
      const HeightFiles whole =
          height_of_picture_file(folder / "grain.png", folder / (std::string("whole") + extension), options);
      options.largest_px = 256;
      const HeightFiles bands =
          height_of_picture_file(folder / "grain.png", folder / (std::string("bands") + extension), options);
      EXPECT_EQ(bands.result.method, whole.result.method);
      EXPECT_EQ(bands.result.map.periodic, whole.result.map.periodic);
      if (bands.result.method == HeightMethod::variational) continue;  // In pieces it is another guess at long waves.
      EXPECT_NEAR(bands.result.rms_mm, whole.result.rms_mm, 1e-6);
      for (const char* suffix : {"", "-opposite", "-x4"}) {
        const auto file = [&](const char* stem) { return folder / (std::string(stem) + suffix + extension); };
        const GreyImage a = read_grey_image(file("whole")), b = read_grey_image(file("bands"));
        ASSERT_EQ(a.pixels.size(), b.pixels.size());
        EXPECT_NEAR(a.pitch_mm, b.pitch_mm, 1e-9);
        double most = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
          most = std::max(most, std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
        EXPECT_LE(most, 2e-5) << file("bands");
      }
    }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 25) << "no temporary file is left";
}

TEST(PrepareFile, ScalesInProportionAndKeepsTheSizeInMillimetres) {
  const test::TemporaryFolder folder;
  const Synthesis surface = synthesize_texture({.size_px = 129, .size_mm = 40});
  write_grey_image(folder / "a.png", surface.picture, 16);
  PrepareFileOptions options;
  options.prepare.borders = BorderMatching::none;
  options.width_px = 64;
  options.pitch_mm = 0.5;
  const PreparedPicture prepared = prepare_picture_file(folder / "a.png", folder / "b.png", options);
  EXPECT_EQ(prepared.image.width, 64);
  EXPECT_EQ(prepared.after.height, 64);
  EXPECT_NEAR(prepared.image.pitch_mm * 64, 0.5 * 129, 1e-9);
  EXPECT_EQ(prepared.steps.back().step, "scale");
}

TEST(Synthesis, TakesTheDimensionInsteadOfHAndTheSpectralMethodForTiles) {
  const Synthesis surface = synthesize_texture({.dimension = 2.3, .tile = true, .size_px = 64, .height_mm = 0.25});
  EXPECT_EQ(surface.method, "spectral");
  EXPECT_TRUE(surface.relief.periodic);
  EXPECT_NEAR(surface.hurst.value(), 0.7, 1e-12);
  EXPECT_EQ(highest(surface.relief), 0.25F);
  const Synthesis graph =
      synthesize_texture({.method = FractalSynthesis::brownian_graph, .dimension = 1.3, .size_px = 65});
  EXPECT_EQ(graph.relief.width, 65);
  EXPECT_EQ(graph.relief.height, 1);
  EXPECT_NEAR(graph.hurst.value(), 0.7, 1e-12);
}

TEST(TextureFiles, WritesAStepForEveryTimeAndCanBeCancelled) {
  const test::TemporaryFolder folder;
  TextureFileOptions options;
  options.width = options.height = 16;
  options.channels = {Channel::main};
  options.steps = 3;
  options.normal_map = options.video = true;
  const TextureFiles files = write_texture_files("brick", RecipeLibrary::builtin(), folder / "series", options);
  ASSERT_EQ(files.channels.size(), 3U);
  EXPECT_EQ(files.channels[1].file, "main.0001.png");
  EXPECT_EQ(files.channels[1].time, 0.5);
  EXPECT_EQ(files.normal_maps.size(), 3U);
  EXPECT_TRUE(std::filesystem::exists(folder / "series" / files.video));
  options.progress = [](const Progress&) { return false; };
  EXPECT_THROW(write_texture_files("brick", RecipeLibrary::builtin(), folder / "none", options), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder / "none" / "series.gif"));
}

TEST(ContactSheet, BrightensDarkTiles) {
  const RecipeLibrary none;
  const auto plain = [](const char* colour) {
    return NamedRecipe(colour, std::string("base|shade=false|mainfunction=0|cols=") + colour + "," + colour);
  };
  const ContactSheet sheet =
      make_contact_sheet({plain("<.1,.2,.05>"), plain("<.35,.1,.2>"), plain("<.2,.4,.9>")}, none, {}, 16);
  ASSERT_EQ(sheet.entries.size(), 3U);
  const double exposures[] = {3, 2, 1};
  const int pixels[3][3] = {{77, 153, 38}, {179, 51, 102}, {51, 102, 230}};
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(sheet.entries[k].error, "");
    EXPECT_NEAR(sheet.entries[k].exposure, exposures[k], 1e-5);
    const int x = k_sheet_gap_px + static_cast<int>(k) % sheet.columns * (16 + k_sheet_gap_px) + 3;
    const int y = k_sheet_gap_px + static_cast<int>(k) / sheet.columns * (16 + k_sheet_gap_px) + 11;
    const std::size_t at = 3 * static_cast<std::size_t>(y * sheet.picture.width + x);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sheet.picture.pixels[at + c], pixels[k][c], 1) << k << ' ' << c;
  }
}

TEST(ContactSheet, ShowsAgeingRecipesOnAMaterial) {
  RecipeLibrary library;
  library.add("board", "brick|idtype=wood");
  library.add("worn", "multi|ismodifier=true|idmaterial=board");
  const auto recipes = examples_of_library(library);
  ASSERT_EQ(recipes.size(), 2U);
  EXPECT_EQ(recipes[0], (NamedRecipe{"board", "board"}));
  EXPECT_EQ(recipes[1], (NamedRecipe{"worn", "multi|textures=board,worn"}));
  const auto categories = recipes_by_category(library);
  EXPECT_EQ(categories.at("wood"), std::vector<std::string>{"board"});
  EXPECT_EQ(categories.at("none"), std::vector<std::string>{"worn"});
}

}  // namespace
}  // namespace papilla
