// SPDX-License-Identifier: MIT
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluator.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

using namespace procedural_detail;

constexpr std::array<std::string_view, k_channels> k_names = {
    "main",          "bump",     "alpha",     "coloralpha", "reflection", "diffuse", "specular",
    "specularcoeff", "friction", "stiffness", "damping",    "roughness",  "color"};
constexpr std::size_t k_color = static_cast<std::size_t>(Channel::color);
constexpr int k_most_side = 65536;
constexpr std::int64_t k_most_texels = std::int64_t{1} << 30;
constexpr std::size_t k_most_near_texels = std::size_t{1} << 26;
constexpr double k_most_factor = 10;  ///< Of friction, stiffness and damping.

/// Rows of BlockRow::column to BlockRow::flow.
constexpr std::size_t k_known_rows = static_cast<std::size_t>(BlockRow::flow) + 1;

/// Buffers of a thread for a row of points.
struct Workspace {
  explicit Workspace(const Graph& graph) : evaluator(graph) {}
  Evaluator evaluator;
  ChannelRows out;
  double x[k_row], y[k_row];
  double known[k_known_rows][k_row];
  double color[3][k_row], below[4][k_row];
  std::uint32_t texels[k_row];
};

struct Raster {
  double columns = 0, rows = 0;  ///< 0: points without order.
  double texel = 0;
};

void fill_block_rows(Workspace& w, Block& block, const Raster& raster, std::int64_t first,
                     const TexturePoints* points) {
  const int n = block.n;
  for (std::size_t k = 0; k < k_known_rows; ++k) block.rows[k] = w.known[k];
  const auto row = [&](BlockRow r) { return w.known[static_cast<std::size_t>(r)]; };
  // A block lies within one row of the raster; points without one are numbered in rows of 2^20.
  const auto width = raster.columns > 0 ? static_cast<std::int64_t>(raster.columns) : std::int64_t{1} << 20;
  const auto column = static_cast<double>(first % width), line = static_cast<double>(first / width);
  for (int i = 0; i < n; ++i) row(BlockRow::column)[i] = column + i;
  std::fill_n(row(BlockRow::row), n, line);
  std::fill_n(row(BlockRow::columns), n, raster.columns);
  std::fill_n(row(BlockRow::rows), n, raster.rows);
  std::fill_n(row(BlockRow::shorter), n, std::min(raster.columns, raster.rows));
  std::fill_n(row(BlockRow::octaveadd), n, raster.texel > 0 ? -std::log2(raster.texel * 256) : 0);
  const bool solid = points && !points->positions.empty();
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(first + i);
    row(BlockRow::posx)[i] = solid ? static_cast<double>(points->positions[3 * k]) : block.x[i];
    row(BlockRow::posy)[i] = solid ? static_cast<double>(points->positions[3 * k + 1]) : block.y[i];
    row(BlockRow::posz)[i] = solid ? static_cast<double>(points->positions[3 * k + 2]) : 0;
    row(BlockRow::sky)[i] = points && !points->sky.empty() ? static_cast<double>(points->sky[k]) : 1;
    row(BlockRow::flow)[i] = points && !points->flow.empty() ? static_cast<double>(points->flow[k]) : 1;
  }
  block.solid = solid;
  if (points && !points->color.empty())
    for (std::size_t c = 0; c < 3; ++c) {
      for (int i = 0; i < n; ++i)
        w.color[c][i] = static_cast<double>(points->color[3 * static_cast<std::size_t>(first + i) + c]);
      block.rows[static_cast<std::size_t>(BlockRow::lower_red) + c] = w.color[c];
    }
  if (points) {
    const std::pair<std::span<const float>, BlockRow> below[] = {{points->height, BlockRow::lower_bump},
                                                                 {points->alpha, BlockRow::lower_alpha},
                                                                 {points->reflection, BlockRow::lower_reflection},
                                                                 {points->roughness, BlockRow::lower_roughness}};
    for (std::size_t k = 0; k < std::size(below); ++k) {
      if (below[k].first.empty()) continue;
      std::copy_n(below[k].first.begin() + static_cast<std::ptrdiff_t>(first), n, w.below[k]);
      block.rows[static_cast<std::size_t>(below[k].second)] = w.below[k];
    }
  }
  if (points && !points->normals.empty()) block.normals = points->normals.data() + 3 * first;
}

