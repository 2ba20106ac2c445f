// SPDX-License-Identifier: MIT
#include "bench/param_meshes.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "support/formula_meshes.hpp"

namespace papilla::bench {
namespace {

constexpr double k_pi = std::numbers::pi;

/// A sphere whose radius depends on the direction, open at its lowest ring.
TriangleMesh star(int rings, int segments, double open, const std::function<double(Vec3)>& radius) {
  return test::sphere_mesh(rings, segments, k_pi - open, radius);
}

struct Bump {
  Vec3 direction;
  double height, width;
};

double with_bumps(Vec3 d, const std::vector<Bump>& bumps) {
  double r = 1;
  for (const Bump& bump : bumps) {
    const double angle = std::acos(std::clamp(dot(d, normalized(bump.direction)), -1.0, 1.0)) / bump.width;
    r += bump.height * std::exp(-angle * angle);
  }
  return 100 * r;
}

TriangleMesh hand(int rings, int segments) {
  const std::vector<Bump> fingers{{{-0.8, 0, 0.9}, 1.6, 0.2},
                                  {{-0.3, 0, 1.2}, 2.0, 0.18},
                                  {{0.1, 0.1, 1.2}, 2.1, 0.18},
                                  {{0.5, 0, 1.1}, 1.9, 0.18},
                                  {{1, 0.3, 0.3}, 1.4, 0.22}};
  return star(rings, segments, 0.5, [&](Vec3 d) { return with_bumps(d, fingers); });
}

TriangleMesh head(int rings, int segments) {
  const std::vector<Bump> features{{{0, -1, 0.2}, 0.6, 0.25},      {{0.9, 0, 0.6}, 1.1, 0.16},
                                   {{-0.9, 0, 0.6}, 1.1, 0.16},    {{0, 1, -0.2}, 0.3, 0.6},
                                   {{0, -1, -0.5}, 0.4, 0.3},      {{0.3, -0.9, 0.4}, -0.2, 0.15},
                                   {{-0.3, -0.9, 0.4}, -0.2, 0.15}};
  return star(rings, segments, 0.4, [&](Vec3 d) { return with_bumps(d, features); });
}

/// A tube of radius 1 closed at its end.
TriangleMesh finger(int rings, double length) {
  TriangleMesh mesh;
  constexpr int segments = 24;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double a = 2 * k_pi * s / segments;
      mesh.positions.push_back({std::cos(a), std::sin(a), length * r / rings});
    }
  const auto vertex = [&](int r, int s) { return static_cast<Index>(r * segments + s % segments); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      mesh.triangles.push_back({vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1)});
      mesh.triangles.push_back({vertex(r, s), vertex(r + 1, s + 1), vertex(r + 1, s)});
    }
  const auto tip = static_cast<Index>(mesh.positions.size());
  mesh.positions.push_back({0, 0, length + 0.5});
  for (int s = 0; s < segments; ++s) mesh.triangles.push_back({vertex(rings, s), vertex(rings, s + 1), tip});
  return mesh;
}

TriangleMesh spiral(int turns) {
  return test::grid_mesh(24 * turns, 3, [&](double s, double t) {
    const double angle = 2 * k_pi * turns * s, r = 10 + 5 * t;
    return Vec3{r * std::cos(angle), -r * std::sin(angle), -2 * angle};
  });
}

TriangleMesh cut_torus(int around, int across) {
  return test::grid_mesh(around, across, [](double s, double t) {
    const double a = 2 * k_pi * s, b = 2 * k_pi * t, r = 3 + std::cos(b);
    return Vec3{r * std::cos(a), r * std::sin(a), std::sin(b)};
  });
}

TriangleMesh spikes(int rings, int segments, int count) {
  std::vector<Bump> bumps;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * k_pi * i / count;
    bumps.push_back({{std::cos(angle), std::sin(angle), i % 2 == 0 ? -0.2 : 0.8}, 2, 0.15});
  }
  return star(rings, segments, 0.4, [&](Vec3 d) { return with_bumps(d, bumps); });
}

TriangleMesh long_arms(int rings, int segments) {
  const std::vector<Bump> arms{
      {{0, 0, 1}, 4, 0.2}, {{1, 0, 0.2}, 4, 0.2}, {{-1, 0, 0.2}, 4, 0.2}, {{0, 1, 0}, 4, 0.2}, {{0, -1, 0}, 4, 0.2}};
  return star(rings, segments, 0.4, [&](Vec3 d) { return with_bumps(d, arms); });
}

