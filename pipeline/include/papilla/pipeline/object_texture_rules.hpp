// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "papilla/core/vec.hpp"
#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// A box in the scene's own axes, in millimetres, through which a picture is projected: a slide projector far away.
/// Its middle plane is the picture, seen along `direction`, with `up` upwards as far as that is across.
struct ProjectorBox {
  Vec3 at;         ///< Middle of the box.
  Vec3 direction;  ///< Along which the picture is projected, onto what faces it.
  Vec3 up;         ///< Not along `direction`.
  double width_mm = 0, height_mm = 0, depth_mm = 0;
};

/// Unit axes of a box: right of the picture, up the picture, and the direction of the projection.
struct ProjectorAxes {
  Vec3 right, up, forward;
};

/// right = forward × up, normalised. @throws InvalidInput when `direction` is zero or along `up`.
ProjectorAxes projector_axes(Vec3 direction, Vec3 up);

/// Where a picture is high: what hands feel of it.
struct ObjectRelief {
  enum class Source {
    automatic,   ///< Alpha where the picture has any, else brightness.
    alpha,       ///< Opaque is high.
    brightness,  ///< White is high.
    darkness     ///< Black is high.
  };
  double depth_mm = 0;  ///< From the lowest to the highest place, > 0.
  Source source = Source::automatic;
  std::filesystem::path picture;    ///< Another picture to take it from, white is high; empty: none.
  std::optional<double> max_slope;  ///< mm per mm; without it default_max_slope() of the friction.
};

/// One entry of "decals": a picture projected onto surfaces.
struct DecalRule : SurfaceSelector {
  std::string name;               ///< That of the picture's file without one.
  std::filesystem::path picture;  ///< With alpha, where it has any.
  ProjectorBox box;
  double max_angle_deg = 75;        ///< Triangles that are turned farther from the picture get nothing of it.
  std::optional<double> offset_mm;  ///< Towards the projector; without it 1/10000 of the scene's diagonal, >= 0.02.
  std::optional<double> roughness, metallic;  ///< Those of the surface below without one.
  std::optional<ObjectRelief> height;         ///< Without it the surface below is felt.
};

/// What of a picture becomes transparent.
struct CutOut {
  enum class By { alpha, color, none } by = By::alpha;
  std::array<double, 3> color{};  ///< sRGB, 0 to 1.
  double tolerance = 0.1;         ///< Largest difference of a channel that is cut out; twice as far away all is kept.
};

/// One entry of "replace": a picture on a rectangle instead of surfaces.
struct CarrierRule : SurfaceSelector {
  std::string name;
  std::filesystem::path picture;           ///< Empty: of the surfaces themselves.
  std::optional<ProjectorBox> box;         ///< The marked region and its carrier; without it a carrier for every part.
  std::optional<Vec3> direction, up;       ///< Of carriers that are fitted, in the scene's axes.
  std::array<double, 4> crop{0, 0, 1, 1};  ///< Left, top, right, bottom, as shares of the picture.
  std::array<double, 2> scale{1, 1};       ///< Of the fitted rectangle's width and height.
  double contrast = 1, brightness = 0;     ///< v -> 1/2 + contrast·(v − 1/2) + brightness, of sRGB.
  CutOut cut_out;                          ///< Not of a picture of the surfaces.
  int pixels = 512;                        ///< Longer side of a picture of the surfaces.
  std::optional<ObjectRelief> height;      ///< Of a picture.
  bool felt = true;                        ///< Of a picture of the surfaces: its depth is felt.
  std::optional<double> roughness, metallic;  ///< Those of the largest surface that is replaced without one.
};

}  // namespace papilla
