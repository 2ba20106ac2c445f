// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Both coordinates times a factor, for turbulence of unlike size across and down.
struct Scaled {
  double x[k_row], y[k_row];
  Scaled(const PatternRow& row, double fx, double fy) {
    for (int i = 0; i < row.n; ++i) x[i] = row.x[i] * fx, y[i] = row.y[i] * fy;
  }
};

std::unique_ptr<Pattern> make_wood(TypeArguments& arguments) {
  const double fibres = arguments.number("intensity2"), rings = arguments.number("rings");
  const bool cross_cut = arguments.flag("makerings");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        double bend[k_row], fibre[k_row];
        const Scaled wide(row, cross_cut ? 1 : 0.25, 1), fine(row, 1, cross_cut ? 1 : 24);
        turbulence_row(wide.x, wide.y, row.n, 3, 3, false, seed, bend);
        turbulence_row(fine.x, fine.y, row.n, cross_cut ? 40 : 3, 2, false, seed + 1, fibre);
        for (int i = 0; i < row.n; ++i) {
          const double place = cross_cut ? std::hypot(row.x[i] - 0.5, row.y[i] - 0.5) * 2 * rings + 0.6 * bend[i]
                                         : row.y[i] * rings / 2 + 1.6 * bend[i];
          const double ring = place - std::floor(place);
          // Early wood fades slowly into dark late wood, which ends sharply.
          row.out[i] =
              std::clamp(1 - 0.7 * ring * ring * smooth01((1 - ring) * 12) + fibres * 0.6 * fibre[i] - 0.1, 0.0, 1.0);
        }
      },
      [=](PatternShader& shader) {
        shader.add(R"(
float bend = turbulence_row($x * $wide, $y, 3.0, 3.0, false, $seed);
float fibre = turbulence_row($x, $y * $fine, $cells, 2.0, false, $seed1);
float place = pick($cross, hypot($x - 0.5, $y - 0.5) * 2.0 * $rings + 0.6 * bend, $y * $rings / 2.0 + 1.6 * bend);
float ring = place - floor(place);
$out = clamp(1.0 - 0.7 * ring * ring * smooth01((1.0 - ring) * 12.0) + $fibres * fibre - 0.1, 0.0, 1.0);
)",
                   {{"wide", cross_cut ? 1.0 : 0.25},
                    {"fine", cross_cut ? 1.0 : 24.0},
                    {"cells", cross_cut ? 40.0 : 3.0},
                    {"seed", seed},
                    {"seed1", seed + 1},
                    {"cross", cross_cut},
                    {"rings", rings},
                    {"fibres", fibres * 0.6}});
      });
}

std::unique_ptr<Pattern> make_marble(TypeArguments& arguments) {
  const double strength = arguments.number("turbulence"), octaves = arguments.number("octaves");
  const bool absolute = arguments.flag("absturb");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        turbulence_row(row.x, row.y, row.n, 3, octaves, absolute, seed, row.out);
        for (int i = 0; i < row.n; ++i)
          row.out[i] = 0.5 + 0.5 * std::sin(2 * k_pi * (2 * row.x[i] + row.y[i] + 4 * strength * row.out[i]));
      },
      [=](PatternShader& shader) {
        shader.add(
            "$out = 0.5 + 0.5 * sin_turns(2.0 * $x + $y + $strength * turbulence_row($x, $y, 3.0, $octaves, $absolute, "
            "$seed));\n",
            {{"strength", 4 * strength}, {"octaves", octaves}, {"absolute", absolute}, {"seed", seed}});
      });
}

