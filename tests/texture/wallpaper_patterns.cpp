// SPDX-License-Identifier: MIT
#include "texture/wallpaper_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace papilla::test {
namespace {

/// (x, y) → (a x + b y + s, c x + d y + t) in the conventional cell.
struct Operation {
  int a, b, c, d;
  double s, t;
};

/// The coordinates of general positions in the International Tables for Crystallography, volume A, chapter 2.2.
std::vector<Operation> operations(WallpaperGroup group) {
  using enum WallpaperGroup;
  const Operation one{1, 0, 0, 1, 0, 0}, two{-1, 0, 0, -1, 0, 0};
  const auto centred = [](std::vector<Operation> list) {
    const std::size_t count = list.size();
    for (std::size_t i = 0; i < count; ++i) {
      Operation moved = list[i];
      moved.s += 0.5;
      moved.t += 0.5;
      list.push_back(moved);
    }
    return list;
  };
  const std::vector<Operation> four = {one, two, {0, -1, 1, 0, 0, 0}, {0, 1, -1, 0, 0, 0}};
  const std::vector<Operation> three = {one, {0, -1, 1, -1, 0, 0}, {-1, 1, -1, 0, 0, 0}};
  const std::vector<Operation> six = {one, {0, -1, 1, -1, 0, 0}, {-1, 1, -1, 0, 0, 0},
                                      two, {0, 1, -1, 1, 0, 0},  {1, -1, 1, 0, 0, 0}};
  const std::vector<Operation> across = {{0, -1, -1, 0, 0, 0}, {-1, 1, 0, 1, 0, 0}, {1, 0, 1, -1, 0, 0}};
  const std::vector<Operation> along = {{0, 1, 1, 0, 0, 0}, {1, -1, 0, -1, 0, 0}, {-1, 0, -1, 1, 0, 0}};
  const auto joined = [](std::vector<Operation> list, const std::vector<Operation>& more) {
    list.insert(list.end(), more.begin(), more.end());
    return list;
  };
  switch (group) {
    case p1: return {one};
    case p2: return {one, two};
    case pm: return {one, {-1, 0, 0, 1, 0, 0}};
    case pg: return {one, {-1, 0, 0, 1, 0, 0.5}};
    case cm: return centred({one, {-1, 0, 0, 1, 0, 0}});
    case pmm: return {one, two, {-1, 0, 0, 1, 0, 0}, {1, 0, 0, -1, 0, 0}};
    case pmg: return {one, two, {-1, 0, 0, 1, 0.5, 0}, {1, 0, 0, -1, 0.5, 0}};
    case pgg: return {one, two, {-1, 0, 0, 1, 0.5, 0.5}, {1, 0, 0, -1, 0.5, 0.5}};
    case cmm: return centred({one, two, {-1, 0, 0, 1, 0, 0}, {1, 0, 0, -1, 0, 0}});
    case p4: return four;
    case p4m: return joined(four, {{-1, 0, 0, 1, 0, 0}, {1, 0, 0, -1, 0, 0}, {0, 1, 1, 0, 0, 0}, {0, -1, -1, 0, 0, 0}});
    case p4g:
      return joined(
          four, {{-1, 0, 0, 1, 0.5, 0.5}, {1, 0, 0, -1, 0.5, 0.5}, {0, 1, 1, 0, 0.5, 0.5}, {0, -1, -1, 0, 0.5, 0.5}});
    case p3: return three;
    case p3m1: return joined(three, across);
    case p31m: return joined(three, along);
    case p6: return six;
    case p6m: return joined(joined(six, across), along);
  }
  return {};
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }

 private:
  std::mt19937_64 engine_;
};

