// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "bench/bench_json.hpp"
#include "contact_targets.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/channel_field.hpp"
#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/histogram.hpp"
#include "papilla/haptic/proxy.hpp"
#ifdef PAPILLA_HAVE_EMBREE
#include "embree_closest.hpp"
#endif

namespace {

using namespace papilla;
using bench::Recorder;

constexpr double k_size = 0.2, k_speed = 0.2, k_period = 1e-3;

/// Where the probe is, tick by tick; a copy goes the same way.
using Probe = std::function<Vec3()>;

/// Wanders at 0.2 m/s, 1 to 3 mm deep.
template <class Height>
Probe over_heights(std::uint64_t seed, const Height& height) {
  return [=, wanderer = testing::Wanderer(seed, k_size, 0.1 * k_size, k_speed * k_period), tick = 0]() mutable {
    const Vec2 at = wanderer.next();
    return Vec3{at.x, at.y, height(at.x, at.y) - 0.002 + 0.001 * std::cos(0.01 * tick++)};
  };
}
Probe over_relief(std::uint64_t seed) { return over_heights(seed, testing::rough_relief); }
Probe over_plate(std::uint64_t seed) {
  return over_heights(seed, [](double, double) { return 0.0; });
}
Probe over_sphere(std::uint64_t seed) {
  return [wanderer = testing::Wanderer(seed, 2 * k_size, 0.1, k_speed * k_period), tick = 0]() mutable {
    const Vec2 at = wanderer.next();
    const double around = at.x / 0.1, up = 0.5 * std::sin(at.y / 0.1);
    return (0.098 + 0.001 * std::cos(0.01 * tick++)) *
           Vec3{std::cos(around) * std::cos(up), std::sin(around) * std::cos(up), std::sin(up)};
  };
}

struct Shape {
  std::string name;
  ContactMesh mesh;
  Probe (*probe)(std::uint64_t seed);
  std::vector<HeightField> heights;
  double friction = 0;
  std::vector<ChannelField> channels = {};
};

/// Stiffness, friction and damping around those of the constants, waves of 4 mm and longer: 512 texels over 0.2 m.
ChannelField place_by_place(double friction) {
  constexpr int pixels = 512;
  const ContactMaterial constants;
  std::vector<ChannelField::Texel> texels;
  for (int j = 0; j < pixels; ++j)
    for (int i = 0; i < pixels; ++i) {
      const auto wave = [&](double u, double v) {
        return static_cast<std::uint16_t>(
            std::lround(32767.5 * (1 + std::sin(2 * std::numbers::pi * (u * i + v * j) / pixels))));
      };
      texels.push_back({wave(20, 7), wave(-9, 31), wave(13, 50)});
    }
  return ChannelField(
      pixels, pixels, std::move(texels),
      {{MapChannel{Quantity::stiffness, constants.stiffness, 0.5 * constants.stiffness},
        MapChannel{Quantity::dynamic_friction, friction, 0.5 * friction}, MapChannel{Quantity::damping, 1, 0}},
       {},
       {}});
}

/// Waves of 1.6 mm and longer in all directions, 0.2 mm high: one tile of 25.6 mm, eight of them side by side.
HeightField grain() {
  constexpr int pixels = 512, longest = 4, shortest = 16;
  std::vector<double> height(pixels * pixels, 0.0);
  for (int k = longest; k <= shortest; ++k) {
    const double around = 2.4 * k;  // The golden angle.
    const double u = std::round(k * std::cos(around)), v = std::round(k * std::sin(around));
    for (int j = 0; j < pixels; ++j)
      for (int i = 0; i < pixels; ++i)
        height[static_cast<std::size_t>(j * pixels + i)] +=
            std::cos(2 * std::numbers::pi * (u * i + v * j) / pixels + k * k) / k;
  }
  const auto [low, high] = std::minmax_element(height.begin(), height.end());
  std::vector<std::uint16_t> samples;
  for (const double h : height)
    samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * (h - *low) / (*high - *low))));
  HeightFieldOptions options;
  options.scale_m = 2e-4;
  options.uv_transform.scale = {8, 8};
  return HeightField(pixels, pixels, samples, options);
}

