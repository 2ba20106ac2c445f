// SPDX-License-Identifier: MIT
// Counts what is allocated: an executable of its own, as it replaces the global operator new.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>

#include "haptic/grids_glb.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace {

std::size_t g_used = 0, g_most = 0;

}  // namespace

void* operator new(std::size_t size) {
  void* block = std::malloc(std::max<std::size_t>(size, 1));
  if (block == nullptr) throw std::bad_alloc();
  g_used += ::malloc_usable_size(block);
  g_most = std::max(g_most, g_used);
  return block;
}
void operator delete(void* block) noexcept {
  g_used -= ::malloc_usable_size(block);
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept { operator delete(block); }

namespace papilla {
namespace {

/// Bytes a triangle: what loading takes besides the ContactSurface at its worst, and the surface.
struct Taken {
  double loading, surface;
};

Taken taken(bool has_relief, bool is_shaded) {
  const std::string png = testing::sine_png();
  nlohmann::json tag = {{"version", 2}, {"stiffness", 300}, {"forceShading", is_shaded}};
  if (has_relief)
    tag["height"] = {{"image", "haptic.height.grain"},
                     {"sha256", sha256_hex(std::as_bytes(std::span(png.data(), png.size())))},
                     {"scale", 2e-4},
                     {"offset", -1e-4},
                     {"metresPerUV", {0.04, 0.04}}};
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("papilla-memory-test-" + std::to_string(::getpid()) + ".glb");
  std::ofstream(path, std::ios::binary) << testing::grids_glb(70, 200, {{"haptic", tag}}, {{"haptic", tag}},
                                                              has_relief ? png : "");
  const std::size_t before = g_used;
  g_most = before;
  HapticScene scene = load_haptic_scene(path);
  const ContactSurface surface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m);
  std::filesystem::remove(path);
  const auto triangles = static_cast<double>(surface.triangles());
  EXPECT_EQ(surface.triangles() + surface.skipped_triangles(), 3U * 2 * 2 * 70 * 200);
  return {static_cast<double>(g_most - before) / triangles, static_cast<double>(surface.bytes()) / triangles};
}

// 220 MiB for two million triangles are 115 bytes each, program, stacks and libraries included. The file counts, too.
TEST(PlayerMemory, OfAPlainTriangleIsAtMost90Bytes) {
  const Taken of = taken(false, false);
  EXPECT_LE(of.loading, 62);
  EXPECT_LE(of.surface, 23);
}

TEST(PlayerMemory, OfATriangleWithReliefIsAtMost115Bytes) {
  const Taken of = taken(true, false);
  EXPECT_LE(of.loading, 82);
  EXPECT_LE(of.surface, 46);
}

TEST(PlayerMemory, NormalsForShadingTake24BytesMore) {
  const Taken plain = taken(true, false), shaded = taken(true, true);
  EXPECT_LE(shaded.loading - plain.loading, 12);
  EXPECT_NEAR(shaded.surface - plain.surface, 12, 0.1);  // Turned normals can move a corner of a box.
}

}  // namespace
}  // namespace papilla
