// SPDX-License-Identifier: MIT
// Sweeps over a relief that begin where others ended, as a proxy's do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "contact_shapes.hpp"
#include "contact_triangles.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla::testing {
namespace {

constexpr double k_width = 6.4e-3, k_depth = 4e-3;
constexpr double k_base_below = 2e-5;  // Of the relief, below the plate.
constexpr int k_columns = 64, k_rows = 40;

/// Turned about all axes, and away from the origin.
Vec3 turned(Vec3 p) {
  const Vec3 axis = normalized(Vec3{0.36, -0.48, 0.8});
  const double c = std::cos(1.1), s = std::sin(1.1);
  return c * p + s * cross(axis, p) + ((1 - c) * dot(axis, p)) * axis + Vec3{0.3, -0.2, 0.5};
}

ContactMesh turned(ContactMesh mesh) {
  for (Vec3& p : mesh.positions) p = turned(p);
  return mesh;
}

HeightField oblong_waves() {
  HeightFieldOptions options;
  options.scale_m = 8e-5;
  options.offset_m = -k_base_below;
  options.uv_transform.scale = {1, 2};
  return {k_columns, k_rows, wave_samples(k_columns, k_rows), options};
}

/// Parameters: squares along x, radius of the probe.
struct ReliefSweeps : ::testing::TestWithParam<std::pair<int, double>> {
  ContactMesh mesh = turned(plate(GetParam().first, 2, k_width, k_depth));
  std::unique_ptr<ContactTriangles> surface;

  void SetUp() override {
    ContactMaterial material;
    material.height = 0;
    surface =
        std::make_unique<ContactTriangles>(mesh, std::vector{material}, std::vector{oblong_waves()}, GetParam().second);
  }

