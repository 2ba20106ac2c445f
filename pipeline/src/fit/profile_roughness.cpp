// SPDX-License-Identifier: MIT
#include "fit/profile_roughness.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <span>

namespace papilla {
namespace {

constexpr double k_longest_m = 0.02;        // Longer waves are form, and the length of a probe's usual way.
constexpr std::size_t k_least_windows = 4;  // For an interval.
constexpr std::size_t k_least_points = 32;  // Of a window: a wave in it has eight.
constexpr int k_least_lags = 4;             // Three octaves of a power law.
constexpr double k_most_bend = 0.1;         // Decades that a power law may be off.

/// Heights at equal steps along a window, without their parabola.
struct Window {
  std::vector<double> heights;
  double step_m = 0;
};

Window window_of(std::span<const ProfilePoint> points) {
  Vec3 normal;
  for (const ProfilePoint& point : points) normal = normal + point.normal;
  normal = normalized(normal);
  const auto height = [&](std::size_t i) { return dot(normal, points[i].place_m - points.front().place_m); };
  Window window;
  const std::size_t count = points.size();
  window.step_m = (points.back().way_m - points.front().way_m) / static_cast<double>(count - 1);
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = points.front().way_m + static_cast<double>(k) * window.step_m;
    while (i + 2 < count && points[i + 1].way_m < at) ++i;
    const double share = std::clamp((at - points[i].way_m) / (points[i + 1].way_m - points[i].way_m), 0.0, 1.0);
    window.heights.push_back((1 - share) * height(i) + share * height(i + 1));
  }
  const auto rows = static_cast<Eigen::Index>(count);
  Eigen::MatrixX3d parabola(rows, 3);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const double x = 2.0 * static_cast<double>(r) / static_cast<double>(rows - 1) - 1;
    parabola.row(r) << 1, x, x * x;
  }
  Eigen::Map<Eigen::VectorXd> heights(window.heights.data(), rows);
  heights -= parabola * parabola.householderQr().solve(heights).eval();
  return window;
}

/// Windows of that length of all runs, those with few points left out.
std::vector<Window> windows_of(const std::vector<std::vector<ProfilePoint>>& runs, double length_m) {
  std::vector<Window> windows;
  for (const auto& run : runs)
    for (std::size_t begin = 0, end = 0; begin < run.size(); begin = end) {
      while (end < run.size() && run[end].way_m - run[begin].way_m < length_m) ++end;
      if (end == run.size()) break;
      if (end - begin >= k_least_points) windows.push_back(window_of({run.data() + begin, end - begin}));
    }
  return windows;
}

/// Mean with half of its 95 % interval (Student).
struct Mean {
  double value = 0, half = 0;
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean mean;
  for (const double value : values) mean.value += value / n;
  double squares = 0;
  for (const double value : values) squares += (value - mean.value) * (value - mean.value);
  const boost::math::students_t student(n - 1);
  mean.half = boost::math::quantile(boost::math::complement(student, 0.025)) * std::sqrt(squares / (n - 1) / n);
  return mean;
}

/// Mean square second difference of a window over that lag, less its noise.
double second_difference(const Window& window, std::size_t lag, double noise_m) {
  double sum = 0;
  const std::size_t count = window.heights.size() - 2 * lag;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = window.heights[i] - 2 * window.heights[i + lag] + window.heights[i + 2 * lag];
    sum += d * d;
  }
  return sum / static_cast<double>(count) - 6 * noise_m * noise_m;
}

struct Line {
  double slope = 0, worst = 0;
};

Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto rows = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixX2d design(rows, 2);
  design.col(0).setOnes();
  design.col(1) = Eigen::Map<const Eigen::VectorXd>(x.data(), rows);
  const Eigen::Map<const Eigen::VectorXd> values(y.data(), rows);
  const Eigen::Vector2d line = design.householderQr().solve(values);
  return {line[1], (values - design * line).cwiseAbs().maxCoeff()};
}