/// A tube along a trefoil knot, cut open along its length and at one place across it.
TriangleMesh knot(int along, int across) {
  const auto curve = [](double a) {
    return Vec3{(2 + std::cos(1.5 * a)) * std::cos(a), (2 + std::cos(1.5 * a)) * std::sin(a), std::sin(1.5 * a)};
  };
  return test::grid_mesh(along, across, [&](double s, double t) {
    constexpr double step = 1e-4;
    const double a = 4 * k_pi * s, b = 2 * k_pi * t;
    const Vec3 tangent = normalized(curve(a + step) - curve(a - step)), side = normalized(cross(tangent, {0, 0, 1}));
    return curve(a) + 0.4 * (std::cos(b) * side + std::sin(b) * cross(tangent, side));
  });
}

TriangleMesh without_unused_vertices(const TriangleMesh& mesh) {
  constexpr Index unused = ~Index{0};
  TriangleMesh result;
  std::vector<Index> number(mesh.positions.size(), unused);
  for (Triangle t : mesh.triangles) {
    for (Index& v : t) {
      if (number[v] == unused) {
        number[v] = static_cast<Index>(result.positions.size());
        result.positions.push_back(mesh.positions[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(t);
  }
  return result;
}

/// A waved sheet cut into teeth.
TriangleMesh comb(int teeth, int length) {
  TriangleMesh mesh = test::grid_mesh(4 * teeth - 2, length, [&](double s, double t) {
    const double x = (4 * teeth - 2) * s, y = length * t;
    return Vec3{x, y, 3 * std::sin(x / 4) * std::cos(y / 4)};
  });
  const auto in_gap = [&](const Triangle& t) {
    const Vec3 c = (1.0 / 3) * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    return c.y > 2 && static_cast<int>(c.x) % 4 >= 2;
  };
  std::erase_if(mesh.triangles, in_gap);
  return without_unused_vertices(mesh);
}

}  // namespace

TriangleMesh squashed(const TriangleMesh& mesh, double height) {
  TriangleMesh result = mesh;
  std::vector<std::vector<Index>> around(mesh.positions.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (const Index v : mesh.triangles[t]) around[v].push_back(t);
  std::vector<char> border(mesh.positions.size(), 0), locked(mesh.positions.size(), 0);
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  for (const auto& [a, b] : edges)
    if (!edges.contains({b, a})) border[a] = border[b] = 1;
  const std::size_t wanted = mesh.triangles.size() / 100, stride = 61;  // spread over the mesh
  std::size_t done = 0;
  for (std::size_t i = 0; i < mesh.triangles.size() && done < wanted; ++i) {
    const Triangle& t = mesh.triangles[i * stride % mesh.triangles.size()];
    if (std::any_of(t.begin(), t.end(), [&](Index v) { return border[v] || locked[v]; })) continue;
    const Vec3 b = result.positions[t[1]], c = result.positions[t[2]], middle = 0.5 * (b + c);
    const Vec3 out = result.positions[t[0]] - middle;
    result.positions[t[0]] = middle + (height * norm(c - b) / norm(out)) * out;
    for (const Index v : t)
      for (const Index n : around[v])
        for (const Index w : mesh.triangles[n]) locked[w] = 1;
    ++done;
  }
  return result;
}

TriangleMesh trimmed(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  std::erase_if(result.triangles, [&](const Triangle& t) {
    const Vec3 c = (1.0 / 3) * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    return std::hypot(c.x - 350, c.y - 250) < 70 || std::hypot(c.x - 750, c.y - 170) < 50 ||
           std::hypot(c.x - 1150, c.y - 300) < 60;
  });
  return result;
}

TriangleMesh needle_panel(double squeeze) {
  return test::grid_mesh(2000, 5, [squeeze](double s, double t) {
    const double z =
        0.3 * std::sin(k_pi * s) + 0.25 * std::sin(k_pi * t) + 0.1 * std::sin(2 * k_pi * s) * std::sin(k_pi * t);
    return 1000.0 * Vec3{2 * s * squeeze, 5 * t, z};
  });
}

std::vector<NamedMesh> curved_disks(bool quick) {
  if (quick) return {{"hand", hand(30, 40)}};
  return {{"hand", hand(110, 96)},
          {"head", head(110, 96)},
          {"finger of length 30", finger(120, 30)},
          {"sphere open by 0.1", star(80, 60, 0.1, [](Vec3) { return 100.0; })},
          {"twelve spikes", spikes(120, 110, 12)},
          {"five long arms", long_arms(140, 110)},
          {"cut torus", cut_torus(120, 60)},
          {"trefoil knot", knot(400, 24)},
          {"comb", comb(20, 40)},
          {"spiral of 30 levels", spiral(30)},
          {"ramp of 2.5 turns", test::grid_mesh(120, 12, test::helical_ramp)}};
}

}  // namespace papilla::bench
