// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace papilla {

/// Order of n conditions for one participant: a row of Williams's Latin square, 0, 1, n−1, 2, n−2, … shifted by the
/// row. Over n participants (n even) or 2n (n odd, where every other square is turned round) every condition stands
/// equally often at every place and follows every other one equally often.
/// @param row number of the participant from 0. @returns the conditions 0 to n − 1, each once.
/// Source: E. J. Williams, Experimental designs balanced for the estimation of residual effects of treatments,
/// Australian Journal of Scientific Research A 2, 1949.
std::vector<std::size_t> balanced_order(std::size_t n, std::size_t row);

}  // namespace papilla
