// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "bicubic.hpp"
#include "checks.hpp"
#include "circle_waves.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/frieze_group.hpp"

namespace papilla {
namespace {

using texture_detail::CircleWaves;

constexpr int k_angles = 96;  // Holds the 12-fold turn and its double.
constexpr int k_most_rotations = 12;
constexpr double k_centre_reach = 0.15;  // Of the shorter side: largest distance of the search from the given centre.

/// The picture along circles, every circle counted by its length.
struct Circles {
  std::vector<CircleWaves> waves;
  std::vector<double> weights;
  std::vector<int> highest;  ///< Waves along the circle longer than 4 pixels.
  double energy = 0, parameters = 0;
  double noise = 0;  ///< Energy per parameter of pixel noise and interpolation errors.
};

/// Standard deviation of the noise of single pixels, from the median of |second difference of second differences|:
/// smooth motifs have small ones, and the median ignores edges [Immerkær 1996, with the median].
double pixel_noise(const GreyImage& motif) {
  std::vector<double> values;
  const auto second = [&](int x, int y) {
    return static_cast<double>(motif.at(x - 1, y)) - 2 * static_cast<double>(motif.at(x, y)) +
           static_cast<double>(motif.at(x + 1, y));
  };
  for (int y = 1; y + 1 < motif.height; ++y)
    for (int x = 1; x + 1 < motif.width; ++x)
      values.push_back(std::abs(second(x, y - 1) - 2 * second(x, y) + second(x, y + 1)));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  constexpr double k_gain = 6, k_median = 0.6745;  // Root of the squared coefficients; of |normal numbers|.
  return *middle / (k_gain * k_median);
}

Circles circles(const GreyImage& motif, Vec2 centre, double noise) {
  const double reach = std::min({centre.x, centre.y, motif.width - 1 - centre.x, motif.height - 1 - centre.y});
  const auto pixel = [&](int x, int y) {
    return motif.at(std::clamp(x, 0, motif.width - 1), std::clamp(y, 0, motif.height - 1));
  };
  Circles result;
  double noise_energy = 0;
  for (double r = 3; r <= reach; r += 2) {
    std::vector<double> samples;
    for (int i = 0; i < k_angles; ++i) {
      const double angle = 2 * std::numbers::pi * i / k_angles;
      samples.push_back(texture_detail::bicubic(centre.x + r * std::cos(angle), centre.y + r * std::sin(angle), pixel));
    }
    result.waves.emplace_back(samples);
    result.weights.push_back(r);
    const CircleWaves& waves = result.waves.back();
    result.highest.push_back(std::min(waves.highest(), static_cast<int>(std::numbers::pi * r / 2)));
    for (int m = 1; m <= result.highest.back(); ++m) result.energy += 2 * r * std::norm(waves.at(m));
    result.parameters += 2 * result.highest.back();
    const double independent = std::min(static_cast<double>(k_angles), 2 * std::numbers::pi * r);
    noise_energy += 2 * r * result.highest.back() * noise * noise / independent;
  }
  result.noise = std::max(noise_energy, texture_detail::k_model_error * result.energy) / result.parameters;
  return result;
}

/// The circles about every centre tried so far: the searches for different orders try the same ones.
class CircleTable {
 public:
  explicit CircleTable(const GreyImage& motif) : motif_(motif), noise_(pixel_noise(motif)) {}

  const Circles& about(Vec2 centre) {
    const auto [entry, is_new] = known_.try_emplace({centre.x, centre.y});
    if (is_new) entry->second = circles(motif_, centre, noise_);
    return entry->second;
  }