/// H by the mean slope over the windows, or why there is none.
std::optional<FittedNumber> hurst_of(const std::vector<Window>& windows, double noise_m, std::string& reason) {
  std::size_t shortest = windows.front().heights.size();
  for (const Window& window : windows) shortest = std::min(shortest, window.heights.size());
  std::vector<std::size_t> lags;
  std::vector<double> log_lags, logs;
  for (std::size_t lag = 2; 8 * lag <= shortest; lag *= 2) {  // Over one step, interpolation smooths.
    double mean = 0, step = 0;
    for (const Window& window : windows) {
      mean += second_difference(window, lag, noise_m) / static_cast<double>(windows.size());
      step += window.step_m / static_cast<double>(windows.size());
    }
    if (!(mean > 6 * noise_m * noise_m)) continue;  // Half of it is noise.
    lags.push_back(lag);
    log_lags.push_back(std::log10(static_cast<double>(lag) * step));
    logs.push_back(0.5 * std::log10(mean));
  }
  if (static_cast<int>(lags.size()) < k_least_lags) {
    reason = "fewer than three octaves of waves are above the noise of the force";
    return std::nullopt;
  }
  if (const Line pooled = line_through(log_lags, logs); pooled.worst > k_most_bend) {
    reason = fmt::format("no power law: the differences of height are off one by {:.2g} decades", pooled.worst);
    return std::nullopt;
  }
  std::vector<double> slopes;
  for (const Window& window : windows) {
    std::vector<double> own;
    for (const std::size_t lag : lags) own.push_back(0.5 * std::log10(second_difference(window, lag, noise_m)));
    if (std::all_of(own.begin(), own.end(), [](double value) { return std::isfinite(value); }))
      slopes.push_back(line_through(log_lags, own).slope);
  }
  if (slopes.size() < k_least_windows) {
    reason = "too few pieces of the way are above the noise of the force";
    return std::nullopt;
  }
  const Mean mean = mean_of(slopes);
  if (!(mean.value > 0 && mean.value < 1)) {
    reason =
        fmt::format("no rough surface: its differences of height grow with the lag to the power of {:.2f}", mean.value);
    return std::nullopt;
  }
  return FittedNumber{mean.value, std::max(0.0, mean.value - mean.half), std::min(1.0, mean.value + mean.half)};
}

}  // namespace

ProfileRoughness profile_roughness(const std::vector<std::vector<ProfilePoint>>& runs, double noise_m) {
  ProfileRoughness result;
  double way = 0, longest = 0;
  for (const auto& run : runs) {
    const double length = run.size() > 1 ? run.back().way_m - run.front().way_m : 0;
    way += length;
    longest = std::max(longest, length);
  }
  const double length = std::min({k_longest_m, way / static_cast<double>(k_least_windows + 1), longest / 2});
  const std::vector<Window> windows = windows_of(runs, length);
  result.no_hurst = "there is no roughness";
  if (windows.size() < k_least_windows) {
    result.no_roughness = fmt::format("the probe slid straight on for {:.3g} mm in too few samples", 1e3 * way);
    return result;
  }
  std::vector<double> squares;
  double step = 0;
  for (const Window& window : windows) {
    double sum = 0;
    for (const double height : window.heights) sum += height * height;
    squares.push_back(sum / static_cast<double>(window.heights.size() - 3) - noise_m * noise_m);
    step = std::max(step, window.step_m);
  }
  const Mean mean = mean_of(squares);
  if (!(mean.value - mean.half > noise_m * noise_m)) {
    result.no_roughness =
        fmt::format("the heights differ by no more than the noise of the force, {:.3g} µm", 1e6 * noise_m);
    return result;
  }
  FittedRoughness roughness;
  roughness.rms_m = {std::sqrt(mean.value), std::sqrt(mean.value - mean.half), std::sqrt(mean.value + mean.half)};
  roughness.shortest_wave_m = 2 * step;
  roughness.longest_wave_m = length;
  result.no_hurst.clear();
  roughness.hurst = hurst_of(windows, noise_m, result.no_hurst);
  result.roughness = roughness;
  return result;
}

}  // namespace papilla
