// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "json/scene_json.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"

namespace papilla::app {
namespace {

std::string perception_text(const Scene& scene, const ScenePerception& perception) {
  std::string text = shown_format("\n{:>9} {:>8} {:>7} {:>9}  part\n", "instances", "in reach", "seen", "area seen");
  for (std::size_t p = 0; p < perception.parts.size(); ++p) {
    const PartPerception& part = perception.parts[p];
    const auto cell = [](bool known, std::size_t count) { return known ? std::to_string(count) : std::string("-"); };
    text += shown_format("{:>9} {:>8} {:>7} {:>9}  {}\n", part.instances,
                         cell(part.in_reach.has_value(), part.instances_in_reach),
                         cell(part.visible_fraction.has_value(), part.instances_seen),
                         part.visible_fraction ? shown_format("{:.1f} %", 100 * *part.visible_fraction) : "-",
                         shown_name(scene.parts[p]));
  }
  return text;
}

std::string simplified_row(std::size_t before, std::size_t after, double deviation, const std::string& name) {
  return shown_format("{:>10} {:>10} {:>12.4g}  {}\n", before, after, deviation, name);
}

/// A row a tagged material.
std::string haptic_text(const Scene& scene) {
  const std::vector<std::size_t> triangles = triangles_of_materials(scene);
  std::string rows;
  std::size_t count = 0;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const auto& tag = scene.materials[m].haptic;
    if (!tag) continue;
    ++count;
    std::string relief = "-";
    if (tag->height) relief = shown_format("{} x {}", tag->height->size[0], tag->height->size[1]);
    rows += shown_format("{:>9} {:>8.4g} {:>9.3g} {:>9} {:>11}  {}\n", triangles[m], tag->stiffness, tag->damping,
                         shown_format("{:.2g}/{:.2g}", tag->static_friction, tag->dynamic_friction), relief,
                         one_line(scene.materials[m].name));
  }
  if (count == 0) return "\nno haptic tag\n";
  return shown_format("\n{} haptic tags\n{:>9} {:>8} {:>9} {:>9} {:>11}  material\n", count, "triangles", "N/m",
                      "N s/m", "friction", "relief") +
         rows;
}

}  // namespace

std::string header_row() {
  return shown_format("{:>9} {:>9} {:>5} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>3}  part\n", "triangles",
                      "vertices", "comp", "loops", "genus", "nonman", "degen", "dupl", "flipped", "T-junc", "aspect",
                      "uv");
}

std::string counters_row(const std::string& name, const MeshStatistics& s) {
  return shown_format("{:>9} {:>9} {:>5} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9.4g} {:>3}  {}\n", s.triangles,
                      s.vertices, s.components, s.boundary_loops, s.genus, s.nonmanifold_edges, s.degenerate_triangles,
                      s.duplicate_triangles, s.flipped_edges, s.t_junctions, s.aspect_max, s.has_uv ? "yes" : "no",
                      name);
}

std::string inspect_text(const Scene& scene, const std::vector<MeshStatistics>& statistics,
                         const std::optional<ScenePerception>& perception, const SceneSides& sides) {
  const Vec3 size = scene_bounds(scene).size();
  std::string text = shown_format("{}, units {}, {} parts, {:.4g} x {:.4g} x {:.4g} mm\n\n", scene.format, scene.unit,
                                  scene.parts.size(), size.x, size.y, size.z);
  text += header_row();
  for (std::size_t i = 0; i < statistics.size(); ++i) text += counters_row(shown_name(scene.parts[i]), statistics[i]);
  if (statistics.size() > 1) text += counters_row("all parts", total_statistics(statistics));
  if (!scene.materials.empty()) text += shown_format("\n{} materials\n", scene.materials.size());
  for (const Material& material : scene.materials) {
    text += shown_format("  {}  base colour", material.name);
    for (const double value : material.base_color) text += shown_format(" {:.3g}", value);
    for (const auto& [use, name] : texture_names(scene, material)) text += shown_format("  {}: {}", use, name);
    text += "\n";
  }
  if (const std::string lines = sides_text(sides, false); !lines.empty()) text += "\n" + lines;
  text += haptic_text(scene);
  if (!scene.asset.copyright.empty()) text += "\ncopyright: " + one_line(scene.asset.copyright) + "\n";
  if (perception) text += perception_text(scene, *perception);
  return text;
}

