// SPDX-License-Identifier: MIT
#include <cmath>

#include "fuzz_input.hpp"
#include "gltf_mutator.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/haptic/tag_limits.hpp"
#include "papilla/io/haptic_scene.hpp"

/// From a file to forces, as papilla-player goes: a hand presses on the largest material and strokes it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  constexpr double k_period_s = 1e-3, k_max_force_n = 3.3;
  constexpr DeviceDynamics k_device{0.1, 1, 0.1, 1e-5, 1e-3};
  const auto path = fuzz::write_input("input.glb", fuzz::text_of(data, size));
  std::optional<HapticScene> scene;
  if (!fuzz::expect_read([&] { scene = load_haptic_scene(path, {.shortest_wave_m = 2e-4}); })) return 0;
  for (const MaterialWarning& warning : scene->warnings)
    fuzz::require(warning.warning.message.find('\n') == std::string::npos, "a warning is one line");
  fuzz::expect_result_or_refusal([&] {
    ContactSurface surface(scene->mesh, scene->materials, scene->heights, scene->probe_radius_m, scene->channels);
    clamp_to_stable(surface, k_device, k_period_s);
    clamp_amplitudes(surface, k_max_force_n);
    const LargestMaterial largest = largest_material(*scene);
    StrokeOptions stroke;
    stroke.seconds = 0.06;
    stroke.press_s = 0.02;
    const Trajectory hand = press_and_stroke(surface, largest.material, largest.centre, stroke);
    HapticTick tick(surface, safety_limits(k_max_force_n), k_period_s);
    tick.reset(hand.position(hand.start_s()));
    for (int i = 0; i < 60; ++i) {
      const Vec3 force = tick({hand.position(hand.start_s() + i * k_period_s), 0, 0});
      fuzz::require(is_finite(force) && norm(force) <= k_max_force_n * (1 + 1e-9), "a force is finite and limited");
    }
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_gltf(data, size, max_size, seed);
}