/// Evaluates the points of `block` and stores the channels from index `first` on.
void evaluate_block(const Graph& graph, Workspace& w, const Block& block, unsigned channels, std::int64_t first,
                    TextureValues& values) {
  if ((channels & ~1U) == 0)
    w.evaluator.main_value(graph.root, block, w.out.row[0]);
  else
    w.evaluator.channels(graph.root, block, channels, w.out);
  for (std::size_t c = 0; c < k_channels; ++c) {
    if (!(channels >> c & 1U)) continue;
    const auto channel = static_cast<Channel>(c);
    const bool limited = channel == Channel::friction || channel == Channel::stiffness || channel == Channel::damping;
    const std::size_t parts = c == k_color ? 3 : 1;
    float* out = values.channels[c].data() + static_cast<std::size_t>(first) * parts;
    for (std::size_t k = 0; k < parts; ++k)
      for (int i = 0; i < block.n; ++i) {
        const double v =
            limited ? std::clamp(w.out.row[c][i], 0.0, k_most_factor) : std::clamp(w.out.row[c + k][i], -1e30, 1e30);
        out[static_cast<std::size_t>(i) * parts + k] = static_cast<float>(v);
      }
  }
}

void allocate_channels(TextureValues& values, unsigned channels, std::size_t count) {
  for (std::size_t c = 0; c < k_channels; ++c)
    if (channels >> c & 1U) values.channels[c].resize(count * (c == k_color ? 3 : 1));
}

using Workspaces = tbb::enumerable_thread_specific<std::unique_ptr<Workspace>>;

void refuse_large(const char* where, const NearRaster& raster) {
  if (raster.texels() > k_most_near_texels)
    throw InvalidInput(std::string(where) + ": " + std::to_string(raster.width) + " x " +
                       std::to_string(raster.height) + " texels; with nearmean() and its kin at most 2^26");
}

Workspace& local(Workspaces& all, const Graph& graph) {
  auto& mine = all.local();
  if (!mine) mine = std::make_unique<Workspace>(graph);
  return *mine;
}

}  // namespace

std::string_view to_string(Channel channel) noexcept { return k_names[static_cast<std::size_t>(channel)]; }

Channel channel_named(std::string_view name) {
  if (name == "height") return Channel::bump;
  std::string list;
  std::vector<std::string_view> known{"height"};
  for (std::size_t c = 0; c < k_channels; ++c) {
    if (k_names[c] == name) return static_cast<Channel>(c);
    list += (c ? ", " : "") + std::string(k_names[c]);
    known.emplace_back(k_names[c]);
  }
  throw InvalidInput("unknown channel '" + std::string(name) + "'" + did_you_mean(name, known) + "; known are " + list +
                     " and height (bump)");
}

double roughness_of_highlight(double specular, double exponent) noexcept {
  const double peak = specular * (std::max(exponent, 0.0) + 2);
  return peak > 2 ? std::pow(2 / peak, 0.25) : 1;
}

RenderedTexture render_texture(const ProceduralTexture& texture, const RenderOptions& options) {
  const std::int64_t texels = std::int64_t{options.width} * options.height;
  if (options.width < 1 || options.height < 1 || options.width > k_most_side || options.height > k_most_side ||
      texels > k_most_texels)
    throw InvalidInput("render_texture: " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                       " texels; each side must be 1 to 65536, and all together at most 2^30");
  const Graph& graph = texture.graph();
  RenderedTexture result{options.width, options.height, {}};
  allocate_channels(result.values, options.channels, static_cast<std::size_t>(texels));
  const bool stretch = graph.nodes[static_cast<std::size_t>(graph.root)]->stretch;
  const double shorter = std::min(options.width, options.height);
  const double step_x = 1 / (stretch ? options.width : shorter), step_y = 1 / (stretch ? options.height : shorter);
  const NearRaster raster{options.width, options.height, graph.nodes[static_cast<std::size_t>(graph.root)]->seamless};
  if (!graph.near.empty()) refuse_large("render_texture", raster);
  Neighbourhoods near(graph, raster);
  Workspaces workspaces;
  SharedProgress progress(options.progress, "texture",
                          static_cast<double>(options.height) * (graph.deepest_near() + 1));
  const auto evaluate = [&](const tbb::blocked_range<int>& range) {
    Workspace& w = local(workspaces, graph);
    for (int row = range.begin(); row < range.end(); ++row)
      for (int column = 0; column < options.width; column += k_row) {
        Block block;
        block.n = std::min(k_row, options.width - column);
        for (int i = 0; i < block.n; ++i)
          w.x[i] = (column + i + 0.5 + options.shift_x) * step_x, w.y[i] = (row + 0.5 + options.shift_y) * step_y;
        block.x = w.x, block.y = w.y, block.texel = std::max(step_x, step_y);
        block.extent_x = options.width * step_x, block.extent_y = options.height * step_y;
        const std::int64_t first = std::int64_t{row} * options.width + column;
        fill_block_rows(w, block,
                        {static_cast<double>(options.width), static_cast<double>(options.height), block.texel}, first,
                        nullptr);
        if (!graph.near.empty()) {
          std::iota(w.texels, w.texels + block.n, static_cast<std::uint32_t>(first));
          block.near = &near, block.texels = w.texels;
        }
        evaluate_block(graph, w, block, options.channels, first, result.values);
      }
    progress.add(static_cast<double>(range.size()));
  };
  const auto grain = static_cast<std::size_t>(std::max(1, 16384 / options.width));
  while (near.next()) tbb::parallel_for(tbb::blocked_range<int>(0, options.height, grain), evaluate);
  return result;
}

