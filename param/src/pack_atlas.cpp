// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/pack.hpp"
#include "place_charts.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "pack_atlas";

/// Widths that are tried, relative to the root of the total box area.
constexpr double k_widths[] = {1.0, 1.04, 1.08, 1.12, 1.18, 1.25, 1.35, 1.5};

struct Box : Bounds2 {
  double triangle_area = 0;
};

std::vector<Box> boxes_of(const CornerAttribute<Vec2>& uv, const ChartSet& charts) {
  std::vector<Box> boxes(charts.count);
  for (std::size_t t = 0; t < uv.indices.size(); ++t) {
    Box& box = boxes[charts.of_triangle[t]];
    const Vec2 corner[3] = {uv.values[uv.indices[t][0]], uv.values[uv.indices[t][1]], uv.values[uv.indices[t][2]]};
    for (const Vec2 p : corner) box.add(p);
    box.triangle_area += 0.5 * std::abs(cross(corner[1] - corner[0], corner[2] - corner[0]));
  }
  return boxes;
}

/// A rectangle to be placed, gutter and tile play included.
struct Item {
  std::uint32_t chart;
  double width, height;
};

/// The upper outline of what is placed: steps from left to right over [0, width].
class Skyline {
 public:
  explicit Skyline(double width) : steps_{{0, 0}}, width_(width) {}

  /// Takes the lowest, then leftmost place.
  Vec2 place(double width, double height) {
    std::size_t best = steps_.size();
    double best_y = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (steps_[i].x + width > width_ * (1 + 1e-12)) break;
      const double y = height_over(i, width);
      if (y < best_y) best = i, best_y = y;
    }
    const Vec2 position{steps_[best].x, best_y};
    raise(best, width, best_y + height);
    return position;
  }

 private:
  struct Step {
    double x, y;
  };

  double height_over(std::size_t i, double width) const {
    const double end = steps_[i].x + width;
    double y = 0;
    for (; i < steps_.size() && steps_[i].x < end; ++i) y = std::max(y, steps_[i].y);
    return y;
  }

  void raise(std::size_t first, double width, double y) {
    const double start = steps_[first].x, end = start + width;
    std::size_t last = first;
    while (last + 1 < steps_.size() && steps_[last + 1].x < end) ++last;
    const double continues = steps_[last].y;
    const bool reaches = last + 1 < steps_.size() ? steps_[last + 1].x <= end : width_ <= end;
    std::vector<Step> replacement{{start, y}};
    if (!reaches) replacement.push_back({end, continues});
    const auto at = steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(first),
                                 steps_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    steps_.insert(at, replacement.begin(), replacement.end());
  }

  std::vector<Step> steps_;
  double width_;
};

struct Placement {
  std::vector<Vec2> position;  ///< Of each item.
  Vec2 size;
  double side() const { return std::max(size.x, size.y); }
};

Placement place_all(const std::vector<Item>& items, double width) {
  Placement result;
  Skyline skyline(width);
  for (const Item& item : items) {
    const Vec2 p = skyline.place(item.width, item.height);
    result.position.push_back(p);
    result.size = {std::max(result.size.x, p.x + item.width), std::max(result.size.y, p.y + item.height)};
  }
  return result;
}

Placement best_placement(const std::vector<Item>& items) {
  double area = 0, widest = 0;
  for (const Item& item : items) {
    area += item.width * item.height;
    widest = std::max(widest, item.width);
  }
  Placement best;
  best.size = {std::numeric_limits<double>::infinity(), 0};
  for (const double factor : k_widths) {
    Placement placement = place_all(items, std::max(widest, factor * std::sqrt(area)));
    if (placement.side() < best.side()) best = std::move(placement);
  }
  return best;
}

double whole_tiles(double distance, double tile) { return tile > 0 ? std::ceil(distance / tile) * tile : distance; }

void check_options(const AtlasOptions& o) {
  if (!(o.gutter_mm >= 0) || !std::isfinite(o.gutter_mm))
    throw InvalidInput(std::string(k_function) + ": gutter_mm is " + std::to_string(o.gutter_mm) +
                       ", expected at least 0");
  if (!(o.tile_mm.x >= 0 && o.tile_mm.y >= 0) || !is_finite(o.tile_mm))
    throw InvalidInput(std::string(k_function) + ": tile_mm is negative or not finite");
}

}  // namespace

Atlas pack_atlas(const CornerAttribute<Vec2>& uv, const ChartSet& charts, const AtlasOptions& options) {
  check_options(options);
  check_flattening(uv, charts, k_function);
  const std::vector<Box> boxes = boxes_of(uv, charts);
  std::vector<Item> items;
  for (std::uint32_t c = 0; c < charts.count; ++c) {
    if (boxes[c].is_empty()) continue;
    items.push_back({c, boxes[c].high.x - boxes[c].low.x + options.gutter_mm + options.tile_mm.x,
                     boxes[c].high.y - boxes[c].low.y + options.gutter_mm + options.tile_mm.y});
  }
  Atlas atlas;
  atlas.offset.resize(charts.count);
  if (items.empty()) return atlas;
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.height != b.height ? a.height > b.height : a.width > b.width;
  });
  const Placement placement = best_placement(items);
  double triangle_area = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Box& box = boxes[items[i].chart];
    Vec2& offset = atlas.offset[items[i].chart];
    offset = {whole_tiles(placement.position[i].x - box.low.x, options.tile_mm.x),
              whole_tiles(placement.position[i].y - box.low.y, options.tile_mm.y)};
    atlas.size_mm = {std::max(atlas.size_mm.x, box.high.x + offset.x),
                     std::max(atlas.size_mm.y, box.high.y + offset.y)};
    triangle_area += box.triangle_area;
  }
  atlas.uv = move_charts(uv, charts, atlas.offset, k_function);
  const double side = std::max(atlas.size_mm.x, atlas.size_mm.y);
  atlas.fill_rate = side > 0 ? triangle_area / (side * side) : 0;
  return atlas;
}

}  // namespace papilla