std::string nodes_text(const std::vector<SurfacePlace>& places) {
  const auto joined = [](const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list.empty() ? "-" : list;
  };
  std::size_t width = 4, part_width = 4;
  for (const SurfacePlace& place : places) {
    width = std::clamp(joined(place.nodes).size(), width, std::size_t{60});
    part_width = std::clamp(place.parts.front().size(), part_width, std::size_t{30});
  }
  std::string text =
      shown_format("\n{:<{}}  {:<{}}  colour   material; layers; CAD material\n", "node", width, "part", part_width);
  for (const SurfacePlace& place : places)
    text +=
        shown_format("{:<{}}  {:<{}}  {:<7}  {}; {}; {}\n", joined(place.nodes), width, place.parts.front(), part_width,
                     joined(place.colours), joined(place.materials), joined(place.layers), joined(place.cad_materials));
  return text;
}

std::string tessellation_text(const Scene& scene, const CadReport& report) {
  const std::vector<std::size_t> uses = uses_of_parts(scene);
  std::string text = shown_format("{:>10} {:>9}  part\n", "triangles", "instances");
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    text +=
        shown_format("{:>10} {:>9}  {}\n", scene.parts[i].mesh.triangles.size(), uses[i], shown_name(scene.parts[i]));
  text += shown_format("{} triangles in {} parts, {} of {} CAD faces failed, largest deviation {:.3g} mm\n",
                       report.triangles, scene.parts.size(), report.failed_faces.size(), report.faces,
                       report.max_deviation_mm);
  for (const CadFaceNote& note : report.off_faces)
    text += shown_format("face {} of '{}' {}\n", note.face, note.part, note.reason);
  return text;
}

std::string ending_line(StopReason stop) {
  return stop == StopReason::time_limit ? "ended by the time limit: the best valid result so far\n" : "";
}

std::string repair_numbers_text(const RepairResult& result) {
  std::string done, text;
  for (const auto& [name, count] : k_repair_counts) {
    if (result.counts.*count == 0) continue;
    std::string words(name);
    std::replace(words.begin(), words.end(), '_', ' ');
    done += shown_format("{}{} {}", done.empty() ? "" : ", ", result.counts.*count, words);
  }
  if (!done.empty())
    text += shown_format("repaired: {}\nsurface lost within {:.3g} mm, added within {:.3g} mm, {}; {:.3g} mm allowed\n",
                         done, result.lost_mm, result.added_mm,
                         result.sampled ? "by samples of the large pieces" : "measured both ways", result.tolerance_mm);
  if (result.counts.opposites > 0)
    text += shown_format("double sheets: {} backs dropped, their fronts are shown from both sides\n",
                         result.counts.opposites);
  if (result.counts.kept_walls > 0)
    text += shown_format("not done: {} backs of double sheets stay, as each side goes on into other surface\n",
                         result.counts.kept_walls);
  if (result.counts.kept_backs > 0)
    text += shown_format("not done: {} backs of double sheets stay, as they look different from their fronts\n",
                         result.counts.kept_backs);
  if (result.refused_triangles > 0)
    text += shown_format(
        "not done: pieces of {} triangles stay as they came, as repair would have moved them by {:.3g} mm\n",
        result.refused_triangles, result.refused_mm);
  if (result.unfinished_triangles > 0)
    text +=
        shown_format("not done: pieces of {} triangles stay as they came, as the time limit left no time for them\n",
                     result.unfinished_triangles);
  return text;
}

std::string repair_text(const RepairSceneResult& result, const WrittenRepair& written) {
  std::string text = header_row() + counters_row("before", result.before) + counters_row("after", written.after);
  text += shown_format("largest deviation {:.3g} mm as written, weld tolerance {:.3g} mm\n",
                       written.max_deviation_mm(result.total), result.total.weld_tolerance_mm);
  text += repair_numbers_text(result.total) + sides_text(result.sides, true);
  for (std::size_t i = 0; i < result.parts.size(); ++i)
    if (!result.parts[i].settled && result.parts[i].unfinished_triangles == 0)
      text += shown_format("not settled: {}\n", shown_name(result.scene.parts[i]));
  return text + ending_line(result.stop);
}