TextureValues evaluate_texture(const ProceduralTexture& texture, const TexturePoints& points, unsigned channels,
                               double texel) {
  const std::size_t count = points.x.size();
  const auto fits = [&](std::size_t size, std::size_t parts) { return size == 0 || size == count * parts; };
  if (points.y.size() != count || !fits(points.normals.size(), 3) || !fits(points.positions.size(), 3) ||
      !fits(points.sky.size(), 1) || !fits(points.flow.size(), 1) || !fits(points.color.size(), 3) ||
      !fits(points.height.size(), 1) || !fits(points.alpha.size(), 1) || !fits(points.reflection.size(), 1) ||
      !fits(points.roughness.size(), 1) || !fits(points.raster.at.size(), 1))
    throw InvalidInput("evaluate_texture: the spans have unlike lengths for " + std::to_string(count) + " points");
  const Graph& graph = texture.graph();
  const NearRaster raster{points.raster.width, points.raster.height, points.raster.repeats};
  const bool near_used = !graph.near.empty() && !points.raster.at.empty();
  if (near_used) {
    refuse_large("evaluate_texture", raster);
    for (const std::uint32_t at : points.raster.at)
      if (at >= raster.texels()) throw InvalidInput("evaluate_texture: a point lies outside of its raster");
  }
  Neighbourhoods near(graph, raster);
  TextureValues values;
  allocate_channels(values, channels, count);
  Workspaces workspaces;
  const std::size_t blocks = (count + k_row - 1) / k_row;
  const auto evaluate = [&](const tbb::blocked_range<std::size_t>& range) {
    Workspace& w = local(workspaces, graph);
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const std::size_t first = k * k_row;
      Block block;
      block.n = static_cast<int>(std::min<std::size_t>(k_row, count - first));
      block.x = points.x.data() + first, block.y = points.y.data() + first, block.texel = texel;
      fill_block_rows(w, block, {0, 0, texel}, static_cast<std::int64_t>(first), &points);
      if (near_used) block.near = &near, block.texels = points.raster.at.data() + first;
      evaluate_block(graph, w, block, channels, static_cast<std::int64_t>(first), values);
    }
  };
  while (near.next()) tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 16), evaluate);
  return values;
}

HeightMap render_relief(const ProceduralTexture& texture, int width, int height, double size_mm_x, double size_mm_y,
                        double depth_mm) {
  if (!(size_mm_x > 0 && size_mm_y > 0 && depth_mm > 0 && std::isfinite(size_mm_x + size_mm_y + depth_mm)))
    throw InvalidInput("render_relief: sizes and depth must be positive");
  RenderOptions options;
  options.width = width, options.height = height, options.channels = 1U << static_cast<unsigned>(Channel::bump);
  RenderedTexture rendered = render_texture(texture, options);
  HeightMap map{width,
                height,
                adopted_values(std::move(rendered.values.channels[static_cast<std::size_t>(Channel::bump)])),
                size_mm_x / width,
                size_mm_y / height,
                false};
  for (float& h : map.mm) h *= static_cast<float>(depth_mm);
  map.periodic = texture.graph().nodes[static_cast<std::size_t>(texture.graph().root)]->seamless;
  return map;
}

}  // namespace papilla
