// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr double k_pi = std::numbers::pi;

std::uint32_t whole(double v) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(v, -1e9, 1e9)));
}
double share_of(double v) { return v - std::floor(v); }
double wrap(double cell, double count) { return count > 0 ? cell - count * std::floor(cell / count) : cell; }

std::unique_ptr<Pattern> make_block(TypeArguments& arguments) {
  const double nx = arguments.number("subx"), ny = arguments.number("suby"), mx = arguments.number("subx2"),
               my = arguments.number("suby2");
  const std::uint32_t seed = arguments.seed();
  return point_pattern(
      [=](const PatternRow& row, int i) {
        const double x = row.x[i] * fitted(1, row.period_x) * nx, y = row.y[i] * fitted(1, row.period_y) * ny;
        double cx = wrap(std::floor(x), nx), cy = wrap(std::floor(y), ny), sx = 0, sy = 0;
        const bool divided = (whole(cx) + whole(cy)) % 2 == 1;
        if (divided) sx = std::floor(share_of(x) * mx), sy = std::floor(share_of(y) * my);
        row.info[10 * k_row + i] = (cy * nx + cx) * mx * my + sy * mx + sx;
        row.id[i] = unit_number(mix_bits(whole(cx) * 256 + whole(sx), whole(cy) * 256 + whole(sy), seed + 61));
        return row.id[i];
      },
      [=](PatternShader& shader) {
        shader.add(R"(
float px = $x * $fx;
float py = $y * $fy;
float cx = wrap(floor(px), $nx);
float cy = wrap(floor(py), $ny);
float sx = 0.0;
float sy = 0.0;
if (((whole(cx) + whole(cy)) & 1u) == 1u) {
sx = floor(fract_of(px) * $mx);
sy = floor(fract_of(py) * $my);
}
$id = unit_number(mix_bits(whole(cx) * 256u + whole(sx), whole(cy) * 256u + whole(sy), $seed));
$out = $id;
)",
                   {{"fx", fitted(1, shader.period_x) * nx},
                    {"fy", fitted(1, shader.period_y) * ny},
                    {"nx", nx},
                    {"ny", ny},
                    {"mx", mx},
                    {"my", my},
                    {"seed", seed + 61}});
        const auto text = [](double v) { return ShaderValue(v).text; };
        shader.set_info(10, "(cy * " + text(nx) + " + cx) * " + text(mx * my) + " + sy * " + text(mx) + " + sx");
      });
}

class Brick final : public Pattern {
 public:
  explicit Brick(TypeArguments& arguments)
      : joint_(arguments.number("mortarthickness") / 2),
        rounding_(arguments.number("round")),
        joint_variation_(arguments.number("mortarthicknessrand")),
        joint_scale_(arguments.number("mortarthicknessrandscale")),
        id_only_(arguments.flag("returnid")),
        offset_(arguments.flag("offsetrand")),
        switching_(arguments.flag("switching")),
        circle_(arguments.flag("circle")),
        seed_(arguments.seed()) {
    const bool tiling = arguments.flag("tiling");
    columns_ = tiling ? arguments.number("columns") : 1 / arguments.number("brickwidth");
    rows_ = tiling ? arguments.number("rows") : 1 / arguments.number("brickheight");
  }

