// SPDX-License-Identifier: MIT
#include "evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace papilla::procedural_detail {
namespace {

constexpr double k_zeros[k_row] = {};
constexpr std::size_t at(Channel c) { return static_cast<std::size_t>(c); }
constexpr unsigned bit(Channel c) { return 1U << static_cast<unsigned>(c); }
constexpr std::size_t k_red = at(Channel::color);

double finite(double v) { return std::isfinite(v) ? v : 0; }

void tidy(double* row, int n) {
  for (int i = 0; i < n; ++i) row[i] = finite(row[i]);
}

/// c <- rule(c, x) with cover alpha.
void blend_row(Blend rule, double* c, const double* x, const double* alpha, int n) {
  switch (rule) {
    case Blend::off: break;
    case Blend::interpolate:
      for (int i = 0; i < n; ++i) c[i] += alpha[i] * (x[i] - c[i]);
      break;
    case Blend::add:
      for (int i = 0; i < n; ++i) c[i] += alpha[i] * x[i];
      break;
    case Blend::subtract:
      for (int i = 0; i < n; ++i) c[i] -= alpha[i] * x[i];
      break;
  }
}

/// What two layers cover together: alpha for all, alpha times coloralpha for the colour.
void cover_row(double* alpha, double* coloralpha, const double* top, const double* top_colour, int n) {
  for (int i = 0; i < n; ++i) {
    const double of_colour = alpha[i] * coloralpha[i];
    alpha[i] += top[i] * (1 - alpha[i]);
    coloralpha[i] = alpha[i] > 0 ? (of_colour + top_colour[i] * (1 - of_colour)) / alpha[i] : 0;
  }
}

}  // namespace

void Pattern::channels(const PatternRow&, ChannelRows&) const {}

/// Rows of one texture.
struct Evaluator::Frame {
  std::vector<double> rows = std::vector<double>(static_cast<std::size_t>(k_frame_rows) * k_row);
  std::vector<double> registers;
  std::unique_ptr<ChannelRows> layered;  ///< Of a multitexture: what its layers gave.
  double texel = 0, extent_x = 1, extent_y = 1;
  double* row(FrameRow r) { return rows.data() + static_cast<std::size_t>(r) * k_row; }
  const double* row(FrameRow r) const { return rows.data() + static_cast<std::size_t>(r) * k_row; }
  double* info(int i) { return row(FrameRow::info0) + i * k_row; }
  double* reg(int i) { return registers.data() + static_cast<std::size_t>(i) * k_row; }
};

Evaluator::Evaluator(const Graph& graph) : graph_(graph), frames_(graph.nodes.size()) {
  constants_.reserve(graph.constants.size() * k_row);
  for (const double value : graph.constants) constants_.insert(constants_.end(), k_row, value);
}

Evaluator::~Evaluator() = default;

Evaluator::Frame& Evaluator::frame_of(int node) {
  auto& frame = frames_[static_cast<std::size_t>(node)];
  if (!frame) frame = std::make_unique<Frame>();
  return *frame;
}

const double* Evaluator::operand(const Operand& o, const Frame& frame, const Block& block) const {
  const auto offset = static_cast<std::size_t>(o.index) * k_row;
  switch (o.where) {
    case Operand::Where::reg: return frame.registers.data() + offset;
    case Operand::Where::constant: return constants_.data() + offset;
    case Operand::Where::frame: return frame.rows.data() + offset;
    case Operand::Where::block: break;
  }
  const double* row = block.rows[static_cast<std::size_t>(o.index)];
  return row ? row : k_zeros;
}

