// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <malloc.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "command_line.hpp"
#include "device_choice.hpp"
#include "exit_code.hpp"
#include "file_options.hpp"
#include "json_text.hpp"
#include "live_publisher.hpp"
#include "live_socket.hpp"
#include "option_checks.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "real_surface.hpp"
#include "report.hpp"
#include "standard_output.hpp"
#include "vibration_output.hpp"
#include "workspace.hpp"

namespace {

using namespace papilla;
using namespace papilla::player;

std::atomic<bool> g_stop{false};
std::atomic<int> g_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

struct Options {
  std::string file, tags, device = "sim", trajectory, record, json;
  std::optional<std::string> live;
  double rate_hz = 1000, seconds = 0, watchdog_ms = 10;
  std::optional<double> probe_radius_mm;
  double reach_mm = 0, speed = 0.1;
  std::string vibration;
  double full_scale_m_per_s2 = 50;
  std::string motion = "stroke";
  std::uint64_t seed = 1;
  std::vector<double> origin;
  std::string surface = "virtual";
  RealSurface real;

  bool is_real() const { return surface == "real"; }
  bool quiet = false, list = false, passivity = false, no_overlay = false;
};

constexpr double k_default_seconds = 2;
constexpr double k_longest_seconds = 1e6;
constexpr double k_longest_way_m = 1000;    // Of a synthetic motion, which is computed before the first tick.
constexpr double k_default_reach_m = 0.15;  // More than the radius of every workspace.

const std::map<std::string, Motion> k_motions = {
    {"stroke", Motion::stroke}, {"circle", Motion::circle}, {"slide", Motion::slide}, {"tap", Motion::tap}};

/// As asked for, else that of the device.
double probe_radius_m(const Options& options, const DeviceChoice& choice) {
  if (options.probe_radius_mm) return 1e-3 * *options.probe_radius_mm;
  return choice.preset != nullptr ? choice.preset->caps().probe_radius_m : k_default_probe_radius_m;
}

/// Holds the stimuli back to what the device can do in a tick, with a warning each.
void limit_amplitudes(ContactSurface& surface, double max_force_n, RunReport& report) {
  for (const AmplitudeClamp& clamp : clamp_amplitudes(surface, max_force_n))
    report.warnings.push_back({report.material_names[clamp.material], to_warning(clamp, max_force_n)});
}

HapticSceneOptions scene_options(const Options& options, const DeviceChoice& choice) {
  HapticSceneOptions scene;
  scene.probe_radius_m = probe_radius_m(options, choice);
  scene.shortest_wave_m = 2 * options.speed / options.rate_hz;
  scene.overlay = !options.no_overlay;
  scene.tags = options.tags;
  if (options.is_real()) return scene;  // The hand is not in the frame of the scene.
  if (!options.origin.empty() && choice.preset == nullptr) {
    scene.reach_around = {{options.origin[0], options.origin[1], options.origin[2]}};
    scene.reach_m = options.reach_mm > 0 ? 1e-3 * options.reach_mm : k_default_reach_m;
  } else if (options.reach_mm > 0 && !options.trajectory.empty()) {
    scene.reach_m = 1e-3 * options.reach_mm;
    const Trajectory hand = parse_trajectory(read_file(options.trajectory), options.trajectory);
    for (const auto& sample : hand.samples())
      if (scene.reach_around.empty() || norm(sample.position - scene.reach_around.back()) > 0.25 * scene.reach_m)
        scene.reach_around.push_back(sample.position);
    scene.reach_m *= 1.25;
  }
  return scene;
}

Trajectory make_hand(const Options& options, const HapticScene& scene, const ContactSurface& surface) {
  if (!options.trajectory.empty()) return parse_trajectory(read_file(options.trajectory), options.trajectory);
  const LargestMaterial largest = largest_material(scene);
  StrokeOptions stroke;
  stroke.motion = k_motions.at(options.motion);
  stroke.seed = options.seed;
  stroke.speed_m_per_s = options.speed;
  stroke.seconds = options.seconds > 0 ? options.seconds : k_default_seconds;
  if (stroke.seconds * stroke.speed_m_per_s > k_longest_way_m)
    throw app::UsageError("--seconds: at this speed a motion of more than " +
                          std::to_string(std::llround(k_longest_way_m / stroke.speed_m_per_s)) +
                          " s leads over more than a kilometre; give a --trajectory");
  return press_and_stroke(surface, largest.material, largest.centre, stroke);
}

std::uint64_t tick_count(const Options& options, const std::optional<Trajectory>& hand) {
  double seconds = options.seconds;
  const bool of_file = !options.trajectory.empty() && hand;
  if (!(seconds > 0))
    seconds = of_file ? hand->end_s() - hand->start_s() : hand ? k_default_seconds : k_longest_seconds;
  if (!(seconds <= k_longest_seconds)) throw InvalidInput("the run would last longer than a million seconds");
  // A recording of n ticks ends at tick n − 1, and is replayed with n ticks.
  return static_cast<std::uint64_t>(std::llround(seconds * options.rate_hz)) +
         (options.seconds > 0 || !of_file ? 0 : 1);
}

/// The first line of the --live protocol.
std::string live_greeting(const RunReport& report, const Options& options) {
  const nlohmann::ordered_json greeting = {{"papilla_live", 1},
                                           {"file", std::filesystem::absolute(options.file).string()},
                                           {"device", report.device},
                                           {"rate_hz", report.rate_hz}};
  return greeting.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void write_json(const Options& options, const nlohmann::ordered_json& json) {
  if (options.json == "-")
    app::print_out(app::json_text(json));
  else if (!options.json.empty())
    write_atomically(options.json, app::json_text(json));
}

/// Identity and state of a file.
struct FileStamp {
  dev_t device = 0;
  ino_t inode = 0;
  off_t bytes = -1;  ///< −1: there is none.
  std::int64_t changed_ns = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

FileStamp stamp_of(const std::filesystem::path& path) noexcept {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  return {s.st_dev, s.st_ino, s.st_size, std::int64_t{1000000000} * s.st_mtim.tv_sec + s.st_mtim.tv_nsec};
}

/// A thread that calls `action` every `period` until it returns false or the object is destroyed.
std::jthread repeat_every(std::chrono::milliseconds period, std::function<bool()> action) {
  return std::jthread([period, action = std::move(action)](const std::stop_token& end) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, end, period, [&] { return end.stop_requested(); }) && action()) {
    }
  });
}

