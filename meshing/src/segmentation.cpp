// SPDX-License-Identifier: MIT
#include "papilla/meshing/segmentation.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <mutex>
#include <string>
#include <vector>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "seam_set.hpp"
#include "segmentation_steps.hpp"

namespace papilla {
namespace {

using namespace detail;

void check_options(const SegmentationOptions& options) {
  const auto require = [](bool valid, const char* name, double value) {
    if (!valid)
      throw InvalidInput(std::string("segment_charts: ") + name + " " + std::to_string(value) + " is out of range");
  };
  const auto is_fraction = [](double f) { return f >= 0 && f <= 1; };
  require(options.seam_cost >= 0 && options.seam_cost < 1e300, "seam_cost", options.seam_cost);
  require(options.feature_angle_deg > 0 && options.feature_angle_deg <= 180, "feature_angle_deg",
          options.feature_angle_deg);
  if (options.eye && !is_finite(*options.eye)) throw InvalidInput("segment_charts: eye is not finite");
  require(options.union_trials >= 0 && options.union_trials <= 1e3, "union_trials", options.union_trials);
  require(is_fraction(options.speck_area_fraction), "speck_area_fraction", options.speck_area_fraction);
  require(is_fraction(options.small_area_fraction), "small_area_fraction", options.small_area_fraction);
}

/// Cuts all patches, largest first so that no thread is left with a big one; results in the order of patches.
std::vector<ChartOutline> cut_patches(const SegmentedMesh& surface, const SeamWeights& weights,
                                      const SegmentationOptions& options, const std::vector<std::uint32_t>& labels,
                                      std::uint32_t count, std::vector<std::uint8_t>& seam,
                                      SegmentationResult& result) {
  std::vector<std::vector<Index>> patches(count);
  for (Index t = 0; t < labels.size(); ++t) patches[labels[t]].push_back(t);
  PieceCutter cutter(surface, seam);
  std::vector<std::vector<ChartOutline>> pieces(count);
  std::vector<PatchCuts> cuts(count);
  SharedProgress done(progress_within(options.progress, 0.3, 0.7), "charts", static_cast<double>(surface.size()));
  oneapi::tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t p) {
    pieces[p] = cut_patch(surface, weights, options, std::move(patches[p]), cutter, seam, cuts[p],
                          [&](std::size_t triangles) { done.add(static_cast<double>(triangles)); });
  });
  std::vector<ChartOutline> charts;
  for (std::uint32_t p = 0; p < count; ++p) {
    result.disk_cuts += cuts[p].opening;
    result.relief_cuts += cuts[p].relief;
    result.halved += cuts[p].halving;
    for (ChartOutline& piece : pieces[p]) charts.push_back(std::move(piece));
  }
  return charts;
}

}  // namespace

struct ChartSegmenter::Surface {
  SegmentedMesh mesh;

  explicit Surface(const TriangleMesh& of) : mesh(of) {}

  SeamWeights weights(const SegmentationOptions& options) const {
    if (!options.weigh_seams) return SeamWeights(mesh);
    return {mesh, options.eye ? openness_to(mesh, *options.eye) : openness(), options.feature_angle_deg};
  }

 private:
  /// Looked at once, where it is asked for.
  const std::vector<float>& openness() const {
    std::call_once(looked_at_, [&] { openness_ = triangle_openness(mesh); });
    return openness_;
  }

  mutable std::once_flag looked_at_;
  mutable std::vector<float> openness_;
};

ChartSegmenter::ChartSegmenter(const TriangleMesh& mesh) {
  check_mesh(mesh, "segment_charts");
  if (!mesh.triangles.empty()) surface_ = std::make_unique<Surface>(mesh);
}

ChartSegmenter::~ChartSegmenter() = default;

SegmentationResult segment_charts(const TriangleMesh& mesh, const SegmentationOptions& options) {
  check_options(options);
  return ChartSegmenter(mesh).segment(options);
}

SegmentationResult ChartSegmenter::segment(const SegmentationOptions& options) const {
  check_options(options);
  const auto tell = [&](double fraction) { report_progress(options.progress, "charts", fraction); };
  SegmentationResult result;
  if (!surface_) return result;
  const SegmentedMesh& surface = surface_->mesh;
  const SeamWeights weights = surface_->weights(options);
  tell(0.2);

  std::uint32_t count = 0;
  std::vector<std::uint32_t> labels = feature_patches(
      surface, feature_halfedges(surface, options.feature_seams ? options.feature_angle_deg : 180), count);
  result.feature_patches = count;
  count = absorb_small(surface, options, labels);
  result.absorbed = result.feature_patches - count;
  tell(0.3);

  std::vector<std::uint8_t> seam = seams_of(surface, labels, {});
  std::vector<ChartOutline> charts = cut_patches(surface, weights, options, labels, count, seam, result);
  const std::size_t before = charts.size();
  if (options.unfold) charts = merge_unfolded(surface, weights, options, seam, std::move(charts));
  result.unfolded = before - charts.size();
  result.absorbed += absorb_charts(surface, options.small_area_fraction, options.speck_area_fraction, seam);
  tell(0.9);

  result.charts = charts_between(surface, seam);
  tell(1);
  return result;
}

std::vector<double> ChartSegmenter::seam_costs(const SegmentationOptions& options) const {
  check_options(options);
  if (!surface_) return {};
  const SegmentedMesh& surface = surface_->mesh;
  const SeamWeights weights = surface_->weights(options);
  std::vector<double> costs(surface.opposite.size(), 0);
  for (Index h = 0; h < costs.size(); ++h)
    if (surface.opposite[h] != k_none) costs[h] = weights.cost(h);
  return costs;
}

}  // namespace papilla