  void evaluate(const PatternRow& row) const override {
    const double columns = fitted(columns_, row.period_x), rows = fitted(rows_, row.period_y, switching_ ? 2 : 1);
    const double count_x = std::round(columns * row.period_x), count_y = std::round(rows * row.period_y);
    const double width = 1 / columns, height = 1 / rows;
    double variation[k_row] = {};
    if (joint_variation_ > 0) turbulence_row(row.x, row.y, row.n, k_cells * joint_scale_, 3, false, seed_, variation);
    for (int i = 0; i < row.n; ++i) {
      const double j = std::floor(row.y[i] * rows), row_number = wrap(j, count_y);
      double x = row.x[i] * columns;
      if (switching_ && whole(j) % 2 == 1) x += 0.5;
      if (offset_) x += unit_number(mix_bits(whole(row_number), 3, seed_ + 67));
      const double column_number = wrap(std::floor(x), count_x);
      row.info[i] = column_number, row.info[k_row + i] = row_number;
      row.id[i] = unit_number(mix_bits(whole(column_number), whole(row_number), seed_ + 71));
      if (id_only_) {
        row.out[i] = row.id[i];
        continue;
      }
      const double from_side = (0.5 - std::abs(share_of(x) - 0.5)) * width,
                   from_end = (0.5 - std::abs(row.y[i] * rows - j - 0.5)) * height;
      const double joint = joint_ / 2 * std::max(0.0, 1 + joint_variation_ * variation[i]);
      row.out[i] = profile(from_side - joint, from_end - joint, std::min(width, height) / 2 - joint_ / 2, row.texel);
      if (circle_) {
        const double r = std::hypot((share_of(x) - 0.5) * width, (row.y[i] * rows - j - 0.5) * height) /
                         (0.3 * std::min(width, height));
        row.out[i] -= 0.5 * smooth01(1 - r) * (row.out[i] > 0 ? 1 : 0);
      }
    }
  }

  void write_shader(PatternShader& shader) const override {
    const double columns = fitted(columns_, shader.period_x), rows = fitted(rows_, shader.period_y, switching_ ? 2 : 1);
    const double width = 1 / columns, height = 1 / rows, half = std::min(width, height) / 2 - joint_ / 2;
    const double ramp = rounding_ * half;
    shader.add(R"(
float variation = 0.0;
if ($variation > 0.0) {
variation = turbulence_row($x, $y, $scale, 3.0, false, $seed);
}
float j = floor($y * $rows);
float row_number = wrap(j, $count_y);
float px = $x * $columns;
if ($switching && (whole(j) & 1u) == 1u) {
px = px + 0.5;
}
if ($offset) {
px = px + unit_number(mix_bits(whole(row_number), 3u, $seed67));
}
float column_number = wrap(floor(px), $count_x);
$id = unit_number(mix_bits(whole(column_number), whole(row_number), $seed71));
)",
               {{"variation", joint_variation_},
                {"scale", k_cells * joint_scale_},
                {"seed", seed_},
                {"rows", rows},
                {"columns", columns},
                {"count_x", std::round(columns * shader.period_x)},
                {"count_y", std::round(rows * shader.period_y)},
                {"switching", switching_},
                {"offset", offset_},
                {"seed67", seed_ + 67},
                {"seed71", seed_ + 71}});
    shader.set_info(0, "column_number");
    shader.set_info(1, "row_number");
    if (id_only_) return shader.add("$out = $id;\n");
    shader.add(
        R"(
float joint = $joint * max(0.0, 1.0 + $variation * variation);
float side = (0.5 - abs(fract_of(px) - 0.5)) * $width - joint;
float end = (0.5 - abs($y * $rows - j - 0.5)) * $height - joint;
)",
        {{"joint", joint_ / 2}, {"variation", joint_variation_}, {"width", width}, {"height", height}, {"rows", rows}});
    if (ramp <= shader.texel)
      shader.add("$out = edge(min(side, end), $texel);\n", {{"texel", shader.texel}});
    else
      shader.add(
          "$out = pick(side <= 0.0 || end <= 0.0, 0.0, smooth01(1.0 - hypot(max(0.0, 1.0 - side / $ramp), "
          "max(0.0, 1.0 - end / $ramp))));\n",
          {{"ramp", ramp}});
    if (circle_)
      shader.add(
          "$out = $out - 0.5 * smooth01(1.0 - hypot((fract_of(px) - 0.5) * $width, ($y * $rows - j - 0.5) * "
          "$height) / $radius) * pick($out > 0.0, 1.0, 0.0);\n",
          {{"width", width}, {"height", height}, {"rows", rows}, {"radius", 0.3 * std::min(width, height)}});
  }

 private:
  double profile(double side, double end, double half, double texel) const {
    const double ramp = rounding_ * half;
    if (ramp <= texel) return edge(std::min(side, end), texel);
    // A rounded box: both slopes together near the corner.
    const double x = std::max(0.0, 1 - side / ramp), y = std::max(0.0, 1 - end / ramp);
    return side <= 0 || end <= 0 ? 0 : smooth01(1 - std::hypot(x, y));
  }

  double columns_ = 4, rows_ = 10, joint_, rounding_, joint_variation_, joint_scale_;
  bool id_only_, offset_, switching_, circle_;
  std::uint32_t seed_;
};

