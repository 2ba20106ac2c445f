// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cell_distances.hpp"
#include "cell_points.hpp"
#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

/// Poisson's distribution with mean 4, as Worley's table of 256 entries has it, in shuffled order.
double worley_count(int index) {
  const double share = (((index * 167 + 13) & 255) + 0.5) / 256;
  double term = std::exp(-4.0), sum = term;
  int count = 0;
  while (sum < share) sum += term *= 4.0 / ++count;
  return std::max(1, count);
}

/// Meets all points of the cells about a place, as cell_row() does.
constexpr std::string_view k_meet_cells = R"(
void $tcells(float px, float py, float period_x, float period_y, uint seed) {
float home_x = floor(px);
float home_y = floor(py);
for (int q = -2; q <= 2; ++q) {
for (int p = -2; p <= 2; ++p) {
float cell_x = home_x + float(p);
float cell_y = home_y + float(q);
uint cx = lattice(wrap(cell_x, period_x));
uint cy = lattice(wrap(cell_y, period_y));
uint hash = mix_bits(cx, cy, seed);
float move_x = 0.0;
float move_y = 0.0;
$displacement
int count = int(($tcounts[int((hash & 255u) >> 2u)] >> ((hash & 3u) * 8u)) & 255u);
for (int k = 0; k < count; ++k) {
uint a = mix_bits(hash, uint(2 * k + 1), 0x51ED270Bu);
uint b = mix_bits(hash, uint(2 * k + 2), 0x51ED270Bu);
float sx = unit_number(a);
float sy = unit_number(b);
float fx = sx + (0.5 - sx) * $smooth + move_x;
float fy = sy + (0.5 - sy) * $smooth + move_y;
float dx = float(p) + fx - (px - home_x);
float dy = float(q) + fy - (py - home_y);
$tmeet($metric, cell_x + fx, cell_y + fy, dx, dy, unit_number(mix_bits(a, b, 3u)));
}
}
}
}
)";

constexpr std::string_view k_displacements[] = {
    "",
    "move_x = float(cy & 1u) * $displace;",
    "move_y = float(cx & 1u) * $displace;",
    "move_x = float(cy & 1u) * $displace;\nmove_y = float(cx & 1u) * $displace;",
    "move_x = float((cx ^ cy) & 1u) * $displace;",
    "move_y = float((cx ^ cy) & 1u) * $displace;",
    "move_x = (unit_number(mix_bits(hash, 11u, 7u)) - 0.5) * $displace;\n"
    "move_y = (unit_number(mix_bits(hash, 13u, 7u)) - 0.5) * $displace;"};

class Voronoi final : public Pattern {
 public:
  explicit Voronoi(TypeArguments& arguments)
      : combination_(arguments, arguments.flag("random")),
        octaves_(arguments.integer("octaves")),
        lacunarity_(arguments.number("lacunarity")),
        sponge_(arguments.integer("cell_initmode")),
        sponge_power_(arguments.number("initpower")),
        seed_(arguments.seed()),
        needs_points_(arguments.mentions("get") || arguments.mentions("get0") || arguments.mentions("get1") ||
                      arguments.mentions("id")) {
    cells_.distance = metric_of(arguments);
    cells_.power_a = arguments.number("distmodea"), cells_.power_b = arguments.number("distmodeb");
    cells_.wanted = distances_wanted(arguments, arguments.flag("random"));
    cells_.smooth = arguments.number("smooth");
    cells_.displace_mode = arguments.integer("displacemode"),
    cells_.displace = std::clamp(arguments.number("displace"), -1.0, 1.0);
    weights_ = numbers_of(arguments, "weights");
    for (int k = static_cast<int>(weights_.size()); k < octaves_; ++k) weights_.push_back(std::pow(lacunarity_, -k));
    fill_counts(arguments);
  }