  /// The least of all triangles nearby.
  ContactTriangles::Clearance clearance(Vec3 x) const {
    const TriangleClusters& clusters = surface->clusters();
    ContactTriangles::Clearance least;
    least.value = 1;
    double reach = 2e-3;
    clusters.within(x - surface->origin(), reach, [&](std::uint32_t cluster) {
      for (std::uint32_t b = clusters.first_block(cluster);
           b < clusters.first_block(cluster) + clusters.blocks_of(cluster); ++b)
        for (std::uint32_t i = 0; i < clusters.triangles_in(b); ++i) {
          const std::uint32_t place = b * TriangleClusters::k_block + i;
          const auto face = surface->known_face(place);
          const auto of_face = surface->clearance_of(face.face, x - surface->origin());
          if (of_face.value < least.value && !surface->is_beyond(face, x - surface->origin())) least = of_face;
        }
    });
    return least;
  }
};

TEST_P(ReliefSweeps, EndAtTheReliefWhereverTheOneBeforeEnded) {
  constexpr int k_sweeps = 1600, k_chain = 20, k_looks = 10;
  const double tolerance = surface->tolerance_m(), radius = GetParam().second;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto near = std::make_unique<Neighbourhood>();
  ContactTriangles::KnownFaces known;
  const Vec3 up = turned({0, 0, 1}) - turned({0, 0, 0});
  Vec3 x, normal;
  int hits = 0, grazes = 0;
  for (int i = 0; i < k_sweeps; ++i) {
    if (i % k_chain == 0) {
      x = turned({k_width * (0.2 + 0.6 * unit(random)), k_depth * (0.4 + 0.2 * unit(random)), radius + 3e-4});
      normal = up;
      ASSERT_TRUE(surface->gather(x, 1e-3, *near));
    }
    const bool presses = i % k_chain == 0 || unit(random) < 0.5;
    const Vec3 aside = normalized(cross(normal, {unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5}));
    const double length = i % k_chain == 0 ? 4e-4 : std::pow(10, -6 + 2 * unit(random));
    const Vec3 way = length * (presses ? -normal : aside);
    const double start = clearance(x).value;
    const auto hit = surface->sweep(x, x + way, *near, known);
    const double end = hit ? hit->t : 1;
    for (int k = 1; k < k_looks; ++k)
      ASSERT_GT(clearance(x + (end * k / k_looks) * way).value, std::min(start, -tolerance) - 0.5 * tolerance) << i;
    x = x + end * way;
    if (!hit) continue;
    ++(presses ? hits : grazes);
    ASSERT_NEAR(clearance(x).value, 0, tolerance) << i;
    const auto there = surface->clearance_of(surface->face(hit->place), x - surface->origin());
    ASSERT_NEAR(there.value, -hit->penetration_m, 0.3 * tolerance) << i;
    EXPECT_GT(dot(normalized(there.gradient), hit->normal), 1 - 1e-4) << i;
    x = x + std::max(0.0, hit->penetration_m) * hit->normal;
    normal = hit->normal;
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(grazes, 100);
}

TEST_P(ReliefSweeps, TheBackOfASheetHasNoRelief) {
  const Vec3 below = turned({0.4 * k_width, 0.45 * k_depth, -2e-3});
  EXPECT_NEAR(clearance(below).value, 2e-3 - k_base_below - surface->contact_radius_m(), 1e-9);
}

/// Beside the rim y = 0 the closest point moves along it alone.
TEST_P(ReliefSweeps, BesideARimTheClearanceFallsAsTheReliefAlongItRises) {
  const auto value = [&](double x) { return clearance(turned({x, -3e-4, 9e-4})); };
  const Vec3 along = turned({1, 0, 0}) - turned({0, 0, 0});
  constexpr double k_step = 1e-6;
  int steep = 0;
  for (double x = 0.31 * k_width; x < 0.7 * k_width; x += 0.037 * k_width) {
    const double slope = (value(x + k_step).value - value(x - k_step).value) / (2 * k_step);
    EXPECT_NEAR(dot(value(x).gradient, along), slope, 0.03) << x;
    steep += std::abs(slope) > 0.1;
  }
  EXPECT_GE(steep, 2);
}

INSTANTIATE_TEST_SUITE_P(Plates, ReliefSweeps,
                         ::testing::Values(std::pair{1, 0.0}, std::pair{1, 4e-4}, std::pair{24, 0.0},
                                           std::pair{24, 4e-4}));

/// Materials 0 and 1 have different waves as deep below the mesh, material 2 none, material 3 waves above the mesh.
ContactSurface waves_on(const ContactMesh& mesh, double radius) {
  std::vector<ContactMaterial> materials(4);
  materials[0].height = 0;
  materials[1].height = 1;
  materials[3].height = 2;
  HeightFieldOptions options;
  options.scale_m = 5e-5;
  const std::vector<std::uint16_t> samples = wave_samples(30, 22);
  const HeightField above(30, 22, samples, options);
  options.offset_m = oblong_waves().min_m() - HeightField(30, 22, samples, options).min_m();
  return {mesh, materials, {oblong_waves(), HeightField(30, 22, samples, options), above}, radius};
}

/// Triangles around the middle of the plate, and a ring of others around them.
/// @param out from the middle, counter-clockwise, of the inner corners; the outer ones are `farther` times as far away.
ContactMesh rings(const std::vector<Vec2>& out, double farther, const std::function<double(Vec2)>& height) {
  ContactMesh mesh;
  std::vector<Vec2> uv;
  const auto add = [&](Vec2 from_middle) {
    const Vec2 at = Vec2{0.5 * k_width, 0.5 * k_depth} + from_middle;
    mesh.positions.push_back({at.x, at.y, height(from_middle)});
    uv.push_back({at.x / k_width, at.y / k_depth});
  };
  add({});
  for (const double scale : {1.0, farther})
    for (const Vec2& corner : out) add(scale * corner);
  const auto join = [&](std::size_t a, std::size_t b, std::size_t c) {
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    for (const std::size_t v : {a, b, c}) mesh.corner_uv.push_back(uv[v]);
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t here = 1 + i, next = 1 + (i + 1) % out.size();
    join(0, here, next);
    join(here, here + out.size(), next);
    join(next, here + out.size(), next + out.size());
  }
  return mesh;
}

ContactMesh hub(int triangles, double lift) {
  std::vector<Vec2> out;
  for (int i = 0; i < triangles; ++i) {
    const double angle = 2 * std::numbers::pi * i / triangles;
    out.push_back({0.36 * k_width * std::cos(angle), 0.36 * k_depth * std::sin(angle)});
  }
  return rings(out, 4. / 3, [&](Vec2 at) { return lift * (1 - std::hypot(at.x / k_width, at.y / k_depth) / 0.48); });
}

/// Two planes fall from a ridge, a third between them almost along it: above the tip it faces more places than they do.
ContactMesh gable() {
  ContactMesh mesh = rings({{0, -1e-3}, {3e-4, 1e-3}, {-3e-4, 1e-3}}, 1.9,
                           [](Vec2 at) { return -0.25 * std::max(std::abs(at.x), 0.3 * at.y); });
  mesh.material.assign(mesh.triangles.size(), 3);
  return mesh;
}

/// So that the skin of all is the same.
void add_far_triangle(ContactMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3 p : {Vec3{0.03, 0, 0}, Vec3{0.031, 0, 0}, Vec3{0.03, 0.001, 0}}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.corner_uv.resize(mesh.corner_uv.size() + 3);
}

/// A ball feels the relief below its middle, whatever triangles carry it.
TEST(ContactRelief, OnAPlaneDoesNotDependOnTheTriangles) {
  constexpr double k_radius = 1e-3;
  std::vector<ContactMesh> meshes = {plate(5, 4, k_width, k_depth), plate(7, 11, k_width, k_depth),
                                     plate(40, 9, k_width, k_depth), hub(7, 0), hub(24, 0)};
  std::vector<ContactSurface> surfaces;
  for (ContactMesh& mesh : meshes) {
    add_far_triangle(mesh);
    surfaces.push_back(waves_on(turned(mesh), k_radius));
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const double contact = surfaces[0].contact_radius_m();
  double least = 1, most = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 x = turned({(0.38 + 0.24 * unit(random)) * k_width, (0.38 + 0.24 * unit(random)) * k_depth,
                           contact + 1.2e-4 * unit(random)});
    const double expected = surfaces[0].clearance(x, 3e-3);
    least = std::min(least, expected);
    most = std::max(most, expected);
    for (std::size_t k = 1; k < surfaces.size(); ++k)
      ASSERT_NEAR(surfaces[k].clearance(x, 3e-3), expected, 2e-7) << k << ' ' << i;
  }
  EXPECT_LT(least, -4e-5);
  EXPECT_GT(most, 5e-5);
}

struct NamedMesh {
  std::string name;
  ContactMesh mesh;
};

ContactMesh grid(const std::function<double(double, double)>& height) {
  return height_grid(13, 8, k_width, k_depth, height);
}

/// The squares of some columns and rows lie elsewhere on the map.
ContactMesh with_patch(ContactMesh mesh, double columns_from, double columns_to) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 middle = (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
    if (middle.x < columns_from * k_width || middle.x > columns_to * k_width || middle.y > 0.5 * k_depth) continue;
    for (std::size_t k = 0; k < 3; ++k) mesh.corner_uv[3 * t + k] = mesh.corner_uv[3 * t + k] + Vec2{0.37, 0.21};
  }
  return mesh;
}

/// A seam that opens from a vertex inside.
ContactMesh with_slit(ContactMesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x < 1.5 * k_width) continue;
    for (std::size_t k = 0; k < 3; ++k)
      mesh.corner_uv[3 * t + k].x += 60 * std::max(0.0, mesh.corner(t, k).y - 0.5 * k_depth);
  }
  return mesh;
}

