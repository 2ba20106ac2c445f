// SPDX-License-Identifier: MIT
#include "papilla/meshing/identical_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

struct Rotation {
  std::array<Vec3, 3> rows;
  Vec3 operator()(const Vec3& p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
};

Rotation random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  double q[4], length = 0;
  for (double& x : q) {
    x = normal(random);
    length += x * x;
  }
  for (double& x : q) x /= std::sqrt(length);
  const auto [w, x, y, z] = std::tuple{q[0], q[1], q[2], q[3]};
  return {{Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           Vec3{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           Vec3{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

TriangleMesh moved(TriangleMesh mesh, const Rotation& turn, Vec3 by) {
  for (Vec3& p : mesh.positions) p = turn(p) + by;
  for (Vec3& n : mesh.normals.values) n = turn(n);
  return mesh;
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Vec3& p : mesh.positions) p.x = -p.x;
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  mesh.uv = {};
  return mesh;
}

/// Another order of vertices and triangles, and another first corner of each.
TriangleMesh shuffled(const TriangleMesh& mesh, std::mt19937& random) {
  std::vector<Index> order(mesh.positions.size());
  for (Index i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  TriangleMesh result;
  result.positions.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result.positions[order[i]] = mesh.positions[i];
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({order[t[1]], order[t[2]], order[t[0]]});
  std::shuffle(result.triangles.begin(), result.triangles.end(), random);
  return result;
}

/// A lump without any symmetry.
TriangleMesh lump() {
  TriangleMesh mesh = test::uv_sphere(10, 12, 16);
  for (Vec3& p : mesh.positions) p = (1 + 0.2 * std::sin(0.3 * p.x + 1) + 0.1 * std::cos(0.4 * p.y + 0.2 * p.z)) * p;
  return mesh;
}

std::vector<PartCopy> find(const std::vector<const TriangleMesh*>& meshes, const IdenticalOptions& options = {}) {
  std::vector<ComparedPart> parts;
  for (const TriangleMesh* mesh : meshes) parts.push_back({mesh, 0});
  return find_identical_parts(parts, options);
}

Vec3 apply(const std::array<double, 16>& m, const Vec3& p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

TEST(FindIdenticalParts, RotatedCopiesAreFoundWithTheirMotion) {
  std::mt19937 random(3);
  for (const TriangleMesh& original : {lump(), test::cube(3), test::torus(10, 3, 24, 12), test::uv_sphere(5, 8, 8)}) {
    TriangleMesh plain = original;
    plain.uv = {};
    const Rotation turn = random_rotation(random);
    const TriangleMesh copy = moved(plain, turn, {100, -20, 7});
    const TriangleMesh other = moved(shuffled(plain, random), random_rotation(random), {-3, 50, 1});
    const auto found = find({&plain, &copy, &other});
    EXPECT_EQ(found[0].original, 0u);
    EXPECT_EQ(found[1].original, 0u);
    EXPECT_EQ(found[2].original, 0u);
    for (const std::size_t k : {1u, 2u}) {
      const TriangleMesh& target = k == 1 ? copy : other;
      EXPECT_LE(found[k].max_distance_mm, 1e-9);
      for (const Vec3& p : plain.positions) {
        double nearest = INFINITY;
        for (const Vec3& q : target.positions) nearest = std::min(nearest, norm(apply(found[k].motion, p) - q));
        EXPECT_LE(nearest, 1e-9);
      }
    }
  }
}

TEST(FindIdenticalParts, AMirroredPartIsNotIdenticalUnlessItIsItsOwnMirrorImage) {
  std::mt19937 random(5);
  const TriangleMesh original = lump(), mirror = moved(mirrored(original), random_rotation(random), {1, 2, 3});
  EXPECT_EQ(find({&original, &mirror})[1].original, 1u);
  const TriangleMesh twice = mirrored(mirror);
  EXPECT_EQ(find({&original, &mirror, &twice})[2].original, 0u);
}

TEST(FindIdenticalParts, NormalsTurnWithTheirPart) {
  std::mt19937 random(11);
  TriangleMesh original = lump();
  original.uv = {};
  original.normals.values.clear();
  for (const Vec3& p : original.positions) original.normals.values.push_back(normalized(p + Vec3{0.3, 0.1, -0.2}));
  original.normals.indices = original.triangles;
  const TriangleMesh copy = moved(original, random_rotation(random), {4, 5, -60});
  EXPECT_EQ(find({&original, &copy})[1].original, 0u);
  TriangleMesh other = copy;
  other.normals.values[7] = normalized(other.normals.values[7] + Vec3{0.5, 0, 0});
  EXPECT_EQ(find({&original, &other})[1].original, 1u);
}

TEST(FindIdenticalParts, NearlyIdenticalPartsAreDifferent) {
  std::mt19937 random(7);
  const TriangleMesh original = lump();
  for (const double shift : {0.5, 0.01, 0.001}) {
    TriangleMesh changed = moved(original, random_rotation(random), {5, 5, 5});
    changed.positions[40] = changed.positions[40] + Vec3{shift, 0, 0};
    EXPECT_EQ(find({&original, &changed})[1].original, 1u) << shift;
  }
  TriangleMesh noisy = moved(original, random_rotation(random), {5, 5, 5});
  std::uniform_real_distribution<double> noise(-2e-6, 2e-6);
  for (Vec3& p : noisy.positions) p = p + Vec3{noise(random), noise(random), noise(random)};
  EXPECT_EQ(find({&original, &noisy})[1].original, 0u);

  TriangleMesh other_diagonal = test::plane(10, 7, 1, 1), plane = other_diagonal;  // same vertices, other triangles
  other_diagonal.uv = plane.uv = {};
  for (TriangleMesh* mesh : {&plane, &other_diagonal}) mesh->positions[3].z = 1;
  other_diagonal.triangles = {{0, 1, 2}, {1, 3, 2}};
  if (std::find(plane.triangles.begin(), plane.triangles.end(), Triangle{0, 1, 2}) != plane.triangles.end())
    other_diagonal.triangles = {{0, 1, 3}, {0, 3, 2}};
  EXPECT_EQ(find({&plane, &other_diagonal})[1].original, 1u);
  TriangleMesh scaled = original;
  for (Vec3& p : scaled.positions) p = 1.001 * p;
  EXPECT_EQ(find({&original, &scaled})[1].original, 1u);
}

TEST(FindIdenticalParts, InsideOutIsDifferent) {
  const TriangleMesh original = lump();
  TriangleMesh turned = original;
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(find({&original, &turned})[1].original, 1u);
}

TEST(FindIdenticalParts, AttributesAndLabelsCount) {
  const TriangleMesh original = test::plane(10, 7, 3, 2);
  TriangleMesh other = original;
  other.uv.values[2].x += 0.1;
  EXPECT_EQ(find({&original, &other})[1].original, 1u);
  IdenticalOptions shape_only;
  shape_only.compare_attributes = false;
  EXPECT_EQ(find({&original, &other}, shape_only)[1].original, 0u);
  TriangleMesh twice = original, second = original;
  twice.uv1 = second.uv1 = original.uv;
  second.uv1.values[2].y += 0.1;
  EXPECT_EQ(find({&twice, &second})[1].original, 1u);
  TriangleMesh painted = original;
  painted.material.assign(painted.triangles.size(), 0);
  EXPECT_EQ(find({&original, &painted})[1].original, 0u);
  painted.material[3] = 1;
  EXPECT_EQ(find({&original, &painted})[1].original, 1u);
  const std::vector<ComparedPart> labelled{{&original, 1}, {&original, 2}, {&original, 1}};
  const auto found = find_identical_parts(labelled);
  EXPECT_EQ(found[1].original, 1u);
  EXPECT_EQ(found[2].original, 0u);
}

TEST(FindIdenticalParts, EmptyAndPointLikePartsAreLeftAlone) {
  TriangleMesh empty, point;
  point.positions = {{1, 1, 1}};
  point.triangles = {{0, 0, 0}};
  const auto found = find({&empty, &empty, &point, &point});
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].original, i);
}

TEST(FindIdenticalParts, RefusesBadInput) {
  EXPECT_THROW(find({nullptr}), InvalidInput);
  const TriangleMesh cube = test::cube(1);
  IdenticalOptions loose;
  loose.relative_tolerance = 0.5;
  EXPECT_THROW(find({&cube}, loose), InvalidInput);
  TriangleMesh broken = cube;
  broken.triangles[0][1] = 99;
  EXPECT_THROW(find({&broken}), InvalidInput);
}

}  // namespace
}  // namespace papilla
