// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/bounded_seams.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/natural.hpp"
#include "papilla/param/projections.hpp"
#include "papilla/param/reference_maps.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla {

class StageCache;

/// The vertex nearest to a place gets this uv [mm].
struct PlacedPin {
  Vec3 position;
  Vec2 uv;
  std::string part = {};  ///< Pattern of names (* and ? match); empty: every part.
};

/// The vertices along shortest paths of edges between those nearest to the points share their u, or their v.
struct PlacedIsoLine {
  std::vector<Vec3> points;
  bool is_u = true;
  std::optional<double> value;  ///< [mm]; not given: found.
  std::string part;             ///< As in PlacedPin.
};

/// Whether what is meant for `pattern` is meant for the part of this name.
bool is_for_part(const std::string& pattern, const std::string& part);

/// The vertex of the mesh. Equal positions must be one vertex. Cost: O(n).
LevyPin pin_on(const TriangleMesh& mesh, const PlacedPin& pin);

/// The vertices of the mesh, in order. Equal positions must be one vertex. Cost: O(n log n) per pair of points.
/// @throws InvalidInput, naming the point, when no path of edges leads to it from the one before.
LevyIsoLine iso_line_on(const TriangleMesh& mesh, const PlacedIsoLine& line);

/// Along what the grain runs.
enum class GrainSource {
  up,         ///< Upright: grain_direction().
  longest,    ///< Along the part: longest_direction().
  direction,  ///< As given.
  edge_loop,  ///< Along the edge_loop_near() a place.
};

/// The direction of the grain on some parts.
struct PlacedGrain {
  GrainSource source = GrainSource::up;
  Vec3 vector{0, 0, 1};   ///< Of direction: it; of edge_loop: the place [mm], in the part's coordinates.
  std::string part = {};  ///< As in PlacedPin.
};

/// What is meant for the part of this name: the first grain that names it by a pattern, else the first for every part;
/// upright when there is none.
PlacedGrain grain_of(const std::vector<PlacedGrain>& grains, const std::string& part);

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
  best,
  automatic
};

struct MethodOptions;

/// The methods by the names that the command line has for them.
const std::map<std::string, UnwrapMethod>& unwrap_methods();
std::string unwrap_method_name(UnwrapMethod method);

/// Whether the method maps charts that it is given; the others make their own.
bool takes_charts(UnwrapMethod method);

/// What time may be spent on charts and on the maps of best and automatic.
enum class UnwrapEffort {
  /// Charts for one seam cost, few unions tried; no Newton steps on charts of over 20,000 vertices. Seams under a bound
  /// are sought on 800 triangles, from few beginnings, and on 2,200 where they come out dear.
  fast,
  /// As the methods' options say; two or three seam costs on parts of up to 50,000 triangles. Seams under a bound are
  /// sought on 2,200 triangles.
  normal,
  /// Two seam costs on every part, Newton steps on all charts until they gain less than 1e-5. Seams under a bound are
  /// sought on the whole part.
  best,
};

/// Names of what the methods' options can be, on the command line and in MATERIALS.json.
const std::map<std::string, LscmSolver>& lscm_solvers();
const std::map<std::string, MaillotSolver>& maillot_solvers();
const std::map<std::string, MaillotStart>& maillot_starts();
const std::map<std::string, LevySolver>& levy_solvers();
const std::map<std::string, LevyWeights>& levy_weights();
const std::map<std::string, LevyBorder>& levy_borders();
const std::map<std::string, LevyCoupling>& levy_couplings();
const std::map<std::string, IntermediateShape>& intermediate_shapes();
const std::map<std::string, IntermediateRule>& intermediate_rules();
const std::map<std::string, EnvironmentMap>& environment_maps();

/// Gives a method of several solvers the one of this name. @return whether it has one so named.
bool choose_solver(const std::string& name, MethodOptions& options);

/// The methods that an option is of, by its name in MATERIALS.json ("distortion_limit"; on the command line with -);
/// empty for one that all methods have.
const std::vector<UnwrapMethod>& methods_of_option(const std::string& option);

/// Why the option means nothing to the method: "is of maillot, not of best"; empty when it does.
std::string foreign_option(const std::string& option, UnwrapMethod method);

/// "D", the mean, or "pNN=D", a percentile, as a bound with D from 4 to 1e6; nothing for a text that is neither.
std::optional<DistortionBound> distortion_bound(const std::string& text);

/// The bound as distortion_bound() reads it.
std::string distortion_bound_name(const DistortionBound& bound);

/// The efforts by the names that the command line has for them.
const std::map<std::string, UnwrapEffort>& unwrap_efforts();

