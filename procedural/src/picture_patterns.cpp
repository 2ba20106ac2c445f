// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "evaluator.hpp"
#include "noise.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {
namespace {

/// Seven rows of five dots a character, from blank to tilde; the highest of five bits is the left dot.
constexpr unsigned char k_glyphs[95][7] = {
    {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, {0x04, 0x04, 0x04, 0x04, 0x04, 0x00, 0x04},
    {0x0a, 0x0a, 0x00, 0x00, 0x00, 0x00, 0x00}, {0x0a, 0x0a, 0x1f, 0x0a, 0x1f, 0x0a, 0x0a},
    {0x04, 0x0f, 0x14, 0x0e, 0x05, 0x1e, 0x04}, {0x18, 0x19, 0x02, 0x04, 0x08, 0x13, 0x03},
    {0x0c, 0x12, 0x14, 0x08, 0x15, 0x12, 0x0d}, {0x04, 0x04, 0x00, 0x00, 0x00, 0x00, 0x00},
    {0x02, 0x04, 0x08, 0x08, 0x08, 0x04, 0x02}, {0x08, 0x04, 0x02, 0x02, 0x02, 0x04, 0x08},
    {0x00, 0x04, 0x15, 0x0e, 0x15, 0x04, 0x00}, {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00},
    {0x00, 0x00, 0x00, 0x00, 0x0c, 0x04, 0x08}, {0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00},
    {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}, {0x00, 0x01, 0x02, 0x04, 0x08, 0x10, 0x00},
    {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}, {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e},
    {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}, {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e},
    {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}, {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e},
    {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}, {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08},
    {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}, {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c},
    {0x00, 0x0c, 0x0c, 0x00, 0x0c, 0x0c, 0x00}, {0x00, 0x0c, 0x0c, 0x00, 0x0c, 0x04, 0x08},
    {0x02, 0x04, 0x08, 0x10, 0x08, 0x04, 0x02}, {0x00, 0x00, 0x1f, 0x00, 0x1f, 0x00, 0x00},
    {0x08, 0x04, 0x02, 0x01, 0x02, 0x04, 0x08}, {0x0e, 0x11, 0x01, 0x02, 0x04, 0x00, 0x04},
    {0x0e, 0x11, 0x01, 0x0d, 0x15, 0x15, 0x0e}, {0x0e, 0x11, 0x11, 0x11, 0x1f, 0x11, 0x11},
    {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e}, {0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e},
    {0x1c, 0x12, 0x11, 0x11, 0x11, 0x12, 0x1c}, {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f},
    {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10}, {0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f},
    {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}, {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e},
    {0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0c}, {0x11, 0x12, 0x14, 0x18, 0x14, 0x12, 0x11},
    {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f}, {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11},
    {0x11, 0x11, 0x19, 0x15, 0x13, 0x11, 0x11}, {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e},
    {0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10, 0x10}, {0x0e, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0d},
    {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}, {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e},
    {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}, {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e},
    {0x11, 0x11, 0x11, 0x11, 0x11, 0x0a, 0x04}, {0x11, 0x11, 0x11, 0x15, 0x15, 0x15, 0x0a},
    {0x11, 0x11, 0x0a, 0x04, 0x0a, 0x11, 0x11}, {0x11, 0x11, 0x11, 0x0a, 0x04, 0x04, 0x04},
    {0x1f, 0x01, 0x02, 0x04, 0x08, 0x10, 0x1f}, {0x0e, 0x08, 0x08, 0x08, 0x08, 0x08, 0x0e},
    {0x00, 0x10, 0x08, 0x04, 0x02, 0x01, 0x00}, {0x0e, 0x02, 0x02, 0x02, 0x02, 0x02, 0x0e},
    {0x04, 0x0a, 0x11, 0x00, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x1f},
    {0x08, 0x04, 0x02, 0x00, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f},
    {0x10, 0x10, 0x16, 0x19, 0x11, 0x11, 0x1e}, {0x00, 0x00, 0x0e, 0x10, 0x10, 0x11, 0x0e},
    {0x01, 0x01, 0x0d, 0x13, 0x11, 0x11, 0x0f}, {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e},
    {0x06, 0x09, 0x08, 0x1c, 0x08, 0x08, 0x08}, {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x0e},
    {0x10, 0x10, 0x16, 0x19, 0x11, 0x11, 0x11}, {0x04, 0x00, 0x0c, 0x04, 0x04, 0x04, 0x0e},
    {0x02, 0x00, 0x06, 0x02, 0x02, 0x12, 0x0c}, {0x10, 0x10, 0x12, 0x14, 0x18, 0x14, 0x12},
    {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}, {0x00, 0x00, 0x1a, 0x15, 0x15, 0x11, 0x11},
    {0x00, 0x00, 0x16, 0x19, 0x11, 0x11, 0x11}, {0x00, 0x00, 0x0e, 0x11, 0x11, 0x11, 0x0e},
    {0x00, 0x00, 0x1e, 0x11, 0x1e, 0x10, 0x10}, {0x00, 0x00, 0x0d, 0x13, 0x0f, 0x01, 0x01},
    {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10}, {0x00, 0x00, 0x0e, 0x10, 0x0e, 0x01, 0x1e},
    {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06}, {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0d},
    {0x00, 0x00, 0x11, 0x11, 0x11, 0x0a, 0x04}, {0x00, 0x00, 0x11, 0x11, 0x15, 0x15, 0x0a},
    {0x00, 0x00, 0x11, 0x0a, 0x04, 0x0a, 0x11}, {0x00, 0x00, 0x11, 0x11, 0x0f, 0x01, 0x0e},
    {0x00, 0x00, 0x1f, 0x02, 0x04, 0x08, 0x1f}, {0x02, 0x04, 0x04, 0x08, 0x04, 0x04, 0x02},
    {0x04, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}, {0x08, 0x04, 0x04, 0x02, 0x04, 0x04, 0x08},
    {0x00, 0x08, 0x15, 0x02, 0x00, 0x00, 0x00}};

/// Whether a dot of the 5 x 7 raster font is set; false outside of a glyph and for characters beyond ASCII.
bool glyph_dot(char character, int column, int row) noexcept {
  if (character < ' ' || character > '~' || column < 0 || column > 4 || row < 0 || row > 6) return false;
  return k_glyphs[character - ' '][row] >> (4 - column) & 1;
}

constexpr const char* k_no_raster =
    "it is a raster of texels, which a shader would need as a picture; write its channels";

/// A grid of values over the unit square.
struct Grid {
  int width = 1, height = 1;
  std::vector<double> values = {0};
  bool repeat = true;

  double at(int x, int y) const {
    if (repeat) {
      x = ((x % width) + width) % width;
      y = ((y % height) + height) % height;
    } else {
      x = std::clamp(x, 0, width - 1);
      y = std::clamp(y, 0, height - 1);
    }
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  /// Interpolation: 0 nearest, 1 linear, 2 cubic (Catmull and Rom).
  double sample(double u, double v, int interpolation) const {
    const double x = std::clamp(u, -1e6, 1e6) * width - 0.5, y = std::clamp(v, -1e6, 1e6) * height - 0.5;
    if (interpolation == 0) return at(static_cast<int>(std::floor(x + 0.5)), static_cast<int>(std::floor(y + 0.5)));
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const double tx = x - ix, ty = y - iy;
    if (interpolation == 1) {
      const double top = at(ix, iy) + tx * (at(ix + 1, iy) - at(ix, iy)),
                   bottom = at(ix, iy + 1) + tx * (at(ix + 1, iy + 1) - at(ix, iy + 1));
      return top + ty * (bottom - top);
    }
    const auto cubic = [](double a, double b, double c, double d, double t) {
      return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
    };
    double rows[4];
    for (int k = 0; k < 4; ++k)
      rows[k] = cubic(at(ix - 1, iy + k - 1), at(ix, iy + k - 1), at(ix + 1, iy + k - 1), at(ix + 2, iy + k - 1), tx);
    return cubic(rows[0], rows[1], rows[2], rows[3], ty);
  }
  void blur(int passes) {
    for (int pass = 0; pass < passes; ++pass) {
      Grid soft = *this;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          double sum = 0;
          for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) sum += at(x + i, y + j);
          soft.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
              sum / 9;
        }
      values = std::move(soft.values);
    }
  }
};

/// A picture in the parts that an image shows: its grey, or its three colours.
std::vector<Grid> rendered(const Graph& graph, int node, int width, int height, bool in_colour) {
  std::vector<Grid> parts(in_colour ? 3 : 1);
  for (Grid& part : parts) {
    part.width = width, part.height = height;
    part.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  Evaluator evaluator(graph);
  const auto values = std::make_unique<ChannelRows>();
  double x[k_row], y[k_row];
  for (int row = 0; row < height; ++row)
    for (int first = 0; first < width; first += k_row) {
      Block block;
      block.n = std::min(k_row, width - first);
      for (int i = 0; i < block.n; ++i) x[i] = (first + i + 0.5) / width, y[i] = (row + 0.5) / height;
      block.x = x, block.y = y, block.texel = 1.0 / width;
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row) * width + first;
      if (!in_colour) {
        evaluator.main_value(node, block, parts[0].values.data() + at);
        continue;
      }
      evaluator.channels(node, block, 1U << static_cast<unsigned>(Channel::color), *values);
      for (std::size_t k = 0; k < 3; ++k)
        std::copy_n(values->row[static_cast<std::size_t>(Channel::color) + k], block.n, parts[k].values.data() + at);
    }
  return parts;
}

std::vector<Grid> read_parts(const RecipePicture& picture, bool in_colour) {
  std::vector<Grid> parts(in_colour ? 3 : 1);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].width = picture.width, parts[k].height = picture.height;
    parts[k].values.resize(picture.rgb.size() / 3);
    for (std::size_t i = 0; i < parts[k].values.size(); ++i)
      parts[k].values[i] =
          static_cast<double>(in_colour ? picture.rgb[3 * i + k]
                                        : 0.2126F * picture.rgb[3 * i] + 0.7152F * picture.rgb[3 * i + 1] +
                                              0.0722F * picture.rgb[3 * i + 2]);
  }
  return parts;
}

