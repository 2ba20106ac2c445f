// SPDX-License-Identifier: MIT
#include <papilla/io/papilla_haptic.h>
#include <papilla/core/error.hpp>
#include <papilla/io/haptic_scene.hpp>

int main() {
  char message[64] = "";
  if (papilla_haptic_open("missing.glb", nullptr, message, sizeof message) != nullptr || message[0] == 0) return 1;
  try {
    papilla::load_haptic_scene("missing.glb");
  } catch (const papilla::IoError&) {
    return 0;
  }
  return 1;
}
