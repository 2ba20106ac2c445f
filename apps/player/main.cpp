// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <iostream>
#include <string>

#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/read_file.hpp"
#include "report.hpp"

namespace {

using namespace papilla;
using namespace papilla::player;

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

struct Options {
  std::string file, device = "sim", trajectory, record, json;
  double rate_hz = 1000, seconds = 0, probe_radius_mm = 0;
  bool quiet = false;
};

constexpr double k_default_seconds = 2;
constexpr double k_longest_seconds = 1e6;

/// "sim" or "sim:PRESET".
const DevicePreset& chosen_preset(const std::string& device) {
  if (device == "sim") return device_presets().front();
  if (device.starts_with("sim:")) return device_preset(device.substr(4));
  throw app::UsageError("--device " + device + ": is not sim or sim:PRESET");
}

Trajectory hand_of(const Options& options, const TaggedScene& scene, const ContactSurface& surface) {
  if (!options.trajectory.empty()) return parse_trajectory(read_file(options.trajectory), options.trajectory);
  const LargestMaterial largest = largest_material(scene);
  StrokeOptions stroke;
  stroke.seconds = options.seconds > 0 ? options.seconds : k_default_seconds;
  return press_and_stroke(surface, largest.material, largest.centre, stroke);
}

std::uint64_t ticks_of(const Options& options, const Trajectory& hand) {
  double seconds = options.seconds;
  if (!(seconds > 0)) seconds = options.trajectory.empty() ? k_default_seconds : hand.end_s() - hand.start_s();
  if (!(seconds <= k_longest_seconds)) throw InvalidInput("the run would last longer than a million seconds");
  // The recording of n ticks ends at tick n − 1: the same number when it is played again.
  const double periods = seconds * options.rate_hz;
  return static_cast<std::uint64_t>(std::llround(periods)) +
         (options.seconds > 0 || options.trajectory.empty() ? 0 : 1);
}

int run(const Options& options) {
  const DevicePreset& preset = chosen_preset(options.device);
  const double period = 1 / options.rate_hz;
  RunReport report;
  report.file = options.file;
  report.rate_hz = options.rate_hz;

  const Stopwatch clock;
  TaggedScene scene;
  {
    const Scene read = read_gltf(options.file);
    scene = tagged_scene(read, options.file, 1e-3 * options.probe_radius_mm);
  }
  ContactSurface surface(scene.mesh, scene.materials, std::move(scene.heights), 1e-3 * options.probe_radius_mm);
  const Trajectory hand = hand_of(options, scene, surface);
  scene.mesh = {};
  report.load_seconds = clock.seconds();
  report.triangles = surface.triangles();
  report.contact_bytes = surface.bytes();
  report.maps_loaded = scene.maps_loaded;
  report.maps_missing = scene.maps_missing;
  report.warnings = std::move(scene.warnings);
  report.material_names = std::move(scene.names);
  if (surface.skipped_triangles() > 0)
    report.warnings.push_back({"",
                               {"triangle_degenerate", std::to_string(surface.skipped_triangles()) +
                                                           " triangles without area were left out"}});

  SimDevice device(preset.caps(), hand, period);
  report.device = device.caps().name;
  report.stiffness_limit = stiffness_limit(device.caps().dynamics, period, 0);
  report.clamps = clamp_to_stable(surface, device.caps().dynamics, period);

  std::vector<RecordRow> rows;
  LoopOptions loop;
  loop.rate_hz = options.rate_hz;
  loop.ticks = ticks_of(options, hand);
  loop.hand = &hand;
  loop.record = options.record.empty() ? nullptr : &rows;
  loop.stop = &g_stop;
  report.loop = run_haptic_loop(device, surface, loop);

  if (!options.record.empty()) write_atomically(options.record, record_csv(rows));
  if (!options.quiet && options.json != "-") std::cout << summary(report);
  if (!options.json.empty()) {
    const std::string text =
        to_json(report).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    if (options.json == "-")
      std::cout << text;
    else
      write_atomically(options.json, text);
  }
  if (!std::cout.flush()) throw IoError("standard output: cannot be written");
  if (report.loop.device_lost) throw DeviceError(report.device + ": the device was lost");
  if (report.loop.fault == ForceGuard::Fault::stale_input)
    throw DeviceError(report.device + ": no fresh position, forces are off");
  if (report.loop.fault == ForceGuard::Fault::not_finite)
    throw DeviceError(report.device + ": a position or force was not finite, forces are off");
  return app::k_exit_done;
}

std::string preset_names() {
  std::string names;
  for (const DevicePreset& preset : device_presets()) names += (names.empty() ? "" : ", ") + std::string(preset.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { g_stop = true; });

  Options options;
  CLI::App program("papilla-player: feel the materials of a glTF file with a force device", "papilla-player");
  program.set_version_flag("--version", std::string("papilla-player ") + version());
  program.add_option("file", options.file, "The .glb or .gltf file")->required()->type_name("FILE");
  program.add_option("--device", options.device, "sim or sim:PRESET; presets: " + preset_names())
      ->capture_default_str();
  program.add_option("--rate", options.rate_hz, "Ticks per second")
      ->type_name("HZ")
      ->check(CLI::Range(100.0, 20000.0))
      ->capture_default_str();
  program.add_option("--seconds", options.seconds, "Length of the run; default: of the trajectory, or 2")
      ->type_name("S")
      ->check(CLI::Range(1e-3, k_longest_seconds));
  program
      .add_option("--trajectory", options.trajectory,
                  "The hand as CSV: t,x,y,z in seconds and metres; default: press 1 mm "
                  "into the largest tagged surface and stroke it at 0.1 m/s")
      ->type_name("T.csv");
  program
      .add_option("--record", options.record,
                  "Write hand, probe, proxy and force of every tick; can be played again as T.csv")
      ->type_name("R.csv");
  program.add_option("--probe-radius", options.probe_radius_mm, "Radius of the probe; 0 is a point")
      ->type_name("MM")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  program.add_option("--json", options.json, "Write the machine-readable result to FILE, or to stdout with -")
      ->type_name("FILE|-");
  program.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
  program.footer(
      "Example:\n  papilla-player cockpit.glb --device sim:touch --seconds 2 --json -\n"
      "Exit codes: 0 done, 2 usage, 3 input, 5 device.");
  try {
    program.parse(argc, argv);
    return run(options);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? app::k_exit_done : app::k_exit_usage;
  } catch (...) {
    return app::report_exception("papilla-player");
  }
}