class Image final : public Pattern {
 public:
  explicit Image(TypeArguments& arguments)
      : in_colour_(!arguments.flag("calcheight")), interpolation_(arguments.integer("ipol")) {
    const std::string path = arguments.text("picpath");
    const std::vector<int> base = arguments.textures("basetexture");
    if (!path.empty()) {
      parts_ = read_parts(arguments.picture(path), in_colour_);
    } else if (!base.empty()) {
      if (arguments.graph().nodes[static_cast<std::size_t>(base[0])]->uses_near)
        arguments.refuse("basetexture", "neighbourhoods are not known in a texture that is rendered once");
      const bool fit = arguments.flag("fit2screen");
      const int side = std::clamp(static_cast<int>(arguments.target_px() * arguments.number("fit2screenratio")),
                                  k_least_side, k_most_side);
      parts_ = rendered(arguments.graph(), base[0], fit ? side : arguments.integer("width"),
                        fit ? side : arguments.integer("height"), in_colour_);
    } else {
      parts_.resize(in_colour_ ? 3 : 1);
    }
    for (Grid& part : parts_) {
      part.repeat = arguments.flag("repeat") || arguments.flag("seamless");
      part.blur(arguments.integer("blur"));
    }
  }

  unsigned given_channels() const override { return in_colour_ ? 1U << static_cast<unsigned>(Channel::color) : 0; }
  void evaluate(const PatternRow& row) const override { sample(row, parts_[0], row.out); }
  void write_shader(PatternShader& shader) const override { shader.refuse(k_no_raster); }
  void channels(const PatternRow& row, ChannelRows& out) const override {
    for (auto& values : out.row) std::fill_n(values, row.n, 0.0);
    for (std::size_t k = 0; k < 3; ++k) sample(row, parts_[k], out.row[static_cast<std::size_t>(Channel::color) + k]);
  }