/// Thread CPU time of every tick: of `runs` runs of the same ticks the least, so that what interrupts add is left out.
/// As much as the largest cache holds is written before each run, so that none finds more in it than the first.
class TickTimes {
 public:
  static constexpr int k_runs = 3;

  /// `start` makes what a run needs and returns it; `tick` is timed, `after` is not.
  template <class Start, class Tick, class After>
  void measure(const Probe& probe, int ticks, const Start& start, const Tick& tick, const After& after) {
    least_.assign(static_cast<std::size_t>(ticks), std::numeric_limits<double>::infinity());
    for (int run = 0; run < k_runs; ++run) {
      bench::empty_caches();
      auto state = start();
      Probe moving = probe;
      for (double& least : least_) {
        const Vec3 at = moving();
        const double before = bench::thread_cpu_seconds();
        tick(state, at);
        const double us = 1e6 * (bench::thread_cpu_seconds() - before);
        least = std::min(least, us);
        if (run == 0) first_.add(us);
        after(state, at);
      }
    }
  }

  void record(Recorder& recorder) const {
    Histogram times;
    for (const double us : least_) times.add(us);
    recorder.record("tick_us_p50", times.quantile(0.5));
    recorder.record("tick_us_p99", times.quantile(0.99));
    recorder.record("tick_us_p999", times.quantile(0.999));
    recorder.record("tick_us_max", times.max());
    recorder.record("one_run_tick_us_p50", first_.quantile(0.5));
    recorder.record("one_run_tick_us_p999", first_.quantile(0.999));
    recorder.record("one_run_tick_us_max", first_.max());
  }

 private:
  std::vector<double> least_;
  Histogram first_;
};

/// A proxy on its way, and what became of its contact.
struct Touching {
  std::unique_ptr<Proxy> proxy;
  ContactAudit audit;
};

void run_proxy(const ContactSurface& surface, const Probe& probe, int ticks, Recorder& recorder) {
  const Vec3 first = Probe(probe)();
  const Vec3 outside = first + 0.02 * (surface.low().z < -0.05 ? normalized(first) : Vec3{0, 0, 1});
  int lost = 0, contact = 0;
  TickTimes times;
  times.measure(
      probe, ticks,
      [&] {
        Touching touching{std::make_unique<Proxy>(surface), ContactAudit(surface)};
        touching.proxy->reset(outside);
        touching.audit.update(outside, touching.proxy->state(), {});
        lost = contact = 0;
        return touching;
      },
      [](Touching& touching, Vec3 at) { touching.proxy->update(at, k_period); },
      [&](Touching& touching, Vec3 at) {
        contact += touching.proxy->state().in_contact;
        lost += touching.audit.update(at, touching.proxy->state(), touching.proxy->waypoints());
      });
  times.record(recorder);
  recorder.record("contact_ticks", contact);
  recorder.record("lost_ticks", lost);
}

/// Shapes and surfaces stay alive until the report is measured.
struct Inputs {
  std::vector<std::unique_ptr<Shape>> shapes;
  std::vector<std::unique_ptr<ContactSurface>> surfaces;
};

