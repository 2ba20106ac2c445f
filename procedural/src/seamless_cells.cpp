// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cell_distances.hpp"
#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

struct Site {
  double x, y, id;
};

double wrapped_difference(double d) { return d - std::round(d); }

/// Points in the unit square that repel each other like equal charges on the torus.
std::vector<Site> repelled_points(int count, int iterations, std::uint32_t seed) {
  std::vector<Site> sites(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const auto n = static_cast<std::uint32_t>(k);
    sites[k] = {unit_number(mix_bits(n, 1, seed)), unit_number(mix_bits(n, 2, seed)),
                unit_number(mix_bits(n, 3, seed))};
  }
  const double stride = 0.1 / count;
  for (int step = 0; step < iterations; ++step) {
    std::vector<Site> moved = sites;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      double fx = 0, fy = 0;
      for (std::size_t j = 0; j < sites.size(); ++j) {
        if (i == j) continue;
        const double dx = wrapped_difference(sites[i].x - sites[j].x), dy = wrapped_difference(sites[i].y - sites[j].y);
        const double r2 = dx * dx + dy * dy + 1e-6, force = 1 / (r2 * std::sqrt(r2));
        fx += dx * force, fy += dy * force;
      }
      const double length = std::hypot(fx, fy);
      if (length <= 0) continue;
      const double reach = std::min(stride, length * stride * stride);
      moved[i].x += fx / length * reach, moved[i].y += fy / length * reach;
      moved[i].x -= std::floor(moved[i].x), moved[i].y -= std::floor(moved[i].y);
    }
    sites = std::move(moved);
  }
  return sites;
}

class SeamlessVoronoi final : public Pattern {
 public:
  explicit SeamlessVoronoi(TypeArguments& arguments)
      : combination_(arguments, false),
        metric_(metric_of(arguments)),
        a_(arguments.number("distmodea")),
        b_(arguments.number("distmodeb")),
        wanted_(distances_wanted(arguments, false)),
        sites_(repelled_points(arguments.integer("points"), arguments.integer("smoothiterations"), arguments.seed())) {}

  void evaluate(const PatternRow& row) const override {
    double distance[k_most_distances][k_row];
    // Distances in mean spacings, so that the number of points does not change the range.
    const double spacing = std::sqrt(static_cast<double>(sites_.size()));
    const double fx = fitted(1, row.period_x), fy = fitted(1, row.period_y);
    for (int i = 0; i < row.n; ++i) {
      const double x = row.x[i] * fx - std::floor(row.x[i] * fx), y = row.y[i] * fy - std::floor(row.y[i] * fy);
      for (int k = 0; k < wanted_; ++k) distance[k][i] = k_infinite;
      for (const Site& site : sites_) {
        const double dx = wrapped_difference(site.x - x), dy = wrapped_difference(site.y - y);
        const double d = distance_of(metric_, dx * spacing, dy * spacing, a_, b_);
        int place = wanted_;
        while (place > 0 && d < distance[place - 1][i]) --place;
        if (place == wanted_) continue;
        for (int j = wanted_ - 1; j > place; --j) {
          distance[j][i] = distance[j - 1][i];
          for (int m = 0; m < k_infos_of_point; ++m)
            row.info[(j * k_infos_of_point + m) * k_row + i] = row.info[((j - 1) * k_infos_of_point + m) * k_row + i];
        }
        distance[place][i] = d;
        keep_point(row, place, i, site.x, site.y, dx, dy, d, site.id);
      }
    }
    combination_.apply(row, distance, wanted_);
  }

  void write_shader(PatternShader& shader) const override {
    std::vector<ShaderValue> sites;
    for (const Site& site : sites_)
      for (const double v : {site.x, site.y, site.id}) sites.emplace_back(v);
    shader.add_array("$tsites", "float", sites);
    const double spacing = std::sqrt(static_cast<double>(sites_.size()));
    const std::string scale = ShaderValue(spacing).text;
    const ShaderValues values{
        {"wanted", wanted_},
        {"count", static_cast<int>(sites_.size())},
        {"fx", fitted(1, shader.period_x)},
        {"fy", fitted(1, shader.period_y)},
        {"metric", metric_shader(metric_, a_, b_, "(dx * " + scale + ")", "(dy * " + scale + ")")}};
    shader.add_function(k_met_points, values);
    for (int k = 0; k < wanted_; ++k) shader.add("$tdistance[$k] = 1.0e30;\n", {{"k", k}});
    shader.add(R"(
float px = fract_of($x * $fx);
float py = fract_of($y * $fy);
for (int k = 0; k < $count; ++k) {
float site_x = $tsites[3 * k];
float site_y = $tsites[3 * k + 1];
float dx = site_x - px;
float dy = site_y - py;
dx = dx - floor(dx + 0.5);
dy = dy - floor(dy + 0.5);
$tmeet($metric, site_x, site_y, dx, dy, $tsites[3 * k + 2]);
}
$id = $tnumber[0];
)",
               values);
    for (int k = 0; k < wanted_; ++k) {
      const char* names[] = {"$tplace_x", "$tplace_y", "$tdiffer_x", "$tdiffer_y", "$tdistance", "$tnumber"};
      for (int n = 0; n < k_infos_of_point; ++n)
        shader.set_info(k * k_infos_of_point + n, names[n] + ("[" + std::to_string(k) + "]"));
      shader.add("float d$k = $tdistance[$k];\n", {{"k", k}});
    }
    combination_.write_shader(shader, wanted_);
  }

 private:
  Combination combination_;
  CellDistance metric_;
  double a_, b_;
  int wanted_;
  std::vector<Site> sites_;
};

}  // namespace

std::unique_ptr<Pattern> make_seamless_cells(TypeArguments& arguments) {
  return std::make_unique<SeamlessVoronoi>(arguments);
}

}  // namespace papilla::procedural_detail