/// Some columns have another material.
ContactMesh with_material(ContactMesh mesh, std::uint32_t material) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double x = (mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x) / 3;
    mesh.material.push_back(x > 0.3 * k_width && x < 0.6 * k_width ? material : 0);
  }
  return mesh;
}

/// Every triangle with vertices of its own.
ContactMesh soup(const ContactMesh& of) {
  ContactMesh mesh;
  mesh.corner_uv = of.corner_uv;
  for (std::size_t t = 0; t < of.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(3 * t);
    for (std::size_t k = 0; k < 3; ++k) mesh.positions.push_back(of.corner(t, k));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

struct CurvedRelief : ::testing::TestWithParam<NamedMesh> {
  ContactMesh mesh = turned(GetParam().mesh);
  ContactSurface surface = waves_on(mesh, 8e-4);
  Vec3 up = turned({0, 0, 1}) - turned({0, 0, 0});
  std::uniform_real_distribution<double> unit{0, 1};

  Vec3 along_it(std::mt19937& random) {
    return normalized(cross(up, {unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5}));
  }
};

/// Close to edges and corners, in steps that are short beside the tolerance.
TEST_P(CurvedRelief, HasNoStepsBetweenTriangles) {
  constexpr double k_step = 5e-8, k_steepest = 0.5;
  std::mt19937 random(9);
  std::normal_distribution<double> aside(0, 3e-5);
  int near = 0;
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const std::size_t t = random() % mesh.triangles.size(), k = random() % 3;
    const double along = i % 2 == 0 ? 0 : unit(random);
    const Vec3 on = mesh.corner(t, k) + along * (mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k));
    Vec3 x = on + surface.contact_radius_m() * up + Vec3{aside(random), aside(random), aside(random)};
    x = x + (8e-5 * unit(random) - surface.clearance(x, 4e-3)) * up;
    const Vec3 step = k_step * along_it(random);
    double before = surface.clearance(x, 4e-3);
    for (int s = 0; s < 400; ++s) {
      x = x + step;
      const double now = surface.clearance(x, 4e-3);
      worst = std::max(worst, std::abs(now - before));
      near += std::abs(now) < 1e-4;
      before = now;
    }
  }
  EXPECT_LT(worst, 0.55 * surface.tolerance_m() + (1 + k_steepest) * k_step);
  EXPECT_GT(near, 40000);
}