std::string simplify_text(const SimplifySceneResult& result, const SimplifySceneOptions& options) {
  const Scene& scene = result.scene;
  std::string text;
  if (result.perception) text += left_out_table(scene, *result.perception);
  if (result.budget && !result.budget->reached && result.stop == StopReason::time_limit)
    text += shown_format("the budget of {} triangles was not reached in time: {} are left within {:.3g} mm\n",
                         *options.budget, result.budget->triangles, result.budget->tolerance_mm);
  else if (result.budget && !result.budget->reached)
    text += shown_format(
        "the budget of {} triangles can't be reached: {} are left within {:.3g} mm, and more deviation saves hardly "
        "any\n",
        *options.budget, result.budget->triangles, result.budget->tolerance_mm);
  text += shown_format("{:>10} {:>10} {:>12}  part\n", "before", "after", "deviation mm");
  for (std::size_t i = 0; i < result.parts.size(); ++i)
    if (const SimplifyResult& part = result.parts[i]; part.triangles_before > 0)
      text += simplified_row(part.triangles_before, result.triangles[i], part.deviation.bound(),
                             shown_name(scene.parts[i]));
  for (const LevelReport& level : result.levels) {
    const std::string& name = shown_name(scene.parts[level.part]);
    if (level.level > 0)
      text += simplified_row(level.triangles_before, level.triangles, level.max_deviation_mm,
                             shown_format("{} level {}", name, level.level));
    else
      text += shown_format("{:>10} {:>10} {:>12}  {}: no level within {:.4g} mm, it would not have a tenth less\n",
                           level.triangles_before, level.triangles, "-", name, level.tolerance_mm);
  }
  return text +
         simplified_row(result.triangles_before, result.triangles_after, result.max_deviation_mm, "drawn in all") +
         ending_line(result.stop);
}

std::string unwrap_remarks(const UnwrapResult& result) {
  std::string text = sides_text(result.sides, true);
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const UnwrappedPart& part = result.parts[p];
    if (part.is_far_from_manifold())
      text += shown_format(
          "part '{}' falls into {} charts, as {} of its {} inner edges have three triangles or more, or two that are "
          "wound against each other: repair it first, papilla repair IN -o CLEAN\n",
          shown_name(result.scene.parts[p]), part.flattening.charts.count, part.nonmanifold_edges + part.opposed_pairs,
          part.shared_edges);
    else if (part.opposed_edges > 0)
      text += shown_format(
          "part '{}': charts end at {} edges of triangles that are wound against each other; papilla repair turns "
          "them\n",
          shown_name(result.scene.parts[p]), part.opposed_edges);
    if (!part.reason.empty() && part.failure.empty()) text += shown_format("{}: {}\n", part.method, part.reason);
    if (!part.choices.empty() && (part.method == "levy" || part.method == "maillot")) {
      if (part.choices.size() > 1) text += shown_format("the first of {} charts: ", part.choices.size());
      text += shown_format("{}: {}\n", part.choices.front().method, part.choices.front().reason);
    }
    if (!part.failure.empty()) text += shown_format("not unwrapped: {}\n", part.failure);
    if (part.bound)
      text += shown_format("part '{}': {} {}, the bound of {} {}, with seams of {:.1f} mm\n",
                           shown_name(result.scene.parts[p]), part.bound->bound.percentile ? "percentile" : "mean",
                           shown_format("{:.6g}", part.bound->distortion), distortion_bound_name(part.bound->bound),
                           part.bound->kept ? "is kept" : "can't be kept", part.bound->seam_mm);
    if (!part.flattening.notes.empty())
      text += shown_format("{} charts did not take the method, the first: {}\n", part.flattening.notes.size(),
                           part.flattening.notes.front().reason);
  }
  return text + ending_line(result.stop);
}

}  // namespace papilla::app