/// Sides and angle of the conventional cell that the group asks for.
std::array<Vec2, 2> conventional_cell(WallpaperGroup group, bool oblique, Random& random) {
  const double length = 22 + 22 * random.uniform();
  double ratio = 1.05 + 0.45 * random.uniform(), angle = 90;
  switch (group) {
    case WallpaperGroup::p1:
    case WallpaperGroup::p2:
      if (oblique) angle = 62 + 56 * random.uniform();
      break;
    case WallpaperGroup::p4:
    case WallpaperGroup::p4m:
    case WallpaperGroup::p4g: ratio = 1; break;
    case WallpaperGroup::p3:
    case WallpaperGroup::p3m1:
    case WallpaperGroup::p31m:
    case WallpaperGroup::p6:
    case WallpaperGroup::p6m:
      ratio = 1;
      angle = 120;
      break;
    default: break;
  }
  const double turn = 2 * std::numbers::pi * random.uniform(), corner = angle * std::numbers::pi / 180;
  const double other = length * ratio;
  return {Vec2{length * std::cos(turn), length * std::sin(turn)},
          Vec2{other * std::cos(turn + corner), other * std::sin(turn + corner)}};
}

using Waves = std::map<std::array<int, 2>, std::complex<double>>;

/// Coefficients of exp(2πi (m u + n v)), symmetric under the group.
Waves symmetric_waves(const std::vector<Operation>& group, const std::array<Vec2, 2>& cell, Random& random) {
  constexpr int k_most = 5;
  const double area = cross(cell[0], cell[1]), scale = std::sqrt(std::abs(area));
  Waves drawn, waves;
  for (int n = -k_most; n <= k_most; ++n)
    for (int m = -k_most; m <= k_most; ++m) {
      if (n < 0 || (n == 0 && m <= 0)) continue;
      const Vec2 k{(m * cell[1].y - n * cell[0].y) / area, (n * cell[0].x - m * cell[1].x) / area};
      const double order = norm(k) * scale;
      if (order > 4.2) continue;
      const std::complex<double> value =
          std::exp(-0.1 * order * order) * std::complex(random.normal(), random.normal());
      drawn[{m, n}] = value;
      drawn[{-m, -n}] = std::conj(value);
    }
  for (const auto& [k, value] : drawn)
    for (const Operation& op : group) {
      // exp(2πi k·(A x + t)) is the wave Aᵀk.
      const std::array<int, 2> image = {op.a * k[0] + op.c * k[1], op.b * k[0] + op.d * k[1]};
      waves[image] += value * std::polar(1.0, 2 * std::numbers::pi * (k[0] * op.s + k[1] * op.t));
    }
  double power = 0;
  for (const auto& [k, value] : waves) power += std::norm(value);
  for (auto& [k, value] : waves) value /= std::sqrt(power);
  for (auto it = waves.begin(); it != waves.end();)
    it = std::norm(it->second) < 1e-20 ? waves.erase(it) : std::next(it);
  return waves;
}

/// Share of the power that a translation by (u, v) does not keep.
double translation_gap(const Waves& waves, double u, double v) {
  double kept = 0;
  for (const auto& [k, value] : waves)
    kept += std::norm(value) * std::cos(2 * std::numbers::pi * (k[0] * u + k[1] * v));
  return (1 - kept) / 2;
}

/// Share that the best translation of a further operation leaves.
double operation_gap(const Waves& waves, const Operation& op) {
  constexpr int k_steps = 24;
  double best = -1;
  for (int j = 0; j < k_steps; ++j)
    for (int i = 0; i < k_steps; ++i) {
      double kept = 0;
      for (const auto& [k, value] : waves) {
        const auto image = waves.find({op.a * k[0] + op.c * k[1], op.b * k[0] + op.d * k[1]});
        if (image == waves.end()) continue;
        const double phase = 2 * std::numbers::pi * (k[0] * i + k[1] * j) / k_steps;
        kept += (std::conj(image->second) * value * std::polar(1.0, phase)).real();
      }
      best = std::max(best, kept);
    }
  return (1 - best) / 2;
}

