// SPDX-License-Identifier: MIT
#include "papilla/param/measure.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/core/units.hpp"
#include "uv_overlap.hpp"

namespace papilla {
namespace {

/// One side of a triangle, named by the points it joins: the lower position first.
struct Side {
  Index part;
  Index low, high;        ///< Positions.
  Index uv_low, uv_high;  ///< uv at these.
  Index corner;           ///< 3 * triangle + corner where the side starts.
  auto edge() const { return std::tie(part, low, high); }
  auto uv_edge() const { return std::tie(part, low, high, uv_low, uv_high); }
};

/// Numbers equal values alike, by sorting; -0 and 0 are equal.
template <class T>
std::vector<Index> number_equal(const Values<T>& values) {
  std::vector<Index> order(values.size()), number(values.size());
  std::iota(order.begin(), order.end(), Index{0});
  oneapi::tbb::parallel_sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (values[a] < values[b]) return true;
    return !(values[b] < values[a]) && a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    number[order[i]] = i > 0 && values[order[i]] == values[order[i - 1]] ? number[order[i - 1]] : order[i];
  return number;
}

/// All sides, those of one edge side by side, within it those of equal uv. Equal positions and equal uv get one number.
/// @param part of each triangle: edges of different parts are different; empty: one part.
std::vector<Side> sorted_sides(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                               const std::vector<std::uint32_t>& part) {
  const std::vector<Index> position = number_equal(mesh.positions), plane = number_equal(uv.values);
  std::vector<Side> sides(3 * mesh.triangles.size());
  oneapi::tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      Side s{part.empty() ? 0 : part[t], position[mesh.triangles[t][k]], position[mesh.triangles[t][l]],
             plane[uv.indices[t][k]],    plane[uv.indices[t][l]],        static_cast<Index>(3 * t + k)};
      if (s.high < s.low) std::swap(s.low, s.high), std::swap(s.uv_low, s.uv_high);
      sides[3 * t + k] = s;
    }
  });
  oneapi::tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.uv_edge() != b.uv_edge() ? a.uv_edge() < b.uv_edge() : a.corner < b.corner;
  });
  return sides;
}

/// Calls visit(first, last) for every run of sides that are equal by `key`.
template <class Key, class Visit>
void each_run(const std::vector<Side>& sides, Key key, Visit visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && key(sides[end]) == key(sides[begin])) ++end;
    visit(begin, end);
    begin = end;
  }
}

constexpr const char* k_function = "measure_distortion";

/// Doubled area over longest edge squared, and edge over extent, at which a triangle counts as degenerate: a few
/// thousand roundings.
constexpr double k_degenerate = 1e-12;

/// A triangle in its own plane and in uv, the longest edge in space first along x.
struct PlanarPair {
  double base = 0, along = 0, height = 0;  ///< Corners in space: (0,0), (base,0), (along,height).
  Vec2 m, n;                               ///< uv of the second and third corner minus that of the first.
  int first = 0;                           ///< Which corner of the triangle is the first.
};

/// The map's derivative: columns ∂(u,v)/∂x and ∂(u,v)/∂y.
struct Jacobian {
  Vec2 x, y;
};

PlanarPair planar_pair(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, std::size_t t) {
  PlanarPair pair;
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k);
    if (dot(e, e) > longest) longest = dot(e, e), pair.first = k;
  }
  const int i = pair.first, j = (i + 1) % 3, k = (i + 2) % 3;
  const Vec3 p = mesh.corner(t, j) - mesh.corner(t, i), q = mesh.corner(t, k) - mesh.corner(t, i);
  pair.base = norm(p);
  if (pair.base > 0) {
    pair.along = dot(p, q) / pair.base;
    pair.height = norm(cross(p, q)) / pair.base;
  }
  const auto at = [&](int c) { return uv.values[uv.indices[t][static_cast<std::size_t>(c)]]; };
  pair.m = at(j) - at(i);
  pair.n = at(k) - at(i);
  return pair;
}

Jacobian jacobian(const PlanarPair& pair) {
  const Vec2 x = (1 / pair.base) * pair.m;
  return {x, (1 / pair.height) * (pair.n - pair.along * x)};
}

