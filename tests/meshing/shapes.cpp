// SPDX-License-Identifier: MIT
#include "meshing/shapes.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

namespace papilla::test {
namespace {

Index id(int value) { return static_cast<Index>(value); }

void add_quad(TriangleMesh& mesh, Index a, Index b, Index c, Index d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// Quadrangles over u in [0, nu], v in [0, nv], wrapped where told.
TriangleMesh patch(int nu, int nv, bool wrap_u, bool wrap_v, const std::function<Vec3(double, double)>& point) {
  TriangleMesh mesh;
  const int columns = wrap_u ? nu : nu + 1, rows = wrap_v ? nv : nv + 1;
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u) mesh.positions.push_back(point(u, v));
  const auto at = [&](int u, int v) { return id((v % rows) * columns + u % columns); };
  for (int v = 0; v < nv; ++v)
    for (int u = 0; u < nu; ++u) add_quad(mesh, at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1));
  return mesh;
}

}  // namespace

TriangleMesh grid(int nx, int ny) {
  return patch(nx, ny, false, false, [](double x, double y) { return Vec3{x, y, 0}; });
}

TriangleMesh terrain(int n, double height, unsigned seed) {
  TriangleMesh mesh = grid(n, n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> z(0, height);
  for (Vec3& p : mesh.positions) p.z = z(random);
  return mesh;
}

TriangleMesh cube(int n) {
  TriangleMesh mesh;
  std::map<std::tuple<int, int, int>, Index> numbers;
  const auto vertex = [&](int x, int y, int z) {
    const auto [place, is_new] = numbers.try_emplace({x, y, z}, id(static_cast<int>(mesh.positions.size())));
    if (is_new) mesh.positions.push_back({double(x) / n, double(y) / n, double(z) / n});
    return place->second;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int k = i + 1, l = j + 1;
      add_quad(mesh, vertex(i, j, n), vertex(k, j, n), vertex(k, l, n), vertex(i, l, n));
      add_quad(mesh, vertex(i, j, 0), vertex(i, l, 0), vertex(k, l, 0), vertex(k, j, 0));
      add_quad(mesh, vertex(n, i, j), vertex(n, k, j), vertex(n, k, l), vertex(n, i, l));
      add_quad(mesh, vertex(0, i, j), vertex(0, i, l), vertex(0, k, l), vertex(0, k, j));
      add_quad(mesh, vertex(i, n, j), vertex(i, n, l), vertex(k, n, l), vertex(k, n, j));
      add_quad(mesh, vertex(i, 0, j), vertex(k, 0, j), vertex(k, 0, l), vertex(i, 0, l));
    }
  return mesh;
}

TriangleMesh sphere(int n) {
  TriangleMesh mesh = cube(n);
  for (Vec3& p : mesh.positions) p = normalized(p - Vec3{0.5, 0.5, 0.5});
  return mesh;
}

TriangleMesh torus(int around, int across) {
  const double du = 2 * std::numbers::pi / around, dv = 2 * std::numbers::pi / across;
  return patch(around, across, true, true, [=](double u, double v) {
    const double r = 3 + std::cos(v * dv);
    return Vec3{r * std::cos(u * du), r * std::sin(u * du), std::sin(v * dv)};
  });
}

TriangleMesh tube(int around, int along) {
  const double du = 2 * std::numbers::pi / around;
  return patch(around, along, true, false, [=](double u, double v) {
    return Vec3{std::cos(u * du), std::sin(u * du), 2 * v / along};
  });
}

TriangleMesh moebius(int n) {
  const double du = 2 * std::numbers::pi / n;
  TriangleMesh mesh = patch(n - 1, 1, false, false, [=](double u, double v) {
    const double w = v - 0.5, r = 3 + w * std::cos(u * du / 2);
    return Vec3{r * std::cos(u * du), r * std::sin(u * du), w * std::sin(u * du / 2)};
  });
  add_quad(mesh, id(n - 1), id(n), id(0), id(2 * n - 1));  // joins the ends with a half turn
  return mesh;
}

TriangleMesh voxels(const std::set<Voxel>& filled) {
  TriangleMesh mesh;
  std::map<Voxel, Index> numbers;
  const auto vertex = [&](int x, int y, int z) {
    const auto [place, is_new] = numbers.try_emplace({x, y, z}, id(static_cast<int>(mesh.positions.size())));
    if (is_new) mesh.positions.push_back({double(x), double(y), double(z)});
    return place->second;
  };
  for (const auto& [x, y, z] : filled) {
    const auto is_free = [&, x = x, y = y, z = z](int dx, int dy, int dz) {
      return !filled.contains({x + dx, y + dy, z + dz});
    };
    const auto v = [&, x = x, y = y, z = z](int dx, int dy, int dz) { return vertex(x + dx, y + dy, z + dz); };
    if (is_free(1, 0, 0)) add_quad(mesh, v(1, 0, 0), v(1, 1, 0), v(1, 1, 1), v(1, 0, 1));
    if (is_free(-1, 0, 0)) add_quad(mesh, v(0, 0, 0), v(0, 0, 1), v(0, 1, 1), v(0, 1, 0));
    if (is_free(0, 1, 0)) add_quad(mesh, v(0, 1, 0), v(0, 1, 1), v(1, 1, 1), v(1, 1, 0));
    if (is_free(0, -1, 0)) add_quad(mesh, v(0, 0, 0), v(1, 0, 0), v(1, 0, 1), v(0, 0, 1));
    if (is_free(0, 0, 1)) add_quad(mesh, v(0, 0, 1), v(1, 0, 1), v(1, 1, 1), v(0, 1, 1));
    if (is_free(0, 0, -1)) add_quad(mesh, v(0, 0, 0), v(0, 1, 0), v(1, 1, 0), v(1, 0, 0));
  }
  return mesh;
}

TriangleMesh double_torus() {
  std::set<Voxel> slab;
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 3; ++y)
      if (!(y == 1 && (x == 1 || x == 3))) slab.insert({x, y, 0});
  return voxels(slab);
}

TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index first = id(static_cast<int>(soup.positions.size()));
    for (int k = 0; k < 3; ++k) soup.positions.push_back(mesh.corner(t, k));
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const Index offset = id(static_cast<int>(a.positions.size()));
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return both;
}

TriangleMesh moved(TriangleMesh mesh, Vec3 by) {
  for (Vec3& p : mesh.positions) p = p + by;
  return mesh;
}

TriangleMesh reversed(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh lattice_soup(int triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(0, 3);
  TriangleMesh soup;
  for (int i = 0; i < 3 * triangles; ++i) {
    soup.positions.push_back({double(place(random)), double(place(random)), double(place(random))});
    if (i % 3 == 2) soup.triangles.push_back({id(i - 2), id(i - 1), id(i)});
  }
  return soup;
}

void set_uv_to_xy(TriangleMesh& mesh) {
  mesh.uv.values.clear();
  for (const Vec3& p : mesh.positions) mesh.uv.values.push_back({p.x, p.y});
  mesh.uv.indices = mesh.triangles;
}

bool uv_is_xy(const TriangleMesh& mesh, double tolerance) {
  if (mesh.uv.indices.size() != mesh.triangles.size()) return false;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[mesh.triangles[t][k]];
      if (norm(mesh.uv.values[mesh.uv.indices[t][k]] - Vec2{p.x, p.y}) > tolerance) return false;
    }
  return true;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += 0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return sum;
}

double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += dot(mesh.corner(t, 0), cross(mesh.corner(t, 1), mesh.corner(t, 2))) / 6;
  return sum;
}

}  // namespace papilla::test