 private:
  static constexpr int k_least_side = 16, k_most_side = 4096;

  void sample(const PatternRow& row, const Grid& part, double* out) const {
    for (int i = 0; i < row.n; ++i)
      out[i] = part.sample(row.x[i] * fitted(1, row.period_x), row.y[i] * fitted(1, row.period_y), interpolation_);
  }

  bool in_colour_;
  int interpolation_;
  std::vector<Grid> parts_;
};

/// x' = a x + b y + e, y' = c x + d y + f, chosen with probability p.
struct AffineMap {
  std::array<double, 7> v{};
};
using System = std::vector<AffineMap>;

System preset(int style) {
  switch (style % 8) {
    case 0:
      return {{{0, 0, 0, .16, 0, 0, .01}},
              {{.2, -.26, .23, .22, 0, 1.6, .07}},
              {{-.15, .28, .26, .24, 0, .44, .07}},
              {{.85, .04, -.04, .85, 0, 1.6, .85}}};
    case 1: return {{{.5, 0, 0, .5, 0, 0, .33}}, {{.5, 0, 0, .5, .5, 0, .33}}, {{.5, 0, 0, .5, .25, .433, .34}}};
    case 2: return {{{.5, -.5, .5, .5, 0, 0, .5}}, {{-.5, -.5, .5, -.5, 1, 0, .5}}};
    case 3:
      return {{{.14, .01, 0, .51, -.08, -1.31, .1}},
              {{.43, .52, -.45, .5, 1.49, -.75, .35}},
              {{.45, -.49, .47, .47, -1.62, -.74, .35}},
              {{.49, 0, 0, .51, .02, 1.62, .2}}};
    case 4:
      return {{{0, 0, 0, .5, 0, 0, .05}},
              {{.42, -.42, .42, .42, 0, .2, .4}},
              {{.42, .42, -.42, .42, 0, .2, .4}},
              {{.1, 0, 0, .1, 0, .2, .15}}};
    case 5:
      return {{{.787879, -.424242, .242424, .859848, 1.758647, 1.408065, .9}},
              {{-.121212, .257576, .151515, .05303, -6.721654, 1.377236, .05}},
              {{.181818, -.136364, .090909, .181818, 6.086107, 1.568035, .05}}};
    case 6:
      return {{{.333, 0, 0, .333, 0, 0, .25}},
              {{.333, 0, 0, .333, .667, 0, .25}},
              {{.333, 0, 0, .333, 0, .667, .25}},
              {{.5, 0, 0, .5, .25, .25, .25}}};
    default:
      return {{{.255, 0, 0, .255, .3726, .6714, .2}},
              {{.255, 0, 0, .255, .1146, .2232, .2}},
              {{.255, 0, 0, .255, .6306, .2232, .2}},
              {{.37, -.642, .642, .37, .6356, -.0061, .4}}};
  }
}

