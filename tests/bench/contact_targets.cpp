// SPDX-License-Identifier: MIT
#include "contact_targets.hpp"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>

#include "call_counter.hpp"
#include "haptic/contact_shapes.hpp"
#include "haptic/passive_contact.hpp"
#include "haptic/reference_descent.hpp"
#include "haptic/textured_force.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_audit.hpp"
#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla::bench {
namespace {

constexpr double k_speed = 0.2, k_period = 1e-3, k_travel = k_speed * k_period;
constexpr int k_wake_turns = 100;  // Of a second each, so that both meet the same load.
constexpr double k_near_m = 1e-4;  // How near a proxy must be to its reference, beside a tick of travel.

/// Runs a probe over a surface; `reference` is how far the proxy is from where it should be, given the probe and the
/// proxy before, or nothing.
template <class Probe, class Reference>
void run(const ContactSurface& surface, long ticks, Vec3 start, Probe&& probe, Reference&& reference, LongRun& sum) {
  auto proxy = std::make_unique<Proxy>(surface);
  ContactAudit audit(surface);
  proxy->reset(start);
  audit.update(start, proxy->state(), {});
  Vec3 last_probe = start;
  for (long i = 0; i < ticks; ++i) {
    const Vec3 at = probe(i), before = proxy->state().proxy;
    const long allocated = allocations(), locked = locks();
    proxy->update(at, k_period);
    const bool lost = audit.update(at, proxy->state(), proxy->waypoints());
    sum.allocations += allocations() - allocated;
    sum.locks += locks() - locked;
    sum.lost += lost;
    sum.contact += proxy->state().in_contact;
    ++sum.ticks;
    const std::optional<double> off = i > 0 ? reference(i, at, before, proxy->state()) : std::optional<double>();
    if (off) {
      const double gap = *off - norm(at - last_probe);
      sum.worst_gap_m = std::max(sum.worst_gap_m, gap);
      sum.gaps += gap > k_near_m;
      ++sum.compared;
    }
    last_probe = at;
  }
}

/// Whether the point `foot` of a surface is the nearest of all to the place `depth_m` behind it, `inward` of it: the
/// surface is not curved as tightly there as that is deep.
bool is_nearest(const testing::ReferenceDescent& reference, Vec3 foot, Vec3 inward, double depth_m) {
  return norm(reference.nearest(foot + depth_m * normalized(inward)) - foot) < k_near_m;
}

/// How far the proxy is from where the descent ends; where that is too far, from where it ends for a probe that is one
/// tolerance of the surface aside.
double descent_gap(testing::ReferenceDescent& reference, const ContactSurface& surface, Vec3 before, Vec3 probe,
                   Vec3 proxy, LongRun& sum) {
  const double gap = reference.gap(before, probe, proxy);
  if (gap <= k_near_m + k_travel) return gap;
  const double aside = reference.gap_shifted(before, probe, proxy, surface.tolerance_m());
  sum.asides += aside <= k_near_m + k_travel;
  return aside;
}

/// Output of a command, or nothing when it fails.
std::optional<std::string> output_of(const std::string& command) {
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string text;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  return ::pclose(pipe) == 0 ? std::optional(text) : std::nullopt;
}

/// A second of cyclictest at 1 kHz; its histogram has lines "microseconds count". Nothing without cyclictest.
std::optional<Histogram> cyclictest() {
  const auto text = output_of("cyclictest -q -m -p80 -i1000 -l1000 -h100000 2>/dev/null");
  if (!text) return std::nullopt;
  Histogram wakeup_us;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    double us = 0;
    long count = 0;
    if (line.empty() || line[0] == '#' || std::sscanf(line.c_str(), "%lf %ld", &us, &count) != 2) continue;
    for (; count > 0; --count) wakeup_us.add(us);
  }
  return wakeup_us;
}