std::unique_ptr<Pattern> make_checker() {
  return point_pattern(
      [](const PatternRow& row, int i) {
        const double x = std::floor(row.x[i] * fitted(2, row.period_x, 2)),
                     y = std::floor(row.y[i] * fitted(2, row.period_y, 2));
        return static_cast<double>((whole(x) + whole(y)) % 2);
      },
      [](PatternShader& shader) {
        shader.add("$out = float((whole(floor($x * $fx)) + whole(floor($y * $fy))) & 1u);\n",
                   {{"fx", fitted(2, shader.period_x, 2)}, {"fy", fitted(2, shader.period_y, 2)}});
      });
}

std::unique_ptr<Pattern> make_checker3d() {
  return point_pattern(
      [](const PatternRow& row, int i) {
        const auto at = [&](BlockRow r) { return row.block->rows[static_cast<std::size_t>(r)][i]; };
        double x = row.x[i] * fitted(k_cells, row.period_x, 2), y = row.y[i] * fitted(k_cells, row.period_y, 2), z = 0;
        if (row.block->solid)
          x = at(BlockRow::posx) * k_cells, y = at(BlockRow::posy) * k_cells, z = at(BlockRow::posz) * k_cells;
        return static_cast<double>((whole(std::floor(x)) + whole(std::floor(y)) + whole(std::floor(z))) % 2);
      },
      [](PatternShader& shader) {
        // A shader knows no position in the scene.
        shader.add("$out = float((whole(floor($x * $fx)) + whole(floor($y * $fy))) & 1u);\n",
                   {{"fx", fitted(k_cells, shader.period_x, 2)}, {"fy", fitted(k_cells, shader.period_y, 2)}});
      });
}

std::unique_ptr<Pattern> make_circle(TypeArguments& arguments) {
  const double r = arguments.number("r");
  return point_pattern(
      [r](const PatternRow& row, int i) {
        double x = row.x[i], y = row.y[i];
        if (row.period_x > 0) x = share_of(x * fitted(1, row.period_x)), y = share_of(y * fitted(1, row.period_y));
        return edge(r - std::hypot(x - 0.5, y - 0.5), row.texel);
      },
      [r](PatternShader& shader) {
        shader.add(shader.period_x > 0 ? "float px = fract_of($x * $fx);\nfloat py = fract_of($y * $fy);\n"
                                       : "float px = $x;\nfloat py = $y;\n",
                   {{"fx", fitted(1, shader.period_x)}, {"fy", fitted(1, shader.period_y)}});
        shader.add("$out = edge($r - hypot(px - 0.5, py - 0.5), $texel);\n", {{"r", r}, {"texel", shader.texel}});
      });
}

