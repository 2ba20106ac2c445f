// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

/// in_voronoi() in a shader.
constexpr std::string_view k_voronoi_shader = R"(
float home_column = column;
float home_line = line;
float least = 1.0e30;
float second = 1.0e30;
float nx = 0.0;
float ny = 0.0;
float mx = 0.0;
float my = 0.0;
for (int q = -2; q <= 2; ++q) {
for (int p = -2; p <= 2; ++p) {
float at_column = home_column + float(p);
float at_line = home_line + float(q);
uint h = mix_bits(whole(wrap(at_column, $columns)), whole(wrap(at_line, $rows)), $seed73);
float dx = at_column + 0.2 + 0.6 * float(h & 1023u) / 1024.0 - px;
float dy = at_line + 0.2 + 0.6 * float((h >> 10u) & 1023u) / 1024.0 - py;
float d = dx * dx + dy * dy;
if (d < least) {
second = least;
mx = nx;
my = ny;
least = d;
nx = dx;
ny = dy;
column = at_column;
line = at_line;
} else if (d < second) {
second = d;
mx = dx;
my = dy;
}
}
}
sx = 0.5 - nx;
sy = 0.5 - ny;
inside = edge((second - least) / (2.0 * max(hypot(mx - nx, my - ny), 1.0e-9)) - $joint, $texel);
)";

/// Width of the joints, as a share of a cell.
constexpr double k_joint = 0.08;

std::uint32_t whole(double v) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(v, -1e9, 1e9)));
}
double wrap(double cell, double count) { return count > 0 ? cell - count * std::floor(cell / count) : cell; }

/// The place of a point in its cell.
struct InCell {
  double column, row;  ///< Of the cell.
  double x, y;         ///< Within it, about [0, 1].
  double inside;       ///< 1 in the cell, 0 in the joint.
};

/// The named recipes side by side, each in cells of its own: bricks, or Voronoi's cells about jittered points.
class Overview final : public Pattern {
 public:
  Overview(TypeArguments& arguments, bool voronoi)
      : shown_(arguments.matching_textures(k_most_shown)), seed_(arguments.seed()), voronoi_(voronoi) {}

  unsigned given_channels() const override { return k_all_channels; }
  void evaluate(const PatternRow& row) const override {
    ChannelRows out;
    channels(row, out);
    std::copy_n(out.row[0], row.n, row.out);
  }