std::unique_ptr<Pattern> make_smear(TypeArguments& arguments) {
  const double density = arguments.number("density"), turbulence = arguments.number("turbulence"),
               randomness = arguments.number("randomness");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        double streak[k_row], bend[k_row] = {}, uneven[k_row];
        if (turbulence != 0) turbulence_row(row.x, row.y, row.n, k_cells, 3, false, seed + 1, bend);
        double x[k_row], y[k_row];
        for (int i = 0; i < row.n; ++i) x[i] = row.x[i] * 0.5, y[i] = row.y[i] * 12 + turbulence * bend[i];
        turbulence_row(x, y, row.n, 2, 4, false, seed, streak);
        turbulence_row(row.x, row.y, row.n, 6, 2, false, seed + 2, uneven);
        for (int i = 0; i < row.n; ++i)
          row.out[i] = smooth01(2 * (density - 0.5) + 0.5 + 1.2 * streak[i] + randomness * uneven[i] * 0.6);
      },
      [=](PatternShader& shader) {
        shader.add(R"(
float bend = 0.0;
if ($turbulence != 0.0) {
bend = turbulence_row($x, $y, $cells, 3.0, false, $seed1);
}
float streak = turbulence_row($x * 0.5, $y * 12.0 + $turbulence * bend, 2.0, 4.0, false, $seed);
float uneven = turbulence_row($x, $y, 6.0, 2.0, false, $seed2);
$out = smooth01($base + 1.2 * streak + $randomness * uneven);
)",
                   {{"turbulence", turbulence},
                    {"cells", k_cells},
                    {"seed", seed},
                    {"seed1", seed + 1},
                    {"seed2", seed + 2},
                    {"base", 2 * (density - 0.5) + 0.5},
                    {"randomness", 0.6 * randomness}});
      });
}

std::unique_ptr<Pattern> make_sparkle(TypeArguments& arguments) {
  const double cx = arguments.number("centrex"), cy = arguments.number("centrey"), radius = arguments.number("radius");
  const double amount = std::clamp(arguments.number("amount") / 100, 0.0, 1.0),
               randomness = arguments.number("randomness"), rays = arguments.number("rays");
  const std::uint32_t seed = arguments.seed();
  const double turn = arguments.flag("timer") ? arguments.time() : 0;
  return point_pattern(
      [=](const PatternRow& row, int i) {
        const double dx = row.x[i] - cx, dy = row.y[i] - cy, r = std::hypot(dx, dy) / radius;
        const double angle = std::atan2(dy, dx) / (2 * k_pi) + turn, place = (angle - std::floor(angle)) * rays;
        const auto level = [&](double k) {
          const double ray = k - rays * std::floor(k / rays);
          return 1 + randomness * (2 * unit_number(mix_bits(static_cast<std::uint32_t>(ray), 5, seed)) - 1);
        };
        const double t = place - std::floor(place),
                     ray = level(std::floor(place)) * (1 - t) + level(std::floor(place) + 1) * t;
        const double glow = 1 / (1 + r * r * r * r), shine = std::pow(std::abs(std::cos(k_pi * t)), 8);
        return std::clamp(glow * ((1 - amount) + amount * shine) * ray + amount * shine * ray * std::exp(-r), 0.0, 1.0);
      },
      [=](PatternShader& shader) {
        shader.add_function(
            "float $tlevel(float k) {\nfloat ray = k - $rays * floor(k / $rays);\nreturn 1.0 + $randomness * "
            "(2.0 * unit_number(mix_bits(whole(ray), 5u, $seed)) - 1.0);\n}\n",
            {{"rays", rays}, {"randomness", randomness}, {"seed", seed}});
        shader.add(R"(
float dx = $x - $cx;
float dy = $y - $cy;
float r = hypot(dx, dy) / $radius;
float angle = atan2_of(dy, dx) / 6.283185307179586 + $turn;
float place = (angle - floor(angle)) * $rays;
float t = place - floor(place);
float ray = $tlevel(floor(place)) * (1.0 - t) + $tlevel(floor(place) + 1.0) * t;
float glow = 1.0 / (1.0 + r * r * r * r);
float shine = k_power(abs(k_cosine(3.141592653589793 * t)), 8.0);
$out = clamp(glow * ($rest + $amount * shine) * ray + $amount * shine * ray * exp(-r), 0.0, 1.0);
)",
                   {{"cx", cx},
                    {"cy", cy},
                    {"radius", radius},
                    {"turn", turn},
                    {"rays", rays},
                    {"rest", 1 - amount},
                    {"amount", amount}});
      });
}