void add_shape(bench::BenchReport& report, Inputs& inputs, Shape shape, int ticks) {
  const Shape& kept = *inputs.shapes.emplace_back(std::make_unique<Shape>(std::move(shape)));
  ContactMaterial material;
  if (!kept.heights.empty()) material.height = 0;
  if (!kept.channels.empty()) material.channels = 0;
  material.static_friction = material.dynamic_friction = kept.friction;
  for (const double radius : {0.0, 1e-3}) {
    const ContactSurface& surface = *inputs.surfaces.emplace_back(std::make_unique<ContactSurface>(
        kept.mesh, std::vector<ContactMaterial>{material}, kept.heights, radius, kept.channels));
    report.add(
        {.method = "proxy",
         .solver = radius > 0 ? "ball 1 mm" : "point",
         .input = kept.name,
         .options = {{"triangles", surface.triangles()}, {"bytes", surface.bytes()}, {"speed_m_per_s", k_speed}},
         .notes = "CPU time of the thread, with what its clock takes; of three runs of the same ticks the least"},
        [&surface, probe = kept.probe, ticks, seed = std::uint64_t{1}](Recorder& recorder) mutable {
          run_proxy(surface, probe(seed++), ticks, recorder);
        });
  }
#ifdef PAPILLA_HAVE_EMBREE
  if (!kept.heights.empty() || kept.friction > 0) return;  // Embree has neither relief nor friction.
  auto embree = std::make_shared<bench::EmbreeClosest>(kept.mesh);
  report.add(
      {.method = "closest-point", .solver = "embree", .input = kept.name, .notes = "lower bound: one query a tick"},
      [embree, probe = kept.probe, ticks, seed = std::uint64_t{1}](Recorder& recorder) mutable {
        TickTimes times;
        times.measure(
            probe(seed++), ticks, [] { return 0; }, [&](int, Vec3 at) { bench::keep(embree->distance(at, 6e-3)); },
            [](int, Vec3) {});
        times.record(recorder);
      });
#endif
}

/// A tick among twenty million triangles.
void add_twenty_million(bench::BenchReport& report) {
  constexpr int n = 3163, ticks = 20000;
  const ContactSurface surface(
      [&] {
        ContactMesh mesh = testing::height_grid(n, n, k_size, k_size, testing::rough_relief);
        mesh.corner_uv = {};
        return mesh;
      }(),
      {ContactMaterial{}}, {}, 0);
  auto proxy = std::make_unique<Proxy>(surface);
  Probe probe = over_relief(1);
  Histogram times;
  for (int i = 0; i < ticks; ++i) {
    const Vec3 at = probe();
    if (i == 0) proxy->reset(at + Vec3{0, 0, 0.02});
    const double before = bench::thread_cpu_seconds();
    proxy->update(at, k_period);
    times.add(1e6 * (bench::thread_cpu_seconds() - before));
  }
  report.target({"20 million triangles within 2 % of a 1 ms tick (median of a point)",
                 fmt::format("median {:.1f} µs, 99.9 % {:.1f} µs, {:.1f} bytes a triangle", times.quantile(0.5),
                             times.quantile(0.999),
                             static_cast<double>(surface.bytes()) / static_cast<double>(surface.triangles())),
                 times.quantile(0.5) <= 20});
}

