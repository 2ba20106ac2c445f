// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <span>
#include <thread>

#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/haptic/trajectory.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla::python {
namespace {

/// What a simulated hand on a simulated device felt.
struct Simulation {
  std::vector<RecordRow> rows;
  LoopResult loop;
  std::vector<StabilityClamp> stability_clamps;
  std::vector<AmplitudeClamp> amplitude_clamps;
};

/// Positions as a trajectory; the object of Python owns nothing else.
Trajectory trajectory_of(std::span<const double> times, std::span<const Vec3> positions) {
  if (times.size() != positions.size())
    throw UsageError("Trajectory: has " + std::to_string(times.size()) + " times for " +
                     std::to_string(positions.size()) + " positions");
  std::vector<Trajectory::Sample> samples(times.size());
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = {times[i], positions[i]};
  return Trajectory(std::move(samples));
}

ContactSurface surface_of(const HapticScene& scene) {
  return {scene.mesh, scene.materials, scene.heights, scene.probe_radius_m, scene.channels};
}

/// Calls `progress` fifty times a second while a loop runs, and stops the loop when that returns false.
class LoopProgress {
 public:
  LoopProgress(LoopOptions& options, const ProgressCallback& progress) {
    options.status = &status_;
    options.stop = &stop_;
    if (!progress) return;
    watch_ = std::jthread([this, &progress, ticks = options.ticks](const std::stop_token& ended) {
      std::mutex mutex;
      std::condition_variable_any waiting;
      std::unique_lock lock(mutex);
      while (!stop_) {
        waiting.wait_for(lock, ended, std::chrono::milliseconds(20), [] { return false; });
        if (ended.stop_requested()) return;
        const double share =
            static_cast<double>(status_.ticks.load()) / static_cast<double>(std::max<std::uint64_t>(ticks, 1));
        if (!progress({"play", std::min(1.0, share)})) stop_ = true;
      }
    });
  }
  bool stopped() const { return stop_; }

 private:
  LoopStatus status_;
  std::atomic<bool> stop_ = false;
  std::jthread watch_;
};

Simulation simulate(ContactSurface& surface, const Trajectory& hand, const DeviceCaps& caps, double rate_hz,
                    std::uint64_t ticks, bool control_passivity, const ProgressCallback& progress) {
  if (!(rate_hz > 0)) throw InvalidInput("simulate: rate_hz must be positive");
  Simulation result;
  SimDevice device(caps, hand, 1 / rate_hz);
  result.stability_clamps = clamp_to_stable(surface, caps.dynamics, 1 / rate_hz);
  result.amplitude_clamps = clamp_amplitudes(surface, caps.max_force_n);
  LoopOptions options;
  options.rate_hz = rate_hz;
  options.ticks = ticks;
  options.control_passivity = control_passivity;
  options.paced = false;
  options.hand = &hand;
  options.record = &result.rows;
  const LoopProgress watched(options, progress);
  result.loop = run_haptic_loop(device, surface, options);
  if (watched.stopped()) throw Cancelled("cancelled during 'play'");
  return result;
}

DeviceCaps caps_of(const std::string& name) { return device_preset(name).caps(); }

/// A tick with what it stands on.
class Tick {
 public:
  Tick(const ContactSurface& surface, const SafetyLimits& limits, double rate_hz)
      : tick_(std::make_unique<HapticTick>(surface, limits, 1 / rate_hz)) {}

  /// The forces at positions of consecutive ticks.
  std::vector<Vec3> forces(std::span<const Vec3> positions) {
    std::vector<Vec3> forces(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) forces[i] = (*tick_)({.position = positions[i]});
    return forces;
  }
  HapticTick& operator*() { return *tick_; }

