// SPDX-License-Identifier: MIT
#include "papilla/texture/frieze_group.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "bicubic.hpp"
#include "checks.hpp"
#include "circle_waves.hpp"
#include "papilla/texture/feature_matrix.hpp"

namespace papilla {
namespace {

using texture_detail::CircleWaves;

constexpr std::array<std::string_view, 7> k_names = {"p1", "p11g", "p1m1", "p2", "p2mg", "p11m", "p2mm"};

/// Correlation of the strip with itself by shift along x, 1 at 0.
std::vector<double> row_correlation(const GreyImage& strip) {
  const FeatureMatrix matrix = feature_matrix(strip);
  double mean = 0;
  for (int t = 1; t <= matrix.reach_x; ++t) mean += matrix.at(t, 0) / matrix.reach_x;
  std::vector<double> values;
  for (int t = 0; t <= matrix.reach_x; ++t) values.push_back(mean > 0 ? 1 - matrix.at(t, 0) / mean : 0);
  return values;
}

/// Vertex of the parabola through three neighbours of a peak.
double vertex(const std::vector<double>& values, std::size_t t) {
  const double before = values[t - 1], after = values[t + 1], bend = before - 2 * values[t] + after;
  return static_cast<double>(t) + (bend < 0 ? std::clamp((before - after) / (2 * bend), -0.5, 0.5) : 0);
}

/// The shortest shift that repeats nearly as well as the best one, fitted to its multiples.
std::optional<double> period(const std::vector<double>& correlation) {
  constexpr double k_least_correlation = 0.3, k_as_good = 0.9;
  std::vector<std::size_t> peaks;
  double best = 0;
  for (std::size_t t = 3; t + 1 < correlation.size(); ++t)
    if (correlation[t] >= correlation[t - 1] && correlation[t] > correlation[t + 1]) {
      peaks.push_back(t);
      best = std::max(best, correlation[t]);
    }
  if (best < k_least_correlation) return std::nullopt;
  const auto first =
      std::find_if(peaks.begin(), peaks.end(), [&](std::size_t t) { return correlation[t] >= k_as_good * best; });
  double length = vertex(correlation, *first), products = 0, squares = 0;
  for (const std::size_t t : peaks) {
    const double multiple = std::round(static_cast<double>(t) / length);
    const double exact = vertex(correlation, t);
    if (multiple < 1 || std::abs(exact - multiple * length) > 0.2 * length) continue;
    products += multiple * exact;
    squares += multiple * multiple;
    length = products / squares;
  }
  return length;
}

struct Cell {
  std::vector<CircleWaves> rows;  ///< One a row of the strip.
  double noise = 0;               ///< Expected |δF|² of one coefficient.
};

/// Mean over all periods, row by row.
Cell mean_cell(const GreyImage& strip, double period_px) {
  const int samples = std::max(8, static_cast<int>(std::lround(period_px)));
  Cell cell;
  double rest = 0;
  for (int y = 0; y < strip.height; ++y) {
    const auto at = [&](int x) { return static_cast<double>(strip.at(std::clamp(x, 0, strip.width - 1), y)); };
    const auto between = [&](double x) {
      const int left = static_cast<int>(std::floor(x));
      const std::array<double, 4> weights = texture_detail::catmull_rom(x - left);
      double sum = 0;
      for (int i = 0; i < 4; ++i) sum += weights[static_cast<std::size_t>(i)] * at(left + i - 1);
      return sum;
    };
    std::vector<double> mean;
    for (int i = 0; i < samples; ++i) {
      double sum = 0, squares = 0;
      int count = 0;
      for (double x = i * period_px / samples; x <= strip.width - 1; x += period_px) {
        const double value = between(x);
        sum += value;
        squares += value * value;
        ++count;
      }
      mean.push_back(sum / count);
      rest += std::max(0.0, squares / count - mean.back() * mean.back()) * count / std::max(1, count - 1);
    }
    cell.rows.emplace_back(mean);
  }
  const double variance = rest / (static_cast<double>(samples) * strip.height);
  cell.noise = variance / strip.width;
  return cell;
}

/// A group whose axis is half of rows_sum.
struct Candidate {
  FriezeGroup group;
  double kept, criterion, shift;  ///< shift: u → −u + shift for mirrors across, in periods.
  int rows_sum;                   ///< Twice the axis.
};

/// Sums over the rows of the window; `other(y)` is the row that y is compared with.
class Window {
 public:
  Window(const Cell& cell, int first, int last) : cell_(cell), first_(first), last_(last) {
    double mean = 0;
    for (int y = first; y <= last; ++y) mean += row(y).at(0).real() / (last - first + 1);
    mean_ = mean;
    for (int y = first; y <= last; ++y) {
      energy_ += std::pow(row(y).at(0).real() - mean, 2);
      for (int m = 1; m <= row(y).highest(); ++m) energy_ += 2 * std::norm(row(y).at(m));
      parameters_ += 2 * row(y).highest() + 1;
    }
  }
  double energy() const { return energy_; }
  double parameters() const { return parameters_; }