void print_status(const LoopStatus& s) {
  fmt::print(
      stderr,
      "\r\033[K{} ticks, force {:.2f} N, contact on {}, lost on {}, late on {}, tick {:.1f} us, wake-up {:.0f} us",
      s.ticks.load(), s.force_n.load(), s.contact_ticks.load(), s.lost_contact_ticks.load(), s.missed_deadlines.load(),
      s.tick_us.load(), s.wakeup_us.load());
  std::fflush(stderr);
}

/// Why a run that has ended is a failure, though it has a report.
void check_end(const RunReport& report, bool file_changed, const std::string& file) {
  if (report.loop.device_lost) throw DeviceError(report.device + ": the device was lost");
  if (report.loop.fault == ForceGuard::Fault::stale_input)
    throw DeviceError(report.device + ": no fresh position, forces are off");
  if (report.loop.fault == ForceGuard::Fault::not_finite)
    throw DeviceError(report.device + ": a position or force was not finite, forces are off");
  if (file_changed) throw DeviceError(file + ": changed while it was played, forces are off");
  if (g_signal != 0)
    throw DeviceError(report.device + ": stopped by signal " + std::to_string(g_signal) + ", forces are off");
}

int run(const Options& options) {
  if (!options.vibration.empty()) require_sound_target(options.vibration);
  const DeviceChoice choice = parse_device(options.device);
  const double period = 1 / options.rate_hz;
  RunReport report;
  report.file = options.file;
  report.rate_hz = options.rate_hz;

  const Stopwatch clock;
  const FileStamp stamp = stamp_of(options.file);
  HapticScene scene = load_haptic_scene(options.file, scene_options(options, choice));
  ContactSurface surface = [&] {
    try {
      return ContactSurface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m,
                            std::move(scene.channels));
    } catch (const InvalidInput& error) {
      throw InvalidInput(options.file + ": " + error.what());
    }
  }();
  std::optional<Trajectory> hand;
  if (choice.preset != nullptr) hand = make_hand(options, scene, surface);
  std::optional<RealPart> real_part;
  if (options.is_real()) {
    const Registration registration = register_part(options.real, scene, surface);
    report.registration_residual_mm = 1e3 * registration.residual_m;
    real_part.emplace(surface, registration.to_part, RealPartOptions{.press_n = options.real.press_n});
  }
  const bool centred = choice.preset == nullptr && !real_part;
  const Vec3 origin = centred ? workspace_origin(options.origin, scene, surface, options.file) : Vec3{};
  scene.mesh = {};
  ::malloc_trim(0);  // Or what loading took is locked into memory with the rest.
  report.load_seconds = clock.seconds();
  report.probe_radius_m = surface.probe_radius_m();
  report.triangles = surface.triangles();
  report.contact_bytes = surface.bytes();
  report.maps_loaded = scene.maps_loaded;
  report.maps_missing = scene.maps_missing;
  report.maps_coarsened = scene.maps_coarsened;
  report.roughness_overlays = scene.roughness_overlays;
  report.channels_loaded = scene.channels_loaded;
  report.channels_missing = scene.channels_missing;
  report.tags = std::move(scene.tags);
  report.triangles_out_of_reach = scene.triangles_out_of_reach;
  report.warnings = std::move(scene.warnings);
  report.material_names = std::move(scene.names);
  if (surface.skipped_triangles() > 0)
    report.warnings.push_back({"",
                               {"triangle_degenerate", std::to_string(surface.skipped_triangles()) +
                                                           " triangles without area were left out"}});

  std::optional<SimDevice> simulated;
  std::optional<OpenedDevice> opened;
  if (hand)
    simulated.emplace(choice.preset->caps(), *hand, period);
  else
    opened.emplace(choice.filter, origin);
  HapticDevice& device = simulated ? *simulated : opened->device();
  if (opened && !opened->watched())
    report.warnings.push_back({"", {"device_unwatched", "no second process watches over the device"}});
  report.device = device.caps().name;
  report.stiffness_limit = stiffness_limit(device.caps().dynamics, period, 0);
  report.clamps = clamp_to_stable(surface, device.caps().dynamics, period);
  limit_amplitudes(surface, device.caps().max_force_n, report);

  std::vector<RecordRow> rows;
  LoopOptions loop;
  loop.rate_hz = options.rate_hz;
  loop.ticks = tick_count(options, hand);
  loop.hand = hand ? &*hand : nullptr;
  loop.real_part = real_part ? &*real_part : nullptr;
  loop.record = options.record.empty() ? nullptr : &rows;
  loop.stop = &g_stop;
  loop.control_passivity = options.passivity;
  loop.watchdog_s = 1e-3 * options.watchdog_ms;
  LoopStatus status;
  loop.status = &status;
  std::atomic<bool> file_changed{false};
  {
    const auto watch = repeat_every(std::chrono::milliseconds(100), [&] {
      if (stamp_of(options.file) == stamp) return true;
      file_changed = g_stop = true;
      return false;
    });
    std::optional<LivePublisher> publisher;
    if (options.live) publisher.emplace(*options.live, live_greeting(report, options));
    if (publisher) loop.latest = &publisher->slot();
    std::optional<VibrationOutput> vibration;
    if (!options.vibration.empty())
      vibration.emplace(options.vibration, surface, options.rate_hz, options.full_scale_m_per_s2).follow(loop);
    std::optional<std::jthread> view;
    const bool shown = !options.quiet && ::isatty(STDERR_FILENO) != 0;
    if (shown) view = repeat_every(std::chrono::milliseconds(200), [&] { return print_status(status), true; });
    report.loop = run_haptic_loop(device, surface, loop);
    view.reset();
    if (shown) print_status(status), std::fputc('\n', stderr);
    if (vibration) report.vibration = vibration->finish();
  }

  std::optional<app::Failure> failure;
  try {
    if (!options.record.empty()) write_atomically(options.record, record_csv(rows));
    check_end(report, file_changed, options.file);
  } catch (const Error&) {
    failure = app::failure_in_flight();
  }
  if (!options.quiet && options.json != "-") app::print_out(summary(report));
  nlohmann::ordered_json json = to_json(report);
  if (failure) app::add_failure(json, *failure);
  write_json(options, json);
  return failure ? app::print_failure("papilla-player", *failure) : app::k_exit_done;
}