System own_system(TypeArguments& arguments) {
  System system;
  for (const char* name : {"one", "two", "three", "four"}) {
    const std::vector<double> v = numbers_of(arguments, name);
    if (v.empty()) continue;
    if (v.size() != 7) arguments.refuse(name, "expected seven numbers a b c d e f p");
    AffineMap map;
    std::copy(v.begin(), v.end(), map.v.begin());
    system.push_back(map);
  }
  if (system.empty()) arguments.refuse("one", "usestyle=false needs at least one map");
  return system;
}

/// The attractor by the chaos game [Barnsley 1988]: logarithm of the number of visits, 0 to 1.
Grid chaos_game(const System& system, int points_k, double size, const std::vector<double>& part, std::uint32_t seed) {
  constexpr int k_cells_a_side = 256;
  const auto game = [&](int count, auto&& visit) {
    double x = 0, y = 0, total = 0;
    for (const AffineMap& map : system) total += std::max(0.0, map.v[6]);
    for (int k = 0; k < count; ++k) {
      double choice = unit_number(mix_bits(static_cast<std::uint32_t>(k), 9, seed)) * total;
      std::size_t m = 0;
      while (m + 1 < system.size() && choice >= system[m].v[6]) choice -= system[m++].v[6];
      const auto& v = system[m].v;
      const double nx = v[0] * x + v[1] * y + v[4], ny = v[2] * x + v[3] * y + v[5];
      x = std::clamp(nx, -1e6, 1e6), y = std::clamp(ny, -1e6, 1e6);
      if (k > 20) visit(x, y);
    }
  };
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  game(5000, [&](double x, double y) {
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  });
  if (part.size() == 4) x0 = part[0], y0 = part[1], x1 = part[0] + part[2], y1 = part[1] + part[3];
  const double side = std::max({x1 - x0, y1 - y0, 1e-9}) * 1.04 / size, cx = (x0 + x1) / 2, cy = (y0 + y1) / 2;
  Grid grid;
  grid.width = grid.height = k_cells_a_side, grid.repeat = false;
  grid.values.assign(static_cast<std::size_t>(k_cells_a_side) * k_cells_a_side, 0);
  game(points_k * 1000, [&](double x, double y) {
    const double gx = ((x - cx) / side + 0.5) * k_cells_a_side, gy = (0.5 - (y - cy) / side) * k_cells_a_side;
    if (gx >= 0 && gy >= 0 && gx < k_cells_a_side && gy < k_cells_a_side)
      ++grid.values[static_cast<std::size_t>(gy) * k_cells_a_side + static_cast<std::size_t>(gx)];
  });
  double most = 1;
  for (const double v : grid.values) most = std::max(most, v);
  for (double& v : grid.values) v = std::log1p(v) / std::log1p(most);
  return grid;
}

