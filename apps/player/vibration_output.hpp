// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/vibration.hpp"

namespace papilla::player {

/// What became of the vibration of a run.
struct VibrationReport {
  std::string target;
  std::uint64_t samples = 0;
  double peak_m_per_s2 = 0, rms_m_per_s2 = 0;
  std::uint64_t missed_ticks = 0;  ///< That were over before the sound could take them.
  bool limited = false;            ///< Some samples were beyond the full scale.
};

/// Whether a target is FILE.wav, alsa or alsa:DEVICE.
bool is_sound_target(const std::string& target);

/// Tells before long work whether a file can be written. @throws IoError as require_writable().
void require_sound_target(const std::string& target);

/// Turns the ticks of a running loop into sound, in a thread of its own: a WAV file of 32-bit floats, or ALSA.
/// libsndfile and libasound are loaded when they are asked for, so that a player without sound does not need them.
class VibrationOutput {
 public:
  /// @param target of is_sound_target(). @param full_scale_m_per_s2 becomes 1 in the signal; what is beyond it
  /// is rounded off. @param surface must outlive the object.
  /// @throws IoError when the file can't be written or libsndfile is missing; DeviceError when libasound is or the
  /// device can't be opened.
  VibrationOutput(const std::string& target, const ContactSurface& surface, double rate_hz, double full_scale_m_per_s2);
  ~VibrationOutput();
  VibrationOutput(const VibrationOutput&) = delete;
  VibrationOutput& operator=(const VibrationOutput&) = delete;

  /// Lets the loop feed it. @param options of the loop; their status is set already.
  void follow(LoopOptions& options);

  /// Waits until all is out. @throws what writing failed with.
  VibrationReport finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla::player
