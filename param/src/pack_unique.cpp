// SPDX-License-Identifier: MIT
#include "papilla/param/pack_unique.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "place_charts.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "pack_unique";

/// Widths that are tried, relative to the root of the charts' area.
constexpr std::array k_widths{1.02, 1.07, 1.12, 1.2, 1.35};

/// Columns of the grid, for few and for many charts.
constexpr std::size_t k_most_columns = 512, k_least_columns = 256, k_many_charts = 200;

/// Times that gutters are adapted to the side that came out.
constexpr int k_gutter_rounds = 6;

[[noreturn]] void refuse(const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); }

void check(const CornerAttribute<Vec2>& uv, const ChartSet& charts, const UniqueAtlasOptions& o) {
  if (o.texture_px < 16 || o.texture_px > 65536)
    refuse("texture_px is " + std::to_string(o.texture_px) + ", expected 16 to 65536");
  if (!(o.gutter_px >= 0 && o.gutter_px <= 0.25 * o.texture_px))
    refuse("gutter_px is " + std::to_string(o.gutter_px) + ", expected 0 to a quarter of texture_px");
  if (!o.density.empty() && o.density.size() != charts.count)
    refuse("there are " + std::to_string(o.density.size()) + " densities for " + std::to_string(charts.count) +
           " charts");
  for (std::size_t c = 0; c < o.density.size(); ++c)
    if (!(o.density[c] > 0) || !std::isfinite(o.density[c]))
      refuse("density[" + std::to_string(c) + "] is " + std::to_string(o.density[c]) + ", expected above 0");
  check_flattening(uv, charts, k_function);
}

/// (x, y) turned by quarter turns, counter-clockwise.
Vec2 turn(Vec2 p, int quarters) {
  switch (quarters) {
    case 1: return {-p.y, p.x};
    case 2: return {-p.x, -p.y};
    case 3: return {p.y, -p.x};
    default: return p;
  }
}

using PlaneTriangle = std::array<Vec2, 3>;

/// A chart's triangles, scaled by its density.
struct Chart {
  std::uint32_t number = 0;
  std::vector<PlaneTriangle> triangles;
  double area = 0;
};

std::vector<Chart> charts_of(const CornerAttribute<Vec2>& uv, const ChartSet& charts, const UniqueAtlasOptions& o) {
  std::vector<Chart> all(charts.count);
  for (std::size_t t = 0; t < uv.indices.size(); ++t) {
    const std::uint32_t c = charts.of_triangle[t];
    const double scale = o.density.empty() ? 1 : o.density[c];
    PlaneTriangle p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = scale * uv.values[uv.indices[t][k]];
    all[c].number = c;
    all[c].area += 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0]));
    all[c].triangles.push_back(p);
  }
  std::erase_if(all, [](const Chart& chart) { return chart.triangles.empty(); });
  return all;
}

/// A chart in one of its four positions over columns of one width, gutter included.
struct Outline {
  Vec2 origin;                    ///< What lies at the left end of the first column, at height 0.
  std::vector<double> low, high;  ///< Per column.
  double height = 0;
};

/// Lowers and raises the outline over the columns that a segment crosses.
void add_segment(Vec2 a, Vec2 b, double cell, std::vector<double>& low, std::vector<double>& high) {
  if (a.x > b.x) std::swap(a, b);
  const auto column = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x / cell, 0.0, static_cast<double>(low.size() - 1)));
  };
  const std::size_t first = column(a.x), last = column(b.x);
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double left = i == first ? a.y : a.y + slope * (static_cast<double>(i) * cell - a.x);
    const double right = i == last ? b.y : a.y + slope * (static_cast<double>(i + 1) * cell - a.x);
    low[i] = std::min({low[i], left, right});
    high[i] = std::max({high[i], left, right});
  }
}