std::unique_ptr<Pattern> make_star(TypeArguments& arguments) {
  const double noise = arguments.number("noise"), turb = arguments.number("turb"), ninja = arguments.number("ninja");
  const double exponent = arguments.flag("round") ? 2 : arguments.number("roundjag");
  const double jags = arguments.number("jags"), inner = arguments.number("rmin"), outer = arguments.number("rmax"),
               size = arguments.number("starscale");
  const bool repeat = arguments.flag("repeat");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        double shift[k_row] = {}, more[k_row] = {};
        if (noise != 0) turbulence_row(row.x, row.y, row.n, 2 * k_cells, 1, false, seed, shift);
        if (turb != 0) turbulence_row(row.x, row.y, row.n, 2 * k_cells, 5, false, seed + 1, more);
        for (int i = 0; i < row.n; ++i) {
          double x = row.x[i], y = row.y[i];
          if (repeat || row.period_x > 0)
            x = share_of(x * fitted(1, row.period_x)), y = share_of(y * fitted(1, row.period_y));
          x -= 0.5, y -= 0.5;
          const double r = std::hypot(x, y) + 0.1 * (noise * shift[i] + turb * more[i]);
          const double turn = share_of(std::atan2(y, x) / (2 * k_pi) * jags + ninja * r * jags / 10);
          double t = 1 - std::abs(2 * turn - 1);  // 0 in the notch, 1 at the point.
          if (exponent > 0) t = std::pow(t, exponent);
          const double border = 0.5 * size * (inner + (outer - inner) * t);
          row.out[i] = border > 0 ? std::clamp(1 - r / border, 0.0, 1.0) : 0;
        }
      },
      [=](PatternShader& shader) {
        const bool wrapped = repeat || shader.period_x > 0;
        shader.add(R"(
float shift = 0.0;
float more = 0.0;
if ($noise != 0.0) {
shift = turbulence_row($x, $y, $cells, 1.0, false, $seed);
}
if ($turb != 0.0) {
more = turbulence_row($x, $y, $cells, 5.0, false, $seed1);
}
float px = pick($wrapped, fract_of($x * $fx), $x) - 0.5;
float py = pick($wrapped, fract_of($y * $fy), $y) - 0.5;
float r = hypot(px, py) + 0.1 * ($noise * shift + $turb * more);
float turn = fract_of(atan2_of(py, px) / 6.283185307179586 * $jags + $ninja * r * $jags / 10.0);
float t = 1.0 - abs(2.0 * turn - 1.0);
if ($exponent > 0.0) {
t = k_power(t, $exponent);
}
float border = 0.5 * $size * ($inner + $reach * t);
$out = pick(border > 0.0, clamp(1.0 - r / max(border, 1.0e-30), 0.0, 1.0), 0.0);
)",
                   {{"noise", noise},
                    {"turb", turb},
                    {"cells", 2 * k_cells},
                    {"seed", seed},
                    {"seed1", seed + 1},
                    {"wrapped", wrapped},
                    {"fx", fitted(1, shader.period_x)},
                    {"fy", fitted(1, shader.period_y)},
                    {"jags", jags},
                    {"ninja", ninja},
                    {"exponent", exponent},
                    {"size", size},
                    {"inner", inner},
                    {"reach", outer - inner}});
      });
}

