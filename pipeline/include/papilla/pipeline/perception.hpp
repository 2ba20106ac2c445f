// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/visibility.hpp"

namespace papilla {

/// Where hands and eyes can be, and what is to be left out.
struct PerceptionOptions {
  std::vector<Volume> reach, view;  ///< In the scene's frame; several are taken together; empty: not asked.
  bool leave_out_unreachable = false, leave_out_unseen = false;  ///< Both: what can be neither touched nor seen.
  std::uint32_t samples = 1000;                                  ///< VisibilityOptions::samples_per_part.

  bool asked() const noexcept { return !reach.empty() || !view.empty() || leave_out_unreachable || leave_out_unseen; }
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

struct ScenePerception {
  std::vector<Instance> uses;
  std::vector<Perception> of_use;     ///< In the order of `uses`.
  std::vector<PartPerception> parts;  ///< In the order of Scene::parts.
};

/// Measures reach and visibility of every use of every part (measure_reach(), measure_visibility(); parts with a
/// material of alpha mode BLEND hide nothing), and finds what is to be left out: what none of the named senses gets at.
/// @throws InvalidInput when something is to be left out without the volume that it needs; as measure_visibility().
ScenePerception measure_perception(const Scene& scene, const PerceptionOptions& options,
                                   const ProgressCallback& progress = {});

/// Removes the uses that are left out from the scene. Parts without a use stay as empty ones, so that part numbers stay
/// valid.
void leave_out(Scene& scene, const ScenePerception& perception);

}  // namespace papilla
