// SPDX-License-Identifier: MIT
#include "dense_cholesky.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/cpu_clones.hpp"

namespace papilla::param_detail {
namespace {

using Complex = std::complex<double>;

/// A pivot that is not positive becomes this: its unknown comes out as zero.
constexpr double k_infinite_pivot = 1e150;

typedef double Four __attribute__((vector_size(32), aligned(8)));

/// Several numbers side by side, as many as the processor works on at once.
template <std::size_t Lanes>
struct Pack {
  typedef double Vector __attribute__((vector_size(8 * Lanes), aligned(8)));
};

template <class Scalar, std::size_t Lanes>
struct Tile;

template <std::size_t Lanes>
struct Tile<double, Lanes> {
  using Vector = typename Pack<Lanes>::Vector;
  static constexpr std::size_t height = 2 * Lanes, width = 4;

  /// c (height × 4) -= a (height × depth) bᵀ (depth × 4); a and b have `stride` numbers per column, c has `c_stride`.
  /// Only the first `rows` × `columns` numbers of c are written.
  static inline __attribute__((always_inline)) void update(const double* a, const double* b, std::size_t stride,
                                                           std::size_t depth, double* c, std::size_t c_stride,
                                                           std::size_t rows, std::size_t columns) {
    if (rows > Lanes)
      update_rows<2>(a, b, stride, depth, c, c_stride, rows, columns);
    else
      update_rows<1>(a, b, stride, depth, c, c_stride, rows, columns);
  }

 private:
  template <std::size_t Vectors>
  static inline __attribute__((always_inline)) void update_rows(const double* a, const double* b, std::size_t stride,
                                                                std::size_t depth, double* c, std::size_t c_stride,
                                                                std::size_t rows, std::size_t columns) {
    Vector sum[Vectors][width] = {};
    for (std::size_t k = 0; k < depth; ++k, a += stride, b += stride)
      for (std::size_t v = 0; v < Vectors; ++v) {
        const Vector x = *reinterpret_cast<const Vector*>(a + v * Lanes);
        for (std::size_t j = 0; j < width; ++j) sum[v][j] += x * b[j];
      }
    if (rows >= Vectors * Lanes && columns >= width) {
      for (std::size_t j = 0; j < width; ++j, c += c_stride)
        for (std::size_t v = 0; v < Vectors; ++v) *reinterpret_cast<Vector*>(c + v * Lanes) -= sum[v][j];
      return;
    }
    for (std::size_t j = 0; j < std::min(columns, width); ++j, c += c_stride)
      for (std::size_t i = 0; i < std::min(rows, Vectors * Lanes); ++i) c[i] -= sum[i / Lanes][j][i % Lanes];
  }
};

template <>
struct Tile<Complex, 4> {
  static constexpr std::size_t height = 4, width = 2;

  /// The same for complex numbers: c (4 × 2) -= a (4 × depth) bᴴ (depth × 2).
  static inline __attribute__((always_inline)) void update(const Complex* a, const Complex* b, std::size_t stride,
                                                           std::size_t depth, Complex* c, std::size_t c_stride,
                                                           std::size_t rows, std::size_t columns) {
    Four real_low[2] = {}, real_high[2] = {}, imaginary_low[2] = {}, imaginary_high[2] = {};
    for (std::size_t k = 0; k < depth; ++k, a += stride, b += stride) {
      const auto* p = reinterpret_cast<const double*>(a);
      const auto* q = reinterpret_cast<const double*>(b);
      const Four x = *reinterpret_cast<const Four*>(p), y = *reinterpret_cast<const Four*>(p + 4);
      for (int j = 0; j < 2; ++j) {
        real_low[j] += x * q[2 * j], real_high[j] += y * q[2 * j];
        imaginary_low[j] += x * q[2 * j + 1], imaginary_high[j] += y * q[2 * j + 1];
      }
    }
    // (x + iy)(p - iq) = xp + yq + i(yp - xq)
    for (std::size_t j = 0; j < std::min(columns, width); ++j, c += c_stride)
      for (std::size_t i = 0; i < std::min(rows, height); ++i) {
        const Four& r = i < 2 ? real_low[j] : real_high[j];
        const Four& m = i < 2 ? imaginary_low[j] : imaginary_high[j];
        const std::size_t k = 2 * (i % 2);
        c[i] -= Complex(r[k] + m[k + 1], r[k + 1] - m[k]);
      }
  }
};

inline double conjugate(double x) { return x; }
inline Complex conjugate(Complex x) { return {x.real(), -x.imag()}; }
inline double real_part(double x) { return x; }
inline double real_part(Complex x) { return x.real(); }
inline double times(double x, double y) { return x * y; }
inline Complex times(Complex x, Complex y) {  // without the checks for infinity of std::complex
  return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
}

/// Factors `count` columns from `first` on, all earlier ones being subtracted already.
template <class Scalar>
inline __attribute__((always_inline)) std::size_t factor_strip(Scalar* a, std::size_t rows, std::size_t first,
                                                               std::size_t count) {
  std::size_t bad = 0;
  for (std::size_t j = first; j < first + count; ++j) {
    Scalar* column = a + j * rows;
    for (std::size_t k = first; k < j; ++k) {
      const Scalar factor = conjugate(a[k * rows + j]);
      const Scalar* earlier = a + k * rows;
      for (std::size_t i = j; i < rows; ++i) column[i] -= times(earlier[i], factor);
    }
    double pivot = real_part(column[j]);
    if (!(pivot > 0)) pivot = k_infinite_pivot * k_infinite_pivot, ++bad;
    const double inverse = 1 / std::sqrt(pivot);
    column[j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < rows; ++i) column[i] *= inverse;
  }
  return bad;
}

template <std::size_t Lanes, class Scalar>
inline __attribute__((always_inline)) std::size_t factor_any(Scalar* a, std::size_t rows, std::size_t columns) {
  using T = Tile<Scalar, Lanes>;
  std::size_t bad = 0;
  for (std::size_t j = 0; j < columns; j += T::width) {
    const std::size_t width = std::min(T::width, columns - j);
    if (j > 0)
      for (std::size_t i = j; i < rows; i += T::height)
        T::update(a + i, a + j, rows, j, a + j * rows + i, rows, rows - i, width);
    bad += factor_strip(a, rows, j, width);
  }
  return bad;
}

template <std::size_t Lanes, class Scalar>
inline __attribute__((always_inline)) void subtract_any(const Scalar* panel, std::size_t rows, std::size_t columns,
                                                        Scalar* c, std::size_t size, std::size_t first,
                                                        std::size_t last) {
  using T = Tile<Scalar, Lanes>;
  const Scalar* p = panel + (rows - size);
  for (std::size_t j = first; j < last; j += T::width)
    for (std::size_t i = j; i < size; i += T::height)
      T::update(p + i, p + j, rows, columns, c + j * size + i, size, size - i, size - j);
}

/// Σ conj(a) b. Four sums side by side, in a fixed order.
inline __attribute__((always_inline)) double inner(const double* a, const double* b, std::size_t count) {
  Four sum = {};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) sum += *reinterpret_cast<const Four*>(a + i) * *reinterpret_cast<const Four*>(b + i);
  double rest = 0;
  for (; i < count; ++i) rest += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]) + rest;
}