std::unique_ptr<Pattern> make_weave(TypeArguments& arguments) {
  const double width_x = arguments.number("xwidth"), width_y = arguments.number("ywidth");
  const double pitch_x = width_x + arguments.number("xgap"), pitch_y = width_y + arguments.number("ygap");
  const double rows = arguments.number("rows"), columns = arguments.number("columns");
  const bool round = arguments.flag("roundthreads"), dive = arguments.flag("shadecrossings");
  const std::string matrix = arguments.text("matrix");
  if (matrix.empty() || matrix.find_first_not_of("01") != std::string::npos ||
      static_cast<double>(matrix.size()) < rows * columns)
    arguments.refuse("matrix", "expected at least rows x columns digits 0 or 1");
  return point_pattern(
      [=](const PatternRow& row, int i) {
        const double x = row.x[i] * fitted(1, row.period_x) * columns, y = row.y[i] * fitted(1, row.period_y) * rows;
        const double cx = wrap(std::floor(x), columns), cy = wrap(std::floor(y), rows);
        const double tx = share_of(x) - 0.5, ty = share_of(y) - 0.5;  // Within the crossing.
        const auto profile = [round](double t, double half) {
          if (std::abs(t) >= half) return 0.0;
          return round ? std::sqrt(1 - t * t / (half * half)) : 1.0;
        };
        const bool across_on_top = matrix[static_cast<std::size_t>(cy * columns + cx)] == '1';
        const double down = profile(tx, width_x / pitch_x / 2), across = profile(ty, width_y / pitch_y / 2);
        const double swing_across = dive ? std::cos(k_pi * tx) : 1, swing_down = dive ? std::cos(k_pi * ty) : 1;
        const double side = across_on_top ? 1 : -1;
        const double height_across = across > 0 ? across * (0.6 + 0.4 * side * swing_across) : 0,
                     height_down = down > 0 ? down * (0.6 - 0.4 * side * swing_down) : 0;
        row.id[i] = height_across > height_down ? 1 : 0;
        return std::max(height_across, height_down);
      },
      [=](PatternShader& shader) {
        std::vector<ShaderValue> on_top;
        for (std::size_t k = 0; k < static_cast<std::size_t>(rows * columns); ++k)
          on_top.emplace_back(matrix[k] == '1' ? 1.0 : -1.0);
        shader.add_array("$tmatrix", "float", on_top);
        const char* profile = round ? "sqrt(max(0.0, 1.0 - $at * $at / $half2))" : "1.0";
        shader.add(
            "float px = $x * $fx;\nfloat py = $y * $fy;\nfloat cx = wrap(floor(px), $columns);\n"
            "float cy = wrap(floor(py), $rows);\nfloat tx = fract_of(px) - 0.5;\nfloat ty = fract_of(py) - 0.5;\n",
            {{"fx", fitted(1, shader.period_x) * columns},
             {"fy", fitted(1, shader.period_y) * rows},
             {"columns", columns},
             {"rows", rows}});
        const double half_x = width_x / pitch_x / 2, half_y = width_y / pitch_y / 2;
        shader.add(std::string("float down = pick(abs($at) >= $half, 0.0, ") + profile + ");\n",
                   {{"at", "tx"}, {"half", half_x}, {"half2", half_x * half_x}});
        shader.add(std::string("float across = pick(abs($at) >= $half, 0.0, ") + profile + ");\n",
                   {{"at", "ty"}, {"half", half_y}, {"half2", half_y * half_y}});
        shader.add(R"(
float side = $tmatrix[int(cy * $columns + cx)];
float swing_across = pick($dive, k_cosine(3.141592653589793 * tx), 1.0);
float swing_down = pick($dive, k_cosine(3.141592653589793 * ty), 1.0);
float height_across = pick(across > 0.0, across * (0.6 + 0.4 * side * swing_across), 0.0);
float height_down = pick(down > 0.0, down * (0.6 - 0.4 * side * swing_down), 0.0);
$id = pick(height_across > height_down, 1.0, 0.0);
$out = max(height_across, height_down);
)",
                   {{"columns", columns}, {"dive", dive}});
      });
}

}  // namespace

std::unique_ptr<Pattern> make_regular_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "block") return make_block(arguments);
  if (type == "brick") return std::make_unique<Brick>(arguments);
  if (type == "checker") return make_checker();
  if (type == "checker3d") return make_checker3d();
  if (type == "circle") return make_circle(arguments);
  if (type == "col")
    return point_pattern([](const PatternRow&, int) { return 1.0; },
                         [](PatternShader& shader) { shader.add("$out = 1.0;\n"); });
  if (type == "star") return make_star(arguments);
  if (type == "weave") return make_weave(arguments);
  return nullptr;
}

std::unique_ptr<Pattern> make_pattern(std::string_view type, TypeArguments& arguments) {
  for (auto* const make : {make_noise_pattern, make_cell_pattern, make_regular_pattern, make_effect_pattern,
                           make_picture_pattern, make_overview_pattern})
    if (auto pattern = make(type, arguments)) return pattern;
  return nullptr;
}

}  // namespace papilla::procedural_detail
