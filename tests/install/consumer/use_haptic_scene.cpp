// SPDX-License-Identifier: MIT
#include <papilla/core/error.hpp>
#include <papilla/io/haptic_scene.hpp>

int main() {
  try {
    papilla::load_haptic_scene("missing.glb");
  } catch (const papilla::IoError&) {
    return 0;
  }
  return 1;
}
