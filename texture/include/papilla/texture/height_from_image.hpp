// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/commensurate_tile.hpp"
#include "papilla/texture/even_light.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/lattice.hpp"
#include "papilla/texture/stored_samples.hpp"

namespace papilla {

/// How grey becomes height. `automatic` takes `wiener` or `intensity` (grey = height, bright = high), whichever it
/// expects to correlate more with the true relief: the picture's spectrum and the light's coherence and uncertainty say
/// that of shape from shading; that of grey is 0.5 for a picture without light direction and 0.10 for a lit one,
/// see wiener.md.
/// `photometric_stereo` takes several photographs: height_from_image() refuses it, see photometric_stereo().
enum class HeightMethod { automatic, variational, pentland, tsai_shah, intensity, wiener, photometric_stereo };

/// The method's name on the command line: auto, variational, pentland, tsai-shah, intensity, wiener,
/// photometric-stereo.
std::string_view to_string(HeightMethod method) noexcept;
/// The method of that name. @throws InvalidInput for any other name.
HeightMethod height_method(std::string_view name);

/// What becomes of the part of a picture that does not repeat. `whole`: relief and roughness come out of the picture as
/// one. The others take the relief from the symmetric part alone and add nothing, or the residual, or a synthesized
/// fractal surface with the dimension and the rms of the residual; roughness carries no wavelength above 1 mm. Without
/// a lattice all of them mean `whole`.
enum class HeightRoughness { whole, none, residual, synthesized };

/// The name on the command line: whole, none, residual, synthesized.
std::string_view to_string(HeightRoughness roughness) noexcept;
/// The roughness of that name. @throws InvalidInput for any other name.
HeightRoughness height_roughness(std::string_view name);

/// The rate of a device and the speed of a hand where nothing is said of them.
inline constexpr double k_device_rate_hz = 1000, k_hand_speed_mm_per_s = 100;

/// The shortest wavelength that a device can render at a stroking speed v: two ticks of the haptic loop, 2 v / rate.
/// @throws InvalidInput when a value is not positive.
double shortest_playable_wavelength_mm(double speed_mm_per_s, double rate_hz);

/// Options of height_from_image().
struct HeightOptions {
  HeightMethod method = HeightMethod::automatic;
  std::optional<Vec3> light =
      {};                 ///< Direction to the light (x right, y down, z to the viewer); estimated when absent.
  double pitch_mm = 0;    ///< Millimetres per pixel; 0 takes the picture's, which may be unknown.
  double depth_mm = 0.3;  ///< Peak to valley of the result.
  std::optional<bool> periodic = {};  ///< Whether the height shall tile; measured from the picture when absent.
  double albedo = 0;   ///< Grey of a surface facing the light; 0: such that the mean grey is that of a level surface.
  int iterations = 0;  ///< Steps of shape from shading; 0: the method's default.
  Transfer transfer = Transfer::automatic;  ///< How the picture becomes brightness; not used by intensity.
  HeightRoughness roughness = HeightRoughness::whole;
  double shortest_wavelength_mm =
      0;                   ///< Waves shorter than this are left out of the result; 0 keeps all. Needs a pitch.
  std::uint64_t seed = 1;  ///< Of synthesized roughness.
  /// One upright tile of the lattice instead of the whole picture, exactly periodic at any angle of the lattice; see
  /// HeightResult::tile. The relief is that of the symmetric part; `whole` and `residual` become `synthesized`, because
  /// what does not repeat can't tile. Needs a lattice.
  bool tile = false;
  int largest_piece_px = 2048;          ///< ShadingOptions::largest_piece_px.
  std::optional<Lattice> lattice = {};  ///< Of the picture, when it is known; else analyze_symmetry() finds it.
  /// The cell to take with that lattice instead of the mean one: the mean over its group, WallpaperSymmetry::primitive.
  std::optional<GreyImage> primitive = {};
  ProgressCallback progress = {};
};

/// A method and why it is taken.
struct HeightChoice {
  HeightMethod method = HeightMethod::intensity;
  std::string reason;
};

/// The method that height_from_image() takes for a picture: that of the options, or the one whose relief is expected to
/// correlate more with the true one. Cost: O(pixels). @throws InvalidInput as height_from_image().
HeightChoice choose_height_method(const GreyImage& image, const HeightOptions& options = {});

/// What height_from_image() returns.
struct HeightResult {
  HeightMap map;                                  ///< 0 to depth_mm; the pitch is 0 when it is unknown.
  HeightMethod method = HeightMethod::intensity;  ///< The one that ran, never automatic.
  std::string reason;                             ///< Why that one.
  Vec3 light{0, 0, 1};                            ///< Used by shape from shading, length 1.
  bool light_estimated = false;
  double light_coherence = 0;        ///< LightEstimate::coherence when estimated.
  double light_uncertainty_deg = 0;  ///< LightEstimate::uncertainty_deg when estimated; 0 for a given light.
  /// Light was estimated: the opposite relief under the opposite light gives the same picture. See opposite_relief().
  bool ambiguous = false;
  /// With the true relief; by wiener and automatic only, where it rests on no assumption about grey.
  std::optional<double> expected_correlation;
  double shadows_fraction = 0;                ///< Brightness below a quarter of the mean; 0 for intensity.
  double highlights_fraction = 0;             ///< Brighter than a matt surface that faces the light; 0 for intensity.
  CurveSource decoded = CurveSource::linear;  ///< What made brightness of the picture; linear for intensity.
  double unevenness = 0;  ///< LightField::unevenness that was divided out; 0 for pictures that tile.
  double depth_mm = 0;    ///< Peak to valley; 0 for a picture without relief, else what was asked.
  double rms_mm = 0;
  HeightRoughness roughness = HeightRoughness::whole;
  double roughness_rms_mm = 0;        ///< Of the roughness added; 0 for whole and none.
  double shortest_wavelength_mm = 0;  ///< Left in the result: the cut, or two pixels; 0 when the pitch is unknown.
  /// Share of the slopes' power that runs across the light: shading shows these slopes to second order only, so that
  /// this share of the relief is guessed. 0 for intensity.
  double guessed_share = 0;
  std::optional<CommensurateTile> tile;        ///< When one was asked for: its size and the strain it costs.
  std::vector<std::string> measured, assumed;  ///< What the picture determines, and what is assumed.
  Trace trace;                                 ///< See ShadingResult; empty for intensity.
  std::array<int, 2> pieces = {1, 1};          ///< Across and down, that shape from shading solved one by one.
  StopReason stop = StopReason::direct;
};

/// Height map in millimetres from one picture of a surface. White or lit is outward. Shape from shading works on linear
/// brightness, over the light_field() unless the picture tiles.
/// The depth is what is asked for: one picture of unknown albedo and light determines shape, not scale. Shape from one
/// picture is a guess under the assumptions of the method and of estimate_light().
/// Periodic pictures give exactly periodic heights. A flat or black picture gives a flat map. Every height is finite.
/// Cost: that of the method; variational takes about 0.15 s at 256². Deterministic.
/// Memory: about 16 bytes a pixel beside the picture, twice that with roughness or a cut, and a constant; pictures of
/// any size.
/// @throws InvalidInput when the picture is empty or not finite, an option is out of range, or a tile is asked for and
/// the picture has no lattice.
HeightResult height_from_image(const GreyImage& image, const HeightOptions& options = {});

/// What height_from_rows() returns: the relief in millimetres is scale · (sample − lowest) of the samples it wrote.
struct HeightRows {
  HeightResult result;  ///< Its map has a size and a pitch, and no samples.
  double scale = 0, lowest = 0;
};

/// height_from_image() of a picture of any size outside the memory, except for a tile, roughness apart and a shortest
/// wavelength. Shape from shading works in pieces, whose differences to the solve of the whole shape_from_shading.hpp
/// states; the other results are the same. Memory: see there; with largest_piece_px = 2048 and 20000 columns about half
/// a gigabyte on two cores.
/// @param curve of the picture: transfer_curve() of HeightOptions::transfer, which is not looked at.
/// @param relief takes the samples; as large as the picture.
/// @throws InvalidInput when a sample is not finite, or an option is out of range or needs the picture in memory;
/// IoError when the disk is full.
HeightRows height_from_rows(const SampleRows& picture, const TransferCurve& curve, const HeightOptions& options,
                            SampleFile& relief);

/// The other relief that the same picture allows: h → highest + lowest − h. Light from the opposite azimuth on the
/// inverted relief gives the same picture, R(−p, −q; −s_x, −s_y) = R(p, q; s_x, s_y), so that one picture does not
/// distinguish them; nor does it distinguish bright as high from dark as high. The light that goes with it is (−s_x,
/// −s_y, s_z). Belhumeur, Kriegman and Yuille, The bas-relief ambiguity, 1999.
/// @throws InvalidInput when the relief is empty or not finite.
HeightMap opposite_relief(const HeightMap& relief);

}  // namespace papilla
