// SPDX-License-Identifier: MIT
#include "papilla/io/scene.hpp"

#include <map>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// A node on the way from a root, in the order of a depth-first walk.
struct Visit {
  std::uint32_t node;
  std::size_t parent;   ///< Index of the parent's visit, or k_no_parent.
  std::size_t sibling;  ///< Number among the parent's children or the roots.
  int depth;
  Transform world;
};
constexpr std::size_t k_no_parent = static_cast<std::size_t>(-1);
constexpr int k_max_depth = 1024;  ///< Bounds the length of an assembly path; real assemblies stay below 50.

void check_node(const Scene& scene, std::uint32_t node, const std::string& where) {
  if (node >= scene.nodes.size())
    throw InvalidInput("scene: " + where + " names node " + std::to_string(node) + " of " +
                       std::to_string(scene.nodes.size()));
}

/// Depth-first order of all nodes that can be reached from the roots.
std::vector<Visit> walk(const Scene& scene) {
  std::vector<Visit> visits, stack;
  std::vector<bool> seen(scene.nodes.size(), false);
  const auto push = [&](const std::vector<std::uint32_t>& nodes, std::size_t parent, const Transform& world, int depth,
                        const std::string& where) {
    if (depth > k_max_depth)
      throw InvalidInput("scene: " + where + " is nested deeper than " + std::to_string(k_max_depth) + " levels");
    for (std::size_t i = nodes.size(); i-- > 0;) {
      check_node(scene, nodes[i], where);
      stack.push_back({nodes[i], parent, i, depth, multiply(world, scene.nodes[nodes[i]].local)});
    }
  };
  push(scene.roots, k_no_parent, k_identity, 0, "the list of roots");
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (seen[visit.node])
      throw InvalidInput("scene: node " + std::to_string(visit.node) + " is part of a cycle or has two parents");
    seen[visit.node] = true;
    visits.push_back(visit);
    const std::vector<std::uint32_t>& children = scene.nodes[visit.node].children;
    if (!children.empty())
      push(children, visits.size() - 1, visit.world, visit.depth + 1, "node " + std::to_string(visit.node));
  }
  return visits;
}

std::string path_of(const Scene& scene, const std::vector<Visit>& visits, std::size_t at) {
  std::string path;
  for (; at != k_no_parent; at = visits[at].parent) {
    const std::string& name = scene.nodes[visits[at].node].name;
    const std::string step = name.empty() ? "#" + std::to_string(visits[at].sibling) : name;
    path = path.empty() ? step : step + "/" + path;
  }
  return path;
}

/// Hands out names, the second time with "~2" behind, and so on.
class UniqueNames {
 public:
  std::string next(const std::string& wanted) {
    std::string name = wanted;
    for (int& count = uses_[wanted]; !taken_.insert(name).second;) name = wanted + "~" + std::to_string(++count + 1);
    return name;
  }

 private:
  std::map<std::string, int> uses_;
  std::set<std::string> taken_;
};

}  // namespace

Transform multiply(const Transform& a, const Transform& b) noexcept {
  Transform product{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) product[4 * row + column] += a[4 * row + k] * b[4 * k + column];
  return product;
}

double determinant(const Transform& t) noexcept {
  return dot(cross(Vec3{t[0], t[4], t[8]}, Vec3{t[1], t[5], t[9]}), Vec3{t[2], t[6], t[10]});
}

Vec3 transform_point(const Transform& t, Vec3 p) noexcept {
  return {t[0] * p.x + t[1] * p.y + t[2] * p.z + t[3], t[4] * p.x + t[5] * p.y + t[6] * p.z + t[7],
          t[8] * p.x + t[9] * p.y + t[10] * p.z + t[11]};
}

Transform to_y_up(UpAxis up) noexcept {
  if (up == UpAxis::y) return k_identity;
  return {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
}

std::vector<Instance> instances(const Scene& scene) {
  std::vector<Instance> result;
  for (const Visit& visit : walk(scene)) {
    const auto part = scene.nodes[visit.node].part;
    if (!part) continue;
    if (*part >= scene.parts.size())
      throw InvalidInput("scene: node " + std::to_string(visit.node) + " names part " + std::to_string(*part) + " of " +
                         std::to_string(scene.parts.size()));
    result.push_back({*part, visit.node, visit.world});
  }
  return result;
}

void assign_part_ids(Scene& scene) {
  const std::vector<Visit> visits = walk(scene);
  std::vector<bool> named(scene.parts.size(), false);
  UniqueNames names;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const auto part = scene.nodes[visits[i].node].part;
    if (!part || *part >= scene.parts.size() || named[*part]) continue;
    named[*part] = true;
    scene.parts[*part].id = names.next(path_of(scene, visits, i));
  }
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (!named[i]) scene.parts[i].id = names.next(scene.parts[i].name);
}

Scene single_part_scene(Part part, std::string format) {
  Scene scene;
  scene.format = std::move(format);
  Node node;
  node.name = part.name;
  node.part = 0;
  scene.parts.push_back(std::move(part));
  scene.nodes.push_back(std::move(node));
  scene.roots = {0};
  if (scene.parts[0].id.empty()) assign_part_ids(scene);
  return scene;
}

}  // namespace papilla