/// σ1 and the signed σ2 of a 2×2 matrix, as the half axes of its image of the unit circle.
std::array<double, 2> singular_values(const Jacobian& j) {
  const double same = std::hypot(0.5 * (j.x.x + j.y.y), 0.5 * (j.x.y - j.y.x));
  const double opposite = std::hypot(0.5 * (j.x.x - j.y.y), 0.5 * (j.x.y + j.y.x));
  return {same + opposite, same - opposite};
}

double angle(Vec2 a, Vec2 b) { return std::atan2(std::abs(cross(a, b)), dot(a, b)); }

/// Mean over the corners of |angle in uv - angle in space|.
double angle_error_deg(const PlanarPair& pair) {
  const std::array<Vec2, 3> space{Vec2{0, 0}, Vec2{pair.base, 0}, Vec2{pair.along, pair.height}};
  const std::array<Vec2, 3> plane{Vec2{0, 0}, pair.m, pair.n};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    sum += std::abs(angle(plane[a] - plane[k], plane[b] - plane[k]) - angle(space[a] - space[k], space[b] - space[k]));
  }
  return sum / 3 * k_degrees_per_radian;
}

/// The largest distance of a point from the first one, per axis.
double extent_of(std::span<const Vec3> points) {
  double extent = 0;
  for (const Vec3 p : points) {
    const Vec3 d = p - points.front();
    extent = std::max({extent, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  return extent;
}

double extent_of(std::span<const Vec2> points) {
  double extent = 0;
  for (const Vec2 p : points) {
    const Vec2 d = p - points.front();
    extent = std::max({extent, std::abs(d.x), std::abs(d.y)});
  }
  return extent;
}

/// Everything that is known of a triangle before charts and the common scale are.
struct RawTriangle {
  PlanarPair pair;
  double area = 0, signed_uv_area = 0;
};

class Measurement {
 public:
  Measurement(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, const MeasureOptions& options)
      : mesh_(mesh), uv_(uv), options_(options), raw_(mesh.triangles.size()) {
    report_.triangles = mesh.triangles.size();
    report_.per_triangle.resize(mesh.triangles.size());
    report_.has_overlap = options.overlap;
  }

  DistortionReport run() {
    if (mesh_.triangles.empty()) return report_;
    measure_shapes();
    sides_ = sorted_sides(mesh_, uv_, options_.part);
    connect_charts();
    find_orientation();
    choose_scale();
    measure_triangles();
    sum_triangles();
    sum_edges();
    if (options_.overlap) measure_overlap();
    return std::move(report_);
  }

 private:
  Vec2 uv_of(Index corner) const { return uv_.values[uv_.indices[corner / 3][corner % 3]]; }
  Vec3 position_of(Index corner) const { return mesh_.positions[mesh_.triangles[corner / 3][corner % 3]]; }
  static Index next(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  double length_of(const Side& s) const { return norm(position_of(next(s.corner)) - position_of(s.corner)); }

  void measure_shapes() {
    const double least_edge = k_degenerate * extent_of(mesh_.positions);
    const double least_uv_edge = k_degenerate * extent_of(uv_.values);
    oneapi::tbb::parallel_for(std::size_t{0}, raw_.size(), [&](std::size_t t) {
      RawTriangle& raw = raw_[t];
      raw.pair = planar_pair(mesh_, uv_, t);
      raw.area = 0.5 * raw.pair.base * raw.pair.height;
      raw.signed_uv_area = 0.5 * cross(raw.pair.m, raw.pair.n);
      const Vec2 third = raw.pair.n - raw.pair.m;
      const double longest_uv = std::max({dot(raw.pair.m, raw.pair.m), dot(raw.pair.n, raw.pair.n), dot(third, third)});
      TriangleDistortion& d = report_.per_triangle[t];
      d.area_mm2 = raw.area;
      d.degenerate_3d = !(raw.pair.height > k_degenerate * raw.pair.base && raw.pair.base > least_edge);
      const bool has_uv_area =
          2 * std::abs(raw.signed_uv_area) > k_degenerate * longest_uv && longest_uv > least_uv_edge * least_uv_edge;
      d.degenerate_uv = !d.degenerate_3d && !has_uv_area;
      d.measured = !d.degenerate_3d && !d.degenerate_uv;
    });
  }

  void connect_charts() {
    UnionFind connected(raw_.size());
    each_run(
        sides_, [](const Side& s) { return s.uv_edge(); },
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin + 1; i < end; ++i) connected.unite(sides_[begin].corner / 3, sides_[i].corner / 3);
        });
    const std::vector<Index> chart = connected.labels(report_.charts);
    for (std::size_t t = 0; t < raw_.size(); ++t) report_.per_triangle[t].chart = chart[t];
  }

  void find_orientation() {
    std::vector<double> signed_area(report_.charts, 0);
    for (std::size_t t = 0; t < raw_.size(); ++t)
      if (report_.per_triangle[t].measured) signed_area[report_.per_triangle[t].chart] += raw_[t].signed_uv_area;
    orientation_.resize(report_.charts);
    for (std::size_t c = 0; c < signed_area.size(); ++c) {
      orientation_[c] = signed_area[c] < 0 ? -1.0 : 1.0;
      report_.mirrored_charts += signed_area[c] < 0;
    }
    for (std::size_t t = 0; t < raw_.size(); ++t) {
      TriangleDistortion& d = report_.per_triangle[t];
      d.flipped = d.measured && raw_[t].signed_uv_area * orientation_[d.chart] < 0;
      report_.flipped += d.flipped;
      report_.degenerate_3d += d.degenerate_3d;
      report_.degenerate_uv += d.degenerate_uv;
      report_.measured_triangles += d.measured;
    }
  }

  /// Per chart: the number of its group, below that of the charts.
  std::vector<std::size_t> scaled_together() const {
    std::vector<std::size_t> group(report_.charts, 0);
    if (options_.normalize == UvNormalization::chart) std::iota(group.begin(), group.end(), std::size_t{0});
    if (options_.normalize != UvNormalization::part || options_.part.empty()) return group;
    std::map<std::uint32_t, std::size_t> group_of_part;
    for (std::size_t t = 0; t < raw_.size(); ++t)
      group[report_.per_triangle[t].chart] =
          group_of_part.try_emplace(options_.part[t], group_of_part.size()).first->second;
    return group;
  }

  /// The factor of each chart: that of its group, √(area in space / area in uv).
  void choose_scale() {
    const std::vector<std::size_t> group_of_chart = scaled_together();
    std::vector<double> area(report_.charts, 0), uv_area(report_.charts, 0);
    for (std::size_t t = 0; t < raw_.size(); ++t) {
      report_.area_mm2 += raw_[t].area;
      const std::size_t group = group_of_chart[report_.per_triangle[t].chart];
      if (report_.per_triangle[t].degenerate_3d) continue;
      area[group] += raw_[t].area;
      uv_area[group] += std::abs(raw_[t].signed_uv_area);
      report_.uv_area += std::abs(raw_[t].signed_uv_area);
    }
    scale_.assign(report_.charts, 1);
    bool is_first = true;
    for (std::size_t t = 0; t < raw_.size(); ++t) {
      double& scale = scale_[report_.per_triangle[t].chart];
      const std::size_t group = group_of_chart[report_.per_triangle[t].chart];
      if (options_.normalize != UvNormalization::none)
        scale = uv_area[group] > 0 ? std::sqrt(area[group] / uv_area[group]) : 0;
      if (!report_.per_triangle[t].measured) continue;
      MinMax& all = report_.uv_scale;
      all.min = is_first ? scale : std::min(all.min, scale);
      all.max = is_first ? scale : std::max(all.max, scale);
      is_first = false;
    }
  }

  double scale_of(std::size_t triangle) const { return scale_[report_.per_triangle[triangle].chart]; }

  void measure_triangles() {
    const double texels_per_uv2 =
        options_.texture_px.x / options_.uv_per_texture.x * (options_.texture_px.y / options_.uv_per_texture.y);
    oneapi::tbb::parallel_for(std::size_t{0}, raw_.size(), [&](std::size_t t) {
      TriangleDistortion& d = report_.per_triangle[t];
      if (d.degenerate_3d) return;
      d.texels_per_mm = std::sqrt(std::abs(raw_[t].signed_uv_area) / raw_[t].area * texels_per_uv2);
      if (!d.measured) return;
      const auto [sigma1, sigma2] = singular_values(jacobian(raw_[t].pair));
      const double scale = scale_of(t);
      d.sigma1 = scale * sigma1;
      d.sigma2 = scale * std::abs(sigma2);
      // Below rounding of σ1 the sum formula has no digits left: σ1 σ2 is the ratio of areas.
      const double ratio = scale * scale * std::abs(raw_[t].signed_uv_area) / raw_[t].area;
      if (d.sigma2 < 1e-8 * d.sigma1) d.sigma2 = ratio / d.sigma1;
      const double grown = d.sigma1 * d.sigma1 + d.sigma2 * d.sigma2;
      const double shrunk = 1 / (d.sigma1 * d.sigma1) + 1 / (d.sigma2 * d.sigma2);
      d.symmetric_dirichlet = grown + shrunk;
      d.stretch_l2 = std::sqrt(0.5 * shrunk);
      d.angle_error_deg = angle_error_deg(raw_[t].pair);
    });
  }

  void sum_triangles() {
    DistortionReport& r = report_;
    double area = 0, uv_area = 0, maillot_weight = 0, orthogonality = 0;
    r.area_ratio.min = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < raw_.size(); ++t) {
      const TriangleDistortion& d = r.per_triangle[t];
      const double a = raw_[t].area, scale = scale_of(t);
      if (!d.degenerate_3d) {
        const double image = scale * scale * raw_[t].signed_uv_area * orientation_[d.chart];
        r.maillot_area += 2 * (image - a) * (image - a) / a;  // doubled areas, as in the source
        maillot_weight += 2 * a;
      }
      if (!d.measured) continue;
      area += a;
      const double conformal = d.sigma1 / d.sigma2, ratio = d.sigma1 * d.sigma2;
      r.stretch_l2 += a * d.stretch_l2 * d.stretch_l2;
      r.stretch_linf = std::max(r.stretch_linf, 1 / d.sigma2);
      r.symmetric_dirichlet.mean += a * d.symmetric_dirichlet;
      r.symmetric_dirichlet.max = std::max(r.symmetric_dirichlet.max, d.symmetric_dirichlet);
      r.conformal.mean += a * conformal;
      r.conformal.max = std::max(r.conformal.max, conformal);
      r.area_ratio.min = std::min(r.area_ratio.min, ratio);
      r.area_ratio.mean += a * ratio;
      r.area_ratio.max = std::max(r.area_ratio.max, ratio);
      r.angle_error_deg.mean += a * d.angle_error_deg;
      r.angle_error_deg.max = std::max(r.angle_error_deg.max, d.angle_error_deg);
      const Jacobian j = jacobian(raw_[t].pair);
      const double gradients = scale * scale * (j.x.x * j.x.y + j.y.x * j.y.y);  // ∇u · ∇v
      orthogonality += a * gradients * gradients;
      const double e1 = 1 / (d.sigma1 * d.sigma1) - 1, e2 = 1 / (d.sigma2 * d.sigma2) - 1;
      r.green_lagrange += a * ratio * (e1 * e1 + e2 * e2);
      uv_area += a * ratio;
    }
    if (maillot_weight > 0) r.maillot_area /= maillot_weight;
    if (!(area > 0)) {
      r.area_ratio.min = 0;
      return;
    }
    r.stretch_l2 = std::sqrt(r.stretch_l2 / area);
    for (double* mean : {&r.symmetric_dirichlet.mean, &r.conformal.mean, &r.area_ratio.mean, &r.angle_error_deg.mean})
      *mean /= area;
    r.levy_orthogonality = std::sqrt(orthogonality / area);
    r.green_lagrange /= uv_area;
    r.symmetric_dirichlet_percentiles = percentiles([](const TriangleDistortion& d) { return d.symmetric_dirichlet; });
    r.stretch_percentiles = percentiles([](const TriangleDistortion& d) { return d.stretch_l2; });
    r.angle_error_percentiles = percentiles([](const TriangleDistortion& d) { return d.angle_error_deg; });
    const auto density = [](const TriangleDistortion& d) { return d.texels_per_mm; };
    const auto values = weighted(density);
    r.texel_density = {values.front().first, percentiles(density).p50, values.back().first};
  }

  /// (value, area) of the measured triangles, by value.
  template <class Value>
  std::vector<std::pair<double, double>> weighted(Value value) const {
    std::vector<std::pair<double, double>> result;
    for (const TriangleDistortion& d : report_.per_triangle)
      if (d.measured) result.push_back({value(d), d.area_mm2});
    oneapi::tbb::parallel_sort(result.begin(), result.end());
    return result;
  }

  template <class Value>
  Percentiles percentiles(Value value) const {
    const auto values = weighted(value);
    double total = 0;
    for (const auto& v : values) total += v.second;
    std::array<double, 3> shares{0.5, 0.9, 0.99}, found{};
    double sum = 0;
    std::size_t next = 0;
    for (const auto& [v, area] : values) {
      sum += area;
      while (next < 3 && sum >= shares[next] * total) found[next++] = v;
    }
    while (next < 3) found[next++] = values.back().first;
    return {found[0], found[1], found[2]};
  }

  void sum_edges() {
    double length = 0, squared_length = 0, jump = 0, weight = 0;
    each_run(
        sides_, [](const Side& s) { return s.uv_edge(); },
        [&](std::size_t begin, std::size_t end) {
          const Side& s = sides_[begin];
          const double space = length_of(s);
          const double plane = scale_of(s.corner / 3) * norm(uv_of(next(s.corner)) - uv_of(s.corner));
          if (space > 0) {
            const double difference = plane * plane - space * space;
            report_.edge_length_error += std::abs(plane - space);
            report_.maillot_length += difference * difference / (space * space);
            length += space;
            squared_length += space * space;
          }
          if (end - begin == 2) add_homogeneity(s, sides_[begin + 1], jump, weight);
        });
    if (length > 0) {
      report_.edge_length_error /= length;
      report_.maillot_length /= squared_length;
    }
    if (weight > 0) report_.levy_homogeneity = std::sqrt(jump / weight);
    sum_seams();
  }

  /// The derivative of uv at a side, inwards in the triangle's plane and perpendicular to the side.
  Vec2 inward_derivative(Index corner) const {
    const Index b = next(corner), c = next(b);
    const Vec3 edge = position_of(b) - position_of(corner), to_top = position_of(c) - position_of(corner);
    const double square = dot(edge, edge), height = norm(cross(edge, to_top)) / std::sqrt(square);
    const Vec2 foot = uv_of(corner) + (dot(edge, to_top) / square) * (uv_of(b) - uv_of(corner));
    return (scale_of(corner / 3) / height) * (uv_of(c) - foot);
  }

  void add_homogeneity(const Side& a, const Side& b, double& jump, double& weight) const {
    const std::size_t s = a.corner / 3, t = b.corner / 3;
    if (s == t || !report_.per_triangle[s].measured || !report_.per_triangle[t].measured) return;
    if (!(length_of(a) > 0)) return;
    const Vec2 difference = inward_derivative(a.corner) + inward_derivative(b.corner);
    jump += (raw_[s].area + raw_[t].area) * dot(difference, difference);
    weight += raw_[s].area + raw_[t].area;
  }

  void sum_seams() {
    double jump = 0;
    each_run(
        sides_, [](const Side& s) { return s.edge(); },
        [&](std::size_t begin, std::size_t end) {
          const Side& first = sides_[begin];
          const Side& last = sides_[end - 1];
          if (first.uv_edge() == last.uv_edge()) return;
          const double length = length_of(first);
          report_.seam_length_mm += length;
          jump += 0.5 * length * (phase_jump(first.uv_low, last.uv_low) + phase_jump(first.uv_high, last.uv_high));
        });
    if (report_.seam_length_mm > 0) report_.seam_phase_jump = jump / report_.seam_length_mm;
  }

  /// |uv a - uv b| in textures, up to whole textures.
  double phase_jump(Index a, Index b) const {
    const Vec2 d = uv_.values[a] - uv_.values[b];
    const double x = d.x / options_.uv_per_texture.x, y = d.y / options_.uv_per_texture.y;
    return norm(Vec2{x - std::round(x), y - std::round(y)});
  }

  void measure_overlap() {
    std::vector<param_detail::UvTriangle> triangles;
    std::vector<Index> number;
    for (Index t = 0; t < raw_.size(); ++t) {
      const TriangleDistortion& d = report_.per_triangle[t];
      if (!(std::abs(raw_[t].signed_uv_area) > 0) || d.degenerate_uv) continue;
      std::array<Vec2, 3> corners{uv_of(3 * t), uv_of(3 * t + 1), uv_of(3 * t + 2)};
      if (raw_[t].signed_uv_area < 0) std::swap(corners[1], corners[2]);
      triangles.push_back({corners, options_.part.empty() ? 0 : options_.part[t]});
      number.push_back(t);
    }
    const param_detail::UvOverlap any = param_detail::find_uv_overlap(triangles, options_.overlap_rows);
    // Charts are those of one part: without an overlap there, there is none within them.
    if (std::find(any.overlaps.begin(), any.overlaps.end(), 1) == any.overlaps.end()) return;
    for (std::size_t i = 0; i < number.size(); ++i) triangles[i].group = report_.per_triangle[number[i]].chart;
    const param_detail::UvOverlap within = param_detail::find_uv_overlap(triangles, options_.overlap_rows);
    report_.overlap_area_fraction = any.fraction;
    report_.overlap_within_charts = within.fraction;
    for (std::size_t i = 0; i < number.size(); ++i) {
      TriangleDistortion& d = report_.per_triangle[number[i]];
      d.overlaps_any = any.overlaps[i];
      d.overlaps_chart = within.overlaps[i];
      report_.overlapping_triangles += d.overlaps_any;
      report_.overlapping_within_charts += d.overlaps_chart;
    }
  }

  const TriangleMesh& mesh_;
  const CornerAttribute<Vec2>& uv_;
  MeasureOptions options_;
  std::vector<RawTriangle> raw_;
  std::vector<Side> sides_;
  std::vector<double> orientation_;  ///< Per chart: -1 when mirrored.
  std::vector<double> scale_;        ///< Of uv, per chart.
  DistortionReport report_;
};

void check_options(const MeasureOptions& o) {
  for (const double x : {o.texture_px.x, o.texture_px.y, o.uv_per_texture.x, o.uv_per_texture.y})
    if (!(x > 0 && std::isfinite(x)))
      throw InvalidInput(std::string(k_function) + ": texture_px and uv_per_texture must be positive, got " +
                         std::to_string(x));
  if (o.overlap_rows < 64 || o.overlap_rows > 65536)
    throw InvalidInput(std::string(k_function) + ": overlap_rows is " + std::to_string(o.overlap_rows) +
                       ", expected 64 to 65536");
}

bool all_have_uv(const CornerAttribute<Vec2>& uv) {
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    if (!uv.has_value(t)) return false;
  return true;
}

/// Measures the triangles that have uv alone and puts the others back into the list.
DistortionReport measure_those_with_uv(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                                       const MeasureOptions& options) {
  TriangleMesh some;
  some.positions = mesh.positions;
  CornerAttribute<Vec2> their_uv{uv.values, {}};
  MeasureOptions their_options = options;
  their_options.part.clear();
  std::vector<std::size_t> number;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!uv.has_value(t)) continue;
    some.triangles.push_back(mesh.triangles[t]);
    their_uv.indices.push_back(uv.indices[t]);
    if (!options.part.empty()) their_options.part.push_back(options.part[t]);
    number.push_back(t);
  }
  DistortionReport report = measure_distortion(some, their_uv, their_options);
  report.triangles = mesh.triangles.size();
  report.without_uv = mesh.triangles.size() - number.size();
  std::vector<TriangleDistortion> all(mesh.triangles.size());
  for (std::size_t i = 0; i < number.size(); ++i) all[number[i]] = report.per_triangle[i];
  report.per_triangle = std::move(all);
  return report;
}

}  // namespace

DistortionReport measure_distortion(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv,
                                    const MeasureOptions& options) {
  check_options(options);
  param_detail::check_mesh(mesh, k_function);
  if (!options.part.empty() && options.part.size() != mesh.triangles.size())
    throw InvalidInput(std::string(k_function) + ": part has " + std::to_string(options.part.size()) + " entries for " +
                       std::to_string(mesh.triangles.size()) + " triangles");
  if (uv.indices.size() == mesh.triangles.size() && !all_have_uv(uv)) return measure_those_with_uv(mesh, uv, options);
  param_detail::check_uv(mesh, uv, k_function);
  return Measurement(mesh, uv, options).run();
}

}  // namespace papilla
