// SPDX-License-Identifier: MIT
// Lattices of photographs, read off by hand: periods counted on the enlarged picture. Needs the folder that
// PAPILLA_SHARED_DATA names.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/symmetry.hpp"
#include "texture/wallpaper_patterns.hpp"

namespace papilla {
namespace {

struct PhotographLattice {
  const char* file;
  Vec2 a, b;
};

/// The waves of each picture's Fourier transform lie on the reciprocal lattice. Bricks in perspective with changing
/// bonds, grass, gravel, leather and scales have none.
constexpr std::array<PhotographLattice, 8> k_photographs = {{
    {"ambientcg_Chainmail004_128.png", {16, 0}, {0, 8}},
    {"ambientcg_Fabric015_128.png", {5.3, 4.6}, {-10.7, 9.2}},
    {"krita_canvas.png", {3.7, 0}, {0.1, 5.9}},
    {"krita_woof_tissue.png", {16, 0}, {0, 16}},
    {"fabric_pattern_07_col_1_1k.jpg", {85.33, 0}, {0, 128}},  // 12 and 8 checks over 1024 pixels.
    {"fabric_pattern_07_nor_gl_1k.jpg", {7.05, 10.6}, {-7.05, 10.6}},
    {"godot_wool_albedo.jpg", {40.2, 0.8}, {0.3, 37.6}},
    {"godot_wool_depth.png", {40.2, 0.8}, {0.3, 37.5}},
}};
constexpr std::array<const char*, 4> k_without = {"grass.png", "krita_reptile.png", "gimp_leather_64.png", "brick.png"};

std::filesystem::path photographs() {
  const char* shared = std::getenv("PAPILLA_SHARED_DATA");
  return shared != nullptr ? std::filesystem::path(shared) / "photos" : std::filesystem::path();
}

TEST(PhotographLattices, AreThoseReadOffByHand) {
  const std::filesystem::path folder = photographs();
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no photographs";
  int present = 0, right = 0;
  std::string wrong;
  for (const auto& [file, a, b] : k_photographs) {
    if (!std::filesystem::is_regular_file(folder / file)) continue;
    ++present;
    const Lattice lattice = analyze_symmetry(read_grey_image(folder / file)).lattice;
    const double cell = std::sqrt(std::abs(cross(a, b)));
    if (lattice.found && test::lattice_error(lattice.vectors_px, a, b) < 0.05 * cell)
      ++right;
    else
      wrong += std::string(file) + " ";
  }
  EXPECT_EQ(right, present) << wrong;
}

TEST(PhotographLattices, NoneWhereThereIsNone) {
  const std::filesystem::path folder = photographs();
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no photographs";
  for (const char* file : k_without)
    if (std::filesystem::is_regular_file(folder / file))
      EXPECT_FALSE(analyze_symmetry(read_grey_image(folder / file)).lattice.found) << file;
}

}  // namespace
}  // namespace papilla
