/* SPDX-License-Identifier: MIT */
#ifndef PAPILLA_HAPTIC_H
#define PAPILLA_HAPTIC_H

/* Forces of the materials of a glTF file, for engines and other languages. Link papilla::haptic_scene.
 *
 * All lengths in metres, forces in newtons, times in seconds, in the frame of the file (glTF: Y up). One object is used
 * by one thread at a time. papilla_haptic_tick() and papilla_haptic_reset() allocate nothing, lock nothing and make no
 * system call; the others may. A null object is refused, not followed. */

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct papilla_haptic papilla_haptic;

typedef struct papilla_haptic_options {
  double rate_hz;        /* Calls of papilla_haptic_tick() per second; 0: 1000. */
  double max_force_n;    /* Limit of the force; 0: 3.3. */
  double probe_radius_m; /* 0: the device's, 0.0005 without one; below 0: a point. */
  /* Name of a device preset ("touch"), to which stiffness and damping are limited; null: no limit. */
  const char* device;
} papilla_haptic_options;

/* Result of a tick: a sum of these. */
enum {
  PAPILLA_HAPTIC_CONTACT = 1,
  PAPILLA_HAPTIC_SLIDING = 2,
  PAPILLA_HAPTIC_FAULT = 4 /* NaN, or a position that is too old: no force until reset(). */
};

/* Loads a file. Returns null on failure, with one line of at most message_size - 1 bytes in `message` (which may be
 * null). `options` may be null. */
papilla_haptic* papilla_haptic_open(const char* path, const papilla_haptic_options* options, char* message,
                                    size_t message_size);
void papilla_haptic_close(papilla_haptic* haptic);

/* Puts the probe to `position` without contact on the way, and clears a fault; forces fade in again. Call it, too,
 * after a pause in which the hand may have gone on. */
void papilla_haptic_reset(papilla_haptic* haptic, const double position[3]);

/* One tick: computes the force on the hand from the newest position, which is age_s old. */
int papilla_haptic_tick(papilla_haptic* haptic, const double position[3], double age_s, double force[3]);

/* Proxy position and contact normal, for drawing; the normal is zero without contact. Either may be null. */
void papilla_haptic_proxy(const papilla_haptic* haptic, double position[3], double normal[3]);

size_t papilla_haptic_triangles(const papilla_haptic* haptic);
/* Names of the tagged materials, and warnings; null beyond the last. */
const char* papilla_haptic_material(const papilla_haptic* haptic, size_t index);
const char* papilla_haptic_warning(const papilla_haptic* haptic, size_t index);

#ifdef __cplusplus
}
#endif

#endif