std::unique_ptr<Pattern> make_ifs(TypeArguments& arguments) {
  System system = arguments.flag("usestyle") ? preset(arguments.integer("style")) : own_system(arguments);
  const Program mix = arguments.formula("ipolfunc");
  if (mix.present) {
    if (!mix.constant) arguments.refuse("ipolfunc", "the share must be the same at every point");
    const double t = std::clamp(mix.value[0], 0.0, 1.0);
    System other = preset(arguments.integer("ipolfuncindex"));
    const std::size_t count = std::max(system.size(), other.size());
    system.resize(count, system.back());
    other.resize(count, other.back());
    for (std::size_t m = 0; m < count; ++m)
      for (std::size_t k = 0; k < 7; ++k) system[m].v[k] += t * (other[m].v[k] - system[m].v[k]);
  }
  Grid grid = chaos_game(system, arguments.integer("kilon"), arguments.number("scalefak"),
                         numbers_of(arguments, "posandscale"), arguments.seed());
  return point_pattern(
      [grid = std::move(grid)](const PatternRow& row, int i) {
        const double x = row.x[i], y = row.y[i];
        return x < 0 || y < 0 || x > 1 || y > 1 ? 0.0 : grid.sample(x, y, 1);
      },
      [](PatternShader& shader) { shader.refuse(k_no_raster); });
}

std::unique_ptr<Pattern> make_text(TypeArguments& arguments) {
  constexpr std::size_t k_most_characters = 4096;
  const std::string text = arguments.text("txt");
  if (text.size() > k_most_characters) arguments.refuse("txt", "at most 4096 characters are written");
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == 'n')
      lines.emplace_back(), ++i;
    else
      lines.back() += text[i];
  }
  std::size_t longest = 1;
  for (const std::string& line : lines) longest = std::max(longest, line.size());
  const int modifier = arguments.integer("modifier");
  const bool bold = modifier == 1 || modifier == 3, slanted = modifier >= 2, centre = arguments.flag("centerx");
  const double line_height = 9 * arguments.number("spacingy"), border_x = arguments.number("borderx"),
               border_y = arguments.number("bordery");
  const double wide = 6.0 * static_cast<double>(longest), high = line_height * static_cast<double>(lines.size());
  const double scale = std::max(wide / (1 - 2 * border_x), high / (1 - 2 * border_y));  // Dots a unit.
  const std::vector<int> fill = arguments.textures("texture");
  const auto dot = [lines, longest, line_height, bold, slanted, centre](double px, double py) {
    const double line = std::floor(py / line_height);
    if (line < 0 || line >= static_cast<double>(lines.size())) return false;
    const std::string& words = lines[static_cast<std::size_t>(line)];
    const double y = py - line * line_height - 1;
    double x = px - (centre ? 3.0 * static_cast<double>(longest - words.size()) : 0);
    if (slanted) x -= (3.5 - y) * 0.25;
    const auto set = [&](double at) {
      const double place = std::floor(at / 6);
      if (place < 0 || place >= static_cast<double>(words.size())) return false;
      return glyph_dot(words[static_cast<std::size_t>(place)], static_cast<int>(std::floor(at - place * 6)),
                       static_cast<int>(std::floor(y)));
    };
    return set(x) || (bold && set(x - 0.5));
  };
  return row_pattern(
      [=](const PatternRow& row) {
        double inside[k_row];
        if (!fill.empty()) {
          Block block = *row.block;
          block.x = row.x, block.y = row.y, block.texel = row.texel;
          row.evaluator->main_value(fill[0], block, inside);
        }
        for (int i = 0; i < row.n; ++i) {
          double x = row.x[i], y = row.y[i];
          if (row.period_x > 0)
            x *= fitted(1, row.period_x), y *= fitted(1, row.period_y), x -= std::floor(x), y -= std::floor(y);
          int hits = 0;
          for (int k = 0; k < 4; ++k) {  // Four samples over a texel.
            const double sx = x + ((k & 1) - 0.5) * 0.5 * row.texel, sy = y + ((k >> 1) - 0.5) * 0.5 * row.texel;
            hits += dot((sx - 0.5) * scale + wide / 2, (sy - 0.5) * scale + high / 2) ? 1 : 0;
          }
          row.out[i] = hits / 4.0 * (fill.empty() ? 1 : inside[i]);
        }
      },
      [](PatternShader& shader) { shader.refuse(k_no_raster); });
}

}  // namespace

std::unique_ptr<Pattern> make_picture_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "image") return std::make_unique<Image>(arguments);
  if (type == "ifs") return make_ifs(arguments);
  if (type == "txt") return make_text(arguments);
  return nullptr;
}

}  // namespace papilla::procedural_detail
