/* SPDX-License-Identifier: MIT */
#include <papilla/io/papilla_haptic.h>

int main(void) {
  char message[64] = "";
  if (papilla_haptic_abi() != PAPILLA_HAPTIC_ABI) return 1;
  return papilla_haptic_open("missing.glb", NULL, message, sizeof message) == NULL && message[0] != 0 ? 0 : 1;
}