void Evaluator::step(const Instruction& code, int index, Frame& frame, const Block& block) {
  std::array<const double*, k_most_arguments> in{};
  for (int k = 0; k < code.arguments; ++k)
    in[static_cast<std::size_t>(k)] = operand(code.in[static_cast<std::size_t>(k)], frame, block);
  double* out = frame.reg(code.out);
  double *u = frame.row(FrameRow::u), *v = frame.row(FrameRow::v);
  const int n = block.n;
  switch (code.action) {
    case Action::kernel: code.kernel(out, in.data(), n); break;
    case Action::set_info:
      for (int i = 0; i < n; ++i) frame.info(code.index)[i] = finite(in[0][i]);
      std::fill_n(out, n, 1.0);
      break;
    case Action::neighbourhood:
      if (block.near)
        block.near->evaluate(code.index, block.texels, n, frame.texel, in[0], out);
      else
        without_neighbours(graph_.near[static_cast<std::size_t>(code.index)].kind, in[0], n, out);
      break;
    case Action::rotate:
      for (int i = 0; i < n; ++i) {
        const double c = std::cos(finite(in[2][i])), s = std::sin(finite(in[2][i])), dx = u[i] - in[0][i],
                     dy = v[i] - in[1][i];
        u[i] = finite(in[0][i] + c * dx - s * dy);
        v[i] = finite(in[1][i] + s * dx + c * dy);
      }
      std::fill_n(out, n, 0.0);
      break;
    case Action::zoom:
      for (int i = 0; i < n; ++i) {
        u[i] = finite(in[0][i] + (u[i] - in[0][i]) * in[2][i]);
        v[i] = finite(in[1][i] + (v[i] - in[1][i]) * in[2][i]);
      }
      std::fill_n(out, n, 0.0);
      break;
    case Action::sphere:
      for (int i = 0; i < n; ++i) {
        const double dx = u[i] - in[0][i], dy = v[i] - in[1][i], r2 = std::min(1.0, 4 * (dx * dx + dy * dy));
        const double bulge = 1 / (1 + std::sqrt(1 - r2));
        u[i] = finite(in[0][i] + 2 * dx * bulge);
        v[i] = finite(in[1][i] + 2 * dy * bulge);
      }
      std::fill_n(out, n, 0.0);
      break;
    case Action::colmap: {
      const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
      const double steps = static_cast<double>(node.colours.size()) - 1;
      for (int i = 0; i < n; ++i) {
        const double place = std::clamp(finite(in[0][i]), 0.0, 1.0) * steps;
        const auto first = static_cast<std::size_t>(std::min(std::floor(place), std::max(0.0, steps - 1)));
        const std::size_t second = std::min(first + 1, node.colours.size() - 1);
        const double t = place - static_cast<double>(first);
        for (std::size_t k = 0; k < 3; ++k)
          out[k * k_row + static_cast<std::size_t>(i)] =
              node.colours[first][k] + t * (node.colours[second][k] - node.colours[first][k]);
      }
      break;
    }
    case Action::texture: {
      Block inner = block;
      inner.x = u, inner.y = v, inner.texel = frame.texel, inner.extent_x = frame.extent_x,
      inner.extent_y = frame.extent_y;
      main_value(code.index, inner, out);
      break;
    }
    case Action::texture_color:
    case Action::texmap_color:
    case Action::texmap_channel: {
      const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
      Block inner = block;
      inner.x = u, inner.y = v, inner.texel = frame.texel, inner.extent_x = frame.extent_x,
      inner.extent_y = frame.extent_y;
      auto values = std::make_unique<ChannelRows>();
      if (code.action == Action::texture_color) {
        channels(node.textures[static_cast<std::size_t>(code.index)], inner, bit(Channel::color), *values);
      } else {
        const Channel c = code.action == Action::texmap_color ? Channel::color : static_cast<Channel>(code.index);
        texmap(node, in[0], inner, bit(c), *values);
      }
      if (code.action == Action::texmap_channel)
        std::copy_n(values->row[code.index], n, out);
      else
        for (std::size_t k = 0; k < 3; ++k) std::copy_n(values->row[k_red + k], n, out + k * k_row);
      break;
    }
  }
}

void Evaluator::run(const Program& program, int node, Frame& frame, const Block& block, double* const* out) {
  const int parts = program.colour ? 3 : 1;
  if (program.constant) {
    for (int k = 0; k < parts; ++k) std::fill_n(out[k], block.n, program.value[static_cast<std::size_t>(k)]);
    return;
  }
  const auto needed = static_cast<std::size_t>(program.registers) * k_row;
  if (frame.registers.size() < needed) frame.registers.resize(needed);
  for (const Instruction& code : program.code) step(code, node, frame, block);
  for (int k = 0; k < parts; ++k) {
    const double* result = operand(program.result[static_cast<std::size_t>(k)], frame, block);
    for (int i = 0; i < block.n; ++i) out[k][i] = finite(result[i]);
  }
}

