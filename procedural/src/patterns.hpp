// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "node.hpp"
#include "pattern_shader.hpp"

namespace papilla::procedural_detail {

/// Cells of noise and points in a picture at scale 1.
inline constexpr double k_cells = 4;

/// The parameters of a recipe, defaults filled in, for a type's pattern.
class TypeArguments {
 public:
  virtual ~TypeArguments() = default;
  virtual double number(std::string_view name) const = 0;  ///< Also flags (0, 1) and integers.
  virtual std::string text(std::string_view name) const = 0;
  virtual Program formula(std::string_view name) = 0;  ///< Not present when empty.
  virtual std::vector<int> textures(std::string_view name) = 0;
  virtual std::vector<int> matching_textures(
      std::size_t most) = 0;                               ///< Named recipes that pass the filters of the funky types.
  virtual bool mentions(std::string_view word) const = 0;  ///< Somewhere in the recipe's formulas.
  virtual RecipePicture picture(const std::string& path) const = 0;
  virtual const Graph& graph() const = 0;
  virtual double time() const = 0;
  virtual int target_px() const = 0;  ///< Texels a side of the picture that will be made.
  std::uint32_t seed() const { return static_cast<std::uint32_t>(number("seed")); }
  bool flag(std::string_view name) const { return number(name) != 0; }
  int integer(std::string_view name) const { return static_cast<int>(number(name)); }
  [[noreturn]] virtual void refuse(std::string_view name,
                                   const std::string& reason) const = 0;  ///< Names the parameter's place.
};

/// The pattern of a type; null for base, texture and multi.
std::unique_ptr<Pattern> make_pattern(std::string_view type, TypeArguments& arguments);

// By family, one file each.
std::unique_ptr<Pattern> make_noise_pattern(std::string_view type, TypeArguments& arguments);
std::unique_ptr<Pattern> make_cell_pattern(std::string_view type, TypeArguments& arguments);
std::unique_ptr<Pattern> make_seamless_cells(TypeArguments& arguments);  ///< Of voronoiseamless.
std::unique_ptr<Pattern> make_regular_pattern(std::string_view type, TypeArguments& arguments);
std::unique_ptr<Pattern> make_effect_pattern(std::string_view type, TypeArguments& arguments);
std::unique_ptr<Pattern> make_overview_pattern(std::string_view type, TypeArguments& arguments);
std::unique_ptr<Pattern> make_picture_pattern(std::string_view type, TypeArguments& arguments);

/// Numbers of a text, separated by blanks or commas. @throws InvalidInput through arguments.refuse().
std::vector<double> numbers_of(const TypeArguments& arguments, std::string_view name);

/// The repeats per unit that are next to `wanted` and fit the period, in whole repeats; `wanted` when period is 0.
double fitted(double wanted, double period, double multiple = 1);

/// A pattern from a function of a row and a point in it, and what writes the same into a shader.
template <class F>
class PointPattern final : public Pattern {
 public:
  PointPattern(F f, WriteShader shader) : f_(std::move(f)), shader_(std::move(shader)) {}
  void evaluate(const PatternRow& row) const override {
    for (int i = 0; i < row.n; ++i) row.out[i] = f_(row, i);
  }
  void write_shader(PatternShader& shader) const override { shader_(shader); }

 private:
  F f_;
  WriteShader shader_;
};
template <class F>
std::unique_ptr<Pattern> point_pattern(F f, WriteShader shader) {
  return std::make_unique<PointPattern<F>>(std::move(f), std::move(shader));
}
template <class F>
class RowPattern final : public Pattern {
 public:
  RowPattern(F f, WriteShader shader) : f_(std::move(f)), shader_(std::move(shader)) {}
  void evaluate(const PatternRow& row) const override { f_(row); }
  void write_shader(PatternShader& shader) const override { shader_(shader); }

 private:
  F f_;
  WriteShader shader_;
};
template <class F>
std::unique_ptr<Pattern> row_pattern(F f, WriteShader shader) {
  return std::make_unique<RowPattern<F>>(std::move(f), std::move(shader));
}

/// sum of noise / 2^k over octaves, at frequency `cells`; 0 octaves give 0.
void turbulence_row(const double* x, const double* y, int n, double cells, double octaves, bool absolute,
                    std::uint32_t seed, double* out);

/// 0 outside, 1 inside an edge at distance d, softened over a texel.
inline double edge(double d, double texel) {
  if (texel <= 0) return d >= 0 ? 1 : 0;
  const double t = d / texel + 0.5;
  return t < 0 ? 0 : t > 1 ? 1 : t;
}
inline double smooth01(double t) { return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t); }

}  // namespace papilla::procedural_detail
