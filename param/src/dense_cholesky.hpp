// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstddef>

namespace papilla::param_detail {

/// Numbers that may be read, and are ignored, behind the end of the arrays of the functions below.
inline constexpr std::size_t k_dense_slack = 64;

/// Factors the first `columns` columns of a Hermitian matrix of `rows` rows, given its lower half, in place.
/// @return how many pivots were not positive; these became `1e150`.
std::size_t factor_columns(double* a, std::size_t rows, std::size_t columns);
std::size_t factor_columns(std::complex<double>* a, std::size_t rows, std::size_t columns);

/// Columns `first` to `last` of subtract_square() may be worked on apart where `first` is a multiple of this.
inline constexpr std::size_t k_square_columns = 32;

/// Subtracts P Pᴴ from columns `first` to `last` of the lower half of c, a square matrix of `size`, where P is the
/// lower `size` rows of a matrix of `rows` rows and `columns` columns.
void subtract_square(const double* panel, std::size_t rows, std::size_t columns, double* c, std::size_t size,
                     std::size_t first, std::size_t last);
void subtract_square(const std::complex<double>* panel, std::size_t rows, std::size_t columns, std::complex<double>* c,
                     std::size_t size, std::size_t first, std::size_t last);

/// x := L⁻¹ x for the columns of a factored panel (rows × columns): solves for the first `columns` numbers of x and
/// subtracts the products of the lower rows with them from the others.
void solve_forward(const double* panel, std::size_t rows, std::size_t columns, double* x);
void solve_forward(const std::complex<double>* panel, std::size_t rows, std::size_t columns, std::complex<double>* x);

/// x := L⁻ᴴ x, the numbers after the first `columns` being known.
void solve_backward(const double* panel, std::size_t rows, std::size_t columns, double* x);
void solve_backward(const std::complex<double>* panel, std::size_t rows, std::size_t columns, std::complex<double>* x);

}  // namespace papilla::param_detail