/// Down to it and along it, over edges and corners.
TEST_P(CurvedRelief, IsNotPassed) {
  constexpr double k_look = 2e-6;
  constexpr double k_dip = 2e-6;  // Between the samples of a sweep, half a texel apart, over a corner.
  std::mt19937 random(17);
  int hits = 0;
  for (int i = 0; i < 250; ++i) {
    const Vec3 on = mesh.corner(random() % mesh.triangles.size(), random() % 3);
    const Vec3 aside = along_it(random);
    Vec3 from = on + surface.contact_radius_m() * up + 2e-4 * (unit(random) - 0.5) * aside;
    for (int k = 0; k < 3; ++k) from = from + (2e-5 * unit(random) - surface.clearance(from, 4e-3)) * up;
    if (surface.clearance(from, 4e-3) < 0) continue;
    const Vec3 way = 4e-4 * unit(random) * aside - 6e-5 * unit(random) * up;
    const auto hit = surface.sweep(from, from + way);
    hits += hit.has_value();
    const double end = hit ? hit->t : 1;
    for (double t = 0; t < end; t += k_look / norm(way))
      ASSERT_GT(surface.clearance(from + t * way, 4e-3), -k_dip) << i << ' ' << t;
    if (hit) {
      EXPECT_NEAR(surface.clearance(from + end * way, 4e-3), 0, k_dip) << i;
    }
  }
  EXPECT_GT(hits, 60);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, CurvedRelief,
    ::testing::Values(
        NamedMesh{"plane", grid([](double, double) { return 0.0; })},
        NamedMesh{"cylinder", grid([](double x, double) { return 40 * x * (k_width - x); })},
        NamedMesh{"steep", grid([](double x, double) { return 160 * x * (k_width - x); })},
        NamedMesh{"dome", grid([](double x, double y) { return 60 * x * (k_width - x) + 90 * y * (k_depth - y); })},
        NamedMesh{"oval", grid([](double x, double y) { return 9 * x * (k_width - x) + 140 * y * (k_depth - y); })},
        NamedMesh{"hollow", grid([](double x, double y) { return -8 * x * (k_width - x) - 12 * y * (k_depth - y); })},
        NamedMesh{"saddle", grid([](double x, double y) { return 14 * x * (k_width - x) - 20 * y * (k_depth - y); })},
        NamedMesh{"slightly", grid([](double x, double y) { return 2 * x * (k_width - x) - 3 * y * (k_depth - y); })},
        NamedMesh{"seam", with_patch(grid([](double x, double) { return 4 * x * (k_width - x); }), 0.4, 2)},
        NamedMesh{"patch", with_patch(grid([](double, double) { return 0.0; }), 0.4, 0.7)},
        NamedMesh{"slit", with_slit(grid([](double, double) { return 0.0; }))},
        NamedMesh{"materials", with_material(grid([](double, double) { return 0.0; }), 1)},
        NamedMesh{"plain", with_material(grid([](double x, double) { return 3 * x * (k_width - x); }), 2)},
        NamedMesh{"soup", soup(grid([](double x, double y) { return 3 * x * (k_width - y); }))},
        NamedMesh{"hub", hub(48, 2e-4)}, NamedMesh{"cone", hub(20, 9e-4)}, NamedMesh{"blunt", hub(11, 6e-5)}),
    [](const auto& mesh) { return mesh.param.name; });

