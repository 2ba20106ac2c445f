// SPDX-License-Identifier: MIT
#include "plane_groups.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace papilla::texture_detail {
namespace {

using Matrices = std::vector<LatticeMatrix>;

constexpr LatticeMatrix k_identity{};

/// Matrices of determinant ±1 under which the lengths and the angle of the vectors change by at most `tolerance`. In a
/// reduced basis all of them have entries −1, 0, 1.
Matrices holohedry(const std::array<Vec2, 2>& vectors, double tolerance) {
  const double aa = dot(vectors[0], vectors[0]), bb = dot(vectors[1], vectors[1]), ab = dot(vectors[0], vectors[1]);
  const double scale = std::sqrt(aa * bb);
  Matrices found = {k_identity};
  for (int i = 0; i < 81; ++i) {
    const LatticeMatrix m{i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 - 1};
    if (std::abs(m.determinant()) != 1 || m == k_identity) continue;
    const auto image_product = [&](int p, int q, int r, int s) {
      return p * r * aa + (p * s + q * r) * ab + q * s * bb;
    };
    const double image_aa = image_product(m.a, m.c, m.a, m.c), image_bb = image_product(m.b, m.d, m.b, m.d);
    const double image_ab = image_product(m.a, m.c, m.b, m.d);
    // Squares of lengths change by twice as much as lengths.
    if (std::abs(image_aa - aa) <= 2 * tolerance * aa && std::abs(image_bb - bb) <= 2 * tolerance * bb &&
        std::abs(image_ab - ab) <= 2 * tolerance * scale)
      found.push_back(m);
  }
  return found;
}

bool contains(const Matrices& group, const LatticeMatrix& m) {
  return std::find(group.begin(), group.end(), m) != group.end();
}

/// The group that two matrices generate; nothing when it is larger than a point group of the plane can be.
std::optional<Matrices> closure(const LatticeMatrix& p, const LatticeMatrix& q) {
  constexpr std::size_t k_most = 12;
  Matrices group = {k_identity};
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const LatticeMatrix& generator : {p, q}) {
      const LatticeMatrix next = product(group[i], generator);
      if (contains(group, next)) continue;
      if (group.size() == k_most) return std::nullopt;
      group.push_back(next);
    }
  return group;
}

bool same_elements(const Matrices& p, const Matrices& q) {
  return p.size() == q.size() &&
         std::all_of(p.begin(), p.end(), [&](const LatticeMatrix& m) { return contains(q, m); });
}

/// All subgroups; those of point groups of the plane have at most two generators.
std::vector<Matrices> subgroups(const Matrices& elements) {
  std::vector<Matrices> groups;
  for (const LatticeMatrix& p : elements)
    for (const LatticeMatrix& q : elements) {
      const std::optional<Matrices> group = closure(p, q);
      const bool known = !group || std::any_of(groups.begin(), groups.end(),
                                               [&](const Matrices& other) { return same_elements(*group, other); });
      if (!known) groups.push_back(*group);
    }
  return groups;
}

bool is_even(int n) { return n % 2 == 0; }

/// A reflection that is diag(1, −1) in some basis, not an exchange of two basis vectors.
bool is_primitive(const LatticeMatrix& m) {
  return is_even(m.a - 1) && is_even(m.b) && is_even(m.c) && is_even(m.d - 1);
}

/// True when M x + t/2, M a reflection, leaves no line in place: no lattice vector l makes (I + M)(t/2 + l) zero.
bool is_glide(const PlaneOperation& operation) {
  const LatticeMatrix& m = operation.matrix;
  const auto twice = [&](int u, int v) { return std::array{u + m.a * u + m.b * v, v + m.c * u + m.d * v}; };
  const std::array<int, 2> along = twice(operation.half_u, operation.half_v);
  for (int v = -2; v <= 2; ++v)
    for (int u = -2; u <= 2; ++u) {
      const std::array<int, 2> shift = twice(2 * u, 2 * v);
      if (along[0] + shift[0] == 0 && along[1] + shift[1] == 0) return false;
    }
  return true;
}

/// A reflection keeps a shortest lattice vector: mirrors along the translations, as in p31m.
bool keeps_a_shortest_vector(const LatticeMatrix& m, const std::array<Vec2, 2>& vectors) {
  const double shortest = norm(vectors[0] - vectors[1]) < norm(vectors[0] + vectors[1]) ? -1.0 : 1.0;
  for (const Vec2 v : {Vec2{1, 0}, Vec2{0, 1}, Vec2{1, shortest}})
    if (apply(m, v) == v) return true;
  return false;
}