 private:
  std::unique_ptr<HapticTick> tick_;
};

void add_surface(py::module_& module) {
  py::class_<ContactSurface> type(
      module, "ContactSurface",
      "The obstacle of a haptic scene: triangles with relief, indexed for queries at 1 kHz. Metres, in the frame of "
      "the scene. Made by contact_surface().");
  type.def_property_readonly("triangles", &ContactSurface::triangles, "Number of triangles that are kept.");
  type.def_property_readonly("skipped_triangles", &ContactSurface::skipped_triangles);
  type.def_property_readonly("material_count", &ContactSurface::material_count);
  type.def_property_readonly("probe_radius_m", &ContactSurface::probe_radius_m);
  type.def_property_readonly("skin_m", &ContactSurface::skin_m);
  type.def_property_readonly("tallest_relief_m", &ContactSurface::tallest_relief_m);
  type.def_property_readonly("low", &ContactSurface::low, "Box of the base, in the frame of the scene [m].");
  type.def_property_readonly("high", &ContactSurface::high);
  type.def(
      "material",
      [](const ContactSurface& surface, std::uint32_t index) {
        if (index >= surface.material_count()) throw py::index_error("there is no such material");
        return ContactMaterial(surface.material(index));
      },
      py::arg("index"), "A copy of the numbers of one material.");
  type.def(
      "closest_point",
      [](const ContactSurface& surface, const Vec3& position, double radius_m) {
        return surface.closest_point(position, radius_m);
      },
      py::arg("position"), py::arg("radius_m"), "Closest point of the base within radius_m, or None.");
  type.def(
      "clearance",
      [](const ContactSurface& surface, const py::object& positions, double radius_m) {
        ReadRows<Vec3> rows(positions, "ContactSurface.clearance: positions");
        const std::span<const Vec3> points = rows.get();
        std::vector<double> clearances(points.size());
        {
          const py::gil_scoped_release without_gil;
          for (std::size_t i = 0; i < points.size(); ++i) clearances[i] = surface.clearance(points[i], radius_m);
        }
        return take(std::move(clearances));
      },
      py::arg("positions"), py::arg("radius_m"),
      "Clearance of a probe at each of the positions (n, 3) [m], as the class of the headers defines it; where no "
      "triangle is within radius_m, radius_m less the contact radius.");
}

void add_trajectory(py::module_& module) {
  py::class_<Trajectory> type(module, "Trajectory",
                              "Position of the hand over time: linear between samples, constant before and after.");
  type.def(py::init([](const py::object& times, const py::object& positions) {
             return trajectory_of(ReadRows<double>(times, "Trajectory: t").get(),
                                  ReadRows<Vec3>(positions, "Trajectory: positions").get());
           }),
           py::arg("t"), py::arg("positions"),
           "Times (n,) in seconds, increasing, and positions (n, 3) in metres. Raises InvalidInput naming the sample.");
  type.def_property_readonly("start_s", &Trajectory::start_s);
  type.def_property_readonly("end_s", &Trajectory::end_s);
  type.def_property_readonly(
      "t",
      [](const Trajectory& trajectory) {
        std::vector<double> times;
        for (const Trajectory::Sample& sample : trajectory.samples()) times.push_back(sample.t);
        return take(std::move(times));
      },
      "Times of the samples [s].");
  type.def_property_readonly(
      "positions",
      [](const Trajectory& trajectory) {
        std::vector<Vec3> positions;
        for (const Trajectory::Sample& sample : trajectory.samples()) positions.push_back(sample.position);
        return take(std::move(positions));
      },
      "Positions of the samples, (n, 3) [m].");
  type.def("position", &Trajectory::position, py::arg("t"), "The position at time t, exact at the times of samples.");
}

void add_tick(py::module_& module) {
  py::class_<Tick> type(module, "HapticTick",
                        "From positions to forces, one a tick: proxy, force model, safety. Forces fade in from the "
                        "first contact on and change no faster than the limits let them; without limits they are "
                        "those of a device of 3.3 N.");
  type.def(py::init([](const ContactSurface& surface, const std::optional<SafetyLimits>& limits, double rate_hz) {
             if (!(rate_hz > 0)) throw UsageError("HapticTick: rate_hz must be positive");
             return Tick(surface, limits.value_or(safety_limits(SafetyLimits{}.max_force_n)), rate_hz);
           }),
           py::arg("surface"), py::arg("limits") = py::none(), py::arg("rate_hz") = LoopOptions{}.rate_hz,
           py::keep_alive<1, 2>());
  type.def(
      "force", [](Tick& tick, const Vec3& position) { return (*tick)({.position = position}); }, py::arg("position"),
      "The force on the hand [N] at the next tick, with the probe at position [m].");
  type.def(
      "forces",
      [](Tick& tick, const py::object& positions) {
        ReadRows<Vec3> points(positions, "HapticTick.forces: positions");
        std::vector<Vec3> forces;
        {
          const py::gil_scoped_release without_gil;
          forces = tick.forces(points.get());
        }
        return take(std::move(forces));
      },
      py::arg("positions"), "The forces (n, 3) [N] at the positions (n, 3) [m] of the next n ticks.");
  type.def(
      "reset", [](Tick& tick, const Vec3& position) { (*tick).reset(position); }, py::arg("position"),
      "Puts the probe to position without contact on the way; clears a fault, and forces fade in again.");
  type.def_property_readonly("in_contact", [](Tick& tick) { return (*tick).proxy().in_contact; });
  type.def_property_readonly(
      "proxy", [](Tick& tick) { return Vec3((*tick).proxy().proxy); },
      "Centre of the probe's ball where the surfaces allow it [m].");
  type.def_property_readonly(
      "lost", [](Tick& tick) { return (*tick).lost(); }, "The last tick lost its contact.");
}

}  // namespace