inline __attribute__((always_inline)) Complex inner(const Complex* a, const Complex* b, std::size_t count) {
  Complex sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += times(conjugate(a[i]), b[i]);
  return sum;
}

template <class Scalar>
inline __attribute__((always_inline)) void forward_any(const Scalar* panel, std::size_t rows, std::size_t columns,
                                                       Scalar* x) {
  for (std::size_t j = 0; j < columns; ++j, panel += rows) {
    const Scalar value = x[j] / real_part(panel[j]);
    x[j] = value;
    for (std::size_t i = j + 1; i < rows; ++i) x[i] -= times(panel[i], value);
  }
}

template <class Scalar>
inline __attribute__((always_inline)) void backward_any(const Scalar* panel, std::size_t rows, std::size_t columns,
                                                        Scalar* x) {
  for (std::size_t j = columns; j-- > 0;) {
    const Scalar* column = panel + j * rows;
    x[j] = (x[j] - inner(column + j + 1, x + j + 1, rows - j - 1)) / real_part(column[j]);
  }
}

#ifdef PAPILLA_CPU_VERSION
/// Eight numbers at once. Each is summed in the same order as with four.
const bool k_wide = __builtin_cpu_supports("x86-64-v4");

PAPILLA_CPU_VERSION("arch=x86-64-v4")
std::size_t factor_columns_wide(double* a, std::size_t rows, std::size_t columns) {
  return factor_any<8>(a, rows, columns);
}

PAPILLA_CPU_VERSION("arch=x86-64-v4")
void subtract_square_wide(const double* panel, std::size_t rows, std::size_t columns, double* c, std::size_t size,
                          std::size_t first, std::size_t last) {
  subtract_any<8>(panel, rows, columns, c, size, first, last);
}
#endif

}  // namespace

PAPILLA_CPU_CLONES("arch=x86-64-v3")
std::size_t factor_columns(double* a, std::size_t rows, std::size_t columns) {
#ifdef PAPILLA_CPU_VERSION
  if (k_wide) return factor_columns_wide(a, rows, columns);
#endif
  return factor_any<4>(a, rows, columns);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
std::size_t factor_columns(Complex* a, std::size_t rows, std::size_t columns) {
  return factor_any<4>(a, rows, columns);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void subtract_square(const double* panel, std::size_t rows, std::size_t columns, double* c, std::size_t size,
                     std::size_t first, std::size_t last) {
#ifdef PAPILLA_CPU_VERSION
  if (k_wide) return subtract_square_wide(panel, rows, columns, c, size, first, last);
#endif
  subtract_any<4>(panel, rows, columns, c, size, first, last);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void subtract_square(const Complex* panel, std::size_t rows, std::size_t columns, Complex* c, std::size_t size,
                     std::size_t first, std::size_t last) {
  subtract_any<4>(panel, rows, columns, c, size, first, last);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void solve_forward(const double* panel, std::size_t rows, std::size_t columns, double* x) {
  forward_any(panel, rows, columns, x);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void solve_forward(const Complex* panel, std::size_t rows, std::size_t columns, Complex* x) {
  forward_any(panel, rows, columns, x);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void solve_backward(const double* panel, std::size_t rows, std::size_t columns, double* x) {
  backward_any(panel, rows, columns, x);
}

PAPILLA_CPU_CLONES("arch=x86-64-v3")
void solve_backward(const Complex* panel, std::size_t rows, std::size_t columns, Complex* x) {
  backward_any(panel, rows, columns, x);
}

}  // namespace papilla::param_detail
