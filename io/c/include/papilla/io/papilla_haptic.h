/* SPDX-License-Identifier: MIT */
#ifndef PAPILLA_HAPTIC_H
#define PAPILLA_HAPTIC_H

/* Forces of the materials of a glTF file, for engines and other languages. C99; link libpapilla.so (papilla::c).
 *
 * Units: metres, newtons, seconds, in the frame of the file (glTF: right-handed, Y up). Texture coordinates are those
 * of the file, (0, 0) is the upper left corner of a picture.
 *
 * Handles: papilla_haptic_open() gives a handle, which is a name and no address: nothing behind it is read before it is
 * known to be open. Null, numbers that are no handle, addresses and handles that were closed are refused by every
 * function. At most PAPILLA_HAPTIC_MOST_OPEN are open at a time.
 *
 * Pointers: a null pointer is refused, or, where it says so, means that the caller does not want the value. What a
 * pointer that is not null points to can not be checked. Texts that are returned are UTF-8, end with a zero, and live
 * as long as the handle.
 *
 * Threads: functions may be called from any thread; one handle by one thread at a time. papilla_haptic_tick(),
 * papilla_haptic_reset(), papilla_haptic_proxy() and papilla_haptic_height() allocate nothing, lock nothing and make no
 * system call; the others may.
 *
 * Errors: nothing throws, nothing ends the program. Functions that return int32_t return 0 or more for success and one
 * of papilla_haptic_error for failure.
 *
 * Stability: within a number of PAPILLA_HAPTIC_ABI functions keep their name, parameters and meaning, structs only grow
 * at their end, and enumerators keep their values. Structs begin with struct_size, which the caller sets to sizeof of
 * the struct that it was compiled with. Smaller ones than the library's are those of older callers: what they do not
 * have gets its default or is not written. Larger options are accepted when all that the library does not know is zero,
 * of larger results only the known part is written. A caller compares papilla_haptic_abi() with PAPILLA_HAPTIC_ABI. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PAPILLA_HAPTIC_API __attribute__((visibility("default")))
#else
#define PAPILLA_HAPTIC_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define PAPILLA_HAPTIC_ABI 1
#define PAPILLA_HAPTIC_MOST_OPEN 256

/* An open scene with one probe. */
typedef struct papilla_haptic papilla_haptic;

typedef enum papilla_haptic_error {
  PAPILLA_HAPTIC_NONE = -1,        /* There is none: no contact, no material of that number, no relief. */
  PAPILLA_HAPTIC_BAD_HANDLE = -2,  /* The handle is not open. */
  PAPILLA_HAPTIC_BAD_ARGUMENT = -3 /* A null pointer, or a struct_size that is none. */
} papilla_haptic_error;

/* Result of a tick: a sum of these. */
typedef enum papilla_haptic_flag {
  PAPILLA_HAPTIC_CONTACT = 1,
  PAPILLA_HAPTIC_SLIDING = 2,
  PAPILLA_HAPTIC_FAULT = 4 /* NaN, or a position that is too old: no force until papilla_haptic_reset(). */
} papilla_haptic_flag;

/* Zero, but for struct_size, is the default of every member. */
typedef struct papilla_haptic_options {
  uint64_t struct_size;  /* sizeof(papilla_haptic_options) */
  double rate_hz;        /* Calls of papilla_haptic_tick() per second, 1 to 1e5; 0: 1000. */
  double max_force_n;    /* Limit of the force, below 1000; 0: 3.3. */
  double probe_radius_m; /* Of the ball that touches, below 1; 0: the device's, 0.0005 without one; below 0: a point. */
  double felt_depth_m;   /* Depth to which reliefs are rounded to hold a probe steady; 0: 0.002; below 0: not at all. */
  const char* device; /* Name of a device preset ("touch"), to which stiffness and damping are limited; null: none. */
  const char* tags;   /* A glTF file whose haptic tags replace those that an editor dropped; null: none. */
} papilla_haptic_options;

#define PAPILLA_HAPTIC_OPTIONS_INIT \
  { sizeof(papilla_haptic_options), 0, 0, 0, 0, NULL, NULL }

/* What a material feels like, as the ticks use it: limited to what is stable on the device. */
typedef struct papilla_haptic_constants {
  uint64_t struct_size;     /* sizeof(papilla_haptic_constants) */
  double stiffness;         /* N/m, of the skin. */
  double damping;           /* N s/m, along the contact normal. */
  double static_friction;   /* Coulomb's, dimensionless. */
  double dynamic_friction;  /* At most static_friction. */
  double stribeck_velocity; /* m/s, over which static friction fades into dynamic. */
  double backing_stiffness; /* N/m, of what lies below the skin. */
  double backing_depth_m;   /* Where it is reached; infinity: never. */
  double max_stiffness;     /* N/m, of its map; `stiffness` without one. */
} papilla_haptic_constants;

