// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/visibility.hpp"
#include "verb.hpp"

namespace papilla::app {

/// Where hands and eyes can be, and what is to be left out: the options --reach, --view, --view-samples, --leave-out.
struct LeaveOutOptions {
  std::string reach, view;             ///< As parse_volumes() reads them; empty: not asked.
  std::vector<std::string> leave_out;  ///< "unreachable", "unseen", or both.
  std::uint32_t samples = 1000;        ///< Per instance; VisibilityOptions::samples_per_part.

  void add_to(CLI::App& verb, bool can_leave_out = true);
  bool asked() const noexcept { return !reach.empty() || !view.empty(); }
};

/// How one use of a part can be perceived.
struct Perception {
  std::optional<bool> in_reach;              ///< Empty: no reach volume was given.
  std::optional<PartVisibility> visibility;  ///< Empty: no view volume was given. Of several the one that sees most.
  std::string_view left_out;                 ///< The reason; empty: it stays.
};

/// What is known of a part: of the use of it that is perceived best.
struct PartPerception {
  std::size_t instances = 0, instances_left_out = 0;
  std::size_t instances_in_reach = 0, instances_seen = 0;
  std::optional<bool> in_reach;
  std::optional<double> visible_fraction;
  std::string_view left_out;  ///< Not empty when all its uses are left out.
  bool is_only_seen = false;  ///< Unreachable parts are to be left out, but it is seen and stays.
};

struct LeaveOutResult {
  std::vector<Instance> uses;
  std::vector<Perception> of_use;     ///< In the order of `uses`.
  std::vector<PartPerception> parts;  ///< In the order of Scene::parts.
};

/// Measures reach and visibility of every use of every part (measure_reach(), measure_visibility(); parts with a
/// material of alpha mode BLEND hide nothing), and finds what is to be left out: what none of the named senses gets at.
/// @throws UsageError when something is to be left out without the volume that it needs; as parse_volumes().
LeaveOutResult measure_perception(const Scene& scene, const LeaveOutOptions& options, const ProgressCallback& progress);

/// Takes the uses that are left out from the scene. Parts without a use stay as empty ones, so that numbers stay valid.
void leave_out(Scene& scene, const LeaveOutResult& result);

/// {part, instances, in_reach, instances_in_reach, visible_fraction, instances_seen, left_out, instances_left_out}.
Json perception_json(const std::string& name, const PartPerception& part);
Json perception_json(const Scene& scene, const LeaveOutResult& result);

/// A row a part that is left out or has uses that are, for people; empty when there is none.
std::string left_out_table(const Scene& scene, const LeaveOutResult& result);

}  // namespace papilla::app