WallpaperGroup name_of(const std::vector<PlaneOperation>& operations, const std::array<Vec2, 2>& vectors) {
  int rotations = 0, mirrors = 0, glides = 0;
  bool centred = true, keeps = false;
  for (const PlaneOperation& operation : operations) {
    if (operation.matrix.determinant() > 0) {
      ++rotations;
      continue;
    }
    ++(is_glide(operation) ? glides : mirrors);
    if (is_primitive(operation.matrix)) centred = false;
    keeps = keeps || keeps_a_shortest_vector(operation.matrix, vectors);
  }
  const bool reflects = mirrors + glides > 0;
  switch (rotations) {
    case 2:
      if (!reflects) return WallpaperGroup::p2;
      if (centred) return WallpaperGroup::cmm;
      return glides == 0 ? WallpaperGroup::pmm : mirrors > 0 ? WallpaperGroup::pmg : WallpaperGroup::pgg;
    case 3: return !reflects ? WallpaperGroup::p3 : keeps ? WallpaperGroup::p31m : WallpaperGroup::p3m1;
    case 4: return !reflects ? WallpaperGroup::p4 : glides == 0 ? WallpaperGroup::p4m : WallpaperGroup::p4g;
    case 6: return reflects ? WallpaperGroup::p6m : WallpaperGroup::p6;
    default:
      if (!reflects) return WallpaperGroup::p1;
      return centred ? WallpaperGroup::cm : glides == 0 ? WallpaperGroup::pm : WallpaperGroup::pg;
  }
}

/// The operations of a point group whose rotations turn about the origin and whose reflection m0 moves by t/2; nothing
/// when these do not generate a group with this lattice.
std::optional<std::vector<PlaneOperation>> operations_of(const Matrices& group, const LatticeMatrix& m0, int half_u,
                                                         int half_v) {
  const auto whole = [&](const LatticeMatrix& m, int sign) {  // (I ± M) t/2 is a lattice vector.
    return is_even(half_u + sign * (m.a * half_u + m.b * half_v)) &&
           is_even(half_v + sign * (m.c * half_u + m.d * half_v));
  };
  std::vector<PlaneOperation> operations;
  for (const LatticeMatrix& m : group) {
    if (m.determinant() < 0) continue;
    if (!whole(m, -1)) return std::nullopt;
    operations.push_back({m, 0, 0});
  }
  const std::size_t rotations = operations.size();
  if (!whole(m0, 1)) return std::nullopt;
  for (std::size_t i = 0; i < rotations; ++i) operations.push_back({product(m0, operations[i].matrix), half_u, half_v});
  return operations;
}

}  // namespace

LatticeMatrix product(const LatticeMatrix& p, const LatticeMatrix& q) {
  return {p.a * q.a + p.b * q.c, p.a * q.b + p.b * q.d, p.c * q.a + p.d * q.c, p.c * q.b + p.d * q.d};
}

Vec2 apply(const LatticeMatrix& m, Vec2 x) { return {m.a * x.x + m.b * x.y, m.c * x.x + m.d * x.y}; }

std::vector<PlaneGroup> plane_groups(const std::array<Vec2, 2>& vectors, double tolerance) {
  std::vector<PlaneGroup> groups;
  for (const Matrices& group : subgroups(holohedry(vectors, tolerance))) {
    // A diagonal reflection first: only its glides tell p4g from p4m.
    std::optional<LatticeMatrix> reflection;
    for (const LatticeMatrix& m : group)
      if (m.determinant() < 0 && (!reflection || (is_primitive(m) && !is_primitive(*reflection)))) reflection = m;
    if (!reflection) {
      std::vector<PlaneOperation> operations;
      for (const LatticeMatrix& m : group) operations.push_back({m, 0, 0});
      groups.push_back({name_of(operations, vectors), std::move(operations)});
      continue;
    }
    for (int t = 0; t < 4; ++t)
      if (auto operations = operations_of(group, *reflection, t % 2, t / 2))
        groups.push_back({name_of(*operations, vectors), std::move(*operations)});
  }
  return groups;
}

}  // namespace papilla::texture_detail