  /// ⟨f, f moved along by `shift` periods, turned over the axis⟩.
  double along(double shift, bool flipped) const {
    return sum(flipped, [&](std::complex<double> a, std::complex<double> b, int m) {
      return (std::conj(a) * b * std::polar(1.0, 2 * std::numbers::pi * m * shift)).real();
    });
  }
  /// The same with the direction along the strip reversed, u → −u + shift.
  double reversed(double shift, bool flipped) const {
    return sum(flipped, [&](std::complex<double> a, std::complex<double> b, int m) {
      return (a * b * std::polar(1.0, 2 * std::numbers::pi * m * shift)).real();
    });
  }

 private:
  const CircleWaves& row(int y) const { return cell_.rows[static_cast<std::size_t>(y)]; }
  template <typename Term>
  double sum(bool flipped, const Term& term) const {
    double total = 0;
    for (int y = first_; y <= last_; ++y) {
      const CircleWaves &a = row(y), &b = row(flipped ? first_ + last_ - y : y);
      total += (a.at(0).real() - mean_) * (b.at(0).real() - mean_);
      for (int m = 1; m <= a.highest(); ++m) total += 2 * term(a.at(m), b.at(m), m);
    }
    return total;
  }

  const Cell& cell_;
  int first_, last_;
  double mean_ = 0, energy_ = 0, parameters_ = 0;
};

/// The shift that maximises a periodic function of it.
template <typename Function>
std::pair<double, double> best_shift(const Function& value) {
  constexpr int k_steps = 64;
  double best = -1e300, at = 0;
  for (int i = 0; i < k_steps; ++i) {
    const double shift = static_cast<double>(i) / k_steps, now = value(shift);
    if (now <= best) continue;
    best = now;
    at = shift;
  }
  for (double step = 0.5 / k_steps; step > 1e-4; step /= 2)
    for (const double shift : {at - step, at + step})
      if (const double now = value(shift); now > best) {
        best = now;
        at = shift;
      }
  return {at, best};
}

std::vector<Candidate> candidates(const Cell& cell, int rows_sum) {
  const int rows = static_cast<int>(cell.rows.size());
  const int first = std::max(0, rows_sum - rows + 1), last = std::min(rows - 1, rows_sum);
  const Window window(cell, first, last);
  const double energy = window.energy(),
               noise = cell.noise + texture_detail::k_model_error * energy / window.parameters();
  std::vector<Candidate> list;
  const auto add = [&](FriezeGroup group, double kept, int order, double shift) {
    const double share = energy > 0 ? kept / energy : 1;
    const double criterion =
        energy > 0 ? (energy - kept) / noise + 2 * window.parameters() / order : 2 * window.parameters() / order;
    // The rows outside the window stay free parameters: windows of different heights compare by their mean.
    list.push_back({group, share, criterion / window.parameters(), shift, rows_sum});
  };
  const double flip = window.along(0, true), glide = window.along(0.5, true);
  const auto mirror = [&](double t) { return window.reversed(t, false); };
  const auto turn = [&](double t) { return window.reversed(t, true); };
  add(FriezeGroup::p1, energy, 1, 0);
  add(FriezeGroup::p11g, (energy + glide) / 2, 2, 0);
  add(FriezeGroup::p11m, (energy + flip) / 2, 2, 0);
  const auto [mirror_at, mirrored] = best_shift(mirror);
  add(FriezeGroup::p1m1, (energy + mirrored) / 2, 2, mirror_at);
  const auto [turn_at, turned] = best_shift(turn);
  add(FriezeGroup::p2, (energy + turned) / 2, 2, turn_at);
  const auto [mg_at, mg] = best_shift([&](double t) { return mirror(t) + turn(t + 0.5); });
  add(FriezeGroup::p2mg, (energy + glide + mg) / 4, 4, mg_at);
  const auto [mm_at, mm] = best_shift([&](double t) { return mirror(t) + turn(t); });
  add(FriezeGroup::p2mm, (energy + flip + mm) / 4, 4, mm_at);
  return list;
}

int order_of(FriezeGroup group) {
  if (group == FriezeGroup::p1) return 1;
  return group == FriezeGroup::p2mg || group == FriezeGroup::p2mm ? 4 : 2;
}

/// A rectangle that the group's images of it tile the strip with.
std::array<Vec2, 4> region(const FriezeSymmetry& s, int rows) {
  const double bottom = rows - 1;
  const bool half_height = s.group == FriezeGroup::p11m || s.group == FriezeGroup::p2mm || s.group == FriezeGroup::p11g;
  const double width = half_height && s.group != FriezeGroup::p2mm ? s.period_px
                       : s.group == FriezeGroup::p2mg              ? s.period_px / 4
                                                                   : s.period_px * (half_height ? 2 : 1) / s.order;
  const double top = half_height ? s.axis_y : 0;
  return {Vec2{s.origin_x, top}, Vec2{s.origin_x + width, top}, Vec2{s.origin_x + width, bottom},
          Vec2{s.origin_x, bottom}};
}

}  // namespace

std::string_view to_string(FriezeGroup group) noexcept { return k_names[static_cast<std::size_t>(group)]; }

FriezeSymmetry find_frieze_group(const GreyImage& strip) {
  texture_detail::require_image(strip, "find_frieze_group");
  FriezeSymmetry result;
  constexpr int k_least_width = 16, k_least_height = 4;
  if (strip.width < k_least_width || strip.height < k_least_height) {
    result.reason = "the strip is smaller than 16 x 4 pixels";
    return result;
  }
  const std::optional<double> length = period(row_correlation(strip));
  if (!length) {
    result.reason = "no shift along the strip repeats it";
    return result;
  }
  const Cell cell = mean_cell(strip, *length);
  const int middle = strip.height - 1, reach = std::max(1, strip.height / 4);
  std::optional<Candidate> best;
  for (int rows_sum = middle - reach; rows_sum <= middle + reach; ++rows_sum)
    for (const Candidate& candidate : candidates(cell, rows_sum)) {
      // Of equally good axes the middle one.
      const bool closer = best && candidate.criterion == best->criterion &&
                          std::abs(candidate.rows_sum - middle) < std::abs(best->rows_sum - middle);
      if (!best || candidate.criterion < best->criterion || closer) best = candidate;
    }
  result.found = true;
  result.group = best->group;
  result.order = order_of(best->group);
  result.period_px = *length;
  result.kept = std::clamp(best->kept, 0.0, 1.0);
  result.axis_y = best->rows_sum / 2.0;
  const double origin = best->shift / 2 * *length;
  result.origin_x = origin < 0 ? origin + *length : origin;
  result.region_px = region(result, strip.height);
  result.reason = "the strip repeats every " + std::to_string(*length) + " pixels";
  return result;
}

}  // namespace papilla
