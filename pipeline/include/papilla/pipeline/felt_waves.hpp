// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/wave_bands.hpp"

namespace papilla {

/// A kind of mechanoreceptor of hairless skin and the frequencies that it answers to.
struct TouchReceptor {
  std::string_view name, senses;
  double low_hz = 0, high_hz = 0;
};

/// SAI, SAII, RAI, RAII as in Schulze 2005, table 5.1 (after Ziegler 1998 and Burdea 1996). Their bands overlap.
inline constexpr std::array<TouchReceptor, 4> k_touch_receptors{{{"SAI", "pressure", 1, 200},
                                                                 {"SAII", "pressure and stretch", 1, 200},
                                                                 {"RAI", "velocity", 10, 200},
                                                                 {"RAII", "vibration and acceleration", 70, 1000}}};

/// Least amplitude (half of peak to peak) in metres of a vibration that a hand feels, over its frequency f:
///     A(f) = 0.1 µm · (250 Hz / f)²   from 40 Hz to 250 Hz, below 40 Hz as at 40 Hz,
///     A(f) = 0.1 µm · (f / 250 Hz)²   from 250 Hz to 1 kHz, above infinite.
/// Flat to 40 Hz, falling by 12 dB an octave to the least near 250 Hz: Verrillo, Effect of contactor area on the
/// vibrotactile threshold, JASA 35, 1963 (contactors of 2.9 cm² and more), level −20 dB re 1 µm there. That it rises as
/// fast above is assumed; that it ends at 1 kHz is table 5.1 of Schulze 2005. Towards lower frequencies than 40 Hz
/// thresholds rise again (Bolanowski et al., JASA 84, 1988), so that the flat part errs to the side of feeling.
/// @pre frequency_hz > 0.
double vibrotactile_threshold_m(double frequency_hz);

/// Options of measure_felt_waves().
struct TouchOptions {
  double speed_m_per_s = 0.1;  ///< Of a usual stroke: that of the player's synthetic hand.
  /// Of slow and fast strokes, times the usual one: what none of these feels may be left out.
  double slow = 0.2, fast = 2;
  /// What is left out must be so many times below the threshold: grasping a tool, some feel less than 0.01 µm (Brisben,
  /// Hsiao and Johnson, Detection of vibration transmitted through an object grasped in the hand, J. Neurophysiology
  /// 81, 1999), a tenth of the 0.1 µm above.
  double margin = 10;
};

/// What one kind of receptor gets of a stroke.
struct ReceptorShare {
  std::string_view receptor;
  double variance_share = 0;   ///< Of the relief's variance in its band, in [0, 1].
  double times_threshold = 0;  ///< Of what is in its band; see FeltWaves.
};

/// What a hand feels of waves that pass under it at a speed v: a wave λ vibrates with v/λ.
struct FeltWaves {
  double slowest_hz = 0, fastest_hz = 0;  ///< Of the usual stroke over the longest and the shortest wave.
  std::vector<ReceptorShare> receptors;   ///< In the order of k_touch_receptors, of the usual stroke.
  double unfelt_share = 0;                ///< Of the variance: faster than every receptor.
  /// How often the threshold is reached by all waves together,
  ///     S = √ Σ (a/A(v/λ))²,  a = √2 · rms of a band,
  /// as the Pacinian channel sums up power over its frequencies: of the usual stroke, and the most of all speeds.
  double times_threshold = 0, most_times_threshold = 0;
  /// The same of waves up to 1 mm (k_longest_roughness_mm), of the usual stroke: how rough it feels.
  double roughness = 0;
  /// Waves shorter than this are together below the threshold by the margin at every speed; 0: none is.
  double finest_felt_mm = 0;
  bool may_be_left_out = false;  ///< All of it.
};

/// Cost: bands · 16 speeds. Deterministic. Directions are not told apart: a stroke at an angle to a wave feels lower
/// frequencies. The probe's size is left out, which hides what is finer than itself. @pre options positive.
FeltWaves measure_felt_waves(std::span<const WaveBand> bands, const TouchOptions& options = {});

/// The shortest wave that a slow stroke brings below the last frequency that is felt. @pre options positive.
double finest_wave_mm(const TouchOptions& options);

/// Samples that a side needs for waves of `finest_mm`: four a wave, as with_roughness(), at most those that it has.
int needed_samples(int samples, double pitch_mm, double finest_mm);

/// A height map and what it would be with waves that are felt only.
struct ReliefSaving {
  int width = 0, height = 0, needed_width = 0, needed_height = 0;  ///< Samples.
  std::size_t bytes = 0, needed_bytes = 0;                         ///< As 16-bit PNG.

  bool saves() const noexcept { return needed_bytes < bytes; }
};

/// What leaving out the waves below finest_felt_mm saves: the relief is sampled anew, four samples for each of the
/// finest waves that are felt (with_roughness()), and encoded. A relief of which all may be left out needs nothing.
/// Nothing of that is applied. Cost: those of resample() and of a PNG. @param bytes of the PNG as it is.
ReliefSaving measure_relief_saving(const HeightMap& relief, const FeltWaves& felt, std::size_t bytes);

}  // namespace papilla
