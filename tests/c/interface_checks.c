/* SPDX-License-Identifier: MIT */
#include "interface_checks.h"

#include <math.h>
#include <papilla/io/papilla_haptic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_OF(x) #x
#define LINE_OF(line) TEXT_OF(line)
#define CHECK(condition) \
  if (!(condition)) return "line " LINE_OF(__LINE__) ": " #condition

static const double above[3] = {0.05, 0.005, -0.05}, below[3] = {0.05, -0.002, -0.05};

/* Members where callers that were compiled long ago have them; pointers and doubles of eight bytes. */
const char* check_layout(void) {
  CHECK(papilla_haptic_abi() == PAPILLA_HAPTIC_ABI);
  CHECK(strcmp(papilla_haptic_version(), PAPILLA_VERSION) == 0);
  if (sizeof(void*) != 8) return NULL;
  CHECK(sizeof(papilla_haptic_options) == 56);
  CHECK(offsetof(papilla_haptic_options, rate_hz) == 8);
  CHECK(offsetof(papilla_haptic_options, max_force_n) == 16);
  CHECK(offsetof(papilla_haptic_options, probe_radius_m) == 24);
  CHECK(offsetof(papilla_haptic_options, felt_depth_m) == 32);
  CHECK(offsetof(papilla_haptic_options, device) == 40);
  CHECK(offsetof(papilla_haptic_options, tags) == 48);
  CHECK(sizeof(papilla_haptic_constants) == 72);
  CHECK(offsetof(papilla_haptic_constants, stiffness) == 8);
  CHECK(offsetof(papilla_haptic_constants, max_stiffness) == 64);
  CHECK(sizeof(papilla_haptic_relief) == 32);
  CHECK(offsetof(papilla_haptic_relief, height) == 12);
  CHECK(offsetof(papilla_haptic_relief, max_m) == 24);
  return NULL;
}

static papilla_haptic* open_point(const char* path) {
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  options.device = "touch";
  options.probe_radius_m = -1;
  return papilla_haptic_open(path, &options, NULL, 0);
}