std::unique_ptr<Pattern> make_flame(TypeArguments& arguments) {
  const double height = arguments.number("flameh"), width = arguments.number("flamew"),
               timing = arguments.number("timing"), strength = arguments.number("turb");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        double x[k_row], y[k_row], flicker[k_row];
        for (int i = 0; i < row.n; ++i) x[i] = row.x[i], y[i] = 0.6 * row.y[i] + timing;
        turbulence_row(x, y, row.n, 6, 5, false, seed, flicker);
        for (int i = 0; i < row.n; ++i) {
          // The share of the height, 0 at the foot; turbulence grows with it. The outline narrows to a tip.
          const double up = std::max(0.0, 1 - row.y[i]), top = up / height + 0.3 * strength * flicker[i] * up;
          const double left = std::max(0.0, 1 - top), half = width / 2 * std::sqrt(left) + 1e-9;
          const double side = std::abs(row.x[i] - 0.5 + 0.25 * strength * flicker[i] * up) / half;
          row.out[i] = std::min(1.0, std::max(0.0, 1 - side * side) * std::min(1.0, 1.6 * left));
        }
      },
      [=](PatternShader& shader) {
        shader.add(
            R"(
float flicker = turbulence_row($x, 0.6 * $y + $timing, 6.0, 5.0, false, $seed);
float up = max(0.0, 1.0 - $y);
float left = max(0.0, 1.0 - (up / $height + 0.3 * $strength * flicker * up));
float side = abs($x - 0.5 + 0.25 * $strength * flicker * up) / ($half * sqrt(left) + 1.0e-9);
$out = min(1.0, max(0.0, 1.0 - side * side) * min(1.0, 1.6 * left));
)",
            {{"timing", timing}, {"seed", seed}, {"height", height}, {"strength", strength}, {"half", width / 2}});
      });
}

std::unique_ptr<Pattern> make_ball(TypeArguments& arguments, bool explosion) {
  const double radius = arguments.number("radius"), strength = arguments.number("turbintensity"),
               scale = arguments.number("turbscale");
  const double z = arguments.number("turbz"),
               brightness = explosion ? arguments.number("attract") : arguments.number("radiusintensity");
  const double timing = explosion ? 0 : arguments.number("timing"),
               octaves = explosion ? 6 : arguments.number("turbfreq");
  const double shift = explosion ? arguments.number("turbadd") : 0;
  const bool absolute = explosion && arguments.flag("absturb");
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [=](const PatternRow& row) {
        double x[k_row], y[k_row], rough[k_row];
        for (int i = 0; i < row.n; ++i) {
          const double dx = row.x[i] - 0.5, dy = row.y[i] - 0.5, r = std::hypot(dx, dy);
          // An explosion is stretched along its rays.
          const double pull = explosion ? 1 / (1 + brightness * 4 * r) : 1;
          x[i] = dx * scale * pull + z, y[i] = dy * scale * pull + 0.7 * z;
        }
        turbulence_row(x, y, row.n, 3, octaves, absolute, seed, rough);
        for (int i = 0; i < row.n; ++i) {
          const double r = std::hypot(row.x[i] - 0.5, row.y[i] - 0.5) / (radius * (1 + timing));
          const double ball = explosion ? std::exp(-r * r / 3) : brightness * std::max(0.0, 1 - r / 2);
          row.out[i] = std::clamp(ball * (1 + strength * (rough[i] + shift)) +
                                      (explosion ? 0.35 * strength * (rough[i] + shift) * std::exp(-r / 3) : 0),
                                  0.0, 1.0);
        }
      },
      [=](PatternShader& shader) {
        shader.add(R"(
float dx = $x - 0.5;
float dy = $y - 0.5;
float far = hypot(dx, dy);
float pull = $scale * pick($explosion, 1.0 / (1.0 + $brightness * 4.0 * far), 1.0);
float rough = turbulence_row(dx * pull + $z, dy * pull + 0.7 * $z, 3.0, $octaves, $absolute, $seed) + $shift;
float r = far / $radius;
float ball = pick($explosion, exp(-r * r / 3.0), $brightness * max(0.0, 1.0 - r / 2.0));
$out = clamp(ball * (1.0 + $strength * rough) + pick($explosion, 0.35 * $strength * rough * exp(-r / 3.0), 0.0), 0.0, 1.0);
)",
                   {{"scale", scale},
                    {"explosion", explosion},
                    {"brightness", brightness},
                    {"z", z},
                    {"octaves", octaves},
                    {"absolute", absolute},
                    {"seed", seed},
                    {"shift", shift},
                    {"radius", radius * (1 + timing)},
                    {"strength", strength}});
      });
}

