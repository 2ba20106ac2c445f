// SPDX-License-Identifier: MIT
#include "papilla/haptic/channel_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"
#include "texels.hpp"

namespace papilla {
namespace {

constexpr double k_white = std::numeric_limits<std::uint16_t>::max();

constexpr std::size_t index_of(Quantity quantity) noexcept { return static_cast<std::size_t>(quantity); }

}  // namespace

std::string_view name_of(Quantity quantity) noexcept {
  constexpr std::string_view k_names[] = {"stiffness", "static_friction", "dynamic_friction", "damping"};
  return k_names[index_of(quantity)];
}

std::optional<Quantity> quantity(std::string_view name) noexcept {
  for (const Quantity known : k_quantities)
    if (name_of(known) == name) return known;
  return std::nullopt;
}

double largest_value(Quantity quantity) noexcept {
  constexpr double k_most[] = {1e7, 100, 100, 1e5};
  return k_most[index_of(quantity)];
}

ChannelField::ChannelField(int width, int height, std::vector<Texel> samples, const ChannelFieldOptions& options)
    : width_(width), height_(height), samples_(std::move(samples)), wrap_(options.wrap) {
  const auto fail = [](const std::string& what) { throw InvalidInput("ChannelField: " + what); };
  if (width <= 0 || height <= 0 ||
      samples_.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    fail(std::to_string(samples_.size()) + " samples are not " + std::to_string(width) + " x " +
         std::to_string(height));
  const UvTransform& t = options.uv_transform;
  for (const double value : {t.offset.x, t.offset.y, t.rotation, t.scale.x, t.scale.y})
    if (!std::isfinite(value)) fail("an option is not finite");
  for (std::size_t c = 0; c < options.channels.size(); ++c) {
    if (!options.channels[c]) continue;
    const MapChannel& channel = *options.channels[c];
    if (!(channel.least() >= 0) || !std::isfinite(channel.most())) fail("a channel can be negative");
    Reading& reading = readings_[index_of(channel.quantity)];
    if (reading.channel >= 0) fail("two channels are " + std::string(name_of(channel.quantity)));
    const auto [low, high] = std::minmax_element(samples_.begin(), samples_.end(),
                                                 [c](const Texel& a, const Texel& b) { return a[c] < b[c]; });
    reading = {static_cast<int>(c), channel.offset, channel.scale / k_white, 0};
    for (const Texel& end : {*low, *high}) reading.most = std::max(reading.most, reading.base + reading.step * end[c]);
  }
  rows_ = t.rows(width, height);
  shift_ = {width * t.offset.x - 0.5, height * t.offset.y - 0.5};
}

Vec2 ChannelField::apply(Vec2 uv, ContactConstants& constants) const noexcept {
  const double x = texel_coordinate(dot(rows_[0], uv) + shift_.x), y = texel_coordinate(dot(rows_[1], uv) + shift_.y);
  const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const auto place = [](double at, long ahead, int size, Wrap wrap) noexcept {
    return static_cast<std::size_t>(wrapped(static_cast<long>(at) + ahead, size, wrap));
  };
  const std::size_t left = place(x0, 0, width_, wrap_[0]), right = place(x0, 1, width_, wrap_[0]);
  const Texel* const top = &samples_[place(y0, 0, height_, wrap_[1]) * static_cast<std::size_t>(width_)];
  const Texel* const bottom = &samples_[place(y0, 1, height_, wrap_[1]) * static_cast<std::size_t>(width_)];
  const auto value = [&](Quantity quantity, double& target) noexcept {
    const Reading& reading = readings_[index_of(quantity)];
    if (reading.channel < 0) return false;
    const auto c = static_cast<std::size_t>(reading.channel);
    const double above = top[left][c] + fx * (top[right][c] - top[left][c]);
    const double below = bottom[left][c] + fx * (bottom[right][c] - bottom[left][c]);
    target = std::max(0.0, reading.base + reading.step * (above + fy * (below - above)));
    return true;
  };
  const double before_static = constants.static_friction, before_dynamic = constants.dynamic_friction;
  const bool has_static = value(Quantity::static_friction, constants.static_friction);
  const bool has_dynamic = value(Quantity::dynamic_friction, constants.dynamic_friction);
  if (has_dynamic && !has_static)
    constants.static_friction *= before_dynamic > 0 ? constants.dynamic_friction / before_dynamic : 0;
  if (has_dynamic && !has_static && !(before_dynamic > 0)) constants.static_friction = constants.dynamic_friction;
  if (has_static && !has_dynamic && before_static > 0)
    constants.dynamic_friction *= constants.static_friction / before_static;
  constants.dynamic_friction = std::min(constants.dynamic_friction, constants.static_friction);
  value(Quantity::damping, constants.damping);
  if (!value(Quantity::stiffness, constants.stiffness)) return {};
  const Reading& reading = readings_[index_of(Quantity::stiffness)];
  const auto c = static_cast<std::size_t>(reading.channel);
  const double across_top = top[right][c] - top[left][c], across_bottom = bottom[right][c] - bottom[left][c];
  const double down_left = bottom[left][c] - top[left][c], down_right = bottom[right][c] - top[right][c];
  const double by_x = reading.step * (across_top + fy * (across_bottom - across_top));
  const double by_y = reading.step * (down_left + fx * (down_right - down_left));
  return by_x * rows_[0] + by_y * rows_[1];
}

std::optional<double> ChannelField::most(Quantity quantity) const noexcept {
  const Reading& reading = readings_[index_of(quantity)];
  if (reading.channel < 0) return std::nullopt;
  return reading.most;
}

}  // namespace papilla