  void channels(const PatternRow& row, ChannelRows& out) const override {
    const double fx = fitted(k_cells, row.period_x), fy = fitted(k_cells, row.period_y);
    const double columns = std::round(fx * row.period_x), rows = std::round(fy * row.period_y);
    double x[k_row], y[k_row], inside[k_row];
    std::size_t choice[k_row];
    for (int i = 0; i < row.n; ++i) {
      const double px = row.x[i] * fx, py = row.y[i] * fy, texel = row.texel * fx;
      const InCell at = voronoi_ ? in_voronoi(px, py, columns, rows, texel) : in_brick(px, py, texel);
      const std::uint32_t column = whole(wrap(at.column, columns)), line = whole(wrap(at.row, rows));
      // Neighbours differ, and 16 cells in a square show up to 16 recipes.
      choice[i] = (seed_ + 5 * line + column) % shown_.size();
      row.id[i] = unit_number(mix_bits(column, line, seed_ + 79));
      row.info[i] = column, row.info[k_row + i] = line;
      x[i] = at.x, y[i] = at.y, inside[i] = at.inside;
    }
    Block inner = *row.block;
    inner.x = x, inner.y = y, inner.texel = row.texel * fx, inner.extent_x = inner.extent_y = 1;
    ChannelRows part;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (std::find(choice, choice + row.n, k) == choice + row.n) continue;
      row.evaluator->channels(shown_[k], inner, k_all_channels, part);
      for (std::size_t c = 0; c < k_channels + 2; ++c)
        for (int i = 0; i < row.n; ++i)
          if (choice[i] == k) out.row[c][i] = part.row[c][i] * (is_zero_in_joints(c) ? inside[i] : 1);
    }
  }

  void write_shader(PatternShader& shader) const override {
    const double fx = fitted(k_cells, shader.period_x), fy = fitted(k_cells, shader.period_y);
    const ShaderValues values{{"fx", fx},
                              {"fy", fy},
                              {"columns", std::round(fx * shader.period_x)},
                              {"rows", std::round(fy * shader.period_y)},
                              {"texel", shader.texel * fx},
                              {"joint", k_joint / 2},
                              {"seed73", seed_ + 73},
                              {"seed79", seed_ + 79},
                              {"seed", seed_},
                              {"shown", static_cast<std::uint32_t>(shown_.size())}};
    shader.add(
        "float px = $x * $fx;\nfloat py = $y * $fy;\nfloat column = floor(px);\nfloat line = floor(py);\n"
        "float sx = px - column;\nfloat sy = py - line;\nfloat inside = 1.0;\n",
        values);
    shader.add(
        voronoi_ ? k_voronoi_shader : "inside = edge(min(min(sx, sy), min(1.0 - sx, 1.0 - sy)) - $joint, $texel);\n",
        values);
    shader.add(
        "uint c = whole(wrap(column, $columns));\nuint l = whole(wrap(line, $rows));\n"
        "uint choice = ($seed + 5u * l + c) % $shown;\n$id = unit_number(mix_bits(c, l, $seed79));\n",
        values);
    shader.set_info(0, "float(c)");
    shader.set_info(1, "float(l)");
    for (std::size_t k = 0; k < shown_.size(); ++k)
      shader.add(
          "if (choice == $k) {\n$tbelow = $call;\n}\n",
          {{"k", static_cast<std::uint32_t>(k)}, {"call", shader.channels(shown_[k], "sx", "sy", shader.texel * fx)}});
    for (const char* part : {"main", "bump", "red", "green", "blue"})
      shader.add("$tbelow.$part = $tbelow.$part * inside;\n", {{"part", part}});
  }

 private:
  static constexpr std::size_t k_most_shown = 16;

  /// True for value, height and colour.
  static bool is_zero_in_joints(std::size_t row) {
    return row == static_cast<std::size_t>(Channel::main) || row == static_cast<std::size_t>(Channel::bump) ||
           row >= static_cast<std::size_t>(Channel::color);
  }

  static InCell in_brick(double x, double y, double texel) {
    const double column = std::floor(x), row = std::floor(y), s = x - column, t = y - row;
    return {column, row, s, t, edge(std::min({s, t, 1 - s, 1 - t}) - k_joint / 2, texel)};
  }

  InCell in_voronoi(double x, double y, double columns, double rows, double texel) const {
    const double column = std::floor(x), row = std::floor(y);
    InCell at{column, row, 0, 0, 1};
    double least = 1e30, second = 1e30, nx = 0, ny = 0, mx = 0, my = 0;
    for (int q = -2; q <= 2; ++q)
      for (int p = -2; p <= 2; ++p) {
        const std::uint32_t h = mix_bits(whole(wrap(column + p, columns)), whole(wrap(row + q, rows)), seed_ + 73);
        const double dx = column + p + 0.2 + 0.6 * (h & 1023U) / 1024.0 - x,
                     dy = row + q + 0.2 + 0.6 * (h >> 10 & 1023U) / 1024.0 - y, d = dx * dx + dy * dy;
        if (d < least) {
          second = least, mx = nx, my = ny;
          least = d, nx = dx, ny = dy;
          at.column = column + p, at.row = row + q;
        } else if (d < second) {
          second = d, mx = dx, my = dy;
        }
      }
    at.x = 0.5 - nx, at.y = 0.5 - ny;
    // Distance to the line half way between the two nearest points.
    const double apart = std::hypot(mx - nx, my - ny);
    at.inside = edge((second - least) / (2 * std::max(apart, 1e-9)) - k_joint / 2, texel);
    return at;
  }

  std::vector<int> shown_;
  std::uint32_t seed_;
  bool voronoi_;
};

}  // namespace

std::unique_ptr<Pattern> make_overview_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "brickfunky") return std::make_unique<Overview>(arguments, false);
  if (type == "voronoifunky") return std::make_unique<Overview>(arguments, true);
  return nullptr;
}

}  // namespace papilla::procedural_detail
