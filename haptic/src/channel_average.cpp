// SPDX-License-Identifier: MIT
#include "papilla/haptic/channel_average.hpp"

#include <algorithm>
#include <cmath>

#include "texels.hpp"

namespace papilla {
namespace {

/// Means of the 2·reach + 1 samples around each of a line of texels, `step` apart. @param copy scratch.
void average_line(ChannelField::Texel* line, long size, long step, long reach, Wrap wrap,
                  std::vector<ChannelField::Texel>& copy) {
  const long count = 2 * reach + 1;
  copy.resize(static_cast<std::size_t>(size + count));
  for (long i = 0; i < size + count; ++i)
    copy[static_cast<std::size_t>(i)] = line[wrapped(i - reach, size, wrap) * step];
  for (std::size_t c = 0; c < copy.front().size(); ++c) {
    const ChannelField::Texel* at = copy.data();
    long sum = 0;
    for (long i = 0; i < count; ++i) sum += at[i][c];
    for (long i = 0; i < size; ++i, ++at) {
      line[i * step][c] = static_cast<std::uint16_t>((sum + reach) / count);
      sum += at[count][c] - at[0][c];
    }
  }
}

}  // namespace

std::vector<ChannelField::Texel> average_texels(std::vector<ChannelField::Texel> samples, int width, int height,
                                                const UvTransform& transform, const std::array<Wrap, 2>& wrap,
                                                double radius_m, Vec2 metres_per_uv) {
  const std::array<Vec2, 2> rows = transform.rows(width, height);
  const std::array<long, 2> size{width, height}, step{1, width};
  const std::array<double, 2> metres{metres_per_uv.x, metres_per_uv.y};
  std::vector<ChannelField::Texel> copy;
  for (const std::size_t axis : {0U, 1U}) {
    if (!(metres[axis] > 0) || !(radius_m > 0)) continue;
    const double texels = radius_m * norm(rows[axis]) / metres[axis];
    const long reach = std::lround(std::min(texels, 0.5 * static_cast<double>(size[axis])));
    for (long line = 0; line < size[1 - axis] && reach > 0; ++line)
      average_line(&samples[static_cast<std::size_t>(line * step[1 - axis])], size[axis], step[axis], reach, wrap[axis],
                   copy);
  }
  return samples;
}

}  // namespace papilla
