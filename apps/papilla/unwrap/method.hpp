// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>

#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/natural.hpp"
#include "papilla/param/projections.hpp"
#include "papilla/param/reference_maps.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla::app {

enum class UnwrapMethod {
  natural,
  intermediate,
  planar,
  environment,
  triplanar,
  maillot,
  levy,
  tutte,
  mvc,
  lscm,
  arap,
  best
};

/// The methods by the names that the command line has for them.
const std::map<std::string, UnwrapMethod>& unwrap_methods();
std::string unwrap_method_name(UnwrapMethod method);

/// Whether the method maps charts that it is given; the others make their own.
bool takes_charts(UnwrapMethod method);

/// Where the charts come from: made by segmentation, or every connected component is one.
enum class ChartSource { automatic, keep };

/// The chosen method and the options of each. Orientation, tile and fallback are set for all by flatten_part().
struct MethodOptions {
  UnwrapMethod method = UnwrapMethod::lscm;
  ChartSource charts = ChartSource::automatic;
  SegmentationOptions segmentation;
  NaturalOptions natural;
  IntermediateOptions intermediate;
  PlanarOptions planar;
  EnvironmentOptions environment;
  TriplanarOptions triplanar;
  MaillotOptions maillot;
  LevyOptions levy;
  LscmOptions lscm;
  ReferenceOptions reference;
  BestOptions best;
  /// Of the methods that iterate; not given: the method's own.
  std::optional<int> iterations;
  std::optional<double> tolerance, time_limit_s;
};

/// The part's charts and uv in millimetres (environment: in textures), not placed yet. Equal positions must be one
/// vertex.
/// @throws what the method throws; InvalidInput, SolverFailure for components that can't be kept as charts.
Flattening flatten_part(const TriangleMesh& mesh, GrainUp up, Vec2 tile_mm, const MethodOptions& options,
                        double& segment_seconds);

}  // namespace papilla::app