  void evaluate(const PatternRow& row) const override {
    double sum[k_most_distances][k_row], distance[k_most_distances][k_row], x[k_row], y[k_row];
    double* rows[k_most_distances] = {distance[0], distance[1], distance[2], distance[3]};
    std::vector<CellHit> hits(needs_points_ ? static_cast<std::size_t>(cells_.wanted * row.n) : 0);
    CellOptions cells = cells_;
    for (int k = 0; k < cells.wanted; ++k) std::fill_n(sum[k], row.n, 0.0);
    for (int octave = 0; octave < octaves_; ++octave) {
      const double wanted = k_cells * std::pow(lacunarity_, octave);
      const double fx = fitted(wanted, row.period_x), fy = fitted(wanted, row.period_y);
      cells.period_x = std::round(fx * row.period_x), cells.period_y = std::round(fy * row.period_y);
      cells.seed = mix_bits(seed_, static_cast<std::uint32_t>(octave), 53);
      for (int i = 0; i < row.n; ++i) x[i] = row.x[i] * fx, y[i] = row.y[i] * fy;
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i) distance[k][i] = octave == 0 ? k_infinite : first_distance(distance[k][i]);
      cell_row(x, y, row.n, cells, rows, needs_points_ && octave == 0 ? hits.data() : nullptr);
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i)
          sum[k][i] += weights_[static_cast<std::size_t>(octave)] * std::min(distance[k][i], k_infinite);
    }
    if (needs_points_)
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i) {
          const CellHit& hit = hits[static_cast<std::size_t>(k * row.n + i)];
          keep_point(row, k, i, hit.x / k_cells, hit.y / k_cells, hit.dx / k_cells, hit.dy / k_cells, sum[k][i],
                     hit.id);
        }
    combination_.apply(row, sum, cells.wanted);
  }

  void write_shader(PatternShader& shader) const override {
    std::vector<ShaderValue> counts;
    for (std::size_t k = 0; k < cells_.counts.size(); k += 4)
      counts.emplace_back(static_cast<std::uint32_t>(cells_.counts[k] | cells_.counts[k + 1] << 8 |
                                                     cells_.counts[k + 2] << 16 | cells_.counts[k + 3] << 24));
    shader.add_array("$tcounts", "uint", counts);
    const ShaderValues values{
        {"displacement", std::string(k_displacements[static_cast<std::size_t>(cells_.displace_mode)])},
        {"displace", cells_.displace},
        {"wanted", cells_.wanted},
        {"smooth", cells_.smooth},
        {"metric", metric_shader(cells_.distance, cells_.power_a, cells_.power_b, "dx", "dy")}};
    shader.add_function(k_met_points, values);
    shader.add_function(k_meet_cells, values);
    for (int octave = 0; octave < octaves_; ++octave) {
      const double wanted = k_cells * std::pow(lacunarity_, octave);
      const double fx = fitted(wanted, shader.period_x), fy = fitted(wanted, shader.period_y);
      for (int k = 0; k < cells_.wanted; ++k)
        shader.add(octave == 0 ? "$tdistance[$k] = 1.0e30;\n" : "$tdistance[$k] = $first;\n",
                   {{"k", k}, {"first", first_distance_shader("$tdistance[" + std::to_string(k) + "]")}});
      shader.add("$tcells($x * $fx, $y * $fy, $period_x, $period_y, $seed);\n",
                 {{"fx", fx},
                  {"fy", fy},
                  {"period_x", std::round(fx * shader.period_x)},
                  {"period_y", std::round(fy * shader.period_y)},
                  {"seed", mix_bits(seed_, static_cast<std::uint32_t>(octave), 53)}});
      for (int k = 0; k < cells_.wanted; ++k) {
        const ShaderValues sum{
            {"d", "d" + std::to_string(k)}, {"k", k}, {"w", weights_[static_cast<std::size_t>(octave)]}};
        shader.add(octave == 0 ? "float $d = $w * min($tdistance[$k], 1.0e30);\n"
                               : "$d = $d + $w * min($tdistance[$k], 1.0e30);\n",
                   sum);
        if (octave == 0 && needs_points_) write_point(shader, k);
      }
    }
    if (needs_points_)
      for (int k = 0; k < cells_.wanted; ++k) shader.set_info(k * k_infos_of_point + 4, "d" + std::to_string(k));
    combination_.write_shader(shader, cells_.wanted);
  }

 private:
  /// keep_point() but the distance.
  static void write_point(PatternShader& shader, int k) {
    const std::string index = "[" + std::to_string(k) + "]";
    if (k == 0) shader.add("$id = $tnumber[0];\n");
    const char* names[] = {"$tplace_x", "$tplace_y", "$tdiffer_x", "$tdiffer_y"};
    for (int n = 0; n < 4; ++n)
      shader.set_info(k * k_infos_of_point + n, names[n] + index + " / " + ShaderValue(k_cells).text);
    shader.set_info(k * k_infos_of_point + 5, "$tnumber" + index);
  }

  std::string first_distance_shader(const std::string& last) const {
    const std::string p = ShaderValue(sponge_power_).text;
    switch (sponge_) {
      case 1: return "k_power(max(0.0, " + last + "), " + p + ")";
      case 2: return last + " * " + p;
      case 3: return last + " + " + p;
      case 4: return p;
      default: return "1.0e30";
    }
  }

  double first_distance(double last) const {
    switch (sponge_) {
      case 1: return std::pow(std::max(0.0, last), sponge_power_);
      case 2: return last * sponge_power_;
      case 3: return last + sponge_power_;
      case 4: return sponge_power_;
      default: return k_infinite;
    }
  }

  void fill_counts(TypeArguments& arguments) {
    const Program density = arguments.formula("densityfunc");
    double orig[k_row], index[k_row], out[k_row];
    for (int i = 0; i < k_row; ++i) orig[i] = worley_count(i), index[i] = i;
    const double* f[2] = {orig, index};
    Evaluator(arguments.graph()).run_on_distances(density, f, 2, k_row, out);
    for (std::size_t i = 0; i < k_row; ++i)
      cells_.counts[i] =
          static_cast<std::uint8_t>(std::clamp(std::round(out[i]), 0.0, static_cast<double>(k_most_cell_points)));
  }

  Combination combination_;
  int octaves_;
  double lacunarity_;
  int sponge_;
  double sponge_power_;
  std::uint32_t seed_;
  bool needs_points_;
  CellOptions cells_;
  std::vector<double> weights_;
};

}  // namespace

std::unique_ptr<Pattern> make_cell_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "voronoi") return std::make_unique<Voronoi>(arguments);
  if (type == "voronoiseamless") return make_seamless_cells(arguments);
  return nullptr;
}

}  // namespace papilla::procedural_detail
