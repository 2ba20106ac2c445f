// SPDX-License-Identifier: MIT
// The force models over a sinusoidal relief against their closed forms, the graphs against their exponent, and the time
// of a tick.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "bench/bench_json.hpp"
#include "haptic/closest_on_curve.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/histogram.hpp"

namespace {

using namespace papilla;

// Waves of 2 mm, 0.1 mm high on the smooth base of a plate; pixels of 50 µm.
constexpr double k_width = 0.04, k_wave = 2e-3, k_range = 1e-4, k_pixel = 5e-5, k_stiffness = 500, k_period = 1e-3;
constexpr double k_turn = 2 * std::numbers::pi / k_wave, k_greys = 256, k_share = 0.9;
constexpr double k_depth = 2e-4, k_speed = 0.05, k_amplitude = 0.01;

double height(double x) { return 0.5 * k_range * (1 + k_share * std::sin(k_turn * x)); }
double grey(double x) { return k_greys * height(x) / k_range; }

HeightField waves() {
  constexpr int columns = 800, rows = 4;
  std::vector<std::uint16_t> samples;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * height((i + 0.5) * k_pixel) / k_range)));
  HeightFieldOptions options;
  options.scale_m = k_range;
  return HeightField(columns, rows, samples, options);
}

/// A plate of square pixels: 4 of them deep.
ContactSurface plate(ContactMaterial material) {
  (is_stimulus(material.model) ? material.stimulus : material.height) = 0;
  material.stiffness = k_stiffness;
  return ContactSurface(testing::plate(40, 1, k_width, 4 * k_pixel), {material}, {waves()}, 0);
}

/// From (x, z) to the closest point of the waves.
Vec3 way_to_waves(double x, double z) { return testing::way_to_curve(height, x, z); }

struct Curve {
  std::string name, formula;
  ContactMaterial material;
  int axis = 0;                                 ///< Of the force: 0 x, 2 z.
  std::function<double(double, double)> exact;  ///< By x and z of the probe, after long sliding.
  std::vector<double> found{}, wanted{};        ///< Along the waves.
  double largest = 0, error = 0;                ///< N, and rms over that of the closed form.
};

ContactMaterial of(ForceModel model, StimulusForm form = StimulusForm::usual) {
  ContactMaterial material;
  material.model = model;
  material.form = form;
  material.amplitude = k_amplitude;
  return material;
}

std::vector<Curve> curves() {
  const double step = k_speed * k_period, a = k_amplitude;
  const auto change = [=](double x) { return grey(x) - grey(x - step); };
  return {
      {"orthogonal", "A·(g(x) − g(x − w))", of(ForceModel::orthogonal), 2,
       [=](double x, double z) { return -k_stiffness * z + a * change(x); }},
      {"lateral, gradient", "−A·g'(x)·pixel", of(ForceModel::lateral), 0,
       [=](double x, double) { return -a * k_pixel * 128 * k_share * k_turn * std::cos(k_turn * x); }},
      {"lateral, displacement", "−A·(g(x) − g(x − w))/w·pixel", of(ForceModel::lateral, StimulusForm::displacement), 0,
       [=](double x, double) { return -a * k_pixel * change(x) / step; }},
      {"lateral-isotropic", "−A·(g(x) − g(x − w))", of(ForceModel::lateral_isotropic), 0,
       [=](double x, double) { return -a * change(x); }},
      {"textured-normal, normal part", "k·(c − x)·z", of(ForceModel::textured_normal), 2,
       [](double x, double z) { return k_stiffness * way_to_waves(x, z).z; }},
      {"textured-normal, lateral part", "k·(c − x)·x", of(ForceModel::textured_normal), 0,
       [](double x, double z) { return k_stiffness * way_to_waves(x, z).x; }},
  };
}

/// A stroke of two waves along x, k_depth below the base.
void follow(Curve& curve) {
  const ContactSurface surface = plate(curve.material);
  const auto tick = std::make_unique<HapticTick>(
      surface, SafetyLimits{.max_force_n = 100, .slew_n_per_s = 1e9, .soft_start_s = 0}, k_period);
  DeviceState device;
  const double y = 2 * k_pixel, start = 0.01, z = -k_depth;
  device.position = {start - 0.004, y, 1e-3};
  tick->reset(device.position);
  double error2 = 0, force2 = 0;
  for (int i = 0; i < 160; ++i) {
    const double x = start - 0.004 + i * k_speed * k_period;
    device.position = {x, y, z};
    const Vec3 force = (*tick)(device);
    if (x < start - 1e-9) continue;
    const double found = curve.axis == 0 ? force.x : force.z, wanted = curve.exact(x, z);
    curve.found.push_back(found);
    curve.wanted.push_back(wanted);
    error2 += (found - wanted) * (found - wanted);
    force2 += wanted * wanted;
    curve.largest = std::max(curve.largest, std::abs(found));
  }
  curve.error = std::sqrt(error2 / force2);
}

