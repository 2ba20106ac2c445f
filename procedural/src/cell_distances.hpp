// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "cell_points.hpp"
#include "patterns.hpp"

/// What voronoi and voronoiseamless make of the distances to the nearest points.
namespace papilla::procedural_detail {

inline constexpr int k_most_distances = 4;
inline constexpr double k_infinite = 1e30;
/// Information numbers that each of the nearest points gets.
inline constexpr int k_infos_of_point = 6;

CellDistance metric_of(const TypeArguments& arguments);

/// How many distances the recipe's formulas ask for. @param random All are mixed.
int distances_wanted(const TypeArguments& arguments, bool random);

/// Gives a texel the information numbers of its rank-nearest point.
void keep_point(const PatternRow& row, int rank, int i, double x, double y, double dx, double dy, double distance,
                double id);

/// Applied to the distances of the metric: root, inverse, func or a random combination.
class Combination {
 public:
  Combination(TypeArguments& arguments, bool random);

  void apply(const PatternRow& row, double (*distance)[k_row], int wanted) const;

  /// apply() to the variables d0, d1, … of a shader.
  void write_shader(PatternShader& shader, int wanted) const;

 private:
  bool rooted_, inverse_;
  Program func_;
  bool random_, plain_ = false;
  std::array<double, k_most_distances> share_{};
};

/// An expression of dx and dy. @param a, b powers of minkowski.
std::string metric_shader(CellDistance metric, double a, double b, const std::string& dx, const std::string& dy);

/// The nearest of the points that were met, in order of their distances, in private variables of the texture: distance,
/// place, difference and number of the point, four each.
inline constexpr std::string_view k_met_points = R"(
float $tdistance[4];
float $tplace_x[4];
float $tplace_y[4];
float $tdiffer_x[4];
float $tdiffer_y[4];
float $tnumber[4];
void $tmeet(float d, float px, float py, float dx, float dy, float number) {
int place = $wanted;
for (int k = $wanted - 1; k >= 0; --k) {
if (d < $tdistance[k]) {
place = k;
}
}
for (int j = $wanted - 1; j > place; --j) {
$tdistance[j] = $tdistance[j - 1];
$tplace_x[j] = $tplace_x[j - 1];
$tplace_y[j] = $tplace_y[j - 1];
$tdiffer_x[j] = $tdiffer_x[j - 1];
$tdiffer_y[j] = $tdiffer_y[j - 1];
$tnumber[j] = $tnumber[j - 1];
}
if (place < $wanted) {
$tdistance[place] = d;
$tplace_x[place] = px;
$tplace_y[place] = py;
$tdiffer_x[place] = dx;
$tdiffer_y[place] = dy;
$tnumber[place] = number;
}
}
)";

}  // namespace papilla::procedural_detail
