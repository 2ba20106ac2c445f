// SPDX-License-Identifier: MIT
#include "simplifier.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "check_mesh.hpp"
#include "decimate.hpp"
#include "one_sided_deviation.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {
namespace {

/// Of the first pass, relative to the tolerance: most parts hold it at once, and what exceeds it is local.
constexpr double k_first_error = 1;
constexpr double k_less =
    0.7;  ///< A pass that does not hold the tolerance is tried once more with this much of its error.
constexpr int k_rounds = 5;  ///< Of keeping vertices at the worst places, a pass.
constexpr int k_most_halvings = 5;
/// Distances below this fraction of the tolerance count as equal in the check.
constexpr double k_settled = 0.9;
/// When more of the triangles than this exceed the tolerance, keeping their vertices would leave less than
/// a smaller error does.
constexpr double k_most_exceeding = 0.3;

void check(const SimplifyOptions& o, std::string_view function) {
  const auto fail = [&](const char* what) { throw InvalidInput(std::string(function) + ": " + what); };
  if (!(o.tolerance_mm > 0)) fail("options.tolerance_mm is not positive");
  if (!(o.feature_angle_deg >= 0 && o.feature_angle_deg <= 180)) fail("options.feature_angle_deg is not in [0, 180]");
  if (o.passes < 1 || o.passes > 6) fail("options.passes is not in [1, 6]");
}

/// Not kept: a tree takes more memory than all else, and a twentieth of the time that measuring takes.
TriangleBvh bvh_of(const TriangleMesh& mesh) { return {mesh.positions, mesh.triangles}; }

/// Marks the corners of the triangles closest to the worst place of each triangle of `candidate`.
void keep_worst_places(const OneSidedDeviation& input_side, const OneSidedDeviation& candidate_side,
                       std::size_t candidate_triangles, const TriangleMesh& current, std::vector<std::uint8_t>& kept) {
  const TriangleBvh current_bvh = bvh_of(current);
  std::vector<const ExceedingTriangle*> worst(candidate_triangles, nullptr);
  for (const ExceedingTriangle& e : input_side.above) {
    const ExceedingTriangle*& w = worst[e.nearest_triangle];
    if (w == nullptr || e.value > w->value) w = &e;
  }
  for (const ExceedingTriangle& e : candidate_side.above)
    if (worst[e.triangle] == nullptr) worst[e.triangle] = &e;
  for (const ExceedingTriangle* e : worst)
    if (e != nullptr)
      for (const Index v : current.triangles[current_bvh.closest(e->at).triangle]) kept[v] = 1;
}

struct OutOfTime {};

}  // namespace

/// How far the passes of a simplification have come. How many rounds one takes nobody knows, so that each surface that
/// is measured takes the pass some way nearer to its end.
class PassProgress {
 public:
  PassProgress(const ProgressCallback& callback, const Deadline& deadline, int passes)
      : callback_(callback), deadline_(deadline), passes_(passes) {}

  void begin_pass() noexcept { ++pass_, measured_ = 0; }

  /// For the next surface that is measured; throws OutOfTime at the deadline.
  ProgressCallback next_surface() {
    return [this, before = measured_++](const Progress& done) {
      if (deadline_.passed()) throw OutOfTime{};
      const double share = 1 - std::pow(k_left, before + done.fraction);
      return !callback_ || callback_({"simplify", (pass_ + share) / passes_});
    };
  }

 private:
  static constexpr double k_left = 0.7;  ///< Of a pass, after each surface.
  const ProgressCallback& callback_;
  const Deadline& deadline_;
  int passes_, pass_ = -1, measured_ = 0;
};

Simplifier::Simplifier(const TriangleMesh& mesh, const SimplifyOptions& options, std::string_view function)
    : mesh_(mesh), options_(options) {
  check(options, function);
  check_mesh(mesh, function);
  Bounds3 bounds;
  check_distance_input(mesh, std::string(function) + ": mesh", bounds);
  diagonal_ = bounds.diagonal();
  wedges_ = make_wedges(mesh, options.feature_angle_deg, options.keep_faces);
  surface_ = surface(wedges_.indices);
}

TriangleMesh Simplifier::surface(const std::vector<Index>& indices) const {
  TriangleMesh surface;
  surface.positions = wedges_.positions;
  surface.triangles.resize(indices.size() / 3);
  for (std::size_t i = 0; i < indices.size(); ++i)
    surface.triangles[i / 3][i % 3] = wedges_.position_of_wedge[indices[i]];
  return surface;
}

std::vector<Index> Simplifier::collapse(const std::vector<Index>& indices, double error_mm,
                                        std::size_t target_triangles) const {
  std::vector<Index> left =
      decimate(wedges_, indices, {}, {target_triangles, error_mm, options_.lock_border, options_.deadline});
  out_of_time_ |= options_.deadline.passed();
  return left;
}

