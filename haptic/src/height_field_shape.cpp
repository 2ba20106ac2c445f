// SPDX-License-Identifier: MIT
// What is done to a relief once, when it is loaded; sampling it in the tick is in height_field.cpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "papilla/core/error.hpp"
#include "papilla/haptic/height_field.hpp"
#include "texels.hpp"

namespace papilla {
namespace {

/// Envelope of parabolas of apex radius R over the samples of a line.
class Envelope {
 public:
  Envelope(double pitch_m, double radius_m, double reach_m, int samples)
      : bend_(pitch_m * pitch_m / (2 * radius_m)),
        margin_(std::min(static_cast<long>(reach_m / pitch_m) + 1, long{2} * samples)),
        samples_(samples) {}

  /// Replaces h(a) by min over b of h(b) + (a − b)²·pitch²/2R, b beyond the ends by `wrap`.
  void lower(double* line, long stride, Wrap wrap) const {
    const long n = samples_ + 2 * margin_;
    std::vector<double> h(static_cast<std::size_t>(n));
    for (long i = 0; i < n; ++i) h[static_cast<std::size_t>(i)] = line[stride * wrapped(i - margin_, samples_, wrap)];
    // The parabolas that are lowest somewhere, and from where on each is.
    struct Lowest {
      long at;
      double from;
    };
    std::vector<Lowest> lowest;
    for (long i = 0; i < n; ++i) {
      double from = -std::numeric_limits<double>::infinity();
      for (; !lowest.empty(); lowest.pop_back()) {
        from = crossing(h, lowest.back().at, i);
        if (from > lowest.back().from) break;
        from = -std::numeric_limits<double>::infinity();
      }
      lowest.push_back({i, from});
    }
    std::size_t k = 0;
    for (long i = 0; i < samples_; ++i) {
      const auto x = static_cast<double>(i + margin_);
      while (k + 1 < lowest.size() && lowest[k + 1].from <= x) ++k;
      const double way = x - static_cast<double>(lowest[k].at);
      line[stride * i] = h[static_cast<std::size_t>(lowest[k].at)] + bend_ * way * way;
    }
  }

 private:
  /// Where the parabola of `right` becomes lower than that of `left`.
  double crossing(const std::vector<double>& h, long left, long right) const {
    const auto a = static_cast<double>(left), b = static_cast<double>(right);
    const double rise = h[static_cast<std::size_t>(right)] - h[static_cast<std::size_t>(left)];
    return 0.5 * (a + b) + rise / (2 * bend_ * (b - a));
  }

  double bend_;
  long margin_, samples_;
};

}  // namespace

/// Range of the samples; with bicubic interpolation also of the values halfway between them, where overshoot is
/// largest. Slopes along rows and columns: the cubic between the samples p1 and p2 with the neighbours p0 and p3 is the
/// Bézier curve of p1, p1 + (p2 − p0)/6, p2 − (p3 − p1)/6 and p2, so its slope is at most three times the longest edge
/// of that polygon. Between rows slopes are blended with the cubic's weights, whose absolute sum is at most 5/4.
/// B-splines and their slopes are means of the samples and of their differences.
HeightField::Extremes HeightField::extremes() const {
  // In integers: 16 times the value halfway between samples, 256 times that between four rows of these.
  const auto halfway = [](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    return 9 * (b + c) - a - d;
  };
  const auto doubled_slope = [](std::int32_t p0, std::int32_t p1, std::int32_t p2, std::int32_t p3) {
    const std::int32_t start = p2 - p0, end = p3 - p1;
    return std::max({std::abs(start), std::abs(end), std::abs(6 * (p2 - p1) - start - end)});
  };
  struct Row {
    std::vector<std::int32_t> at, between;  ///< From column −1 to two beyond the last; from each column to the next.
  };
  const auto n = static_cast<std::size_t>(width_);
  const auto fill = [&](long y, Row& row) {
    const auto first = static_cast<std::size_t>(wrapped(y, height_, options_.wrap[1])) * n;
    std::copy_n(samples_.begin() + static_cast<std::ptrdiff_t>(first), n, row.at.begin() + 1);
    for (const long x : {-1L, long{width_}, long{width_} + 1}) row.at[static_cast<std::size_t>(x + 1)] = texel(x, y);
    for (std::size_t x = 0; x < n; ++x)
      row.between[x] = halfway(row.at[x], row.at[x + 1], row.at[x + 2], row.at[x + 3]);
  };
  std::array<Row, 4> rows;
  for (Row& row : rows) row = {std::vector<std::int32_t>(n + 3), std::vector<std::int32_t>(n)};
  for (const long j : {-1L, 0L, 1L}) fill(j, rows[static_cast<std::size_t>(j + 2)]);

  const auto [low, high] = std::minmax_element(samples_.begin(), samples_.end());
  std::int32_t least = 256 * *low, most = 256 * *high;
  std::int32_t steps[2] = {0, 0}, slopes[2] = {0, 0};
  for (long y = 0; y < height_; ++y) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    fill(y + 2, rows[3]);
    const std::int32_t *r0 = &rows[0].at[1], *r1 = &rows[1].at[1], *r2 = &rows[2].at[1], *r3 = &rows[3].at[1];
    const std::int32_t *b0 = rows[0].between.data(), *b1 = rows[1].between.data(), *b2 = rows[2].between.data(),
                       *b3 = rows[3].between.data(), *left = rows[1].at.data();
    for (std::size_t x = 0; x < n; ++x) {
      const std::int32_t along_x = 16 * b1[x], along_y = 16 * halfway(r0[x], r1[x], r2[x], r3[x]),
                         both = halfway(b0[x], b1[x], b2[x], b3[x]);
      least = std::min({least, along_x, along_y, both});
      most = std::max({most, along_x, along_y, both});
      steps[0] = std::max(steps[0], std::abs(r1[x + 1] - r1[x]));
      steps[1] = std::max(steps[1], std::abs(r2[x] - r1[x]));
      slopes[0] = std::max(slopes[0], doubled_slope(left[x], left[x + 1], left[x + 2], left[x + 3]));
      slopes[1] = std::max(slopes[1], doubled_slope(r0[x], r1[x], r2[x], r3[x]));
    }
  }
  if (options_.interpolation == Interpolation::bicubic)
    return {least / 256.0, most / 256.0, {1.25 * 0.5 * slopes[0], 1.25 * 0.5 * slopes[1]}};
  return {static_cast<double>(*low),
          static_cast<double>(*high),
          {static_cast<double>(steps[0]), static_cast<double>(steps[1])}};
}

