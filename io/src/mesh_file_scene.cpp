// SPDX-License-Identifier: MIT
#include "mesh_file_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/core/unit_name.hpp"
#include "papilla/core/units.hpp"
#include "papilla/meshing/mesh_bounds.hpp"

namespace papilla {
namespace {

// The least and the largest of what an interior is made of: a button, a vehicle's cabin or a room.
constexpr double k_least_part_mm = 10, k_largest_interior_mm = 20000;
/// Nothing that people sit on, lie on, stand at or walk through is smaller.
constexpr double k_least_large_thing_mm = 300;

/// Whether a word is a name of such a thing.
bool is_large_thing(const std::string& word) {
  static const std::set<std::string> k_things = {
      "armchair", "bed",  "bench",    "cabin", "cabinet", "car",   "chair", "cockpit", "couch", "dash",    "dashboard",
      "desk",     "door", "interior", "room",  "seat",    "shelf", "sofa",  "stool",   "table", "wardrobe"};
  return k_things.contains(word);
}

std::string with_article(const std::string& word) {
  return (std::string_view("aeiou").find(word.front()) == std::string_view::npos ? "a " : "an ") + word;
}

/// The last word of a name in lower case: "sofa" of "Leather-Sofa_02".
std::string last_word(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
  const auto end = std::find_if(name.rbegin(), name.rend(), is_letter);
  const auto begin = std::find_if_not(end, name.rend(), is_letter);
  std::string word(begin.base(), end.base());
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

}  // namespace

Scene unitless_scene(std::string format, const ReadOptions& options, UpAxis convention) {
  const double unit = options.millimetres_per_unit.value_or(1);
  if (!(unit > 0 && unit <= 1e9))
    throw InvalidInput(fmt::format("ReadOptions: millimetres_per_unit = {} is not in (0, 1e9]", unit));
  Scene scene;
  scene.format = std::move(format);
  scene.unit = options.millimetres_per_unit ? unit_name(unit) : unit_name(unit) + " (assumed)";
  scene.millimetres_per_unit = unit;
  scene.up = options.up.value_or(convention);
  return scene;
}

Color color_from_srgb(double r, double g, double b, double alpha) {
  const auto linear = [](double x) { return static_cast<float>(linear_from_srgb(x)); };
  return {linear(r), linear(g), linear(b), static_cast<float>(std::clamp(alpha, 0.0, 1.0))};
}

void hint_at_unit(Scene& scene, const std::string& file_name) {
  Bounds3 bounds;
  for (const Part& part : scene.parts) bounds.add(bounds_of(part.mesh));
  if (bounds.is_empty()) return;
  const Vec3 size = bounds.size();
  const double largest = std::max({size.x, size.y, size.z});
  std::string thing = last_word(file_name);
  if (!is_large_thing(thing) && scene.parts.size() == 1) thing = last_word(scene.parts[0].name);
  const bool is_large = is_large_thing(thing);
  const bool is_small = largest < (is_large ? k_least_large_thing_mm : k_least_part_mm);
  if (!is_small && !(largest > k_largest_interior_mm)) return;
  const auto is_plausible = [&](double mm) {
    return mm >= (is_large ? k_least_large_thing_mm : k_least_part_mm) && mm <= k_largest_interior_mm;
  };
  std::string others;
  for (const auto& [name, mm] : {std::pair{"cm", 10.0}, {"m", k_mm_per_metre}, {"in", k_mm_per_inch}})
    if (is_plausible(largest * mm))
      others += fmt::format("{}{:.3g} m in {} (--unit {})", others.empty() ? "; it would be " : ", ",
                            largest * mm / k_mm_per_metre, name, name);
  scene.warnings.push_back(fmt::format(
      "the file states no unit; in millimetres all of it is {:.3g} x {:.3g} x {:.3g} mm, {} {}{}", size.x, size.y,
      size.z, is_small ? "small for" : "large for", is_large ? with_article(thing) : "an interior", others));
}

void add_part_nodes(Scene& scene, const std::string& fallback_name) {
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    Part& part = scene.parts[i];
    if (part.name.empty()) part.name = fallback_name;
    Node node;
    node.name = part.name;
    node.part = i;
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(node));
  }
  assign_part_ids(scene);
}

}  // namespace papilla