/// Where the charts come from.
enum class ChartSource {
  automatic,  ///< segment_charts().
  keep,       ///< Every connected component is one.
  uv,         ///< The mesh's own uv: uv_charts().
};

/// The sources by the names that the command line has for them.
const std::map<std::string, ChartSource>& chart_sources();
std::string chart_source_name(ChartSource source);

/// The charts of a mesh that has them already, the same for every method: closed ones and handles are opened by
/// open_closed_charts(), nothing else is changed. Equal positions must be one vertex. O(n log n); deterministic.
/// @param source not automatic.
/// @throws InvalidInput for triangles without uv; for components that are no surface.
ChartSet given_charts(const TriangleMesh& mesh, ChartSource source);

/// What a part is beside others, and what its grain is: automatic decides by it.
struct PartContext {
  UpAxis up = UpAxis::z;
  Vec2 tile_mm{0, 0};          ///< Of the grain; 0: unknown.
  std::string part;            ///< Its name.
  std::size_t parts = 1;       ///< That are unwrapped together.
  double scene_extent_mm = 0;  ///< Bounding diagonal of all of them as they stand in the scene.
  double extent_mm = 0;        ///< Bounding diagonal of the part as it came; 0: of the mesh that is mapped.
};

/// Why automatic projects a whole part, whatever its shape: it is smaller than one repeat of the grain, or a small one
/// among many under fine grain. Empty: it does not.
std::string reason_to_project(const PartContext& context);

/// The chosen method and the options of each. Orientation, tile and fallback are set for all by flatten_part().
struct MethodOptions {
  UnwrapMethod method = UnwrapMethod::automatic;
  UnwrapEffort effort = UnwrapEffort::normal;
  std::vector<PlacedGrain> grains;  ///< As grain_of() takes them.
  ChartSource charts = ChartSource::automatic;
  SegmentationOptions segmentation;
  bool choose_seam_cost = true;  ///< choose_seam_cost() where the effort allows it; false: as segmentation says.
  /// Given: keep_bound() finds the charts, instead of a seam cost. Of automatic and best with charts of their own.
  std::optional<DistortionBound> max_distortion;
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
  AutomaticOptions automatic;
  std::vector<PlacedPin> pins;           ///< Of levy.
  std::vector<PlacedIsoLine> iso_lines;  ///< Of levy.
  /// Of the methods that iterate; not given: the method's own.
  std::optional<int> iterations;
  std::optional<double> tolerance;
  ProgressCallback progress;  ///< Told the fraction of a part that is charted and mapped; may be empty.
  /// What iterates ends then, charts and parts without a map are projected instead; charts that have to be kept fail.
  Deadline deadline;
  const StageCache* cache = nullptr;  ///< Remembers charts and maps; with a deadline it is only read.
};

/// The patterns of part names that the grains, pins and lines have.
std::vector<std::string> named_parts(const MethodOptions& options);

/// What became of a bound.
struct BoundReport {
  DistortionBound bound;
  bool kept = false;
  double distortion = 0;          ///< bounded_distortion() of the part.
  double seam_mm = 0;             ///< Length of its seams.
  double seam_cost_mm = 0;        ///< The same, by how visible they are.
  std::vector<SeamSample> trace;  ///< Of the maps that were tried.
};

struct FlattenedPart {
  Flattening flattening;             ///< uv in millimetres (environment: in textures), not placed yet.
  std::string method, reason;        ///< Of the part: the method that was taken, and, when it was chosen, why.
  std::vector<ChartChoice> choices;  ///< Of automatic, levy and maillot: per chart.
  double segment_seconds = 0;
  std::optional<BoundReport> bound;  ///< With MethodOptions::max_distortion, unless the part was projected.
};

/// Charts and maps one part. Equal positions must be one vertex. Charts that the method can't map, or that best
/// distorts beyond worth_halving(), are halved a few times before another map takes their place. Automatic takes
/// triplanar for parts that are smaller than one repeat of the grain, and for small ones among many under fine grain;
/// else a method for every chart. Charts of uv are neither halved nor joined; those that the method can't map get the
/// map of best, with a note. With a bound, keep_bound() makes the charts, and nothing is halved that keeps it.
/// @throws what the method throws; InvalidInput, SolverFailure for components that can't be kept as charts;
/// InvalidInput for charts of uv where triangles have none, and for a bound on maps of other methods or given charts.
FlattenedPart flatten_part(const TriangleMesh& mesh, const PartContext& context, const MethodOptions& options);

}  // namespace papilla
