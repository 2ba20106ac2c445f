// SPDX-License-Identifier: MIT
#include "papilla/pipeline/perception.hpp"

#include <algorithm>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/bake_stages.hpp"
#include "placed_meshes.hpp"

namespace papilla {
namespace {

void measure_reaches(const std::vector<PlacedMesh>& placed, const std::vector<Volume>& volumes,
                     std::vector<Perception>& uses) {
  for (Perception& use : uses) use.in_reach = false;
  for (const Volume& volume : volumes) {
    const std::vector<PartReach> reach = measure_reach(placed, volume);
    for (std::size_t i = 0; i < uses.size(); ++i) uses[i].in_reach = *uses[i].in_reach || reach[i].in_reach();
  }
}

void measure_views(const std::vector<PlacedMesh>& placed, const std::vector<Volume>& volumes, std::uint32_t samples,
                   std::vector<Perception>& uses, const ProgressCallback& progress) {
  VisibilityOptions options;
  options.samples_per_part = samples;
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    report_progress(progress, "view", static_cast<double>(v) / static_cast<double>(volumes.size()));
    const std::vector<PartVisibility> seen = measure_visibility(placed, volumes[v], options);
    for (std::size_t i = 0; i < uses.size(); ++i)
      if (!uses[i].visibility || seen[i].visible_fraction > uses[i].visibility->visible_fraction)
        uses[i].visibility = seen[i];
  }
}

bool is_seen(const Perception& use) { return use.visibility && use.visibility->visible_samples > 0; }

LeftOut left_out_of(const Perception& use, bool unreachable, bool unseen) {
  const bool out_of_reach = unreachable && !*use.in_reach, out_of_sight = unseen && !is_seen(use);
  if (unreachable && unseen) return out_of_reach && out_of_sight ? LeftOut::unreachable_and_unseen : LeftOut::no;
  if (out_of_reach) return LeftOut::unreachable;
  return out_of_sight ? LeftOut::unseen : LeftOut::no;
}

void add_use(const Perception& use, PartPerception& part) {
  ++part.instances;
  if (use.in_reach) {
    part.in_reach = part.in_reach.value_or(false) || *use.in_reach;
    part.instances_in_reach += *use.in_reach ? 1U : 0U;
  }
  if (use.visibility) {
    part.visible_fraction = std::max(part.visible_fraction.value_or(0), use.visibility->visible_fraction);
    part.instances_seen += is_seen(use) ? 1U : 0U;
  }
  if (!use.left_out.empty()) {
    ++part.instances_left_out;
    part.left_out = use.left_out;
  }
}

}  // namespace

ScenePerception measure_perception(const Scene& scene, const PerceptionOptions& options,
                                   const ProgressCallback& progress) {
  const bool unreachable = options.leave_out_unreachable, unseen = options.leave_out_unseen;
  if (unreachable && options.reach.empty())
    throw InvalidInput("measure_perception: leaving out what is unreachable needs a reach volume");
  if (unseen && options.view.empty())
    throw InvalidInput("measure_perception: leaving out what is unseen needs a view volume");
  ScenePerception result;
  result.uses = instances(scene);
  result.of_use.resize(result.uses.size());
  result.parts.resize(scene.parts.size());
  const std::vector<PlacedMesh> placed = placed_meshes(scene, result.uses);
  if (!options.reach.empty()) measure_reaches(placed, options.reach, result.of_use);
  if (!options.view.empty()) measure_views(placed, options.view, options.samples, result.of_use, progress);

  for (std::size_t i = 0; i < result.uses.size(); ++i) {
    result.of_use[i].left_out = reason_of(left_out_of(result.of_use[i], unreachable, unseen));
    add_use(result.of_use[i], result.parts[result.uses[i].part]);
  }
  for (PartPerception& part : result.parts) {
    if (part.instances_left_out < part.instances) part.left_out = {};
    part.is_only_seen = unreachable && part.instances > 0 && part.left_out.empty() && !*part.in_reach;
  }
  return result;
}

void leave_out(Scene& scene, const ScenePerception& result) {
  for (std::size_t i = 0; i < result.uses.size(); ++i)
    if (!result.of_use[i].left_out.empty()) scene.nodes[result.uses[i].node].part.reset();
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    if (result.parts[p].left_out.empty()) continue;
    scene.parts[p].mesh = {};
    scene.parts[p].levels.clear();
    scene.parts[p].materials.clear();
  }
}

}  // namespace papilla
