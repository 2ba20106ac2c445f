// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>

namespace papilla::player {

inline constexpr int k_audio_rate_hz = 48000;

/// Takes the next samples, in [-1, 1].
using AudioSink = std::function<void(std::span<const float>)>;

/// Lets `play` fill a mono WAV file of 32-bit floats, which appears when it has ended.
/// @throws IoError when libsndfile is not installed or the file can't be written; what `play` throws.
void with_wav_file(const std::string& file, const std::function<void(const AudioSink&)>& play);

/// Lets `play` play on an ALSA device, in real time.
/// @throws DeviceError when libasound is not installed, or the device can't be opened or is lost.
void with_alsa_device(const std::string& device, const std::function<void(const AudioSink&)>& play);

}  // namespace papilla::player