void Evaluator::run_on_distances(const Program& program, const double* const* f, int count, int n, double* out) {
  if (!scratch_) scratch_ = std::make_unique<Frame>();
  Frame& frame = *scratch_;
  for (int k = 0; k < count; ++k) std::copy_n(f[k], n, frame.row(FrameRow::f1) + k * k_row);
  Block block;
  block.n = n;
  run(program, graph_.root, frame, block, &out);
}

/// Place, information and the formulas that come before the pattern.
void Evaluator::prepare(int index, Frame& frame, const Block& block) {
  const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
  const int n = block.n;
  double *u = frame.row(FrameRow::u), *v = frame.row(FrameRow::v);
  for (int i = 0; i < n; ++i) {
    double x = block.x[i], y = block.y[i];
    if (node.sin_rot != 0) {
      const double dx = x - 0.5, dy = y - 0.5;
      x = 0.5 + node.cos_rot * dx - node.sin_rot * dy;
      y = 0.5 + node.sin_rot * dx + node.cos_rot * dy;
    }
    u[i] = finite(x * node.inverse_scale_x + node.du);
    v[i] = finite(y * node.inverse_scale_y + node.dv);
  }
  frame.texel = block.texel * std::max(std::abs(node.inverse_scale_x), std::abs(node.inverse_scale_y));
  frame.extent_x = block.extent_x * std::abs(node.inverse_scale_x);
  frame.extent_y = block.extent_y * std::abs(node.inverse_scale_y);
  if (node.seamless) {
    for (int i = 0; i < n; ++i) {
      u[i] -= frame.extent_x * std::floor(u[i] / frame.extent_x);
      v[i] -= frame.extent_y * std::floor(v[i] / frame.extent_y);
    }
    tidy(u, n);
    tidy(v, n);
  }
  if (node.uses_infos)
    std::fill(frame.rows.begin() + static_cast<std::ptrdiff_t>(FrameRow::info0) * k_row, frame.rows.end(), 0.0);
  std::fill_n(frame.row(FrameRow::id), n, 0.0);
  if (node.uses_normal) {
    double* dot = frame.row(FrameRow::normaldot);
    for (int i = 0; i < n; ++i) {
      const float* normal = block.normals ? block.normals + 3 * i : nullptr;
      dot[i] = 0;
      for (std::size_t k = 0; k < 3; ++k)
        dot[i] -= node.dirt[k] * (normal ? static_cast<double>(normal[k]) : node.normal[k]);
      dot[i] = finite(dot[i]);
    }
  }
  const auto formula = [&](const Program& program, FrameRow row) {
    double* out = frame.row(row);
    if (program.present)
      run(program, index, frame, block, &out);
    else
      std::fill_n(out, n, 0.0);
  };
  formula(node.a, FrameRow::a);
  formula(node.b, FrameRow::b);
  double moved[2][k_row];
  double* target[2] = {moved[0], moved[1]};
  if (node.perturb_x.present) run(node.perturb_x, index, frame, block, &target[0]);
  if (node.perturb_y.present) run(node.perturb_y, index, frame, block, &target[1]);
  if (node.perturb_x.present) std::copy_n(moved[0], n, u);
  if (node.perturb_y.present) std::copy_n(moved[1], n, v);
}

void Evaluator::pattern_and_main(int index, Frame& frame, const Block& block) {
  const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
  double* self = frame.row(FrameRow::self);
  if (node.layered && !frame.layered) frame.layered = std::make_unique<ChannelRows>();
  if (node.multi) {
    layers(index, frame, block, *frame.layered);
  } else if (node.pattern) {
    PatternRow row;
    row.n = block.n, row.x = frame.row(FrameRow::u), row.y = frame.row(FrameRow::v), row.out = self;
    row.id = frame.row(FrameRow::id), row.info = frame.row(FrameRow::info0), row.texel = frame.texel;
    if (node.seamless && node.type->seamless != Seamless::four_corner)
      row.period_x = frame.extent_x, row.period_y = frame.extent_y;
    row.block = &block, row.evaluator = this;
    if (node.layered) {
      node.pattern->channels(row, *frame.layered);
      for (auto& channel : frame.layered->row) tidy(channel, block.n);
    } else {
      node.pattern->evaluate(row);
      tidy(self, block.n);
    }
  } else {
    std::fill_n(self, block.n, 0.0);
  }
  if (node.layered) std::copy_n(frame.layered->row[at(Channel::main)], block.n, self);
  double* main = frame.row(FrameRow::main);
  std::copy_n(self, block.n, main);
  run(node.main, index, frame, block, &main);
}

