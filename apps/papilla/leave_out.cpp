// SPDX-License-Identifier: GPL-3.0-or-later
#include "leave_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bake/plan.hpp"
#include "exit_code.hpp"
#include "papilla/core/error.hpp"
#include "placed_meshes.hpp"
#include "volume_option.hpp"

namespace papilla::app {
namespace {

bool wants(const LeaveOutOptions& options, const char* what) {
  return std::find(options.leave_out.begin(), options.leave_out.end(), what) != options.leave_out.end();
}

void check(const LeaveOutOptions& options) {
  if (wants(options, "unreachable") && options.reach.empty())
    throw UsageError("--leave-out: 'unreachable' needs --reach");
  if (wants(options, "unseen") && options.view.empty()) throw UsageError("--leave-out: 'unseen' needs --view");
}

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

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

void LeaveOutOptions::add_to(CLI::App& verb, bool can_leave_out) {
  verb.add_option("--reach", reach, "Where hands can be, mm in the scene's frame: X,Y,Z,R, X,Y,Z,X,Y,Z or a JSON file")
      ->type_name("VOLUME")
      ->group("Leave out");
  verb.add_option("--view", view, "Where eyes can be, given like --reach")->type_name("VOLUME")->group("Leave out");
  verb.add_option("--view-samples", samples, "Points looked at on every use of a part")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->group("Leave out");
  if (!can_leave_out) return;
  verb.add_option("--leave-out", leave_out,
                  "unreachable, unseen, or both: then parts that can be neither touched nor seen")
      ->type_name("WHAT,...")
      ->delimiter(',')
      ->check(CLI::IsMember({"unreachable", "unseen"}))
      ->group("Leave out");
}

LeaveOutResult measure_perception(const Scene& scene, const LeaveOutOptions& options,
                                  const ProgressCallback& progress) {
  check(options);
  LeaveOutResult result;
  result.uses = instances(scene);
  result.of_use.resize(result.uses.size());
  result.parts.resize(scene.parts.size());
  const std::vector<PlacedMesh> placed = placed_meshes(scene, result.uses);
  if (!options.reach.empty()) measure_reaches(placed, parse_volumes("--reach", options.reach), result.of_use);
  if (!options.view.empty())
    measure_views(placed, parse_volumes("--view", options.view), options.samples, result.of_use, progress);

  const bool unreachable = wants(options, "unreachable"), unseen = wants(options, "unseen");
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

void leave_out(Scene& scene, const LeaveOutResult& result) {
  for (std::size_t i = 0; i < result.uses.size(); ++i)
    if (!result.of_use[i].left_out.empty()) scene.nodes[result.uses[i].node].part.reset();
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    if (result.parts[p].left_out.empty()) continue;
    scene.parts[p].mesh = {};
    scene.parts[p].levels.clear();
    scene.parts[p].materials.clear();
  }
}

Json perception_json(const std::string& name, const PartPerception& part) {
  const bool reach = part.in_reach.has_value(), view = part.visible_fraction.has_value();
  return {{"part", name},
          {"instances", part.instances},
          {"in_reach", or_null(part.in_reach)},
          {"instances_in_reach", reach ? Json(part.instances_in_reach) : Json(nullptr)},
          {"visible_fraction", or_null(part.visible_fraction)},
          {"instances_seen", view ? Json(part.instances_seen) : Json(nullptr)},
          {"left_out", part.left_out.empty() ? Json(nullptr) : Json(std::string(part.left_out))},
          {"instances_left_out", part.instances_left_out}};
}

Json perception_json(const Scene& scene, const LeaveOutResult& result) {
  Json json = Json::array();
  for (std::size_t p = 0; p < result.parts.size(); ++p)
    json.push_back(perception_json(scene.parts[p].name, result.parts[p]));
  return json;
}

std::string left_out_table(const Scene& scene, const LeaveOutResult& result) {
  std::string table;
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const PartPerception& part = result.parts[p];
    if (part.instances_left_out == 0) continue;
    const std::string uses = part.instances_left_out == part.instances
                                 ? ""
                                 : fmt::format(" ({} of {} uses)", part.instances_left_out, part.instances);
    std::string_view reason = part.left_out;
    for (std::size_t i = 0; reason.empty() && i < result.uses.size(); ++i)
      if (result.uses[i].part == p) reason = result.of_use[i].left_out;
    table += fmt::format("left out: {}{}: {}\n", scene.parts[p].name, uses, reason);
  }
  return table;
}

}  // namespace papilla::app
