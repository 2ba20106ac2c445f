// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace papilla::bench {

/// What ageing a scene took.
struct WeatherJob {
  int maps = 0;            ///< Colour and height a normal, and the materials' own pictures: how the source counts.
  int faces = 0;           ///< Triangles.
  int normals = 0;         ///< Unlike ones, summed over the materials.
  int charts = 0;          ///< Pieces of surface with a map of their own.
  int tiles = 0;           ///< Those of them that were kept.
  double cpu_seconds = 0;  ///< From the scene in memory to the encoded pictures, all threads.
};

/// Ages a scene like that of the source: two materials, 108 triangles with 43 normals, every rectangle shown by the
/// whole unit square of the texture; rust and snow over both, at `size` x `size` texels a rectangle.
/// @param sky  whether snow looks for the sky, too, which that of 2006 did not.
WeatherJob run_weather_job(int size, bool sky);

}  // namespace papilla::bench