Outline outline_of(const Chart& chart, int quarters, double cell, double gutter) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds2 bounds;
  for (const PlaneTriangle& t : chart.triangles)
    for (const Vec2 corner : t) bounds.add(turn(corner, quarters));
  Outline o;
  o.origin = bounds.low - Vec2{0.5 * gutter, 0.5 * gutter};
  const auto columns = static_cast<std::size_t>(std::ceil((bounds.size().x + gutter) / cell)) + 1;
  std::vector<double> low(columns, infinity), high(columns, -infinity);
  for (const PlaneTriangle& t : chart.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      add_segment(turn(t[k], quarters) - o.origin, turn(t[(k + 1) % 3], quarters) - o.origin, cell, low, high);
  // Half a gutter to all sides.
  const auto reach = static_cast<std::size_t>(std::ceil(0.5 * gutter / cell));
  o.low.assign(columns, infinity), o.high.assign(columns, -infinity);
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t j = i > reach ? i - reach : 0; j <= std::min(i + reach, columns - 1); ++j) {
      o.low[i] = std::min(o.low[i], low[j] - 0.5 * gutter);
      o.high[i] = std::max(o.high[i], high[j] + 0.5 * gutter);
    }
  while (o.low.size() > 1 && !(o.low.back() < infinity)) o.low.pop_back(), o.high.pop_back();
  o.height = *std::max_element(o.high.begin(), o.high.end());
  return o;
}

struct Placement {
  std::vector<Vec2> offset;  ///< Per chart: added after its turn.
  std::vector<int> quarters;
  double side = std::numeric_limits<double>::infinity();
};

/// Places charts one after the other on what lies there.
class Horizon {
 public:
  Horizon(std::size_t columns, double cell) : top_(columns, 0.0), cell_(cell) {}

  struct Place {
    std::size_t column = 0;
    double y = 0, top = std::numeric_limits<double>::infinity(), waste = 0;
  };

  /// The best place of an outline; its `top` is infinite when the outline is too wide.
  Place find(const Outline& o) const {
    Place best;
    for (std::size_t x = 0; x + o.low.size() <= top_.size(); ++x) {
      double y = 0;
      for (std::size_t i = 0; i < o.low.size() && y + o.height <= best.top; ++i)
        y = std::max(y, top_[x + i] - o.low[i]);
      if (y + o.height > best.top) continue;
      double waste = 0;
      for (std::size_t i = 0; i < o.low.size(); ++i) waste += std::max(0.0, y + o.low[i] - top_[x + i]);
      if (y + o.height < best.top || waste < best.waste) best = {x, y, y + o.height, waste};
    }
    return best;
  }

  void put(const Outline& o, const Place& place) {
    for (std::size_t i = 0; i < o.high.size(); ++i)
      top_[place.column + i] = std::max(top_[place.column + i], place.y + o.high[i]);
    width_ = std::max(width_, static_cast<double>(place.column + o.low.size()) * cell_);
    height_ = std::max(height_, place.top);
  }

  double side() const { return std::max(width_, height_); }

 private:
  std::vector<double> top_;
  double cell_, width_ = 0, height_ = 0;
};

class Packer {
 public:
  explicit Packer(std::vector<Chart> charts) : charts_(std::move(charts)), order_(charts_.size()) {
    for (const Chart& c : charts_) area_ += c.area;
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::vector<double> extent;
    for (const Chart& c : charts_) extent.push_back(extent_of(c));
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return extent[a] > extent[b]; });
  }

  double area() const { return area_; }
  const std::vector<Chart>& charts() const { return charts_; }

  Placement pack(double gutter) const {
    Placement best;
    for (const double factor : k_widths) {
      Placement placement = pack_into(factor * std::sqrt(area_) + gutter, gutter);
      if (placement.side < best.side) best = std::move(placement);
    }
    return best;
  }

 private:
  static double extent_of(const Chart& chart) {
    Bounds2 bounds;
    for (const PlaneTriangle& t : chart.triangles)
      for (const Vec2 p : t) bounds.add(p);
    return std::max(bounds.size().x, bounds.size().y);
  }

  Placement pack_into(double width, double gutter) const {
    // Wide enough for the narrower side of the widest chart: each fits in one of its positions.
    const std::size_t columns = charts_.size() > k_many_charts ? k_least_columns : k_most_columns;
    const double extent = order_.empty() ? 0 : extent_of(charts_[order_.front()]);
    width = std::max(width, extent + gutter);
    const double cell = width / static_cast<double>(columns);
    Horizon horizon(columns + 2, cell);
    Placement result;
    result.offset.resize(charts_.size());
    result.quarters.resize(charts_.size());
    for (const std::size_t c : order_) {
      std::array<Outline, 4> outlines;
      Horizon::Place best;
      int chosen = -1;
      for (int q = 0; q < 4; ++q) {
        outlines[static_cast<std::size_t>(q)] = outline_of(charts_[c], q, cell, gutter);
        const Horizon::Place place = horizon.find(outlines[static_cast<std::size_t>(q)]);
        if (place.top < best.top || (place.top == best.top && place.waste < best.waste)) best = place, chosen = q;
      }
      if (chosen < 0) return {};  // too wide for this width
      const Outline& o = outlines[static_cast<std::size_t>(chosen)];
      horizon.put(o, best);
      result.quarters[c] = chosen;
      result.offset[c] = Vec2{static_cast<double>(best.column) * cell, best.y} - o.origin;
    }
    result.side = horizon.side();
    return result;
  }

  std::vector<Chart> charts_;
  std::vector<std::size_t> order_;
  double area_ = 0;
};