/// tileable(x, y) = sum over the four corners of value(x - i w, y - j h) times its share of the rectangle.
void Evaluator::blended_corners(int index, Frame& frame, const Block& block, double width, double height) {
  const int n = block.n;
  double x[k_row], y[k_row], sum[k_row] = {};
  double *u = frame.row(FrameRow::u), *v = frame.row(FrameRow::v);
  std::copy_n(u, n, x);
  std::copy_n(v, n, y);
  for (int corner = 3; corner >= 0; --corner) {
    const int across = corner & 1, down = corner >> 1;
    for (int i = 0; i < n; ++i) u[i] = x[i] - across * width, v[i] = y[i] - down * height;
    pattern_and_main(index, frame, block);
    for (int i = 0; i < n; ++i) {
      const double s = x[i] / width, t = y[i] / height;
      sum[i] += frame.row(FrameRow::main)[i] * (across ? s : 1 - s) * (down ? t : 1 - t);
    }
  }
  std::copy_n(sum, n, frame.row(FrameRow::main));
  std::copy_n(x, n, u);
  std::copy_n(y, n, v);
}

void Evaluator::finish_main(const Node& node, Frame& frame, int n) {
  double* main = frame.row(FrameRow::main);
  for (int i = 0; i < n; ++i) {
    double value = node.absolute ? std::abs(main[i]) : main[i];
    if (node.invert) value = 1 - value;
    value = std::min(std::max(value, node.limit_low), node.limit_high);
    main[i] = finite(value * node.intensity + node.add);
  }
}

void Evaluator::main_value(int index, const Block& block, double* out) {
  const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
  Frame& frame = frame_of(index);
  prepare(index, frame, block);
  if (node.seamless && node.type->seamless == Seamless::four_corner)
    blended_corners(index, frame, block, frame.extent_x, frame.extent_y);
  else
    pattern_and_main(index, frame, block);
  finish_main(node, frame, block.n);
  if (out) std::copy_n(frame.row(FrameRow::main), block.n, out);
}

void Evaluator::channels(int index, const Block& block, unsigned mask, ChannelRows& out) {
  const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
  const int n = block.n;
  Frame& frame = frame_of(index);
  main_value(index, block, nullptr);
  std::copy_n(frame.row(FrameRow::main), n, out.row[at(Channel::main)]);
  const ChannelRows* below = frame.layered.get();
  if ((mask & bit(Channel::roughness)) && node.own_highlight)
    mask |= bit(Channel::specular) | bit(Channel::specularcoeff);
  for (std::size_t c = 1; c < k_channels; ++c) {
    if (!(mask >> c & 1U)) continue;
    if (c == at(Channel::roughness) && node.own_highlight) {
      for (int i = 0; i < n; ++i)
        out.row[c][i] =
            roughness_of_highlight(out.row[at(Channel::specular)][i], out.row[at(Channel::specularcoeff)][i]);
      continue;
    }
    const int parts = c == k_red ? 3 : 1;
    double* rows[3] = {out.row[c], out.row[c + (parts > 1 ? 1 : 0)], out.row[c + (parts > 2 ? 2 : 0)]};
    const Program& program = node.channels[c];
    const bool from_below = node.layered >> c & 1U;
    if (!from_below || program.present || c == at(Channel::alpha))
      run(program, index, frame, block, rows);
    else
      for (int k = 0; k < parts; ++k)
        for (int i = 0; i < n; ++i) rows[k][i] = below->row[c + static_cast<std::size_t>(k)][i] * node.channel_scale[c];
    if (from_below && c == at(Channel::alpha))
      for (int i = 0; i < n; ++i) rows[0][i] *= below->row[c][i] * node.channel_scale[c];
    if (c == at(Channel::alpha) || c == at(Channel::coloralpha) || c == at(Channel::roughness) || c == k_red)
      for (int k = 0; k < parts; ++k)
        for (int i = 0; i < n; ++i) rows[k][i] = std::clamp(rows[k][i], 0.0, 1.0);
  }
}

