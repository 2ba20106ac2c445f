// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "papilla/core/progress.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// How grey becomes height. `automatic` takes `variational` when the picture has a lattice (lit elements) and
/// `intensity` (grey = height, bright = high) otherwise.
enum class HeightMethod { automatic, variational, tsai_shah, intensity };

/// The method's name on the command line: auto, variational, tsai-shah, intensity.
std::string_view to_string(HeightMethod method) noexcept;
/// The method of that name. @throws InvalidInput for any other name.
HeightMethod height_method(std::string_view name);

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
  Progress progress = {};
};

/// What height_from_image() returns.
struct HeightResult {
  HeightMap map;                                  ///< 0 to depth_mm; the pitch is 0 when it is unknown.
  HeightMethod method = HeightMethod::intensity;  ///< The one that ran, never automatic.
  std::string reason;                             ///< Why that one.
  Vec3 light{0, 0, 1};                            ///< Used by shape from shading, length 1.
  bool light_estimated = false;
  double light_coherence = 0;  ///< LightEstimate::coherence when estimated.
  double depth_mm = 0;         ///< Peak to valley; 0 for a picture without relief, else what was asked.
  double rms_mm = 0;
  Trace trace;  ///< See ShadingResult; empty for intensity.
  StopReason stop = StopReason::direct;
};

/// Height map in millimetres from one picture of a surface. White or lit is outward.
/// The depth is what is asked for: one picture of unknown albedo and light tells shape, not scale. Shape from one
/// picture is a guess under the assumptions of the method and of estimate_light().
/// Periodic pictures give exactly periodic heights. A flat or black picture gives a flat map. Every height is finite.
/// Cost: that of the method; variational takes about 0.15 s at 256². Deterministic.
/// @throws InvalidInput when the picture is empty or not finite, or an option is out of range.
HeightResult height_from_image(const GreyImage& image, const HeightOptions& options = {});

}  // namespace papilla