template <>
struct RecordTraits<Simulation> : IsRecord<false> {};
template <>
struct IsBoundClass<ContactSurface> : BoundByHand<false> {};
template <>
struct IsBoundClass<Trajectory> : BoundByHand<false> {};

void add_haptic(py::module_& module) {
  add_surface(module);
  add_trajectory(module);
  add_tick(module);
  Record<Simulation>(module, "Simulation", "What a simulated hand on a simulated device felt.")
      .field<&Simulation::rows>("rows", "NDArray[np.void]",
                                "A tick each: t [s], hand, probe, proxy [m], force [N], in_contact.")
      .field<&Simulation::loop>("loop", "LoopResult", "")
      .field<&Simulation::stability_clamps>("stability_clamps", "tuple[StabilityClamp, ...]",
                                            "Materials whose stiffness or damping the device can't show.")
      .field<&Simulation::amplitude_clamps>("amplitude_clamps", "tuple[AmplitudeClamp, ...]",
                                            "Materials whose stimulus is too strong for the device.")
      .done();
  define<HapticSceneOptions>(module, "load_haptic_scene(path: str | os.PathLike[str]) -> HapticScene",
                             docs::load_haptic_scene,
                             [](const std::filesystem::path& path, const HapticSceneOptions& options) {
                               return load_haptic_scene(path, options);
                             });
  define<HapticSceneOptions>(module, "haptic_scene(scene: Scene, path: str | os.PathLike[str]) -> HapticScene",
                             docs::haptic_scene,
                             [](const Scene& scene, const std::filesystem::path& path,
                                const HapticSceneOptions& options) { return haptic_scene(scene, path, options); });
  define(module, "contact_surface(scene: HapticScene) -> ContactSurface",
         "The obstacle of a haptic scene. Raises InvalidInput when no triangle is left.",
         [](const HapticScene& scene) { return surface_of(scene); });
  define(module, "largest_material(scene: HapticScene) -> LargestMaterial",
         "The material with the largest area, and the centroid of that area.",
         [](const HapticScene& scene) { return largest_material(scene); });
  define<StrokeOptions>(
      module, "press_and_stroke(surface: ContactSurface, material: int, near: ArrayLike) -> Trajectory",
      docs::press_and_stroke,
      [](const ContactSurface& surface, std::uint32_t material, const Vec3& near, const StrokeOptions& options) {
        return press_and_stroke(surface, material, near, options);
      });
  define(module, "device_names() -> list[str]", "The simulated devices; the first is the default.", [] {
    std::vector<std::string> names;
    for (const DevicePreset& preset : device_presets()) names.emplace_back(preset.name);
    return names;
  });
  define(module, "device_caps(name: str) -> DeviceCaps",
         "What a simulated device can do. Raises DeviceError listing the names when there is none of this name.",
         [](const std::string& name) { return caps_of(name); });
  define(module,
         "clamp_to_stable(surface: ContactSurface, device: DeviceDynamics, period_s: float) -> "
         "list[StabilityClamp]",
         docs::clamp_to_stable, [](ContactSurface& surface, const DeviceDynamics& device, double period_s) {
           return clamp_to_stable(surface, device, period_s);
         });
  define(module, "safety_limits(max_force_n: float) -> SafetyLimits", docs::safety_limits,
         [](double max_force_n) { return safety_limits(max_force_n); });
  define(module,
         "simulate(surface: ContactSurface, hand: Trajectory, device: DeviceCaps, rate_hz: float = 1000.0, ticks: int "
         "= 2000, control_passivity: bool = False) -> Simulation",
         "Lets a simulated hand move along a trajectory on a simulated device and records every tick: "
         "clamp_to_stable() and clamp_amplitudes() of the surface, then run_haptic_loop() as fast as it goes. "
         "Deterministic, bit for bit.\nRaises InvalidInput when the rate is not in [1, 100000] or a number of the "
         "device is out of range.",
         [](ContactSurface& surface, const Trajectory& hand, const DeviceCaps& device, double rate_hz,
            std::uint64_t ticks, bool control_passivity, const ProgressCallback& progress) {
           return simulate(surface, hand, device, rate_hz, ticks, control_passivity, progress);
         });
}

}  // namespace papilla::python
