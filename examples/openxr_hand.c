/* SPDX-License-Identifier: MIT */
/* A host in the form of an OpenXR program, without graphics: a hand comes down on a glTF file that stands in the room,
 * strokes it, is lost by the tracking for 60 ms, and goes away.
 *     openxr-hand FILE.glb X Y Z     the place, in metres in the frame of the file, that the hand touches from above
 * (+Y) The runtime behind `xr` is simulated, with the signatures of openxr.h: put xrLocateSpace and
 * xrApplyHapticFeedback there instead, and take the time from xrWaitFrame (for drawing) and from a clock (for the
 * haptic thread). */
#include <math.h>
#include <openxr/openxr.h>
#include <papilla/io/papilla_haptic.h>
#include <stdio.h>
#include <stdlib.h>

enum { k_rate_hz = 1000, k_frames_hz = 90 };
static const double k_max_force_n = 3.3, k_second = 1e9; /* XrTime counts nanoseconds. */

/* What the host calls of OpenXR. */
static struct {
  PFN_xrLocateSpace locate_space;
  PFN_xrApplyHapticFeedback apply_haptic_feedback;
} xr;

/* ---- Poses. OpenXR and glTF are both right-handed, Y up and in metres: all that lies between them is where the file
 * stands in the room. */

static void rotate(const XrQuaternionf* q, int back, const double v[3], double out[3]) {
  /* v + 2 w (u x v) + 2 u x (u x v), u the vector part; the other way round with -u. */
  const double s = back ? -1 : 1, u[3] = {s * q->x, s * q->y, s * q->z}, w = q->w;
  const double c[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  out[0] = v[0] + 2 * (w * c[0] + u[1] * c[2] - u[2] * c[1]);
  out[1] = v[1] + 2 * (w * c[1] + u[2] * c[0] - u[0] * c[2]);
  out[2] = v[2] + 2 * (w * c[2] + u[0] * c[1] - u[1] * c[0]);
}

static void to_room(const XrPosef* file, const double in_file[3], double in_room[3]) {
  rotate(&file->orientation, 0, in_file, in_room);
  in_room[0] += file->position.x;
  in_room[1] += file->position.y;
  in_room[2] += file->position.z;
}

static void to_file(const XrPosef* file, const XrVector3f* in_room, double in_file[3]) {
  const double v[3] = {in_room->x - (double)file->position.x, in_room->y - (double)file->position.y,
                       in_room->z - (double)file->position.z};
  rotate(&file->orientation, 1, v, in_file);
}

/* ---- The simulated runtime: a tracked hand and a controller that vibrates. */

static struct {
  XrPosef file;        /* Where the file stands in the room. */
  double target[3];    /* What the hand touches, in the frame of the file. */
  double vibration;    /* The last amplitude. */
  uint32_t vibrations; /* How often one was asked for. */
} simulated = {{{0, 0.70710678F, 0, 0.70710678F}, {0.2F, 1, -0.5F}}, {0, 0, 0}, 0, 0}; /* A quarter turn about Y. */

static double eased(double t) { return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t); }

/* 5 mm above the target, 1 mm below it after half a second, strokes of 20 mm, up again after two. */
static XrResult XRAPI_PTR simulated_locate_space(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location) {
  const double t = (double)time / k_second, height = 5e-3 - 6e-3 * (eased(2 * t) - eased(4 * (t - 2)));
  const double along = t < 0.6 ? 0 : 0.01 * sin(3.14159265358979 * (t - 0.6));
  const double hand[3] = {simulated.target[0] + along, simulated.target[1] + height, simulated.target[2]};
  double room[3];
  (void)space;
  (void)base;
  to_room(&simulated.file, hand, room);
  location->pose.orientation.w = 1;
  location->pose.position.x = (float)room[0];
  location->pose.position.y = (float)room[1];
  location->pose.position.z = (float)room[2];
  location->locationFlags = XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  if (t < 1.3 || t >= 1.36) location->locationFlags |= XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
  return XR_SUCCESS;
}

static XrResult XRAPI_PTR simulated_haptic_feedback(XrSession session, const XrHapticActionInfo* action,
                                                    const XrHapticBaseHeader* feedback) {
  (void)session;
  if (action->type != XR_TYPE_HAPTIC_ACTION_INFO || feedback->type != XR_TYPE_HAPTIC_VIBRATION)
    return XR_ERROR_VALIDATION_FAILURE;
  simulated.vibration = ((const XrHapticVibration*)feedback)->amplitude;
  ++simulated.vibrations;
  return XR_SUCCESS;
}

/* ---- The host. */

typedef struct hand_state {
  double position[3]; /* In the frame of the file. */
  XrTime seen;        /* When it was tracked last. */
  int lost;
} hand_state;

/* The newest tracked position. A hand that is back within a second goes on from where it was drawn, so that it stays on
 * its side of what it touched; later it is put where it is. */