const char* check_forces(const char* plate) {
  double force[3], proxy[3], normal[3];
  int32_t found = 0;
  papilla_haptic* haptic = open_point(plate);
  CHECK(haptic != NULL);
  CHECK(papilla_haptic_triangles(haptic) == 200);
  CHECK(papilla_haptic_reset(haptic, above) == 0);
  CHECK(papilla_haptic_tick(haptic, above, 0, force) == 0);
  CHECK(force[1] == 0);
  CHECK(papilla_haptic_proxy(haptic, proxy, normal) == PAPILLA_HAPTIC_NONE);
  CHECK(proxy[1] == above[1] && normal[1] == 0);
  for (int i = 0; i < 100; ++i) found = papilla_haptic_tick(haptic, below, 0, force);
  CHECK((found & PAPILLA_HAPTIC_CONTACT) != 0);
  CHECK(force[1] < 0.1); /* The first force fades in: a wall does not stiffen around a hand that is in it. */
  papilla_haptic_tick(haptic, above, 0, force);
  for (int i = 0; i < 100; ++i) found = papilla_haptic_tick(haptic, below, 0, force);
  CHECK((found & PAPILLA_HAPTIC_CONTACT) != 0);
  CHECK(fabs(force[1] - 300 * 0.002) <= 300 * 1.2e-4); /* Hooke's law, within the height of the relief. */
  CHECK(papilla_haptic_proxy(haptic, proxy, normal) == 0);
  CHECK(fabs(proxy[1]) < 1.5e-4 && fabs(proxy[2] - below[2]) < 1.5e-4);
  CHECK(normal[1] > 0.9 && fabs(normal[2]) < 1e-9 && fabs(force[2]) < 1e-9); /* The relief does not change along z. */
  CHECK(papilla_haptic_proxy(haptic, NULL, NULL) == 0);
  CHECK((papilla_haptic_tick(haptic, below, 1, force) & PAPILLA_HAPTIC_FAULT) != 0); /* A second old. */
  CHECK(force[1] == 0);
  CHECK(papilla_haptic_reset(haptic, above) == 0);
  CHECK(papilla_haptic_tick(haptic, above, 0, force) == 0);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

static double height_at_rest(const char* path, double radius, const char* device) {
  const double deep[3] = {0.05, -0.001, -0.05};
  double force[3], proxy[3];
  papilla_haptic* haptic;
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  options.device = device;
  options.probe_radius_m = radius;
  haptic = papilla_haptic_open(path, &options, NULL, 0);
  papilla_haptic_reset(haptic, above);
  papilla_haptic_tick(haptic, deep, 0, force);
  papilla_haptic_proxy(haptic, proxy, NULL);
  papilla_haptic_close(haptic);
  return proxy[1];
}

/* Half a millimetre, the device's, when nothing is said; on a skin of 20 micrometres. */
const char* check_probe_radius(const char* smooth) {
  CHECK(fabs(height_at_rest(smooth, 0, "touch") - 5.2e-4) < 2e-6);
  CHECK(fabs(height_at_rest(smooth, 0, NULL) - 5.2e-4) < 2e-6);
  CHECK(fabs(height_at_rest(smooth, 2e-3, "touch") - 2.02e-3) < 2e-6);
  CHECK(fabs(height_at_rest(smooth, -1, "touch") - 2e-5) < 2e-6);
  return NULL;
}

const char* check_materials(const char* plate, const char* smooth) {
  papilla_haptic_constants constants;
  papilla_haptic_relief relief;
  papilla_haptic* haptic = papilla_haptic_open(plate, NULL, NULL, 0);
  CHECK(haptic != NULL);
  CHECK(papilla_haptic_material_count(haptic) == 1);
  CHECK(strcmp(papilla_haptic_material_name(haptic, 0), "grain") == 0);
  CHECK(papilla_haptic_material_name(haptic, 1) == NULL);
  CHECK(papilla_haptic_material_name(haptic, UINT32_MAX) == NULL);
  constants.struct_size = sizeof constants;
  CHECK(papilla_haptic_material(haptic, 0, &constants) == 0);
  CHECK(constants.stiffness == 300 && constants.max_stiffness == 300 && constants.damping == 0);
  CHECK(constants.static_friction == 0 && constants.stribeck_velocity == 0.01);
  CHECK(isinf(constants.backing_depth_m));
  CHECK(papilla_haptic_material(haptic, 1, &constants) == PAPILLA_HAPTIC_NONE);
  relief.struct_size = sizeof relief;
  CHECK(papilla_haptic_material_relief(haptic, 0, &relief) == 0);
  CHECK(relief.width == 128 && relief.height == 4);
  CHECK(papilla_haptic_material_relief(haptic, UINT32_MAX, &relief) == PAPILLA_HAPTIC_NONE);
  CHECK(papilla_haptic_warning_count(haptic) == 0 && papilla_haptic_warning(haptic, 0) == NULL);
  CHECK(papilla_haptic_close(haptic) == 0);
  haptic = papilla_haptic_open(smooth, NULL, NULL, 0);
  CHECK(papilla_haptic_material_relief(haptic, 0, &relief) == PAPILLA_HAPTIC_NONE);
  CHECK(papilla_haptic_height(haptic, 0, above, 1, NULL, NULL) == PAPILLA_HAPTIC_NONE);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

/* The file's relief is h(u) = 1e-4 sin(8 pi u) m with 32 samples a wave, a = pi/16 apart. Catmull and Rom's slope at
 * the samples is sin(a)/a = 1 - 6.5e-3 of the sine's, which is t (1 - t) (1 - 2 t) a 6.5e-3 < 1.3e-4 of the amplitude
 * between them. Samples are rounded to 2e-4/65535 m, of an amplitude that is 1.5e-5 less. */
const char* check_heights(const char* plate) {
  enum { count = 97 };
  const double pi = 3.14159265358979323846;
  double uv[2 * count], heights[count], gradients[2 * count], ball[count], odd[2];
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  papilla_haptic* haptic;
  options.probe_radius_m = -1;
  options.felt_depth_m = -1;
  haptic = papilla_haptic_open(plate, &options, NULL, 0);
  CHECK(haptic != NULL);
  for (int i = 0; i < count; ++i) {
    uv[2 * i] = -0.7 + 0.031 * i;
    uv[2 * i + 1] = 0.01 * i;
  }
  CHECK(papilla_haptic_height(haptic, 0, uv, count, heights, gradients) == 0);
  for (int i = 0; i < count; ++i) {
    CHECK(fabs(heights[i] - 1e-4 * sin(8 * pi * uv[2 * i])) < 1.6e-8);
    CHECK(fabs(gradients[2 * i] - 8e-4 * pi * cos(8 * pi * uv[2 * i])) < 8e-4 * pi * 6.6e-3);
    CHECK(fabs(gradients[2 * i + 1]) < 1e-9);
  }
  CHECK(papilla_haptic_height(haptic, 0, uv, count, NULL, gradients) == 0);
  CHECK(papilla_haptic_height(haptic, 0, uv, count, heights, NULL) == 0);
  CHECK(papilla_haptic_height(haptic, 0, uv, 0, NULL, NULL) == 0);
  odd[0] = NAN;
  odd[1] = INFINITY;
  CHECK(papilla_haptic_height(haptic, 0, odd, 1, heights, gradients) == 0);
  CHECK(fabs(heights[0]) <= 1e-4 && isfinite(gradients[0]) && isfinite(gradients[1]));
  CHECK(papilla_haptic_close(haptic) == 0);
  /* A ball is stopped by the peaks before it reaches the valleys. */
  haptic = papilla_haptic_open(plate, NULL, NULL, 0);
  CHECK(papilla_haptic_height(haptic, 0, uv, count, ball, NULL) == 0);
  for (int i = 0; i < count; ++i) CHECK(ball[i] > 1e-4 * sin(8 * pi * uv[2 * i]) - 5e-6);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

static int refused(const char* path, const char* word) {
  char message[200];
  memset(message, 'x', sizeof message);
  if (papilla_haptic_open(path, NULL, message, sizeof message) != NULL) return 0;
  message[sizeof message - 1] = '\0';
  return strstr(message, word) != NULL && strchr(message, '\n') == NULL;
}

const char* check_refused_files(const char* folder) {
  char short_one[5], kept[3] = {'a', 'b', 'c'};
  CHECK(refused("missing.glb", "missing.glb"));
  CHECK(refused("", "no path"));
  CHECK(refused(NULL, "no path"));
  CHECK(refused(folder, folder));
  CHECK(papilla_haptic_open("missing.glb", NULL, short_one, sizeof short_one) == NULL);
  CHECK(strlen(short_one) == 4);
  CHECK(papilla_haptic_open("missing.glb", NULL, kept, 0) == NULL);
  CHECK(kept[0] == 'a');
  CHECK(papilla_haptic_open("missing.glb", NULL, NULL, 100) == NULL);
  return NULL;
}

const char* check_refused_options(const char* plate) {
  char message[200] = "";
  const double bad[] = {-1, 0.5, 2e5, NAN, INFINITY};
  papilla_haptic* haptic;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
    papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
    options.rate_hz = bad[i];
    CHECK(papilla_haptic_open(plate, &options, message, sizeof message) == NULL);
    CHECK(strstr(message, "out of range") != NULL);
  }
  for (int k = 0; k < 3; ++k) {
    papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
    if (k == 0) options.max_force_n = NAN;
    if (k == 1) options.probe_radius_m = NAN;
    if (k == 2) options.felt_depth_m = INFINITY;
    CHECK(papilla_haptic_open(plate, &options, message, sizeof message) == NULL);
    CHECK(strstr(message, "out of range") != NULL);
  }
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  options.device = "no such device";
  CHECK(papilla_haptic_open(plate, &options, message, sizeof message) == NULL);
  CHECK(strstr(message, "no such device") != NULL);
  options.device = NULL;
  options.tags = "missing-tags.glb";
  CHECK(papilla_haptic_open(plate, &options, message, sizeof message) == NULL);
  CHECK(strstr(message, "missing-tags.glb") != NULL);
  options.tags = plate;
  haptic = papilla_haptic_open(plate, &options, message, sizeof message);
  CHECK(haptic != NULL && message[0] == '\0');
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

/* Every function refuses it, and zeroes what it would have written for drawing or for a device. */
static const char* check_refuses(papilla_haptic* handle) {
  double force[3] = {1, 1, 1}, proxy[3] = {1, 1, 1}, normal[3] = {1, 1, 1}, height = 7;
  papilla_haptic_constants constants;
  papilla_haptic_relief relief;
  constants.struct_size = sizeof constants;
  relief.struct_size = sizeof relief;
  CHECK(papilla_haptic_tick(handle, below, 0, force) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(force[0] == 0 && force[1] == 0 && force[2] == 0);
  CHECK(papilla_haptic_tick(handle, NULL, 0, NULL) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_reset(handle, above) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_proxy(handle, proxy, normal) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(proxy[0] == 0 && normal[2] == 0);
  CHECK(papilla_haptic_triangles(handle) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_material_count(handle) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_warning_count(handle) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_material_name(handle, 0) == NULL);
  CHECK(papilla_haptic_warning(handle, 0) == NULL);
  CHECK(papilla_haptic_material(handle, 0, &constants) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_material_relief(handle, 0, &relief) == PAPILLA_HAPTIC_BAD_HANDLE);
  CHECK(papilla_haptic_height(handle, 0, above, 1, &height, NULL) == PAPILLA_HAPTIC_BAD_HANDLE && height == 7);
  CHECK(papilla_haptic_close(handle) == PAPILLA_HAPTIC_BAD_HANDLE);
  return NULL;
}

const char* check_handles(const char* plate) {
  double force[3];
  const char* wrong;
  uint64_t bits = 88172645463325252u;
  void* memory = malloc(64);
  papilla_haptic* first = papilla_haptic_open(plate, NULL, NULL, 0);
  papilla_haptic* second = papilla_haptic_open(plate, NULL, NULL, 0);
  const uintptr_t name = (uintptr_t)first;
  CHECK(first != NULL && second != NULL && first != second);
  if ((wrong = check_refuses(NULL)) != NULL) return wrong;
  if ((wrong = check_refuses((papilla_haptic*)memory)) != NULL) return wrong;
  if ((wrong = check_refuses((papilla_haptic*)(void*)force)) != NULL) return wrong;
  for (uintptr_t small = 1; small < 2000; ++small)
    if ((wrong = check_refuses((papilla_haptic*)small)) != NULL) return wrong;
  for (int bit = 0; bit < (int)(8 * sizeof name); ++bit) { /* An open one with one bit turned over. */
    const uintptr_t turned = name ^ ((uintptr_t)1 << bit);
    if (turned != (uintptr_t)second && (wrong = check_refuses((papilla_haptic*)turned)) != NULL) return wrong;
  }
  for (int i = 0; i < 10000; ++i) { /* Marsaglia's xorshift. */
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    if ((wrong = check_refuses((papilla_haptic*)(uintptr_t)bits)) != NULL) return wrong;
  }
  CHECK(papilla_haptic_close(first) == 0);
  if ((wrong = check_refuses(first)) != NULL) return wrong;
  CHECK(papilla_haptic_tick(second, above, 0, force) == 0);
  first = papilla_haptic_open(plate, NULL, NULL, 0); /* May stand where the closed one was. */
  CHECK(first != NULL && (uintptr_t)first != name);
  if ((wrong = check_refuses((papilla_haptic*)name)) != NULL) return wrong;
  CHECK(papilla_haptic_close(first) == 0 && papilla_haptic_close(second) == 0);
  if ((wrong = check_refuses(second)) != NULL) return wrong;
  free(memory);
  return NULL;
}

const char* check_arguments(const char* plate) {
  double force[3] = {1, 1, 1};
  papilla_haptic* haptic = papilla_haptic_open(plate, NULL, NULL, 0);
  CHECK(haptic != NULL);
  CHECK(papilla_haptic_reset(haptic, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_tick(haptic, NULL, 0, force) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(force[0] == 0 && force[1] == 0 && force[2] == 0);
  CHECK(papilla_haptic_tick(haptic, above, 0, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_material(haptic, 0, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_material_relief(haptic, 0, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_height(haptic, 0, NULL, 1, force, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_height(haptic, 0, above, SIZE_MAX, force, NULL) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  CHECK(papilla_haptic_warning(haptic, UINT32_MAX) == NULL);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

/* Callers that were compiled with an older or a newer header. */
const char* check_struct_sizes(const char* plate) {
  struct {
    papilla_haptic_options known;
    double added;
  } newer = {PAPILLA_HAPTIC_OPTIONS_INIT, 0};
  struct {
    papilla_haptic_constants known;
    double added;
  } result;
  char message[200];
  const uint64_t none[] = {0, 7, UINT64_MAX, 0x7ffdeadbeef0u};
  papilla_haptic* haptic;
  newer.known.struct_size = sizeof newer;
  haptic = papilla_haptic_open(plate, &newer.known, message, sizeof message);
  CHECK(haptic != NULL);
  CHECK(papilla_haptic_close(haptic) == 0);
  newer.added = 1;
  CHECK(papilla_haptic_open(plate, &newer.known, message, sizeof message) == NULL);
  CHECK(strstr(message, "this version lacks") != NULL);
  newer.known.struct_size = offsetof(papilla_haptic_options, max_force_n); /* The rest is not looked at. */
  newer.known.rate_hz = 500;
  newer.known.max_force_n = NAN;
  haptic = papilla_haptic_open(plate, &newer.known, message, sizeof message);
  CHECK(haptic != NULL);
  for (size_t i = 0; i < sizeof none / sizeof *none; ++i) {
    newer.known.struct_size = none[i];
    CHECK(papilla_haptic_open(plate, &newer.known, message, sizeof message) == NULL);
    CHECK(strstr(message, "struct_size") != NULL);
    result.known.struct_size = none[i];
    CHECK(papilla_haptic_material(haptic, 0, &result.known) == PAPILLA_HAPTIC_BAD_ARGUMENT);
  }
  memset(&result, 0x55, sizeof result);
  result.known.struct_size = offsetof(papilla_haptic_constants, damping);
  CHECK(papilla_haptic_material(haptic, 0, &result.known) == 0);
  CHECK(result.known.stiffness == 300);
  CHECK(memcmp(&result.known.damping, &result.added, sizeof(double)) == 0); /* Neither was written. */
  result.known.struct_size = sizeof result;
  CHECK(papilla_haptic_material(haptic, 0, &result.known) == 0);
  CHECK(result.known.max_stiffness == 300 && result.known.struct_size == sizeof result);
  memset(&result.known.damping, 0x55, sizeof(double));
  CHECK(memcmp(&result.known.damping, &result.added, sizeof(double)) == 0);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

const char* check_bad_positions(const char* plate) {
  const double numbers[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e7, 0};
  const size_t count = sizeof numbers / sizeof *numbers;
  papilla_haptic* haptic = open_point(plate);
  CHECK(haptic != NULL);
  for (size_t i = 0; i < count * count * count; ++i) {
    const double position[3] = {numbers[i % count], numbers[i / count % count], numbers[i / count / count]};
    double force[3];
    CHECK(papilla_haptic_tick(haptic, position, 0, force) >= 0);
    CHECK(isfinite(force[0]) && isfinite(force[1]) && isfinite(force[2]));
    CHECK(sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]) <= 3.3 + 1e-9);
    if (i % 2 == 0) CHECK(papilla_haptic_reset(haptic, position) == 0);
  }
  double force[3];
  CHECK((papilla_haptic_tick(haptic, above, NAN, force) & PAPILLA_HAPTIC_FAULT) != 0);
  CHECK(force[1] == 0);
  CHECK(papilla_haptic_reset(haptic, above) == 0);
  CHECK(papilla_haptic_tick(haptic, above, 0, force) == 0);
  CHECK(papilla_haptic_close(haptic) == 0);
  return NULL;
}

const char* check_most_open(const char* plate) {
  papilla_haptic* open[PAPILLA_HAPTIC_MOST_OPEN];
  char message[200];
  for (int i = 0; i < PAPILLA_HAPTIC_MOST_OPEN; ++i) {
    open[i] = papilla_haptic_open(plate, NULL, NULL, 0);
    CHECK(open[i] != NULL);
  }
  CHECK(papilla_haptic_open(plate, NULL, message, sizeof message) == NULL);
  CHECK(strstr(message, "256 handles") != NULL);
  CHECK(papilla_haptic_close(open[100]) == 0);
  open[100] = papilla_haptic_open(plate, NULL, NULL, 0);
  CHECK(open[100] != NULL);
  for (int i = 0; i < PAPILLA_HAPTIC_MOST_OPEN; ++i) CHECK(papilla_haptic_close(open[i]) == 0);
  return NULL;
}
