// SPDX-License-Identifier: MIT
// Counts what is allocated: an executable of its own, as it replaces the global operator new.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <numbers>

#include "papilla/meshing/simplify.hpp"

namespace {

std::atomic<std::size_t> g_used = 0, g_most = 0;

void* counted(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  const std::size_t used = g_used += ::malloc_usable_size(block);
  for (std::size_t most = g_most; used > most && !g_most.compare_exchange_weak(most, used);) {
  }
  return block;
}

void release(void* block) noexcept {
  g_used -= ::malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(std::max<std::size_t>(size, 1))); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }

namespace papilla {
namespace {

/// A ball with waves of two lengths, without caps.
TriangleMesh wavy_ball(Index rows, Index columns) {
  TriangleMesh mesh;
  for (Index i = 0; i <= rows; ++i)
    for (Index j = 0; j < columns; ++j) {
      const double a = std::numbers::pi * (i + 0.5) / (rows + 1), b = 2 * std::numbers::pi * j / columns;
      const double r = 50 + 0.5 * std::sin(7 * a) * std::cos(5 * b) + 0.05 * std::sin(40 * a) * std::sin(37 * b);
      mesh.positions.push_back({r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b), r * std::cos(a)});
    }
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j) {
      const Index a = i * columns + j, b = i * columns + (j + 1) % columns;
      mesh.triangles.push_back({a, a + columns, b});
      mesh.triangles.push_back({b, a + columns, b + columns});
    }
  return mesh;
}

TEST(SimplifyMemory, IsAtMost300BytesATriangleWithTheMesh) {
  const TriangleMesh mesh = wavy_ball(100, 200);
  SimplifyOptions options;
  options.tolerance_mm = 0.05;
  g_most = g_used.load();
  const SimplifyResult result = simplify(mesh, options);
  EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
  const std::size_t most = g_most;
  EXPECT_LE(most / mesh.triangles.size(), 300U);
}

}  // namespace
}  // namespace papilla
