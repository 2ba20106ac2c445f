// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "seam_state.hpp"
#include "seam_trace.hpp"
#include "shorten_seams.hpp"

namespace papilla::param_detail {

/// Seeks short seams of one mesh whose map keeps a bound, as keep_bound() says.
class BoundKeeper {
 public:
  /// @param trace gets a sample of every map. All that is given has to outlive this.
  BoundKeeper(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools, const Deadline& deadline,
              SeamTrace& trace);
  BoundKeeper(const BoundKeeper&) = delete;
  BoundKeeper& operator=(const BoundKeeper&) = delete;

  /// Told the first state whose seams are short; the bound to go on with.
  using Calibrate = std::function<DistortionBound(const SeamState&)>;

  /// From nothing on, on coarse meshes first where there are any. @return the cheapest state that keeps the bound, or
  /// the one of least distortion.
  SeamState search(const Calibrate& calibrate = {});

  /// Short seams for another bound, from what is known.
  SeamState moved(SeamState state, const DistortionBound& bound);

  /// Brings a state within the bound where it is not, and shortens its seams. @return nothing when it can't be brought.
  std::optional<SeamState> finished(SeamState state);

  /// A map of seams, made once as long as it is remembered, and again where it was left unfinished and is wanted whole.
  /// @param whole also where it is of no use as it breaks the bound. @param nearby as SeamTools::map says.
  SeamState map_seams(const std::vector<std::uint8_t>& seam, bool whole, const CornerAttribute<Vec2>* nearby);

  bool keeps(const SeamState& state) const { return state.distortion <= bound_.most + k_bound_slack; }
  const SeamMesh& mesh() const { return mesh_; }

 private:
  struct Try {
    bool keeps_bound = false;
    std::vector<std::uint8_t> seam;
  };
  using Tries = std::map<double, Try>;  ///< By seam cost.
  struct Known {
    SeamState state;        ///< Without uv and seams where it is not whole.
    bool is_whole = false;  ///< Not left unfinished.
    std::size_t triangles() const;
  };

  /// How far a search goes.
  struct Extent {
    std::size_t starts;       ///< Of those with and without seams along features: of each, at most.
    std::size_t near_starts;  ///< Of those of fewer seams, beyond the bound.
    int generous;             ///< Costs below the last one that keeps the bound that are tried, too.
    bool moves_tips;          ///< Slits may end at other vertices.
    std::size_t most_maps;    ///< After so many, seams for another bound are not searched on.
    int most_failures;        ///< Maps that break the bound where lifted seams are finished.
  };
  static constexpr Extent k_thorough{3, 2, 1, true, std::numeric_limits<std::size_t>::max(), 6};
  static constexpr Extent k_brief{1, 0, 0, false, 100, 2};

  SeamState search_mesh(const Calibrate& calibrate);
  void count(const SeamState& state);
  bool consider(SeamState state);
  bool try_cost(double seam_cost);
  bool is_same_without_features();
  void search_cost();
  bool leave_same_seams(double low, double high);
  SeamState map(const ChartSet& charts, double most_excess_mm2, const CornerAttribute<Vec2>* nearby);
  std::vector<std::uint32_t> worth_halving(const SeamState& state) const;
  void halve();
  void lengthen();
  void keep_cheapest();
  void remember(std::vector<bool> seam, Known known);
  void move_bound(const DistortionBound& bound);
  std::optional<SeamState> cheapest_known() const;
  std::optional<SeamState> lengthened(SeamState state) const;
  SeamState shortened(SeamState state);
  SeamState reconnected(SeamState state);
  SeamState shortest(const Calibrate& calibrate);
  SeamState exchanged(SeamState state);

  SeamMesh mesh_;
  DistortionBound bound_;
  const SeamTools& tools_;
  const Extent& extent_;
  const Deadline& deadline_;
  SeamTrace& trace_;
  bool feature_seams_ = true;
  std::vector<SeamState> kept_, starts_, near_;
  std::optional<SeamState> least_;  ///< Of the least distortion.
  double last_cost_mm_ = 0, last_distortion_ = 0;
  std::map<bool, Tries> tried_;                         ///< Without seams along features, and with.
  std::unordered_map<std::vector<bool>, Known> known_;  ///< By their seams.
  std::size_t remembered_ = 0;                          ///< Triangles of known_.
  std::size_t maps_ = 0;                                ///< That were made.
  const MapSeams map_ = [this](const auto& seam, const SeamState& nearby) {
    return map_seams(seam, false, &nearby.charted.flattening.uv);
  };
  const MapSeams map_fully_ = [this](const auto& seam, const SeamState& nearby) {
    return map_seams(seam, true, &nearby.charted.flattening.uv);
  };
};

}  // namespace papilla::param_detail
