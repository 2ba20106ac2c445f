/* SPDX-License-Identifier: MIT */
/* Lowers a probe onto a glTF file from a place in front of it and prints the forces: forces FILE X Y Z, in metres. */
#include <papilla/io/papilla_haptic.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  char message[256];
  double position[3], force[3], proxy[3];
  int i, found = 0;
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  papilla_haptic* haptic;
  if (argc != 5) return 2;
  options.device = "touch";
  haptic = papilla_haptic_open(argv[1], &options, message, sizeof message);
  if (haptic == NULL) {
    fprintf(stderr, "%s\n", message);
    return 3;
  }
  for (i = 0; i < 3; ++i) position[i] = strtod(argv[2 + i], NULL);
  papilla_haptic_reset(haptic, position);
  for (i = 1; i <= 200; ++i) {
    position[1] -= 5e-5; /* glTF is Y up. */
    found = papilla_haptic_tick(haptic, position, 0, force);
    papilla_haptic_proxy(haptic, proxy, NULL);
    if (i % 20 == 0) printf("%3d ms  %.3f N  proxy at %.4f m\n", i, force[1], proxy[1]);
  }
  for (i = 0; i < papilla_haptic_warning_count(haptic); ++i)
    printf("%s\n", papilla_haptic_warning(haptic, (uint32_t)i));
  papilla_haptic_close(haptic);
  return (found & PAPILLA_HAPTIC_CONTACT) != 0 ? 0 : 1;
}