int list_devices(const Options& options) {
  const auto list = device_list();
  if (options.json != "-" && !options.quiet) app::print_out(device_list_text(list));
  write_json(options, list);
  return app::k_exit_done;
}

void check_real(const Options& options) {
  const bool real = options.is_real();
  if (!real && !(options.real.touched.empty() && options.real.part_points.empty()))
    throw app::UsageError("--touched and --part-points need --surface real");
  if (real && !options.vibration.empty())
    throw app::UsageError("--vibration needs --surface virtual: a real part makes its own");
  if (real && options.real.touched.empty()) throw app::UsageError("--surface real needs --touched");
  if (real && options.trajectory.empty() && options.device.starts_with("sim"))
    throw app::UsageError("--surface real on a simulated device needs a --trajectory, which moves on the real part");
}

std::string preset_names() {
  std::string names;
  for (const DevicePreset& preset : device_presets()) names += (names.empty() ? "" : ", ") + std::string(preset.name);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int number) {
      g_signal = number;
      g_stop = true;
    });

  start_file_guard();

  Options options;
  CLI::App program("papilla-player: feel the materials of a glTF file with a force device", "papilla-player");
  program.set_version_flag("--version", std::string("papilla-player ") + version());
  auto* const file = app::reads(program.add_option("file", options.file, "The .glb or .gltf file"))->type_name("FILE");
  program.add_flag("--list-devices", options.list, "List force devices, connected and simulated, and end");
  program
      .add_option(
          "--device", options.device,
          "sim[:PRESET] or hid[:VID:PID[:SERIAL]]; hid takes the first force device; presets: " + preset_names())
      ->type_name("DEVICE|{sim,hid}")
      ->capture_default_str();
  program
      .add_option(
          "--origin", options.origin,
          "Where the middle of a hid device's workspace lies in the scene; default: 10 mm in front of the largest "
          "tagged surface")
      ->type_name("X,Y,Z [m]")
      ->delimiter(',')
      ->expected(3);
  program.add_option("--rate", options.rate_hz, "Ticks per second")
      ->type_name("HZ")
      ->check(app::in_range(100.0, 20000.0))
      ->capture_default_str();
  program.add_option("--seconds", options.seconds, "Length of the run; default: of the trajectory, or 2")
      ->type_name("S")
      ->check(app::in_range(1e-3, k_longest_seconds));
  app::reads(program.add_option("--trajectory", options.trajectory,
                                "The hand as CSV: t,x,y,z in seconds and metres; default: press 1 mm "
                                "into the largest tagged surface and move there"))
      ->type_name("T.csv");
  program.add_option("--motion", options.motion, "How the hand moves without a trajectory")
      ->transform(app::one_of({"stroke", "circle", "slide", "tap"}))
      ->capture_default_str();
  program.add_option("--seed", options.seed, "Of the random slide")->check(app::not_negative())->capture_default_str();
  program
      .add_option("--speed", options.speed,
                  "Of the hand; finer relief than the rate can carry at this speed is left out")
      ->type_name("M/S")
      ->check(app::in_range(1e-3, 2.0))
      ->capture_default_str();
  program
      .add_option("--reach", options.reach_mm,
                  "Load only what is this near to the trajectory or to --origin; default: all, or 150 around --origin")
      ->type_name("MM")
      ->check(app::in_range(1.0, 1e5));
  program
      .add_option("--surface", options.surface,
                  "real: the tip moves on a real part that the file describes, and the device gives the deviation of "
                  "the texture alone")
      ->transform(app::one_of({"virtual", "real"}))
      ->capture_default_str();
  const auto points = [&](const char* name, std::vector<double>& values, const char* what) {
    program.add_option(name, values, what)
        ->type_name("X,Y,Z,X,Y,Z,X,Y,Z [m]")
        ->delimiter(',')
        ->expected(9)
        ->check(app::in_range(-1e6, 1e6));
  };
  points("--touched", options.real.touched,
         "Where the tip touched three points of the real part, as --record has them");
  points("--part-points", options.real.part_points,
         "The same three points in the file; default: the part is a plane, which the first point lays on the middle of "
         "the largest tagged surface");
  program.add_option("--press", options.real.press_n, "Load of the hand on the real part, which no device measures")
      ->type_name("N")
      ->check(app::in_range(0.0, 20.0))
      ->capture_default_str();
  app::writes(program.add_option("--record", options.record,
                                 "Write hand, probe, proxy and force of every tick; can be played again as T.csv"))
      ->type_name("R.csv");
  app::writes_if_file(
      program.add_option("--vibration", options.vibration,
                         "Write the acceleration of the stroke as sound, 20 to 1000 Hz: a .wav file, or play it on an "
                         "ALSA device, for voice coils, controllers with audio haptics and headphones"))
      ->type_name("FILE.wav|{alsa}[:DEVICE]");
  program.add_option("--full-scale", options.full_scale_m_per_s2, "Acceleration that is 1 in the sound")
      ->type_name("M/S2")
      ->check(app::in_range(0.01, 1e4))
      ->capture_default_str();
  program
      .add_option("--probe-radius", options.probe_radius_mm,
                  "Radius of the probe, default: the device's, 0.5; 0: a point")
      ->type_name("MM")
      ->check(app::in_range(0.0, 100.0));
  program.add_flag("--no-overlay", options.no_overlay,
                   "Leave out the roughness that tags ask to be laid over their height maps");
  program.add_flag("--passivity-control", options.passivity,
                   "Soften a contact that gives energy to the hand, beside the limit of stiffness");
  program.add_option("--watchdog", options.watchdog_ms, "Age of a position from which on there is no force")
      ->type_name("MS")
      ->check(app::in_range(1.0, 1000.0))
      ->capture_default_str();
  auto* const live =
      app::writes(
          program.add_option("--live", options.live,
                             "Tell what happens over a local socket, for papilla view --follow; "
                             "in a folder of this user alone; default: $XDG_RUNTIME_DIR/papilla/player.sock, or "
                             "/tmp/papilla-UID/player.sock"))
          ->type_name("[SOCKET]")
          ->expected(0, 1);
  app::reads(program.add_option("--tags", options.tags,
                                "The file as it was before another program changed it: tags that are missing are "
                                "taken from there"))
      ->type_name("FILE");
  app::writes(
      program.add_option("--json", options.json, "Write the machine-readable result to FILE, or to stdout with -"))
      ->type_name("FILE|-");
  program.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
  program.footer(
      "Example:\n  papilla-player cockpit.glb --device sim:touch --seconds 2 --json -\n"
      "Exit codes: 0 done, 2 usage, 3 input, 5 device.");
  const bool as_json = app::wants_json_on_stdout(argc, argv);
  try {
    try {
      program.parse(argc, argv);
      app::refuse_no_numbers(program);
    } catch (const CLI::ParseError& error) {
      return app::report_parse_error(program, error, as_json);
    }
    app::declare_files(program);
    if (options.list) return list_devices(options);
    if (!live->empty() && options.live.value_or("").empty()) options.live = app::default_live_socket();
    if (file->empty()) throw app::UsageError("a FILE is required");
    if (!options.vibration.empty() && !is_sound_target(options.vibration))
      throw app::UsageError("--vibration '" + options.vibration + "': is neither FILE.wav nor alsa or alsa:DEVICE");
    check_real(options);
    return run(options);
  } catch (...) {
    return app::report_exception("papilla-player", as_json);
  }
}
