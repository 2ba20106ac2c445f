// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/texture/image.hpp"

namespace papilla {

/// A picture with its known properties.
struct NamedPicture {
  std::string name;
  GreyImage picture;
  std::optional<double> dimension;  ///< Of a fractal surface.
  std::optional<double> period_px;  ///< Of a square lattice along the axes; 0: there is none.
};

/// Pictures that are made to break estimators: flat, black, white, of one bit, noise, with a spike, of one pixel
/// and one row; fractal surfaces with H from 0.01 to 0.99; lattices under noise and with 2 pixels a cell.
std::vector<NamedPicture> extreme_pictures();

}  // namespace papilla