/// The plane orthogonal to the ridge, where the third face stops to count: it would seem 1 µm higher than the others.
TEST(ContactRelief, HasNoStepAboveTheTipOfAGable) {
  constexpr double k_step = 5e-8;
  const ContactSurface surface = waves_on(gable(), 8e-4);
  for (const double aside : {-4e-5, 0.0, 2e-5}) {
    const auto clearance = [&](int k) {
      return surface.clearance({0.5 * k_width + aside, 0.5 * k_depth + k * k_step, surface.contact_radius_m() + 5e-5},
                               4e-3);
    };
    for (int k = -20; k < 20; ++k)
      EXPECT_NEAR(clearance(k + 1), clearance(k), 0.55 * surface.tolerance_m() + k_step) << aside << ' ' << k;
  }
}

/// A shared edge, in any order and with vertices of its own, is no rim: a ball beside it feels no neighbour.
TEST(ContactRelief, SoupsAreFeltAsMeshes) {
  const ContactMesh mesh = grid([](double, double) { return 0.0; });
  const ContactSurface joined = waves_on(mesh, 1e-3), apart = waves_on(soup(mesh), 1e-3);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.3, 0.7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x{unit(random) * k_width, unit(random) * k_depth, joined.contact_radius_m() + 3e-5};
    ASSERT_EQ(apart.clearance(x, 3e-3), joined.clearance(x, 3e-3)) << i;
  }
}

/// On a ramp of slope m the skin lies orthogonally to it: it is touched √(1 + m²) skins above.
TEST(ContactRelief, TheSkinIsAsThickOnSlopes) {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < k_columns; ++x)
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535.0 * x / (k_columns - 1))));
  HeightFieldOptions options;
  options.scale_m = k_width * (k_columns - 1) / k_columns;  // From the centre of the first texel to that of the last.
  ContactMaterial material;
  material.height = 0;
  const ContactTriangles surface(plate(1, 1, k_width, k_depth), {material},
                                 {HeightField(k_columns, 3, samples, options)}, 0);
  const double skin = surface.skin_m(), first = 0.5 * k_width / k_columns, z = 8e-3;
  for (const double x : {0.3, 0.44, 0.61}) {
    const Vec3 above = Vec3{x * k_width, 0.2 * k_depth, z} - surface.origin();  // Of the triangle below the diagonal.
    const double lift = x * k_width - first + (std::sqrt(2.0) - 1) * skin;
    ContactTriangles::Clearance below;
    below.distance = 1;
    for (const std::uint32_t place : {0U, 1U}) {
      const auto of_face = surface.clearance_of(surface.face(place), above);
      if (of_face.distance < below.distance) below = of_face;
    }
    EXPECT_NEAR(below.value, z - skin - lift, 2e-7) << x;
  }
}

/// Beside a relief that lies below the mesh the base of plain triangles slants down to it, and what fills it up rises.
TEST(ContactRelief, PlainTrianglesBesideALowerReliefAreNotPassed) {
  constexpr double k_lowered = 1e-4;
  ContactMesh mesh = plate(2, 1, k_width, k_depth);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.material.push_back(mesh.corner(t, 0).x + mesh.corner(t, 1).x + mesh.corner(t, 2).x > 1.5 * k_width ? 1 : 0);
  std::vector<ContactMaterial> materials(2);
  materials[0].height = 0;
  HeightFieldOptions options;
  options.offset_m = -k_lowered;
  const ContactTriangles surface(mesh, materials, {HeightField(2, 2, {0, 0, 0, 0}, options)}, 0);
  const double over = surface.skin_m() + 2e-5;
  for (const double y : {0.2, 0.5, 0.7}) {
    const Vec3 from{0.95 * k_width, y * k_depth, over}, to{0.6 * k_width, y * k_depth, over - 4e-5};
    const auto hit = surface.sweep(from, to);
    ASSERT_TRUE(hit) << y;
    EXPECT_NEAR(over - 4e-5 * hit->t, surface.skin_m(), 1.1 * surface.tolerance_m()) << y;
  }
}

}  // namespace
}  // namespace papilla::testing