/// p99.9 of some turns: the median of theirs, which a few bursts of a host don't move, and that of all ticks together.
class TurnQuantiles {
 public:
  void add(const Histogram& turn) {
    each_.push_back(turn.quantile(0.999));
    all_.add(turn);
  }
  WakeUp::Quantiles get() const { return {median(each_), all_.quantile(0.999)}; }

 private:
  std::vector<double> each_;
  Histogram all_;
};

}  // namespace

LongRun sliver_run(long ticks, int seeds) {
  constexpr double width = 2e-5, length = 0.01;
  constexpr int columns = 10000, rows = 20;
  const ContactSurface surface(testing::plate(columns, rows, columns * width, rows * length), {ContactMaterial{}}, {},
                               0);
  LongRun sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    testing::Wanderer wanderer(static_cast<std::uint64_t>(seed), 0.2, 0.02, k_travel);
    run(
        surface, ticks / seeds, {0.1, 0.1, 0.01},
        [&](long i) {
          const Vec2 at = wanderer.next();
          return Vec3{at.x, at.y, -0.002 + 0.001 * std::cos(0.01 * static_cast<double>(i))};
        },
        [](long, Vec3 at, Vec3, const ProxyState& state) {
          return std::optional(norm(state.proxy - Vec3{at.x, at.y, 2e-5}));
        },
        sum);
  }
  return sum;
}

LongRun relief_run(double size, long triangles, long ticks, int seeds) {
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
  const double stretch = size / 0.2;  // Slopes stay as they are.
  const auto height = [stretch](double x, double y) {
    return stretch * testing::rough_relief(x / stretch, y / stretch);
  };
  const ContactMesh mesh = testing::height_grid(n, n, size, size, height);
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  testing::ReferenceDescent reference(mesh, surface.skin_m());
  LongRun sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    testing::Wanderer wanderer(static_cast<std::uint64_t>(seed), size, 0.1 * size, k_travel);
    run(
        surface, ticks / seeds, {0.5 * size, 0.5 * size, height(0.5 * size, 0.5 * size) + 0.02},
        [&](long i) {
          const Vec2 at = wanderer.next();
          return Vec3{at.x, at.y, height(at.x, at.y) - 0.002 + 0.001 * std::cos(0.01 * static_cast<double>(i))};
        },
        [&](long i, Vec3 at, Vec3 before, const ProxyState& state) -> std::optional<double> {
          if (i % 100 != 99) return std::nullopt;
          return descent_gap(reference, surface, before, at, state.proxy, sum);
        },
        sum);
  }
  return sum;
}

LongRun sphere_run(long triangles, long ticks, int seeds) {
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
  const ContactSurface surface(testing::sphere(n, 0.1), {ContactMaterial{}}, {}, 0);
  LongRun sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    testing::Wanderer wanderer(static_cast<std::uint64_t>(seed), 0.4, 0.1, k_travel);
    run(
        surface, ticks / seeds, {0.12, 0, 0},
        [&](long i) {
          const Vec2 at = wanderer.next();
          const double around = (at.x - 0.2) / 0.1, up = 0.5 * std::sin((at.y - 0.2) / 0.1);
          return (0.098 + 0.001 * std::cos(0.01 * static_cast<double>(i))) *
                 Vec3{std::cos(around) * std::cos(up), std::sin(around) * std::cos(up), std::sin(up)};
        },
        [](long, Vec3 at, Vec3, const ProxyState& state) {
          return std::optional(norm(state.proxy - (0.1 / norm(at)) * at));
        },
        sum);
  }
  return sum;
}

