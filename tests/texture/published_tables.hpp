// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/texture/image.hpp"

namespace papilla::test {

/// The four dimensions of table 6.1, in its order: box, information, correlation, probability.
using FourDimensions = std::array<double, 4>;

/// One picture of table 6.1 of Schulze 2005: its nominal dimension, its side, and what was published.
struct DimensionCell {
  double dimension;
  int side_px;
  FourDimensions published;
};
inline constexpr std::array<DimensionCell, 6> k_dimension_table = {{{2.2, 256, {2.22, 2.21, 2.20, 2.20}},
                                                                    {2.5, 256, {2.36, 2.36, 2.36, 2.51}},
                                                                    {2.8, 256, {2.44, 2.44, 2.44, 2.78}},
                                                                    {2.7, 130, {2.39, 2.38, 2.37, 2.68}},
                                                                    {2.7, 185, {2.42, 2.42, 2.43, 2.68}},
                                                                    {2.7, 235, {2.42, 2.42, 2.43, 2.69}}}};
inline constexpr int k_table_seeds = 5;

/// The picture behind a cell: an exact fractional Brownian surface of 513², its best plane taken away (as flattening
/// the illumination of a picture does), stretched to 8 bits, the central side_px × side_px of it.
GreyImage dimension_picture(const DimensionCell& cell, unsigned seed);

/// Mean of the four dimensions over seeds 1 to k_table_seeds.
FourDimensions measured_dimensions(const DimensionCell& cell);

/// One row of table 2 of Cho et al. 2017.
struct SignatureRow {
  double hurst, sta, str;
};
inline constexpr std::array<SignatureRow, 5> k_signature_table = {{{0.90, 0.6478, 0.8630},
                                                                   {0.75, 0.5937, 0.8579},
                                                                   {0.60, 0.5211, 0.8975},
                                                                   {0.45, 0.3966, 0.8534},
                                                                   {0.30, 0.3238, 0.8566}}};

/// Mean Sta and Str over seeds 1 to k_table_seeds of the three-step midpoint displacement on 257².
SignatureRow measured_signature(double hurst);

}  // namespace papilla::test