std::unique_ptr<Pattern> make_earthstar(TypeArguments& arguments) {
  const std::uint32_t seed = arguments.seed();
  return row_pattern(
      [seed](const PatternRow& row) {
        double terrain[k_row];
        turbulence_row(row.x, row.y, row.n, k_cells, 7, false, seed, terrain);
        for (int i = 0; i < row.n; ++i) {
          const double dx = row.x[i] - 0.5, dy = row.y[i] - 0.5, r = std::hypot(dx, dy) + 0.05 * terrain[i];
          const double turn = std::atan2(dy, dx) / (2 * k_pi) * 7, t = 1 - std::abs(2 * (turn - std::floor(turn)) - 1);
          row.out[i] = std::clamp(0.35 + 0.4 * terrain[i] + 0.6 * smooth01((0.18 + 0.3 * t - r) * 5), 0.0, 1.0);
        }
      },
      [seed](PatternShader& shader) {
        shader.add(R"(
float terrain = turbulence_row($x, $y, $cells, 7.0, false, $seed);
float dx = $x - 0.5;
float dy = $y - 0.5;
float r = hypot(dx, dy) + 0.05 * terrain;
float turn = atan2_of(dy, dx) / 6.283185307179586 * 7.0;
float t = 1.0 - abs(2.0 * (turn - floor(turn)) - 1.0);
$out = clamp(0.35 + 0.4 * terrain + 0.6 * smooth01((0.18 + 0.3 * t - r) * 5.0), 0.0, 1.0);
)",
                   {{"cells", k_cells}, {"seed", seed}});
      });
}

class Mandelbrot final : public Pattern {
 public:
  explicit Mandelbrot(TypeArguments& arguments)
      : most_(arguments.integer("max")),
        zoom_(arguments.number("zoom")),
        xp_(arguments.number("xp")),
        yp_(arguments.number("yp")),
        boundary_(arguments.number("boundary")),
        power_(arguments.number("power")),
        julia_(arguments.flag("julia")),
        rr_(arguments.number("rr")),
        ii_(arguments.number("ii")),
        paint_(arguments.integer("paintmode")) {
    if (arguments.flag("forceintegerpow")) power_ = std::round(power_);
  }

  void evaluate(const PatternRow& row) const override {
    for (int i = 0; i < row.n; ++i)
      row.out[i] = point(xp_ + (row.x[i] - 0.5) * 3 / zoom_ -
                             (julia_     ? 0
                              : xp_ == 0 ? 0.5
                                         : 0),
                         yp_ + (row.y[i] - 0.5) * 3 / zoom_);
  }

  void write_shader(PatternShader& shader) const override {
    const double shift = julia_ ? 0 : xp_ == 0 ? 0.5 : 0;
    shader.add(R"(
float px = $xp + ($x - 0.5) * $size;
float py = $yp + ($y - 0.5) * $size;
float cx = $cx;
float cy = $cy;
float zx = $zx;
float zy = $zy;
float steps = 0.0;
for (int k = 0; k < $most; ++k) {
if (zx * zx + zy * zy > $boundary) {
break;
}
float re = zx;
float im = zy;
)",
               {{"xp", xp_ - shift},
                {"yp", yp_},
                {"size", 3 / zoom_},
                {"cx", julia_ ? ShaderValue(rr_) : "px"},
                {"cy", julia_ ? ShaderValue(ii_) : "py"},
                {"zx", julia_ ? "px" : "0.0"},
                {"zy", julia_ ? "py" : "0.0"},
                {"most", most_},
                {"boundary", boundary_}});
    if (power_ == 2)
      shader.add("zx = re * re - im * im + cx;\nzy = 2.0 * re * im + cy;\n");
    else
      shader.add(R"(
float modulus = k_power(re * re + im * im, $half);
float angle = $power * atan2_of(im, re);
zx = modulus * k_cosine(angle) + cx;
zy = modulus * k_sine(angle) + cy;
)",
                 {{"half", power_ / 2}, {"power", power_}});
    shader.add("steps = steps + 1.0;\n}\nfloat size = zx * zx + zy * zy;\n");
    const ShaderValues values{{"most", static_cast<double>(most_)},
                              {"log_boundary", 1 / std::log(std::max(boundary_, 1.5))},
                              {"log_power", 1 / std::log(std::max(power_, 1.5))},
                              {"root", 0.5 / std::sqrt(std::max(boundary_, 1e-9))}};
    switch (paint_) {
      case 1:
        return shader.add(
            "$out = pick(steps == $most, 1.0, clamp((steps + 1.0 - log(max(log(max(size, 1.0000001)) * "
            "$log_boundary, 1.0e-9)) * $log_power) / $most, 0.0, 1.0));\n",
            values);
      case 2: return shader.add("$out = clamp(sqrt(size) * $root, 0.0, 1.0);\n", values);
      case 3: return shader.add("$out = atan2_of(zy, zx) / 6.283185307179586 + 0.5;\n");
      default: return shader.add("$out = steps / $most;\n", values);
    }
  }

 private:
  double point(double x, double y) const {
    std::complex<double> z = julia_ ? std::complex(x, y) : std::complex(0.0, 0.0);
    const std::complex<double> c = julia_ ? std::complex(rr_, ii_) : std::complex(x, y);
    int steps = 0;
    for (; steps < most_ && std::norm(z) <= boundary_; ++steps) {
      const double re = z.real(), im = z.imag();
      z = power_ == 2 ? std::complex(re * re - im * im, 2 * re * im) : std::pow(z, power_);
      z += c;
    }
    const double share = static_cast<double>(steps) / most_;
    switch (paint_) {
      case 1: {
        if (steps == most_) return 1;
        const double ratio = std::log(std::max(std::norm(z), 1.0 + 1e-9)) / std::log(std::max(boundary_, 1.5));
        return std::clamp((steps + 1 - std::log(std::max(ratio, 1e-9)) / std::log(std::max(power_, 1.5))) / most_, 0.0,
                          1.0);
      }
      case 2: return std::clamp(std::abs(z) / std::sqrt(std::max(boundary_, 1e-9)) / 2, 0.0, 1.0);
      case 3: return std::arg(z) / (2 * k_pi) + 0.5;
      default: return share;
    }
  }

  int most_;
  double zoom_, xp_, yp_, boundary_, power_;
  bool julia_;
  double rr_, ii_;
  int paint_;
};