CadRun cad_run(const Part& part, long ticks, int seeds) {
  ContactMesh mesh;
  for (const Vec3& p : part.mesh.positions) mesh.positions.push_back(1e-3 * p);
  for (const Triangle& t : part.mesh.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  const ContactSurface surface(mesh, {ContactMaterial{}}, {}, 0);
  testing::ReferenceDescent reference(mesh, surface.skin_m());
  CadRun sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    StrokeOptions stroke;
    stroke.motion = Motion::slide;
    stroke.speed_m_per_s = k_speed;
    stroke.seed = static_cast<std::uint64_t>(seed);
    stroke.seconds = k_period * static_cast<double>(ticks / seeds);
    const Trajectory hand = press_and_stroke(surface, 0, 0.5 * (surface.low() + surface.high()), stroke);
    run(
        surface, ticks / seeds, hand.position(0),
        [&](long i) { return hand.position(k_period * static_cast<double>(i)); },
        [&](long i, Vec3 at, Vec3 before, const ProxyState& state) -> std::optional<double> {
          if (i % 10 != 9 || !state.in_contact) return std::nullopt;
          const Vec3 foot = reference.nearest(at), under = reference.nearest(state.proxy);
          // Half a millimetre to spare, and under the proxy as well: it may have come over a ridge.
          if (is_nearest(reference, foot, at - foot, norm(at - foot) + 5e-4) &&
              is_nearest(reference, under, under - state.proxy, norm(at - state.proxy))) {
            const double gap =
                norm(state.proxy - foot) - norm(at - hand.position(k_period * static_cast<double>(i - 1)));
            ++sum.flat_compared;
            sum.flat_gaps += gap > k_near_m;
            sum.worst_flat_gap_m = std::max(sum.worst_flat_gap_m, gap);
          }
          return descent_gap(reference, surface, before, at, state.proxy, sum.descent);
        },
        sum.descent);
  }
  return sum;
}

std::optional<WakeUp> wake_up() {
  const ContactSurface surface(testing::plate(10, 10, 0.1, 0.1), {ContactMaterial{}}, {}, 0);
  StrokeOptions stroke;
  stroke.seconds = 1;
  const Trajectory hand = press_and_stroke(surface, 0, {0.05, 0.05, 0}, stroke);
  LoopOptions options;
  options.ticks = 1000;
  TurnQuantiles ours, theirs;
  for (int turn = 0; turn < k_wake_turns; ++turn) {
    SimDevice device(device_presets().front().caps(), hand, 1e-3);
    ours.add(run_haptic_loop(device, surface, options).wakeup_us);
    const auto other = cyclictest();
    if (!other) return std::nullopt;
    theirs.add(*other);
  }
  return WakeUp{ours.get(), theirs.get()};
}

std::optional<long> stripped_bytes(const std::string& program) {
  namespace fs = std::filesystem;
  const fs::path copy = fs::temp_directory_path() / fmt::format("papilla-stripped-{}", ::getpid());
  if (!output_of(fmt::format("strip -o '{}' '{}'", copy.string(), program))) return std::nullopt;
  const auto size = static_cast<long>(fs::file_size(copy));
  fs::remove(copy);
  return size;
}