/// True when the pattern nearly has a symmetry beyond its group.
bool is_ambiguous(const Waves& waves, const std::vector<Operation>& group, WallpaperGroup name) {
  constexpr double k_least_gap = 0.06;
  for (const int p : {2, 3, 5})
    for (int j = 0; j < p; ++j)
      for (int i = 0; i < p; ++i) {
        const double u = static_cast<double>(i) / p, v = static_cast<double>(j) / p;
        const bool own = (i == 0 && j == 0) || std::any_of(group.begin(), group.end(), [&](const Operation& op) {
                           return op.a == 1 && op.b == 0 && op.c == 0 && op.d == 1 && op.s == u && op.t == v;
                         });
        if (!own && translation_gap(waves, u, v) < k_least_gap) return true;
      }
  using enum WallpaperGroup;
  const bool hexagonal = name == p3 || name == p3m1 || name == p31m || name == p6 || name == p6m;
  for (const Operation& op : operations(hexagonal ? p6m : p4m)) {
    const bool own = std::any_of(group.begin(), group.end(), [&](const Operation& other) {
      return op.a == other.a && op.b == other.b && op.c == other.c && op.d == other.d;
    });
    if (!own && operation_gap(waves, op) < k_least_gap) return true;
  }
  return false;
}

std::size_t at(int x, int y, int side) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
}

/// Gaussian blur of a square field; the borders repeat their last value.
void blur(std::vector<double>& field, int side, double deviation) {
  const int reach = static_cast<int>(std::ceil(3.5 * deviation));
  std::vector<double> kernel;
  for (int k = -reach; k <= reach; ++k) kernel.push_back(std::exp(-k * k / (2 * deviation * deviation)));
  double sum = 0;
  for (const double value : kernel) sum += value;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<double> turned(field.size());
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        double value = 0;
        for (int k = -reach; k <= reach; ++k)
          value += kernel[static_cast<std::size_t>(k + reach)] * field[at(std::clamp(x + k, 0, side - 1), y, side)];
        turned[at(y, x, side)] = value / sum;
      }
    field = std::move(turned);
  }
}

/// A random smooth field of rms 1 whose correlation is exp(−r² / (2 length²)).
std::vector<double> smooth_field(int side, double length, Random& random) {
  // Blurred white noise, drawn on a larger square so that the borders have the statistics of the middle.
  const double deviation = length / std::numbers::sqrt2;
  const int rim = static_cast<int>(std::ceil(3.5 * deviation)), whole = side + 2 * rim;
  std::vector<double> noise(static_cast<std::size_t>(whole) * static_cast<std::size_t>(whole)), field;
  for (double& value : noise) value = random.normal();
  blur(noise, whole, deviation);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) field.push_back(noise[at(x + rim, y + rim, whole)]);
  double mean = 0, squares = 0;
  for (const double value : field) mean += value / static_cast<double>(field.size());
  for (const double value : field) squares += (value - mean) * (value - mean) / static_cast<double>(field.size());
  for (double& value : field) value = (value - mean) / std::sqrt(squares);
  return field;
}

/// What the 8 × 8 cosine transform loses when its coefficients are rounded as baseline JPEG does with the table of its
/// annex K scaled to `quality`.
void quantize_blocks(std::vector<double>& grey, int side, int quality) {
  static constexpr std::array<int, 64> k_table = {
      16, 11,  10,  16, 24, 40, 51, 61, 12,  12,  14,  19,  26, 58, 60, 55,  14,  13,  16,  24, 40, 57,
      69, 56,  14,  17, 22, 29, 51, 87, 80,  62,  18,  22,  37, 56, 68, 109, 103, 77,  24,  35, 55, 64,
      81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98,  112, 100, 103, 99};
  const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  const auto wave = [](int k, int i) {
    return std::cos((2 * i + 1) * k * std::numbers::pi / 16) * (k == 0 ? std::sqrt(0.125) : 0.5);
  };
  std::array<double, 64> waves{};
  for (int k = 0; k < 8; ++k)
    for (int i = 0; i < 8; ++i) waves[at(i, k, 8)] = wave(k, i);
  for (int top = 0; top < side; top += 8)
    for (int left = 0; left < side; left += 8) {
      std::array<double, 64> block{}, half{}, coefficients{};
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
          block[at(x, y, 8)] = grey[at(std::min(left + x, side - 1), std::min(top + y, side - 1), side)] - 128;
      for (int y = 0; y < 8; ++y)
        for (int k = 0; k < 8; ++k)
          for (int i = 0; i < 8; ++i) half[at(k, y, 8)] += waves[at(i, k, 8)] * block[at(i, y, 8)];
      for (int n = 0; n < 8; ++n)
        for (int k = 0; k < 8; ++k) {
          double& value = coefficients[at(k, n, 8)];
          for (int i = 0; i < 8; ++i) value += waves[at(i, n, 8)] * half[at(k, i, 8)];
          const int step = std::clamp((k_table[at(k, n, 8)] * scale + 50) / 100, 1, 255);
          value = step * std::round(value / step);
        }
      half = {};
      for (int n = 0; n < 8; ++n)
        for (int x = 0; x < 8; ++x)
          for (int k = 0; k < 8; ++k) half[at(x, n, 8)] += waves[at(x, k, 8)] * coefficients[at(k, n, 8)];
      for (int y = top; y < std::min(side, top + 8); ++y)
        for (int x = left; x < std::min(side, left + 8); ++x) {
          double value = 0;
          for (int n = 0; n < 8; ++n) value += waves[at(y - top, n, 8)] * half[at(x - left, n, 8)];
          grey[at(x, y, side)] = std::clamp(128 + value, 0.0, 255.0);
        }
    }
}

