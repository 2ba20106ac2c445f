// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/haptic/contact_surface.hpp"

namespace papilla {

/// Options of Vibration.
struct VibrationOptions {
  double rate_hz = 1000;            ///< Of the ticks, in [100, 20000].
  double sample_rate_hz = 48000;    ///< Of the samples, in [8000, 192000].
  double low_hz = 20;               ///< Below, waves are movement, not vibration.
  double high_hz = 1000;            ///< Above, nothing is felt.
  double effective_mass_kg = 0.02;  ///< Of the tool's tip that follows the relief, > 0.
};

/// One tick of a contact.
struct VibrationTick {
  Vec3 proxy;         ///< Metres, in the frame of the surface.
  double load_n = 0;  ///< Force that presses the probe on, ≥ 0.
  bool in_contact = false;
};

/// The acceleration that a stroke over a relief gives to what follows it, as a signal for voice coils, game controllers
/// with audio haptics, and headphones.
///
/// The path of the proxy between ticks is a Catmull-Rom curve. At each sample, the height h of the relief (dilated by
/// the probe) is read at its closest base point, so that waves shorter than a tick's way count too; then
///     a(t) = F/m · tanh(m/F · (B ∗ h″)(t)),
/// with B the band pass [low, high]: a Butterworth high pass of order 2 at a third of `low`, a Chebyshev low pass of
/// order 8 with a ripple of 0.1 dB at `high`. F is the load and m the effective mass: a tip pressed with F can't be
/// thrown down faster than F/m. A relief A·sin(2πx/λ) passed at speed v gives the frequency v/λ and the amplitude
/// A·(2πv/λ)², as long as that is well below F/m.
///
/// Contact that begins or ends fades within 5 ms and moves nothing: heights count from where contact began. A height
/// that jumps by more than three times the way, as from chart to chart, counts as continued.
///
/// Cost: a closest point a sample, about 3 % of a core on 230 thousand triangles; not for the haptic thread. The signal
/// comes two ticks and 1 to 2 periods of `high` after the contact. Deterministic; never NaN for finite input.
/// Breaks down for loads near 0, where every amplitude saturates, and for stimuli, which displace nothing.
/// Source: Okamura, Dennerlein and Howe 1998 (vibration from contact); band of the Pacinian receptors.
class Vibration {
 public:
  /// @param surface must outlive the object. @throws InvalidInput when an option is out of its range or `low` is not
  /// below `high`, or `high` above 0.4 of the sample rate.
  explicit Vibration(const ContactSurface& surface, const VibrationOptions& options = {});
  Vibration(Vibration&&) noexcept;
  Vibration& operator=(Vibration&&) noexcept;
  ~Vibration();

  /// Appends the samples of one tick, in m/s².
  void tick(const VibrationTick& now, std::vector<float>& samples);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla
