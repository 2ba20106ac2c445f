// SPDX-License-Identifier: MIT
#include "papilla/texture/even_light.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "pyramid.hpp"

namespace papilla {
namespace {

constexpr std::array<std::string_view, 3> k_transfers = {"auto", "srgb", "linear"};
constexpr std::array<std::string_view, 3> k_curve_sources = {"linear", "srgb", "profile"};

/// Sides of the reduced copy that the quadric is fitted to; it has six values only.
constexpr int k_reduced_px = 512;

/// −1 to 1 over the centres of `count` samples.
double place(int i, int count) { return (2.0 * i + 1) / count - 1; }

using Terms = Eigen::Matrix<double, 6, 1>;

Terms terms(double x, double y) { return (Terms() << 1, x, y, x * x, x * y, y * y).finished(); }

/// A table of the curve is within 1e-6 of it and costs a tenth.
std::vector<float> srgb_table() {
  constexpr int k_steps = 4096;
  std::vector<float> table;
  for (int i = 0; i <= k_steps; ++i)
    table.push_back(static_cast<float>(linear_from_srgb(static_cast<double>(i) / k_steps)));
  return table;
}

/// @pre the table has at least two values.
float decode(const std::vector<float>& table, float value) {
  const std::size_t last = table.size() - 2;
  const float at = std::clamp(value, 0.0F, 1.0F) * static_cast<float>(last + 1);
  const std::size_t step = std::min(static_cast<std::size_t>(at), last);
  const float rest = at - static_cast<float>(step);
  return (1 - rest) * table[step] + rest * table[step + 1];
}

}  // namespace

std::string_view to_string(Transfer transfer) noexcept { return k_transfers[static_cast<std::size_t>(transfer)]; }

Transfer transfer(std::string_view name) {
  return static_cast<Transfer>(texture_detail::index_of_name(name, k_transfers, "transfer"));
}

std::string_view to_string(CurveSource source) noexcept { return k_curve_sources[static_cast<std::size_t>(source)]; }

TransferCurve transfer_curve(Transfer transfer, int bits, const std::vector<float>& profile) {
  constexpr int k_camera_bits = 8;
  const bool is_automatic = transfer == Transfer::automatic;
  if (is_automatic && profile.size() >= 2) return {CurveSource::profile, profile};
  if (transfer == Transfer::srgb || (is_automatic && bits == k_camera_bits)) return {CurveSource::srgb, srgb_table()};
  return {};
}

LightField light_field(const SampleRows& picture, const TransferCurve& curve) {
  if (picture.width() < 1 || picture.height() < 1) throw InvalidInput("light_field: the picture is empty");
  const EvenedSamples brightness(picture, curve, {});
  const GreyImage small = texture_detail::shrunk(brightness, k_reduced_px).image;
  double mean = 0;
  for (const float value : small.pixels) mean += static_cast<double>(value);
  mean /= static_cast<double>(small.pixels.size());
  LightField field;
  if (!(mean > 0)) return field;
  constexpr double k_darkest = 0.01;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Terms right = Terms::Zero();
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const Terms t = terms(place(x, small.width), place(y, small.height));
      normal += t * t.transpose();
      right += t * std::log(std::max(k_darkest * mean, static_cast<double>(small.at(x, y))));
    }
  // Pictures of one or two rows leave some terms open: those become 0.
  const Terms quadric = normal.completeOrthogonalDecomposition().solve(right);
  std::copy_n(quadric.data(), field.quadric.size(), field.quadric.begin());
  double low = 1e300, high = -1e300;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const double value = quadric.dot(terms(place(x, small.width), place(y, small.height)));
      low = std::min(low, value);
      high = std::max(high, value);
    }
  field.unevenness = std::expm1(high - low);
  return field;
}

EvenedSamples::EvenedSamples(const SampleRows& picture, TransferCurve curve, const LightField& field)
    : SampleRows(picture.width(), picture.height()), picture_(picture), field_(field), curve_(std::move(curve)) {}

void EvenedSamples::read(int x, int y, int count, float* samples) const {
  picture_.read(x, y, count, samples);
  if (!curve_.linear.empty())
    for (int i = 0; i < count; ++i) samples[i] = decode(curve_.linear, samples[i]);
  const auto& q = field_.quadric;
  if (q == LightField{}.quadric) return;
  const double v = place(y, height()), start = q[0] + v * (q[2] + v * q[5]), across = q[1] + v * q[4];
  for (int i = 0; i < count; ++i) {
    const double u = place(x + i, width());
    samples[i] *= static_cast<float>(std::exp(-(start + u * (across + u * q[3]))));
  }
}

}  // namespace papilla