static void follow_hand(papilla_haptic* haptic, XrTime now, hand_state* hand) {
  XrSpaceLocation location = {XR_TYPE_SPACE_LOCATION, NULL, 0, {{0, 0, 0, 1}, {0, 0, 0}}};
  double drawn[3];
  if (XR_FAILED(xr.locate_space(XR_NULL_HANDLE, XR_NULL_HANDLE, now, &location)) ||
      (location.locationFlags & XR_SPACE_LOCATION_POSITION_TRACKED_BIT) == 0) {
    hand->lost = 1;
    return;
  }
  to_file(&simulated.file, &location.pose.position, hand->position);
  papilla_haptic_proxy(haptic, drawn, NULL);
  if (hand->lost) papilla_haptic_reset(haptic, (double)(now - hand->seen) < k_second ? drawn : hand->position);
  hand->lost = 0;
  hand->seen = now;
}

/* A controller has a motor, no force: the amplitude follows the force. */
static void vibrate(double force_n) {
  XrHapticActionInfo action = {XR_TYPE_HAPTIC_ACTION_INFO, NULL, XR_NULL_HANDLE, XR_NULL_PATH};
  XrHapticVibration vibration = {XR_TYPE_HAPTIC_VIBRATION, NULL, 1000000000 / k_frames_hz, XR_FREQUENCY_UNSPECIFIED, 0};
  vibration.amplitude = (float)(force_n / k_max_force_n);
  xr.apply_haptic_feedback(XR_NULL_HANDLE, &action, (const XrHapticBaseHeader*)&vibration);
}

int main(int argc, char** argv) {
  char message[256];
  papilla_haptic_options options = PAPILLA_HAPTIC_OPTIONS_INIT;
  papilla_haptic* haptic;
  hand_state hand = {{0, 0, 0}, -2000000000, 1};
  double largest_n = 0, largest_lost_n = 0, drawn[3], room[3] = {0, 0, 0};
  int touched = 0, faults = 0, next_frame = 0;
  if (argc != 5) {
    fprintf(stderr, "usage: openxr-hand FILE.glb X Y Z\n");
    return 2;
  }
  if (papilla_haptic_abi() != PAPILLA_HAPTIC_ABI) {
    fprintf(stderr, "openxr-hand: libpapilla.so has interface %u, not %d\n", (unsigned)papilla_haptic_abi(),
            PAPILLA_HAPTIC_ABI);
    return 1;
  }
  for (int i = 0; i < 3; ++i) simulated.target[i] = strtod(argv[2 + i], NULL);
  xr.locate_space = simulated_locate_space;
  xr.apply_haptic_feedback = simulated_haptic_feedback;

  options.rate_hz = k_rate_hz;
  options.max_force_n = k_max_force_n;
  haptic = papilla_haptic_open(argv[1], &options, message, sizeof message);
  if (haptic == NULL) {
    fprintf(stderr, "openxr-hand: %s\n", message);
    return 3;
  }

  /* A real host has the ticks in a thread of their own with a clock of 1 kHz, and the frames in that of xrWaitFrame. */
  for (int tick = 0; tick < 5 * k_rate_hz / 2; ++tick) {
    const XrTime now = (XrTime)tick * (XrTime)(k_second / k_rate_hz);
    double force[3], size_n;
    follow_hand(haptic, now, &hand);
    const int32_t found = papilla_haptic_tick(haptic, hand.position, (double)(now - hand.seen) / k_second, force);
    size_n = sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    if (found < 0 || size_n > k_max_force_n) return 1;
    touched += (found & PAPILLA_HAPTIC_CONTACT) != 0;
    faults += (found & PAPILLA_HAPTIC_FAULT) != 0;
    if (size_n > largest_n) largest_n = size_n;
    if (now - hand.seen > (XrTime)(0.011 * k_second) && size_n > largest_lost_n) largest_lost_n = size_n;

    if ((double)tick * k_frames_hz / k_rate_hz < next_frame) continue;
    ++next_frame; /* A frame: draw the hand where the proxy is, outside of what it touches. */
    papilla_haptic_proxy(haptic, drawn, NULL);
    to_room(&simulated.file, drawn, room);
    vibrate(size_n);
    if (next_frame % 18 == 1)
      printf("%4.1f s  %5.3f N  hand drawn at %.4f %.4f %.4f m%s\n", (double)now / k_second, size_n, room[0], room[1],
             room[2], hand.lost ? ", lost" : "");
  }
  printf("%d ticks in contact, %.3f N at most; %d ticks without tracking, %.3f N then; %u vibrations\n", touched,
         largest_n, faults, largest_lost_n, (unsigned)simulated.vibrations);
  papilla_haptic_close(haptic);
  return touched > 0 && largest_lost_n == 0 ? 0 : 1;
}