HeightField HeightField::halved() const {
  if (width_ % 2 != 0 || height_ % 2 != 0)
    throw InvalidInput("HeightField::halved: " + std::to_string(width_) + " x " + std::to_string(height_) + " is odd");
  std::vector<std::uint16_t> result;
  result.reserve(samples_.size() / 4);
  for (long y = 0; y < height_; y += 2)
    for (long x = 0; x < width_; x += 2) {
      const unsigned sum = unsigned{texel(x, y)} + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1);
      result.push_back(static_cast<std::uint16_t>((sum + 2) / 4));
    }
  return HeightField(width_ / 2, height_ / 2, std::move(result), options_);
}

HeightField HeightField::overlaid(int factor, const std::vector<double>& added_m) const {
  if (factor < 1 ||
      added_m.size() != samples_.size() * static_cast<std::size_t>(factor) * static_cast<std::size_t>(factor))
    throw InvalidInput("HeightField::overlaid: " + std::to_string(added_m.size()) + " heights are not " +
                       std::to_string(factor) + " times " + std::to_string(width_) + " x " + std::to_string(height_));
  std::vector<double> heights;
  heights.reserve(added_m.size());
  const double step = 1.0 / factor,
               first = 0.5 * (step - 1);  // The centre of the first of `factor` samples in a texel.
  for (int y = 0; y < factor * height_; ++y)
    for (int x = 0; x < factor * width_; ++x)
      heights.push_back(sample_texels({first + step * x, first + step * y}).height_m + added_m[heights.size()]);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double bottom = *low, range = *high - bottom;
  HeightFieldOptions options = options_;
  options.offset_m = bottom;
  options.scale_m = range;
  options.white_is_outward = true;
  std::vector<std::uint16_t> samples;
  samples.reserve(heights.size());
  for (const double h : heights)
    samples.push_back(static_cast<std::uint16_t>(range > 0 ? std::lround(65535 * (h - bottom) / range) : 0));
  return HeightField(factor * width_, factor * height_, std::move(samples), options);
}

std::optional<Vec2> HeightField::pitch_m(Vec2 metres_per_uv) const {
  const auto step = steps(metres_per_uv);
  if (!step) return std::nullopt;
  return Vec2{norm(step->x), norm(step->y)};
}

std::optional<HeightField::Steps> HeightField::steps(Vec2 metres_per_uv) const {
  if (!(metres_per_uv.x > 0) || !(metres_per_uv.y > 0)) throw InvalidInput("HeightField: metres per uv must be > 0");
  // The inverse of A, scaled to metres.
  const double det = a_[0][0] * a_[1][1] - a_[0][1] * a_[1][0];
  if (det == 0) return std::nullopt;
  return Steps{{a_[1][1] / det * metres_per_uv.x, -a_[1][0] / det * metres_per_uv.y},
               {-a_[0][1] / det * metres_per_uv.x, a_[0][0] / det * metres_per_uv.y}};
}