namespace {

std::string count_text(const LongRun& r) {
  return fmt::format("{} lost of {} ticks, {} in contact", r.lost, r.ticks, r.contact);
}

void add_long_runs(BenchReport& report) {
  const bool quick = report.options().quick;
  const long ticks = quick ? 2000 : 1000000, large = quick ? 20000 : 2000000;
  const int seeds = quick ? 1 : 5;
  const LongRun slivers = sliver_run(ticks, seeds);
  report.target({"no contact lost in a million ticks on 400 000 slivers of 0.02 × 10 mm", count_text(slivers),
                 slivers.lost == 0 && slivers.contact > slivers.ticks / 2});
  const LongRun metre = relief_run(1, large, ticks, seeds);
  report.target({"no contact lost in a million ticks on a metre of relief with two million triangles",
                 count_text(metre), metre.lost == 0 && metre.contact > metre.ticks / 2});
  const LongRun sphere = sphere_run(quick ? 20000 : 200000, ticks / 5, seeds);
  const LongRun relief = relief_run(0.2, quick ? 20000 : 200000, ticks / 5, seeds);
  const auto gap = [&](const char* where, const LongRun& r) {
    report.target(
        {fmt::format("proxy within 0.1 mm and one tick of travel of the reference, {}", where),
         fmt::format("{} of {} ticks farther, worst {:.3f} mm beyond the travel{}", r.gaps, r.compared,
                     1e3 * r.worst_gap_m,
                     r.asides > 0 ? fmt::format(" ({} beside the answer to a probe 1.25 µm aside)", r.asides) : ""),
         r.gaps == 0});
  };
  gap("slivers (global closest point)", slivers);
  gap("sphere (global closest point)", sphere);
  gap("relief 0.2 m (descent from the proxy before, every 100th tick)", relief);
  gap("relief 1 m (descent from the proxy before, every 100th tick)", metre);
  const Scene cockpit = read_cad(PAPILLA_COCKPIT);
  for (const char* name : {"rim", "shifter_knob", "dash_skin", "knob_grip"}) {
    const auto part =
        std::find_if(cockpit.parts.begin(), cockpit.parts.end(), [&](const Part& p) { return p.name == name; });
    if (part == cockpit.parts.end()) throw InvalidInput(fmt::format("{}: no part {}", PAPILLA_COCKPIT, name));
    const CadRun run = cad_run(*part, quick ? 500 : 50000, seeds);
    gap(fmt::format("CAD part {}, {} triangles (descent from the proxy before, every 10th tick)", name,
                    part->mesh.triangles.size())
            .c_str(),
        run.descent);
    report.target(
        {fmt::format("proxy within 0.1 mm and one tick of travel of the global closest point where the surface is "
                     "less curved than the probe is deep, CAD part {}",
                     name),
         fmt::format("{} of {} ticks farther, worst {:.3f} mm beyond the travel; {} lost of {}", run.flat_gaps,
                     run.flat_compared, 1e3 * run.worst_flat_gap_m, run.descent.lost, run.descent.ticks),
         run.flat_gaps == 0 && run.descent.lost == 0});
  }
  report.target({"no allocation and no lock in a million ticks",
                 fmt::format("{} allocations, {} locks in {} ticks", slivers.allocations + metre.allocations,
                             slivers.locks + metre.locks, slivers.ticks + metre.ticks),
                 slivers.allocations + metre.allocations + slivers.locks + metre.locks == 0});
}

void add_felt(BenchReport& report) {
  const int ticks = report.options().quick ? 50 : 2000;
  const auto row = [&](const char* what, const testing::AnalyticRelief& relief) {
    const double share = testing::force_error(relief, 1024, k_speed, ticks).rms_share;
    report.target({fmt::format("textured force within 1 % rms of the analytic relief at 0.2 m/s, {}", what),
                   fmt::format("{:.2f} %", 100 * share), share <= 0.01});
  };
  row("sine of 2 mm and 0.1 mm", testing::sine_relief());
  row("spheres of 1.5 mm, 2 mm apart", testing::sphere_relief());

  ContactMaterial material;
  material.static_friction = 0.5;
  material.dynamic_friction = 0.3;
  const ContactSurface surface(testing::plate(10, 10, 0.1, 0.1), {material}, {}, 0);
  Proxy proxy(surface);
  proxy.reset({0.02, 0.05, 0.001});
  double worst = 0;
  for (int i = 0; i < 250; ++i) {
    const Vec3 probe{0.02 + 2e-4 * i, 0.05, -1e-3};
    const Vec3 force = heightfield_force(surface, proxy.update(probe, k_period), probe, {});
    if (i > 20) worst = std::max(worst, std::abs(-force.x / (0.3 * force.z) - 1));
  }
  report.target(
      {"sliding friction within 1 % of Coulomb's", fmt::format("{:.3f} % at worst", 100 * worst), worst <= 0.01});
}

void add_passivity(BenchReport& report) {
  EvidenceTable table{
      "Stability of every device",
      "K: the largest stable stiffness at 1 kHz. Work: the least that the hand has done on the device since "
      "it was at rest, at 0.9 K; below zero the device would feed the hand. Speed: of the handle eight "
      "seconds after it came down at 0.5 m/s, held by a spring only. m mass, b damping, f friction, Δ "
      "encoder step, t delay; every number but the largest force is assumed or derived as "
      "`--list-devices` and the header say.",
      {"device", "m [kg]", "b [N·s/m]", "f [N]", "Δ [µm]", "t [ms]", "K [N/m]", "least work [J]",
       "speed at 0.9 K [m/s]", "speed at 3 K [m/s]"},
      {}};
  bool never_negative = true, control_fails = true;
  const double seconds = report.options().quick ? 2 : 600;
  for (const DevicePreset& preset : device_presets()) {
    const testing::PortEnergy energy = testing::wall_contact(preset, 0.9, seconds, 1);
    const double calm = testing::speed_at_rest(preset, 0.9), wild = testing::speed_at_rest(preset, 3);
    never_negative = never_negative && energy.least_j >= 0 && energy.contact_share > 0.1;
    control_fails = control_fails && calm < 1e-3 && wild > 1e-2;
    const DeviceDynamics d = preset.caps().dynamics;
    table.rows.push_back({std::string(preset.name), fmt::format("{:.3f}", d.mass_kg), fmt::format("{:.2f}", d.damping),
                          fmt::format("{:.2f}", d.friction_n), fmt::format("{:.0f}", 1e6 * d.encoder_step_m),
                          fmt::format("{:.1f}", 1e3 * d.delay_s), fmt::format("{:.0f}", energy.limit),
                          fmt::format("{:.2g}", energy.least_j), fmt::format("{:.2g}", calm),
                          fmt::format("{:.2g}", wild)});
  }
  report.target({"passivity observer never negative for every device at 0.9 of its limit, 10 minutes each",
                 fmt::format("{} devices, {:.0f} s each", table.rows.size(), seconds), never_negative});
  report.target({"without the clamp, at 3 times the limit, every device goes unstable",
                 fmt::format("{} devices, see the table", table.rows.size()), control_fails});
  report.table(std::move(table));
}

void add_system(BenchReport& report) {
  const auto size = stripped_bytes(PAPILLA_PLAYER);
  report.target({"player binary at most 1 MB stripped", size ? fmt::format("{} bytes", *size) : "no strip here",
                 size ? std::optional(*size <= 1000000) : std::nullopt});
  const auto wake = report.options().quick ? std::nullopt : wake_up();
  report.target({"wake-up p99.9 no worse than cyclictest's in turn + 10 µs",
                 wake ? fmt::format("{:.0f} µs, cyclictest {:.0f} µs (medians of {} turns of 1 s; of all wake-ups "
                                    "{:.0f} and {:.0f} µs)",
                                    wake->ours.median_us, wake->cyclictest.median_us, k_wake_turns, wake->ours.all_us,
                                    wake->cyclictest.all_us)
                      : "no cyclictest here",
                 wake ? std::optional(wake->ours.median_us <= wake->cyclictest.median_us + 10) : std::nullopt});
  const int status = report.options().quick ? -1 : std::system(PAPILLA_UHID_TEST " >/dev/null 2>&1");
  const int code = status >= 0 && WIFEXITED(status) ? WEXITSTATUS(status) : 77;
  report.target({"HID path with real hidapi and a real kernel (uhid in a virtual machine)",
                 code == 77  ? "not run: no qemu or no kernel"
                 : code == 0 ? "passed"
                             : "failed",
                 code == 77 ? std::nullopt : std::optional(code == 0)});
}

}  // namespace

void add_contact_targets(BenchReport& report) {
  add_long_runs(report);
  add_felt(report);
  add_passivity(report);
  add_system(report);
}

}  // namespace papilla::bench