void add_speed_targets(bench::BenchReport& report, bool quick, const Inputs& inputs) {
  if (quick) return;
  const auto of = [&](const char* subject, const char* input, const char* quantity) {
    return report.median_of(subject, input, quantity);
  };
  const auto limit = [&](const char* promise, double value, double most, const char* unit) {
    report.target({promise, fmt::format("{:.2f} {}", value, unit), value <= most});
  };
  const char *point = "proxy/point", *ball = "proxy/ball 1 mm", *small = "relief 20k", *middle = "relief 199k",
             *large = "relief 2000k", *grain = "plate with a grain";
  const auto time = [&](const char* promise, const char* subject, const char* input, const std::string& quantity,
                        double most) {
    const double us = of(subject, input, quantity.c_str());
    std::string notes = fmt::format("one run: {:.2f}", of(subject, input, ("one_run_" + quantity).c_str()));
#ifdef PAPILLA_HAVE_EMBREE
    if (input != grain)
      notes += fmt::format("; Embree's closest point: {:.2f}", of("closest-point/embree", input, quantity.c_str()));
#endif
    report.target({promise, fmt::format("{:.2f} µs ({})", us, notes), us <= most});
  };
  time("ball of 1 mm, 200 k triangles: p99.9 at most 25 µs", ball, middle, "tick_us_p999", 25);
  time("ball of 1 mm, 2 M triangles: p99.9 at most 50 µs", ball, large, "tick_us_p999", 50);
  time("ball of 1 mm, 2 M triangles: worst at most 200 µs", ball, large, "tick_us_max", 200);
  time("point, 2 M triangles: median at most 3.4 µs", point, large, "tick_us_p50", 3.4);
  time("point, 2 M triangles: p99.9 at most 20 µs", point, large, "tick_us_p999", 20);
  time("point on a grain 0.2 mm high: p99.9 at most a fifth of a tick at 1 kHz, 200 µs", point, grain, "tick_us_p999",
       200);
  time("ball of 1 mm on that grain: p99.9 at most a tenth of a tick at 1 kHz, 100 µs", ball, grain, "tick_us_p999",
       100);
  limit("point: time at 2 M over time at 20 k triangles at most 2.5",
        of(point, large, "tick_us_p50") / of(point, small, "tick_us_p50"), 2.5, "times");
#ifdef PAPILLA_HAVE_EMBREE
  limit("point: within 3 times of Embree's closest point, 2 M triangles",
        of(point, large, "tick_us_p50") / of("closest-point/embree", large, "tick_us_p50"), 3, "times");
#else
  report.target({"point: within 3 times of Embree's closest point", "built without Embree", std::nullopt});
#endif
  for (const char* subject : {point, ball})
    for (const std::string what : {"", "a grain and "}) {
      const std::string constant = "plate with " + what + "friction";
      limit(fmt::format("{} on a plate with {}friction: with maps at most 1.15 times the median tick", subject, what)
                .c_str(),
            of(subject, (constant + " by maps").c_str(), "tick_us_p50") / of(subject, constant.c_str(), "tick_us_p50"),
            1.15, "times");
    }
  for (const auto& surface : inputs.surfaces)
    if (surface->triangles() == 2000000 && surface->probe_radius_m() == 0) {
      const double bytes = static_cast<double>(surface->bytes()) / static_cast<double>(surface->triangles());
      limit("at most 64 bytes a triangle", bytes, 64, "bytes");
      break;
    }
  add_twenty_million(report);
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const int ticks = quick ? 500 : 20000;
  Inputs inputs;
  for (const int n : quick ? std::vector<int>{20} : std::vector<int>{100, 316, 1000}) {
    const std::string size = std::to_string(2 * n * n / 1000) + "k";
    add_shape(report, inputs,
              {"relief " + size, testing::height_grid(n, n, k_size, k_size, testing::rough_relief), over_relief, {}},
              ticks);
    add_shape(report, inputs, {"sphere " + size, testing::sphere(n, 0.1), over_sphere, {}}, ticks);
  }
  const int squares = quick ? 20 : 200;
  const ContactMesh plate = testing::plate(squares, squares, k_size, k_size);
  add_shape(report, inputs, {"plate", plate, over_plate, {}}, ticks);
  add_shape(report, inputs, {"plate with a grain", plate, over_plate, {grain()}}, ticks);
  constexpr double k_friction = 0.4;
  for (const bool has_grain : {false, true})
    for (const bool has_maps : {false, true}) {
      std::vector<HeightField> heights;
      std::vector<ChannelField> channels;
      if (has_grain) heights.push_back(grain());
      if (has_maps) channels.push_back(place_by_place(k_friction));
      add_shape(report, inputs,
                {fmt::format("plate with {}friction{}", has_grain ? "a grain and " : "", has_maps ? " by maps" : ""),
                 plate, over_plate, std::move(heights), k_friction, std::move(channels)},
                ticks);
    }
#ifdef PAPILLA_HAVE_EMBREE
  report.compare("proxy/point", "closest-point/embree", "tick_us_p50");
#endif
  report.measure();
  add_speed_targets(report, quick, inputs);
  bench::add_contact_targets(report);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("contact", "Time of a contact tick", argc, argv, body); }