std::unique_ptr<Pattern> make_led(TypeArguments& arguments) {
  const double width = arguments.number("digwidth"), height = arguments.number("digheight"),
               spacing = arguments.number("digspacing");
  const int decimals = arguments.integer("numdecimals"), digits = arguments.integer("numdigits");
  const Program number = arguments.formula("displaynumber");
  if (!number.constant) arguments.refuse("displaynumber", "the number must be the same at every point");
  double shown = number.value[0] * std::pow(10.0, arguments.number("exponent") + decimals);
  shown = std::clamp(std::round(std::abs(shown)), 0.0, 1e15);
  std::string places(static_cast<std::size_t>(digits), '0');
  for (int k = digits - 1; k >= 0; --k, shown = std::floor(shown / 10))
    places[static_cast<std::size_t>(k)] = static_cast<char>('0' + static_cast<int>(std::fmod(shown, 10)));
  // Segments a to g, bit 0 to 6: top, right, right, bottom, left, left, middle.
  static constexpr unsigned k_segments[10] = {0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07, 0x7F, 0x6F};
  return point_pattern(
      [=](const PatternRow& row, int i) {
        const double left = 0.5 - (digits - 1) * spacing / 2, x = (row.x[i] - left) / spacing + 0.5;
        const int place = static_cast<int>(std::clamp(std::floor(x), -1.0, 1000.0));
        if (place < 0 || place >= digits) return 0.0;
        const double px = (row.x[i] - left - place * spacing) / (width / 2), py = (row.y[i] - 0.5) / (height / 2);
        // Lengths in halves of a digit's width; segments end in points that meet at the corners.
        const double tall = height / width, reach = 0.94, thick = std::min(0.17, 0.17 * tall);
        const auto bar = [thick](double along, double off, double length) {
          return std::max(std::abs(along) + std::abs(off) - length, std::abs(off) - thick);
        };
        const double y = py * tall, upper = y + tall / 2, lower = y - tall / 2, side = reach * tall / 2;
        const double distances[7] = {bar(px, y + tall, reach), bar(upper, px - 1, side), bar(lower, px - 1, side),
                                     bar(px, y - tall, reach), bar(lower, px + 1, side), bar(upper, px + 1, side),
                                     bar(px, y, reach)};
        const unsigned lit = k_segments[places[static_cast<std::size_t>(place)] - '0'];
        double nearest = 1;
        for (int k = 0; k < 7; ++k)
          if (lit >> k & 1U) nearest = std::min(nearest, distances[k]);
        const double point = left + (digits - 0.5 - decimals) * spacing;
        if (decimals > 0)
          nearest = std::min(nearest, std::hypot((row.x[i] - point) / (width / 2), y - tall) - 1.2 * thick);
        return edge(-nearest, row.texel > 0 ? 2 * row.texel / width : 0);
      },
      [=](PatternShader& shader) {
        std::vector<ShaderValue> lit;
        for (const char digit : places) lit.emplace_back(k_segments[digit - '0']);
        shader.add_array("$tlit", "uint", lit);
        const double left = 0.5 - (digits - 1) * spacing / 2, tall = height / width, reach = 0.94;
        const double thick = std::min(0.17, 0.17 * tall);
        shader.add_function(
            "float $tbar(float along, float off, float length) {\nreturn max(abs(along) + abs(off) - length, "
            "abs(off) - $thick);\n}\n",
            {{"thick", thick}});
        shader.add(R"(
float place = clamp(floor(($x - $left) / $spacing + 0.5), -1.0, 1000.0);
$out = 0.0;
if (place >= 0.0 && place < $digits) {
float px = ($x - $left - place * $spacing) / $half_width;
float py = ($y - 0.5) / $half_height * $tall;
float upper = py + $half_tall;
float lower = py - $half_tall;
uint lit = $tlit[int(place)];
float nearest = 1.0;
nearest = min(nearest, pick((lit & 1u) != 0u, $tbar(px, py + $tall, $reach), 1.0));
nearest = min(nearest, pick((lit & 2u) != 0u, $tbar(upper, px - 1.0, $side), 1.0));
nearest = min(nearest, pick((lit & 4u) != 0u, $tbar(lower, px - 1.0, $side), 1.0));
nearest = min(nearest, pick((lit & 8u) != 0u, $tbar(px, py - $tall, $reach), 1.0));
nearest = min(nearest, pick((lit & 16u) != 0u, $tbar(lower, px + 1.0, $side), 1.0));
nearest = min(nearest, pick((lit & 32u) != 0u, $tbar(upper, px + 1.0, $side), 1.0));
nearest = min(nearest, pick((lit & 64u) != 0u, $tbar(px, py, $reach), 1.0));
if ($has_point) {
nearest = min(nearest, hypot(($x - $point) / $half_width, py - $tall) - $dot);
}
$out = edge(-nearest, $soft);
}
)",
                   {{"left", left},
                    {"spacing", spacing},
                    {"digits", static_cast<double>(digits)},
                    {"half_width", width / 2},
                    {"half_height", height / 2},
                    {"tall", tall},
                    {"half_tall", tall / 2},
                    {"reach", reach},
                    {"side", reach * tall / 2},
                    {"has_point", decimals > 0},
                    {"point", left + (digits - 0.5 - decimals) * spacing},
                    {"dot", 1.2 * thick},
                    {"soft", 2 * shader.texel / width}});
      });
}