void Evaluator::layers(int index, Frame& frame, const Block& block, ChannelRows& out) {
  const Node& node = *graph_.nodes[static_cast<std::size_t>(index)];
  const int n = block.n;
  double u[k_row], v[k_row];
  std::copy_n(frame.row(FrameRow::u), n, u);
  std::copy_n(frame.row(FrameRow::v), n, v);
  Block inner = block;
  inner.x = u, inner.y = v, inner.texel = frame.texel, inner.extent_x = frame.extent_x, inner.extent_y = frame.extent_y;
  // Layers may read any channel below them, so all are there.
  for (std::size_t c = 0; c < k_channels + 2; ++c) std::fill_n(out.row[c], n, 0.0);
  auto layer = std::make_unique<ChannelRows>();
  for (std::size_t k = 0; k < node.textures.size(); ++k) {
    const Node& top = *graph_.nodes[static_cast<std::size_t>(node.textures[k])];
    channels(node.textures[k], inner, k_all_channels, k == 0 ? out : *layer);
    if (k > 0 && top.cuts) {
      for (int i = 0; i < n; ++i) out.row[at(Channel::alpha)][i] *= 1 - layer->row[at(Channel::alpha)][i];
    } else if (k > 0) {
      const double* alpha = layer->row[at(Channel::alpha)];
      double cover[k_row];
      for (int i = 0; i < n; ++i) cover[i] = alpha[i] * layer->row[at(Channel::coloralpha)][i];
      for (std::size_t c = 0; c < k_channels + 2; ++c) {
        const std::size_t channel = std::min(c, k_red);
        if (channel == at(Channel::alpha) || channel == at(Channel::coloralpha)) continue;
        blend_row(top.blend[channel], out.row[c], layer->row[c], channel == k_red ? cover : alpha, n);
      }
      cover_row(out.row[at(Channel::alpha)], out.row[at(Channel::coloralpha)], alpha, cover, n);
    }
    for (std::size_t c = 0; c < k_channels + 2; ++c)
      inner.rows[static_cast<std::size_t>(BlockRow::lower_main) + c] = out.row[c];
  }
  for (std::size_t c = 0; c < k_channels + 2; ++c) tidy(out.row[c], n);
}

/// Mixes the channels of the node's textures by their ranges and fades at the given place in [0, 1].
void Evaluator::texmap(const Node& node, const double* place, const Block& block, unsigned mask, ChannelRows& out) {
  const int n = block.n;
  double at_place[k_row];
  for (int i = 0; i < n; ++i) at_place[i] = std::clamp(finite(place[i]), 0.0, 1.0);
  for (std::size_t c = 0; c < k_channels + 2; ++c) std::fill_n(out.row[c], n, 0.0);
  double total = 0;
  for (std::size_t k = 0; k < node.textures.size(); ++k)
    total += node.ranges[k] + (k + 1 < node.textures.size() ? node.fades[k] : 0);
  if (!(total > 0)) total = 1;
  double start = 0;
  auto part = std::make_unique<ChannelRows>();
  for (std::size_t k = 0; k < node.textures.size(); ++k) {
    const double end = start + node.ranges[k] / total;
    const double before = k > 0 ? node.fades[k - 1] / total : 0,
                 after = k + 1 < node.textures.size() ? node.fades[k] / total : 0;
    channels(node.textures[k], block, mask, *part);
    for (int i = 0; i < n; ++i) {
      const double p = at_place[i];
      double weight = 1;
      if (p < start && k > 0) weight = before > 0 ? std::max(0.0, 1 - (start - p) / before) : 0;
      if (p > end && k + 1 < node.textures.size()) weight = after > 0 ? std::max(0.0, 1 - (p - end) / after) : 0;
      if (weight == 0) continue;
      for (std::size_t c = 0; c < k_channels + 2; ++c)
        if (mask >> std::min(c, k_red) & 1U) out.row[c][i] += weight * part->row[c][i];
    }
    start = end + after;
  }
}

}  // namespace papilla::procedural_detail