Vec2 wave_vector(const std::array<int, 2>& k, const std::array<Vec2, 2>& cell) {
  const double area = cross(cell[0], cell[1]);
  return {(k[0] * cell[1].y - k[1] * cell[0].y) / area, (k[1] * cell[0].x - k[0] * cell[1].x) / area};
}

GreyImage drawn(const Waves& waves, const std::array<Vec2, 2>& cell, int side, double noise, Random& random) {
  const Vec2 origin{40 * random.uniform(), 40 * random.uniform()};
  std::vector<double> signal(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
  for (const auto& [k, value] : waves) {
    if (k[1] < 0 || (k[1] == 0 && k[0] < 0)) continue;  // Each wave once, with its conjugate.
    const Vec2 wave = wave_vector(k, cell);
    const std::complex<double> step = std::polar(1.0, 2 * std::numbers::pi * wave.x);
    for (int y = 0; y < side; ++y) {
      std::complex<double> now =
          2.0 * value * std::polar(1.0, 2 * std::numbers::pi * (wave.y * (y - origin.y) - wave.x * origin.x));
      double* row = signal.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(side);
      for (int x = 0; x < side; ++x) {
        row[x] += now.real();
        now *= step;
      }
    }
  }
  GreyImage image{side, side, {}, 0, 8};
  const double contrast = 40 / std::sqrt(1 + noise * noise);
  for (const double value : signal) {
    const double grey = 128 + contrast * (value + (noise > 0 ? noise * random.normal() : 0));
    image.pixels.push_back(static_cast<float>(std::round(std::clamp(grey, 0.0, 255.0)) / 255));
  }
  return image;
}

/// The vectors of the mean cell of the picture whose point x shows the pattern's point x + scale · (across, down)(x):
/// the linear part of the displacement is theirs.
std::array<Vec2, 2> mean_cell(const std::array<Vec2, 2>& cell, int side, const std::vector<double>& across,
                              const std::vector<double>& down, double scale) {
  const double middle = (side - 1) / 2.0;
  double xx = 0;
  std::array<Vec2, 2> slopes{};  // Change of the displacement along x and along y.
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Vec2 u = scale * Vec2{across[at(x, y, side)], down[at(x, y, side)]};
      xx += (x - middle) * (x - middle);
      slopes[0] = slopes[0] + (x - middle) * u;
      slopes[1] = slopes[1] + (y - middle) * u;
    }
  const Vec2 p = Vec2{1, 0} + (1 / xx) * slopes[0], q = Vec2{0, 1} + (1 / xx) * slopes[1];
  const double determinant = cross(p, q);
  const auto undone = [&](Vec2 v) { return Vec2{cross(v, q) / determinant, cross(p, v) / determinant}; };
  return {undone(cell[0]), undone(cell[1])};
}

