/* SPDX-License-Identifier: MIT */
#ifndef PAPILLA_TESTS_INTERFACE_CHECKS_H
#define PAPILLA_TESTS_INTERFACE_CHECKS_H

/* Checks of papilla_haptic.h as a C99 program calls it. Each returns null, or the first condition that does not hold
 * with its line. `plate` is testing::plate_glb() with the relief of testing::sine_png() in a tag of 300 N/m, `smooth`
 * the same without relief. */

#ifdef __cplusplus
extern "C" {
#endif

const char* check_layout(void);
const char* check_forces(const char* plate);
const char* check_probe_radius(const char* smooth);
const char* check_materials(const char* plate, const char* smooth);
const char* check_heights(const char* plate);
const char* check_refused_files(const char* folder);
const char* check_refused_options(const char* plate);
const char* check_handles(const char* plate);
const char* check_arguments(const char* plate);
const char* check_struct_sizes(const char* plate);
const char* check_bad_positions(const char* plate);
const char* check_most_open(const char* plate);

#ifdef __cplusplus
}
#endif

#endif