bench::EvidenceTable table_of(const std::vector<Curve>& all) {
  bench::EvidenceTable table{
      "Two waves of a sinusoidal relief",
      fmt::format("Waves of {:g} mm, {:g} mm high, pixels of {:g} mm, a point {:g} mm below the base at {:g} mm/s, "
                  "{:g} N/m, A = {:g}; forces in N, each beside its closed form.",
                  1e3 * k_wave, 1e3 * k_range, 1e3 * k_pixel, 1e3 * k_depth, 1e3 * k_speed, k_stiffness, k_amplitude),
      {"x [mm]"},
      {}};
  for (const Curve& curve : all) {
    table.columns.push_back(curve.name);
    table.columns.push_back("closed form");
  }
  for (std::size_t i = 0; i < all.front().found.size(); i += 2) {
    std::vector<std::string> row{fmt::format("{:.2f}", 1e3 * k_speed * k_period * static_cast<double>(i))};
    for (const Curve& curve : all) {
      row.push_back(fmt::format("{:.4f}", curve.found[i]));
      row.push_back(fmt::format("{:.4f}", curve.wanted[i]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// How the textured-normal force begins and ends: from above a crest to below the base.
void press(bench::BenchReport& report) {
  const ContactSurface surface = plate(of(ForceModel::textured_normal));
  bench::EvidenceTable table{"Pressing into a crest, a flank and a valley with textured-normal",
                             "The base is at 0, so that the probe is above it in the first rows. Forces in N.",
                             {"z [mm]", "crest", "k·distance", "flank", "k·distance", "valley", "k·distance"},
                             {}};
  const std::array<double, 3> places = {0.01 + k_wave / 4, 0.01, 0.01 - k_wave / 4};
  double jump = 0, error = 0;
  std::vector<std::vector<std::string>> rows;
  for (const double x : places) {
    const auto tick = std::make_unique<HapticTick>(
        surface, SafetyLimits{.max_force_n = 100, .slew_n_per_s = 1e9, .soft_start_s = 0}, k_period);
    DeviceState device;
    device.position = {x, 2 * k_pixel, 1.5e-4};
    tick->reset(device.position);
    double last = 0;
    for (int i = 0; i <= 450; ++i) {
      const double z = 1.5e-4 - 1e-6 * i;
      device.position.z = z;
      const double force = norm((*tick)(device));
      const double wanted = z < height(x) ? k_stiffness * norm(way_to_waves(x, z)) : 0;
      jump = std::max(jump, std::abs(force - last) - k_stiffness * 1e-6);
      error = std::max(error, std::abs(force - wanted));
      last = force;
      if (i % 25 != 0) continue;
      const auto row = static_cast<std::size_t>(i / 25);
      if (rows.size() <= row) rows.push_back({fmt::format("{:.3f}", 1e3 * z)});
      rows[row].push_back(fmt::format("{:.4f}", force));
      rows[row].push_back(fmt::format("{:.4f}", wanted));
    }
  }
  table.rows = std::move(rows);
  report.table(std::move(table));
  report.target({"textured-normal: no step of the force beyond k times the way of the probe, pressing in",
                 fmt::format("{:.2e} N beyond it", jump), jump < 1e-4});
  report.target(
      {"textured-normal: k times the distance to the closest textured point within 0.1 mN, above and below the base",
       fmt::format("{:.2e} N", error), error < 1e-4});
}

double variogram_hurst(const GreyGraph& graph) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (int k = 1; k <= 16; k *= 2) {
    double sum = 0;
    for (int i = 0; i + k < GreyGraph::k_samples; ++i) sum += std::pow(graph.at(i + k) - graph.at(i), 2);
    const double x = std::log(k), y = std::log(sum / (GreyGraph::k_samples - k));
    sx += x, sy += y, sxx += x * x, sxy += x * y, ++n;
  }
  return 0.5 * (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void graphs(bench::BenchReport& report) {
  bench::EvidenceTable table{
      "Graphs of the exponents of the tag",
      "Figure 6.6 of the source: every eighth sample of 257, grey levels. The last column is half the slope of the "
      "graph's variogram over lags of 1 to 16.",
      {"D of the surface", "H"},
      {}};
  for (int i = 0; i < GreyGraph::k_samples; i += 8) table.columns.push_back(std::to_string(i));
  table.columns.push_back("H found");
  double worst = 0;
  for (const double dimension : {2.1, 2.3, 2.5, 2.7, 2.9}) {
    const GreyGraph graph(3 - dimension);
    std::vector<std::string> row{fmt::format("{:.1f}", dimension), fmt::format("{:.1f}", 3 - dimension)};
    for (int i = 0; i < GreyGraph::k_samples; i += 8) row.push_back(fmt::format("{:.0f}", graph.at(i)));
    const double found = variogram_hurst(graph);
    worst = std::max(worst, std::abs(found - (3 - dimension)));
    row.push_back(fmt::format("{:.2f}", found));
    table.rows.push_back(std::move(row));
  }
  report.table(std::move(table));
  report.target({"the graph's exponent within 0.12 of 3 − D (one graph of 257 samples)", fmt::format("{:.3f}", worst),
                 worst <= 0.12});
}

/// Thread CPU time of ticks that wander 0.2 to 1.2 mm deep over a plate with a grain.
void times(bench::BenchReport& report) {
  bench::EvidenceTable table{"Time of a tick",
                             "A point over 20 000 triangles with the waves, 0.2 m/s; µs of processor.",
                             {"model", "median", "99 %"},
                             {}};
  double plain = 0, textured = 0;
  for (const ForceModel model : {ForceModel::heightfield, ForceModel::textured_normal, ForceModel::orthogonal,
                                 ForceModel::lateral, ForceModel::graph_orthogonal}) {
    ContactMaterial material = of(model);
    (is_stimulus(model) ? material.stimulus : material.height) = 0;
    const ContactSurface surface(testing::plate(100, 100, k_width, k_width), {material}, {waves()}, 0);
    const auto tick = std::make_unique<HapticTick>(surface, safety_limits(3.3), k_period);
    testing::Wanderer wanderer(1, k_width, 0.1 * k_width, 2e-4);
    Histogram histogram;
    const int ticks = report.options().quick ? 500 : 20000;
    for (int i = 0; i < ticks; ++i) {
      const Vec2 at = wanderer.next();
      DeviceState device;
      device.position = {at.x, at.y, i == 0 ? 1e-3 : -7e-4 + 5e-4 * std::cos(0.01 * i)};
      const double before = bench::thread_cpu_seconds();
      bench::keep((*tick)(device));
      histogram.add(1e6 * (bench::thread_cpu_seconds() - before));
    }
    table.rows.push_back({std::string(name_of(model)), fmt::format("{:.1f}", histogram.quantile(0.5)),
                          fmt::format("{:.1f}", histogram.quantile(0.99))});
    if (model == ForceModel::heightfield) plain = histogram.quantile(0.5);
    if (model == ForceModel::textured_normal) textured = histogram.quantile(0.5);
  }
  report.table(std::move(table));
  report.target({"a tick of textured-normal takes at most 5 times that of heightfield (median)",
                 fmt::format("{:.1f} µs, {:.1f} times", textured, textured / plain), textured <= 5 * plain});
}

void body(bench::BenchReport& report) {
  std::vector<Curve> all = curves();
  bench::EvidenceTable errors{"Error against the closed form",
                              "Root mean square over that of the closed form.",
                              {"model", "closed form", "largest force [N]", "error"},
                              {}};
  for (Curve& curve : all) {
    follow(curve);
    errors.rows.push_back(
        {curve.name, curve.formula, fmt::format("{:.4f}", curve.largest), fmt::format("{:.3f} %", 100 * curve.error)});
    report.target({fmt::format("{}: within 2 % rms of its closed form over a sinusoidal relief", curve.name),
                   fmt::format("{:.3f} %", 100 * curve.error), curve.error <= 0.02});
  }
  report.table(std::move(errors));
  press(report);
  graphs(report);
  times(report);
  report.table(table_of(all));
  report.measure();
}

}  // namespace

int main(int argc, char** argv) {
  return bench::run_benchmark("forces", "Force models against their closed forms", argc, argv, body);
}