GreyImage photographed(const Waves& waves, std::array<Vec2, 2>& cell, int side, const PhotoConditions& photo,
                       Random& random) {
  const double length = std::sqrt(std::abs(cross(cell[0], cell[1])));
  const Vec2 origin{40 * random.uniform(), 40 * random.uniform()};
  const std::vector<double> across = smooth_field(side, photo.warp_length * length, random),
                            down = smooth_field(side, photo.warp_length * length, random);
  const double turn = 2 * std::numbers::pi * random.uniform();
  const bool radial = random.uniform() < 0.5;
  std::vector<double> grey(across.size());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const std::size_t i = at(x, y, side);
      const Vec2 p = Vec2{static_cast<double>(x), static_cast<double>(y)} - origin +
                     (photo.warp * length) * Vec2{across[i], down[i]};
      double signal = 0;
      for (const auto& [k, value] : waves) {
        if (k[1] < 0 || (k[1] == 0 && k[0] < 0)) continue;
        signal += 2 * (value * std::polar(1.0, 2 * std::numbers::pi * dot(wave_vector(k, cell), p))).real();
      }
      // Light falls off along a line or from a point near a corner to the far one: 0 to 1.
      const double u = 2.0 * x / (side - 1) - 1, v = 2.0 * y / (side - 1) - 1;
      const double along = (u * std::cos(turn) + v * std::sin(turn)) / std::numbers::sqrt2;
      const double fall =
          radial ? std::min(1.0, (std::pow(u - 0.5 * std::cos(turn), 2) + std::pow(v - 0.5 * std::sin(turn), 2)) / 3.6)
                 : 0.5 + 0.5 * along;
      grey[i] = (140 + 40 * signal) * (1 - photo.falloff * fall);
    }
  blur(grey, side, photo.blur_px);
  for (double& value : grey) value = std::clamp(std::round(value + 255 * photo.noise * random.normal()), 0.0, 255.0);
  quantize_blocks(grey, side, photo.quality);
  GreyImage image{side, side, {}, 0, 8};
  for (const double value : grey) image.pixels.push_back(static_cast<float>(std::round(value) / 255));
  cell = mean_cell(cell, side, across, down, photo.warp * length);
  return image;
}

}  // namespace

namespace {

template <class Draw>
WallpaperPattern drawn_pattern(WallpaperGroup group, std::uint64_t seed, const Draw& draw) {
  Random random(seed * 17 + static_cast<std::uint64_t>(group));
  const std::vector<Operation> list = operations(group);
  for (;;) {
    std::array<Vec2, 2> cell = conventional_cell(group, seed % 2 == 0, random);
    const Waves waves = symmetric_waves(list, cell, random);
    if (is_ambiguous(waves, list, group)) continue;
    WallpaperPattern pattern;
    pattern.group = group;
    pattern.image = draw(waves, cell, random);
    pattern.a = cell[0];
    pattern.b = cell[1];
    if (group == WallpaperGroup::cm || group == WallpaperGroup::cmm) {
      pattern.a = 0.5 * (cell[0] + cell[1]);
      pattern.b = 0.5 * (cell[1] - cell[0]);
    }
    return pattern;
  }
}

}  // namespace

WallpaperPattern wallpaper_pattern(WallpaperGroup group, std::uint64_t seed, double noise, int side) {
  return drawn_pattern(group, seed, [=](const Waves& waves, const std::array<Vec2, 2>& cell, Random& random) {
    return drawn(waves, cell, side, noise, random);
  });
}

WallpaperPattern photographed_pattern(WallpaperGroup group, std::uint64_t seed, const PhotoConditions& photo,
                                      int side) {
  return drawn_pattern(group, seed, [&](const Waves& waves, std::array<Vec2, 2>& cell, Random& random) {
    return photographed(waves, cell, side, photo, random);
  });
}

double lattice_error(const std::array<Vec2, 2>& found, Vec2 a, Vec2 b) {
  const double area = cross(a, b);
  std::array<Vec2, 2> whole;
  double worst = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    whole[i] = {std::round(cross(found[i], b) / area), std::round(cross(a, found[i]) / area)};
    worst = std::max(worst, norm(whole[i].x * a + whole[i].y * b - found[i]));
  }
  return std::abs(cross(whole[0], whole[1])) == 1 ? worst : 1e9;
}

}  // namespace papilla::test
