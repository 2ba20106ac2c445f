// SPDX-License-Identifier: MIT
// Presses a probe into the largest material of a glTF file and prints the forces.
#include <cstdio>

#include <papilla/core/error.hpp>
#include <papilla/haptic/haptic_tick.hpp>
#include <papilla/io/haptic_scene.hpp>

static int run(int argc, char** argv) {
  using namespace papilla;
  if (argc != 2) return 2;
  HapticScene scene = load_haptic_scene(argv[1]);
  const LargestMaterial largest = largest_material(scene);
  const ContactSurface surface(scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m,
                               std::move(scene.channels));
  const auto start = surface.closest_point(largest.centre, 10, largest.material);
  if (!start) return 1;
  HapticTick tick(surface, safety_limits(3.3), 1e-3);
  for (int i = 0; i < 200; ++i) {
    DeviceState device;
    device.position = start->point + (0.005 - 3e-5 * i) * start->face_normal;
    const Vec3 force = tick(device);
    if (i % 20 == 19) std::printf("%3d ms  %.3f N\n", i + 1, norm(force));
  }
  return tick.proxy().in_contact ? 0 : 1;
}

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const papilla::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