 private:
  const GreyImage& motif_;
  double noise_;
  std::map<std::pair<double, double>, Circles> known_;
};

/// Energy in the multiples of n.
double rotated(const Circles& c, int n) {
  double sum = 0;
  for (std::size_t i = 0; i < c.waves.size(); ++i)
    for (int m = n; m <= c.highest[i]; m += n) sum += 2 * c.weights[i] * std::norm(c.waves[i].at(m));
  return sum;
}

/// ⟨f, f mirrored about the direction φ⟩ over the multiples of n.
double mirrored(const Circles& c, int n, double direction) {
  double sum = 0;
  for (std::size_t i = 0; i < c.waves.size(); ++i)
    for (int m = n; m <= c.highest[i]; m += n) {
      const std::complex<double> value = c.waves[i].at(m);
      sum += 2 * c.weights[i] * (value * value * std::polar(1.0, 2.0 * m * direction)).real();
    }
  return sum;
}

struct Candidate {
  RosetteSymmetry symmetry;
  double criterion = 1e300;  ///< Per parameter: circles about different centres compare.
};

struct Mirror {
  double value = -1e300, direction = 0;
};

/// The best mirror line of the n-fold motif.
Mirror best_mirror(const Circles& c, int n) {
  constexpr int k_steps = 48;
  const double sector = std::numbers::pi / n;
  Mirror best;
  const auto consider = [&](double direction) {
    if (const double value = mirrored(c, n, direction); value > best.value) best = {value, direction};
  };
  for (int i = 0; i < k_steps; ++i) consider(sector * i / k_steps);
  for (double step = sector / k_steps / 2; step > 1e-4 * sector; step /= 2)
    for (const double side : {-step, step}) consider(best.direction + side);
  if (best.direction < 0) best.direction += sector;
  return best;
}

/// Cn or Dn, whichever suits the motif read about one centre better.
Candidate rated(const Circles& c, int n) {
  Candidate best;
  const auto consider = [&](bool mirrors, double kept, double direction) {
    const int order = mirrors ? 2 * n : n;
    const double criterion = ((c.energy - kept) / c.noise + 2 * c.parameters / order) / c.parameters;
    if (criterion >= best.criterion) return;
    best.criterion = criterion;
    best.symmetry = {n,
                     mirrors,
                     std::clamp(kept / c.energy, 0.0, 1.0),
                     {},
                     mirrors ? direction * 180 / std::numbers::pi : 0,
                     360.0 / order};
  };
  const double kept = rotated(c, n);
  consider(false, kept, 0);
  const Mirror mirror = best_mirror(c, n);
  consider(true, (kept + mirror.value) / 2, mirror.direction);
  return best;
}

/// Share of the motif that the n-fold turn about a centre keeps; for n = 1 what the best mirror does.
double turned(const Circles& c, int n) {
  if (!(c.energy > 0)) return 0;
  return (n == 1 ? best_mirror(c, 1).value : rotated(c, n)) / c.energy;
}

}  // namespace

RosetteSymmetry find_rosette_group(const GreyImage& motif, Vec2 centre_px) {
  constexpr int k_least_side = 16, k_least_reach = 6;
  texture_detail::require_image(motif, "find_rosette_group", k_least_side);
  const auto inside = [&](Vec2 c) {
    return c.x >= k_least_reach && c.y >= k_least_reach && c.x <= motif.width - 1 - k_least_reach &&
           c.y <= motif.height - 1 - k_least_reach;
  };
  if (!is_finite(centre_px) || !inside(centre_px))
    throw InvalidInput("find_rosette_group: the centre (" + std::to_string(centre_px.x) + ", " +
                       std::to_string(centre_px.y) + ") is not within the picture, 6 pixels off its border");
  CircleTable table(motif);
  const double reach = std::min(motif.width, motif.height) * k_centre_reach;
  const Circles& start = table.about(centre_px);
  Candidate best;
  best.symmetry.centre_px = centre_px;
  if (!(start.energy > 0)) return best.symmetry;
  std::array<Vec2, k_most_rotations + 1> centres;
  for (int n = 1; n <= k_most_rotations; ++n) {
    // An n-fold centre is also a centre for every divisor of n, and those searches converge from further away.
    Vec2 centre = centre_px;
    double most = turned(start, n);
    for (int divisor = 2; divisor < n; ++divisor) {
      if (n % divisor != 0) continue;
      const Vec2 other = centres[static_cast<std::size_t>(divisor)];
      if (const double now = turned(table.about(other), n); now > most) {
        most = now;
        centre = other;
      }
    }
    for (double step = std::min(motif.width, motif.height) / 20.0; step > 0.05;) {
      bool moved = false;
      for (const Vec2 direction : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}}) {
        const Vec2 trial = centre + step * direction;
        const double now = inside(trial) && norm(trial - centre_px) <= reach ? turned(table.about(trial), n) : 0;
        if (now <= most) continue;
        most = now;
        centre = trial;
        moved = true;
      }
      if (!moved) step /= 2;
    }
    centres[static_cast<std::size_t>(n)] = centre;
    Candidate candidate = rated(table.about(centre), n);
    if (candidate.criterion >= best.criterion) continue;
    best = candidate;
    best.symmetry.centre_px = centre;
  }
  return best.symmetry;
}

}  // namespace papilla