/// The main value of the layers below.
std::unique_ptr<Pattern> make_lower(TypeArguments& arguments) {
  const std::string key = arguments.text("sdkey");
  return row_pattern(
      [key](const PatternRow& row) {
        const auto lower = [&](BlockRow r) { return row.block->rows[static_cast<std::size_t>(r)]; };
        std::fill_n(row.out, row.n, 0.0);
        const auto add = [&](BlockRow r, double share) {
          if (const double* values = lower(r))
            for (int i = 0; i < row.n; ++i) row.out[i] += share * values[i];
        };
        if (key == "hmbump" || key == "main")
          return add(key == "main" ? BlockRow::lower_main : BlockRow::lower_bump, 1);
        for (const BlockRow part : {BlockRow::lower_red, BlockRow::lower_green, BlockRow::lower_blue})
          add(part, 1.0 / 3);
      },
      [key](PatternShader& shader) {
        shader.add(key == "main"     ? "$out = g_lower.main;\n"
                   : key == "hmbump" ? "$out = g_lower.bump;\n"
                                     : "$out = (g_lower.red + g_lower.green + g_lower.blue) / 3.0;\n");
      });
}

}  // namespace

std::unique_ptr<Pattern> make_effect_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "wood") return make_wood(arguments);
  if (type == "marble") return make_marble(arguments);
  if (type == "smear") return make_smear(arguments);
  if (type == "sparkle") return make_sparkle(arguments);
  if (type == "flame") return make_flame(arguments);
  if (type == "tmp") return make_ball(arguments, false);
  if (type == "xplo") return make_ball(arguments, true);
  if (type == "earthstar") return make_earthstar(arguments);
  if (type == "mandelbrot") return std::make_unique<Mandelbrot>(arguments);
  if (type == "led") return make_led(arguments);
  if (type == "sd") return make_lower(arguments);
  return nullptr;
}

}  // namespace papilla::procedural_detail