std::vector<std::uint16_t> HeightField::quantised(const std::vector<double>& heights_m) const {
  std::vector<std::uint16_t> result;
  result.reserve(heights_m.size());
  for (const double h : heights_m) {
    const double v = metres_per_step_ != 0 ? (h - base_m_) / metres_per_step_ : 0;
    result.push_back(static_cast<std::uint16_t>(std::clamp(std::lround(v), 0L, 65535L)));
  }
  return result;
}

HeightField HeightField::dilated(double radius_m, Vec2 metres_per_uv) const {
  if (!(radius_m >= 0)) throw InvalidInput("HeightField::dilated: needs radius >= 0");
  const auto step = steps(metres_per_uv);
  const double range = max_m_ - min_m_;
  const double reach = range >= radius_m ? radius_m : std::sqrt(range * (2 * radius_m - range));
  if (reach == 0 || !step) return *this;
  // The height of the texel's parallelogram bounds the offsets within reach.
  const double area = std::abs(cross(step->x, step->y));
  const double columns = reach * norm(step->y) / area, rows = reach * norm(step->x) / area;
  if (!(columns <= 64 && rows <= 64))
    throw InvalidInput("HeightField::dilated: a probe of radius " + std::to_string(radius_m * 1e3) +
                       " mm spans more than 64 texels of the map");

  struct Tap {
    long x, y;
    double cap;
  };
  std::vector<Tap> taps;
  for (long j = -static_cast<long>(rows); j <= static_cast<long>(rows); ++j)
    for (long i = -static_cast<long>(columns); i <= static_cast<long>(columns); ++i) {
      const double distance = norm(static_cast<double>(i) * step->x + static_cast<double>(j) * step->y);
      if (distance <= reach) taps.push_back({i, j, std::sqrt(radius_m * radius_m - distance * distance) - radius_m});
    }
  std::sort(taps.begin(), taps.end(), [](const Tap& a, const Tap& b) {
    return a.cap != b.cap ? a.cap > b.cap : (a.y != b.y ? a.y < b.y : a.x < b.x);
  });

  std::vector<double> result;
  result.reserve(samples_.size());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      double best = min_m_;
      for (const Tap& tap : taps) {
        if (max_m_ + tap.cap <= best) break;
        best = std::max(best, base_m_ + metres_per_step_ * texel(x + tap.x, y + tap.y) + tap.cap);
      }
      result.push_back(best);
    }
  return HeightField(width_, height_, quantised(result), options_);
}

HeightField HeightField::rounded(double radius_m, Vec2 metres_per_uv) const {
  if (!(radius_m >= 0) || !std::isfinite(radius_m)) throw InvalidInput("HeightField::rounded: needs radius >= 0");
  const auto step = steps(metres_per_uv);
  const double range = max_m_ - min_m_;
  if (radius_m == 0 || range == 0 || !step) return *this;
  // Farther samples are higher than the range on every parabola.
  const double reach = std::sqrt(2 * radius_m * range);
  const Envelope across(norm(step->x), radius_m, reach, width_), down(norm(step->y), radius_m, reach, height_);
  std::vector<double> heights;
  heights.reserve(samples_.size());
  for (const std::uint16_t v : samples_) heights.push_back(base_m_ + metres_per_step_ * v);
  for (const double sign : {1.0, -1.0}) {
    for (double& h : heights) h *= sign;
    for (long y = 0; y < height_; ++y)
      across.lower(&heights[static_cast<std::size_t>(y * width_)], 1, options_.wrap[0]);
    for (long x = 0; x < width_; ++x) down.lower(&heights[static_cast<std::size_t>(x)], width_, options_.wrap[1]);
    for (double& h : heights) h *= sign;
  }
  HeightFieldOptions options = options_;
  if (options.interpolation == Interpolation::bicubic) options.interpolation = Interpolation::bspline;
  return HeightField(width_, height_, quantised(heights), options);
}

double HeightField::share_steeper(double slope, Vec2 metres_per_uv) const {
  const auto step = steps(metres_per_uv);
  if (!step) return 0;
  const double area = cross(step->x, step->y), rounding = 1e-3 * slope;
  std::size_t steeper = 0;
  for (long y = 0; y < height_; ++y)
    for (long x = 0; x < width_; ++x) {
      const double here = texel(x, y);
      const double dx = metres_per_step_ * (texel(x + 1, y) - here), dy = metres_per_step_ * (texel(x, y + 1) - here);
      // The g with g·step.x = dx and g·step.y = dy.
      const Vec2 g{(dx * step->y.y - dy * step->x.y) / area, (dy * step->x.x - dx * step->y.x) / area};
      steeper += norm(g) > slope + rounding;
    }
  return static_cast<double>(steeper) / static_cast<double>(samples_.size());
}

}  // namespace papilla
