// SPDX-License-Identifier: MIT
// How steady forces are along strokes over every material: a micrometre of the hand, steep relief, steps.
#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <vector>

#include "bench/bench_json.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "pipeline/felt_strokes.hpp"

namespace {

using namespace papilla;
namespace fs = std::filesystem;

constexpr double k_most_difference = 0.02, k_most_ratio = 2.5, k_most_tick_us = 50;
constexpr std::array k_devices = {"touch", "omega3"};
constexpr std::array<testing::Stroke, 2> k_strokes = {
    {{.depth_m = 5e-4, .speed_m_per_s = 0.02}, {.depth_m = 1e-3, .speed_m_per_s = 0.1}}};

struct Row {
  const MaterialRule* rule = nullptr;
  const char* device = nullptr;
  GrainHeight height;
  double friction = 0;
  std::array<testing::Steadiness, k_strokes.size()> found;
};

void measure(Row& row, bool quick) {
  const DeviceCaps caps = device_preset(row.device).caps();
  const testing::FeltPlate plate = testing::felt_plate(*row.rule, caps);
  row.height = plate.baked.grains.at(row.rule->name).height;
  row.friction = plate.haptic.materials.front().static_friction;
  for (std::size_t i = 0; i < k_strokes.size(); ++i) {
    testing::Stroke stroke = k_strokes[i];
    if (quick) stroke.way_m = 2e-3;
    row.found[i] = testing::steadiness(plate.surface, caps, stroke, quick ? 1 : 8);
  }
}

bench::EvidenceTable table_of(const std::string& title, const std::vector<Row>& rows) {
  bench::EvidenceTable table{
      title,
      "Each of eight ways of 60 mm is compared with itself moved by 1 µm along x, y and z: root mean square of the "
      "difference of the forces over that of the force, the worst and the mean. Lag: of the proxy behind the probe. "
      "Ratio: lateral over normal force. Steeper: share of the relief above the limit of the slope before it was "
      "limited.",
      {"material", "device", "friction", "slope before", "slope limit", "steeper", "height before, after [mm]",
       "0.5 mm, 20 mm/s: worst", "mean", "lag [mm]", "ratio", "1 mm, 100 mm/s: worst", "mean", "lag [mm]", "ratio"},
      {}};
  for (const Row& row : rows) {
    const SlopeLimitResult& slopes = row.height.slopes;
    std::vector<std::string> cells = {
        row.rule->name,
        row.device,
        fmt::format("{:.2f}", row.friction),
        fmt::format("{:.2f}", slopes.steepest_before),
        fmt::format("{:.2f}", row.height.max_slope),
        fmt::format("{:.2f} %", 100 * slopes.share_before),
        fmt::format("{:.3f}, {:.3f}", row.height.unlimited_depth_mm, row.height.depth_mm)};
    for (const testing::Steadiness& found : row.found) {
      cells.push_back(fmt::format("{:.2f} %", 100 * found.worst));
      cells.push_back(fmt::format("{:.2f} %", 100 * found.mean));
      cells.push_back(fmt::format("{:.2f}", 1e3 * found.extremes.lag_m));
      cells.push_back(fmt::format("{:.2f}", found.extremes.lateral_ratio));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void add_targets(bench::BenchReport& report, const std::string& which, const std::vector<Row>& rows) {
  double difference = 0, ratio = 0, step = 0, slope = 0;
  long lost = 0;
  std::string worst;
  for (const Row& row : rows)
    for (const testing::Steadiness& found : row.found) {
      if (found.worst > difference) worst = row.rule->name, difference = found.worst;
      ratio = std::max(ratio, found.extremes.lateral_ratio);
      step = std::max(step, found.extremes.largest_step_n / device_preset(row.device).caps().max_force_n);
      slope = std::max(slope, row.height.slopes.steepest_after / row.height.max_slope);
      lost += found.extremes.lost;
    }
  report.target({fmt::format("a micrometre changes the force along a stroke by at most 2 % rms, {}", which),
                 fmt::format("{:.2f} % at worst ({})", 100 * difference, worst), difference <= k_most_difference});
  report.target({fmt::format("no probe is caught: lateral over normal force at most {}, {}", k_most_ratio, which),
                 fmt::format("{:.2f}, {} contacts lost", ratio, lost), ratio <= k_most_ratio && lost == 0});
  report.target({fmt::format("baked slopes are within their limit, {}", which), fmt::format("{:.4f} of it", slope),
                 slope <= 1 + 1e-6});
  report.target({fmt::format("no step of the force above 2 % of the device's largest a millisecond, {}", which),
                 fmt::format("{:.2f} %", 100 * step), step <= 0.02 * (1 + 1e-9)});
}

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

constexpr int k_fine = 32, k_ways = 4, k_runs = 5;

/// What the ticks of strokes at 1 kHz cost, and how far their forces are from those of steps k_fine times as small.
struct TickWork {
  double off = 0;
  std::vector<double> sweeps, seconds;
};

TickWork work_of(const ContactSurface& surface, const DeviceCaps& caps, testing::Stroke stroke, int ways) {
  TickWork work;
  for (int i = 0; i < ways; ++i) {
    stroke.angle = 1.4 * (i + 0.1) / ways, stroke.substeps = 1;
    testing::StrokeForces found = testing::stroke_forces(surface, caps, stroke, &bench::thread_cpu_seconds);
    for (int run = 1; run < k_runs; ++run) {
      const auto again = testing::stroke_forces(surface, caps, stroke, &bench::thread_cpu_seconds).tick_s;
      std::transform(again.begin(), again.end(), found.tick_s.begin(), found.tick_s.begin(),
                     [](double a, double b) { return std::min(a, b); });
    }
    stroke.substeps = k_fine;
    work.off = std::max(work.off, testing::relative_difference(testing::stroke_forces(surface, caps, stroke), found));
    work.sweeps.insert(work.sweeps.end(), found.sweeps.begin(), found.sweeps.end());
    work.seconds.insert(work.seconds.end(), found.tick_s.begin(), found.tick_s.end());
  }
  return work;
}

/// Error over work of a tick.
void add_work(bench::BenchReport& report, const Materials& demo) {
  const bool quick = report.options().quick;
  const int ways = quick ? 1 : k_ways;
  bench::EvidenceTable table{
      "Error over work of a tick, materials of the demo",
      fmt::format("{} ways of 60 mm at 1 kHz, on a device of 12 N. Off: from the same ways in steps {} times as small, "
                  "root mean square of the difference over that of the force; a tick moves the hand by 20 or 100 µm. "
                  "Processor time of the thread, of each tick the least of {} runs, which leaves interrupts out.",
                  ways, k_fine, k_runs),
      {"material", "stroke", "off", "sweeps, mean", "99 %", "99.9 %", "most", "time [µs], 50 %", "99 %", "99.9 %"},
      {}};
  std::vector<double> all;  // On reliefs.
  double slowest_us = 0;
  std::string slowest;
  const DeviceCaps caps = device_preset("omega3").caps();
  for (const auto& [name, rule] : demo.materials) {
    const testing::FeltPlate plate = testing::felt_plate(rule, caps);
    for (testing::Stroke stroke : k_strokes) {
      if (quick) stroke.way_m = 2e-3;
      const TickWork work = work_of(plate.surface, caps, stroke, ways);
      const double sum = std::accumulate(work.sweeps.begin(), work.sweeps.end(), 0.0);
      std::vector<std::string> cells = {
          name, fmt::format("{:g} mm, {:g} mm/s", 1e3 * stroke.depth_m, 1e3 * stroke.speed_m_per_s),
          fmt::format("{:.2f} %", 100 * work.off),
          fmt::format("{:.1f}", sum / static_cast<double>(work.sweeps.size()))};
      for (const double q : {0.99, 0.999, 1.0}) cells.push_back(fmt::format("{:.0f}", quantile(work.sweeps, q)));
      for (const double q : {0.5, 0.99, 0.999}) cells.push_back(fmt::format("{:.1f}", 1e6 * quantile(work.seconds, q)));
      const double us = 1e6 * quantile(work.seconds, 0.999);
      if (us > slowest_us) slowest_us = us, slowest = name + ", " + cells[1];
      table.rows.push_back(std::move(cells));
      if (!rule.texture.empty()) all.insert(all.end(), work.seconds.begin(), work.seconds.end());
    }
  }
  const double p999_us = 1e6 * quantile(all, 0.999);
  report.target({fmt::format("p99.9 of a tick over all strokes on reliefs of the demo at most {:g} µs", k_most_tick_us),
                 fmt::format("{:.1f} µs of {} ticks", p999_us, all.size()), p999_us <= k_most_tick_us});
  report.target({fmt::format("p99.9 of a tick of each stroke on its own at most {:g} µs", k_most_tick_us),
                 fmt::format("{:.1f} µs ({})", slowest_us, slowest), slowest_us <= k_most_tick_us});
  report.table(std::move(table));
}

/// The leather as steep as its picture gives it, under a point and under balls.
void add_steep_leather(bench::BenchReport& report, const MaterialRule& rule) {
  bench::EvidenceTable table{
      "What it takes: the leather of the demo, 0.5 mm deep at 20 mm/s on a device of 12 N",
      "Slopes as the picture gives them or limited when baking, peaks as sharp as they are or rounded when loading, a "
      "point or balls.",
      {"slopes", "peaks", "probe", "lag [mm]", "lateral over normal", "largest force [N]", "difference by 1 µm, worst",
       "mean"},
      {}};
  const DeviceCaps caps = device_preset("omega3").caps();
  for (const bool limited : {false, true})
    for (const double felt : {0.0, k_felt_depth_m})
      for (const double radius : {0.0, 5e-4, 1e-3}) {
        MaterialRule steep = rule;
        if (!limited) steep.height.max_slope = 1000;
        const testing::FeltPlate plate =
            testing::felt_plate(steep, caps, {.probe_radius_m = radius, .felt_depth_m = felt});
        const testing::Steadiness found =
            testing::steadiness(plate.surface, caps, k_strokes[0], report.options().quick ? 1 : 4);
        double strongest = 0;
        for (const Vec3& f : testing::stroke_forces(plate.surface, caps, k_strokes[0]).force_n)
          strongest = std::max(strongest, norm(f));
        table.rows.push_back({limited ? "limited" : "as they are", felt > 0 ? "rounded" : "as they are",
                              radius > 0 ? fmt::format("ball of {:g} mm", 1e3 * radius) : "point",
                              fmt::format("{:.2f}", 1e3 * found.extremes.lag_m),
                              fmt::format("{:.2f}", found.extremes.lateral_ratio), fmt::format("{:.2f}", strongest),
                              fmt::format("{:.2f} %", 100 * found.worst), fmt::format("{:.2f} %", 100 * found.mean)});
      }
  report.table(std::move(table));
}

/// Error over run time of the limiter, on the relief of every material of the demo.
void add_limiter(bench::BenchReport& report, const std::vector<Row>& rows) {
  bench::EvidenceTable table{"Limiting slopes: error over run time",
                             "Largest slope over the limit, less 1, after so many steps of the iteration.",
                             {"material", "step 0", "10", "100", "last", "steps", "seconds", "rms change [µm]"},
                             {}};
  for (const Row& row : rows) {
    const SlopeLimitResult& s = row.height.slopes;
    if (s.trace.empty() || row.device != std::string_view(k_devices[0])) continue;
    const auto at = [&](std::size_t i) {
      return fmt::format("{:.3f}", s.trace[std::min(i, s.trace.size() - 1)].error);
    };
    table.rows.push_back({row.rule->name, at(0), at(10), at(100), at(s.trace.size()), std::to_string(s.iterations),
                          fmt::format("{:.2f}", s.trace.back().seconds), fmt::format("{:.2f}", 1e3 * s.rms_change_mm)});
  }
  report.table(std::move(table));
}

std::vector<Row> measure_all(const Materials& rules, bool quick) {
  std::vector<Row> rows;
  for (const auto& [name, rule] : rules.materials)
    for (const char* device : k_devices)
      if (!rule.texture.empty()) rows.push_back({&rule, device, {}, 0, {}});
  oneapi::tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    measure(rows[i], quick);
    fmt::print(stderr, "{} on {}: {:.2f} % and {:.2f} %\n", rows[i].rule->name, rows[i].device,
               100 * rows[i].found[0].worst, 100 * rows[i].found[1].worst);
  });
  return rows;
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const fs::path folder = fs::temp_directory_path() / fmt::format("papilla-stroke-{}", ::getpid());
  Materials demo = testing::demo_rules(PAPILLA_DATA, folder);
  Materials recipes = testing::recipe_rules();
  if (quick)
    for (Materials* rules : {&demo, &recipes}) rules->materials = {*rules->materials.find("leather")};
  const std::vector<Row> of_demo = measure_all(demo, quick), of_recipes = measure_all(recipes, quick);
  report.measure();
  add_targets(report, "materials of the demo", of_demo);
  add_targets(report, "built-in recipes", of_recipes);
  report.table(table_of("Materials of the demo", of_demo));
  add_work(report, demo);
  report.table(table_of("Built-in recipes", of_recipes));
  add_steep_leather(report, demo.materials.at("leather"));
  add_limiter(report, of_demo);
  fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("stroke", "Force along strokes", argc, argv, body); }