bool Simplifier::collapse_and_check(std::vector<Index>& indices, double error_mm, double tolerance_mm,
                                    std::size_t target_triangles, PassProgress& progress) const {
  DeviationOptions measure;
  measure.list_above_mm = tolerance_mm;
  measure.mean_samples = 0;
  std::vector<std::uint8_t> kept(wedges_.positions.size(), 0);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<Index> candidate =
        decimate(wedges_, indices, kept, {target_triangles, error_mm, options_.lock_border, options_.deadline});
    if (options_.deadline.passed()) throw OutOfTime{};
    if (candidate.size() == indices.size()) return true;
    if (candidate.empty()) return false;
    const TriangleMesh mesh = surface(candidate);
    const double floor = k_settled * tolerance_mm;
    measure.settled_below_mm = floor;
    measure.progress = progress.next_surface();
    const OneSidedDeviation candidate_side = one_sided_deviation(mesh, bvh_of(surface_), floor, measure);
    OneSidedDeviation input_side;
    if (options_.two_sided) {
      measure.progress = progress.next_surface();
      input_side = one_sided_deviation(surface_, bvh_of(mesh), floor, measure);
    }
    if (candidate_side.above.empty() && input_side.above.empty()) {
      indices = std::move(candidate);
      return true;
    }
    const auto exceeding = static_cast<double>(candidate_side.above.size() + input_side.above.size());
    if (exceeding > k_most_exceeding * static_cast<double>(mesh.triangles.size() + surface_.triangles.size()))
      return false;
    if (indices.size() == all().size())
      keep_worst_places(input_side, candidate_side, mesh.triangles.size(), surface_, kept);
    else
      keep_worst_places(input_side, candidate_side, mesh.triangles.size(), surface(indices), kept);
  }
  return false;
}

std::vector<Index> Simplifier::within(std::vector<Index> indices, double tolerance_mm, std::size_t target_triangles,
                                      const Stopwatch& clock, Trace& trace, const ProgressCallback& progress) const {
  PassProgress passes(progress, options_.deadline, options_.passes);
  try {
    run_passes(indices, tolerance_mm, target_triangles, clock, trace, passes);
  } catch (const OutOfTime&) {
    out_of_time_ = true;
  }
  return indices;
}

void Simplifier::run_passes(std::vector<Index>& indices, double tolerance_mm, std::size_t target_triangles,
                            const Stopwatch& clock, Trace& trace, PassProgress& progress) const {
  const auto note = [&] {
    trace.push_back({clock.seconds(), static_cast<double>(indices.size()) /
                                          static_cast<double>(std::max<std::size_t>(all().size(), 1))});
  };
  const auto is_done = [&] { return indices.size() / 3 <= target_triangles; };
  note();
  double error = k_first_error * tolerance_mm;
  bool any = false;
  progress.begin_pass();
  for (int halvings = 0; !any && !is_done() && halvings <= k_most_halvings; ++halvings) {
    any = collapse_and_check(indices, error, tolerance_mm, target_triangles, progress);
    if (!any) error /= 2;
  }
  if (any) note();
  for (int pass = 1; any && !is_done() && pass < options_.passes; ++pass) {
    error *= 2;
    progress.begin_pass();
    any = collapse_and_check(indices, error, tolerance_mm, target_triangles, progress) ||
          collapse_and_check(indices, k_less * error, tolerance_mm, target_triangles, progress);
    if (any) note();
  }
}

SimplifyResult Simplifier::result(const std::vector<Index>& indices, double tolerance_mm) const {
  SimplifyResult result;
  result.mesh = extract(wedges_, mesh_, indices);
  result.triangles_before = mesh_.triangles.size();
  if (result.mesh.triangles.empty() || indices.size() == all().size()) return result;
  DeviationOptions measure;
  measure.mean_samples = 0;
  measure.relative_tolerance = 0.05;
  measure.settled_below_mm = std::isfinite(tolerance_mm) ? 0.1 * tolerance_mm : 0;
  const double floor = std::max(measure.settled_below_mm, 1e-6 * diagonal_);
  const OneSidedDeviation mesh_side = one_sided_deviation(result.mesh, bvh_of(surface_), floor, measure);
  if (options_.two_sided) result.deviation.from_to = one_sided_deviation(surface_, bvh_of(result.mesh), floor, measure);
  result.deviation.to_from = mesh_side;
  // within() has shown this already; the measurement above only says how much of it is used.
  for (OneSidedDeviation* side : {&result.deviation.from_to, &result.deviation.to_from})
    side->bound = std::min(side->bound, tolerance_mm);
  return result;
}

}  // namespace papilla::detail