[[noreturn]] void refuse_gutters(const Packer& packer, const UniqueAtlasOptions& o) {
  refuse("gutters of " + std::to_string(o.gutter_px) + " texels leave " + std::to_string(packer.charts().size()) +
         " charts no room in " + std::to_string(o.texture_px) + " texels");
}

/// Gutters are asked for in texels of a side that the gutters help to make.
Placement pack_with_gutters(const Packer& packer, const UniqueAtlasOptions& o, double& gutter) {
  gutter = o.gutter_px / o.texture_px * std::sqrt(packer.area() / 0.6);
  Placement placement = packer.pack(gutter);
  for (int i = 0; i < k_gutter_rounds && gutter * o.texture_px < o.gutter_px * placement.side; ++i) {
    gutter = 1.01 * o.gutter_px * placement.side / o.texture_px;
    placement = packer.pack(gutter);
  }
  if (!std::isfinite(placement.side) || gutter * o.texture_px < o.gutter_px * placement.side) refuse_gutters(packer, o);
  return placement;
}

}  // namespace

UniqueAtlas pack_unique(const CornerAttribute<Vec2>& uv, const ChartSet& charts, const UniqueAtlasOptions& options) {
  check(uv, charts, options);
  const Packer packer(charts_of(uv, charts, options));
  UniqueAtlas atlas;
  atlas.uv = move_charts(uv, charts, std::vector<Vec2>(charts.count), k_function);
  if (!(packer.area() > 0)) {
    if (!packer.charts().empty()) refuse("the charts have no area");
    return atlas;
  }
  const double texels = options.gutter_px * options.gutter_px * static_cast<double>(packer.charts().size());
  if (texels > static_cast<double>(options.texture_px) * options.texture_px) refuse_gutters(packer, options);
  double gutter = 0;
  const Placement placement = pack_with_gutters(packer, options, gutter);
  std::vector<std::size_t> slot(charts.count, 0);
  for (std::size_t i = 0; i < packer.charts().size(); ++i) slot[packer.charts()[i].number] = i;
  std::vector<char> done(uv.values.size(), 0);
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    for (const Index i : uv.indices[t]) {
      if (done[i]) continue;
      done[i] = 1;
      const std::uint32_t c = charts.of_triangle[t];
      const double scale = options.density.empty() ? 1 : options.density[c];
      const Vec2 p = turn(scale * uv.values[i], placement.quarters[slot[c]]) + placement.offset[slot[c]];
      atlas.uv.values[i] = {std::clamp(p.x / placement.side, 0.0, 1.0), std::clamp(p.y / placement.side, 0.0, 1.0)};
    }
  atlas.fill_rate = packer.area() / (placement.side * placement.side);
  atlas.texels_per_mm = options.texture_px / placement.side;
  atlas.gutter_px = gutter * atlas.texels_per_mm;
  return atlas;
}

}  // namespace papilla