/* The height field of a material. */
typedef struct papilla_haptic_relief {
  uint64_t struct_size; /* sizeof(papilla_haptic_relief) */
  uint32_t width;  /* Samples along u. The centre of sample (x, y) is at ((x + 1/2)/width, (y + 1/2)/height) of the */
  uint32_t height; /* texture coordinates after the texture transform of the tag. */
  double min_m;    /* Bounds of the height everywhere, along the outward normal. */
  double max_m;
} papilla_haptic_relief;

/* PAPILLA_HAPTIC_ABI and the version "x.y.z" of the library that is loaded. */
PAPILLA_HAPTIC_API uint32_t papilla_haptic_abi(void);
PAPILLA_HAPTIC_API const char* papilla_haptic_version(void);

/* Loads a glTF file. Returns null on failure, with one line of at most message_size - 1 bytes in `message`, which names
 * file, place and reason; `message` may be null, and is empty after success. `options` may be null. The cost is that of
 * reading the file and about a microsecond a triangle. */
PAPILLA_HAPTIC_API papilla_haptic* papilla_haptic_open(const char* path, const papilla_haptic_options* options,
                                                       char* message, size_t message_size);
PAPILLA_HAPTIC_API int32_t papilla_haptic_close(papilla_haptic* haptic);

/* Puts the probe to `position` without contact on the way, and clears a fault; forces fade in again. Call it, too,
 * after a pause in which the hand may have gone on. */
PAPILLA_HAPTIC_API int32_t papilla_haptic_reset(papilla_haptic* haptic, const double position[3]);

/* One tick: computes the force on the hand from the newest position, which is age_s old. Returns a sum of
 * papilla_haptic_flag, or an error; the force is zero with a fault and with an error, and is never NaN nor longer than
 * max_force_n. Call it rate_hz times a second: the rate is part of damping, friction and fading in. */
PAPILLA_HAPTIC_API int32_t papilla_haptic_tick(papilla_haptic* haptic, const double position[3], double age_s,
                                               double force[3]);

/* Where the ball of the probe rests after the last tick, which is what to draw, and the contact normal, zero without
 * contact; either may be null. Returns the number of the material that holds it, or PAPILLA_HAPTIC_NONE without
 * contact. */
PAPILLA_HAPTIC_API int32_t papilla_haptic_proxy(const papilla_haptic* haptic, double position[3], double normal[3]);

/* Number of triangles that can be felt, of materials with a tag, and of warnings. */
PAPILLA_HAPTIC_API int64_t papilla_haptic_triangles(const papilla_haptic* haptic);
PAPILLA_HAPTIC_API int32_t papilla_haptic_material_count(const papilla_haptic* haptic);
PAPILLA_HAPTIC_API int32_t papilla_haptic_warning_count(const papilla_haptic* haptic);

/* The name of a material with a tag, and what the file's tags gave reason to warn of ("code: material: reason"); null
 * beyond the last. */
PAPILLA_HAPTIC_API const char* papilla_haptic_material_name(const papilla_haptic* haptic, uint32_t material);
PAPILLA_HAPTIC_API const char* papilla_haptic_warning(const papilla_haptic* haptic, uint32_t index);

/* Writes the constants, or the size and bounds of the height field of a material. PAPILLA_HAPTIC_NONE when there is no
 * such material, or it has no height field. */
PAPILLA_HAPTIC_API int32_t papilla_haptic_material(const papilla_haptic* haptic, uint32_t material,
                                                   papilla_haptic_constants* constants);
PAPILLA_HAPTIC_API int32_t papilla_haptic_material_relief(const papilla_haptic* haptic, uint32_t material,
                                                          papilla_haptic_relief* relief);

/* The height field of a material at `count` texture coordinates uv[2 i], uv[2 i + 1] of the file: heights_m[i] in
 * metres above the triangles, and its derivatives by u and v in gradients_m[2 i], gradients_m[2 i + 1], in metres per
 * unit. Either result may be null. It is the relief that ticks follow: as a ball of probe_radius_m feels it, with peaks
 * rounded for felt_depth_m. With both below 0 it is the file's. Coordinates that are not finite give the height of
 * some sample. */
PAPILLA_HAPTIC_API int32_t papilla_haptic_height(const papilla_haptic* haptic, uint32_t material, const double* uv,
                                                 size_t count, double* heights_m, double* gradients_m);

#ifdef __cplusplus
}
#endif

#endif
