// SPDX-License-Identifier: MIT
#include "vibration_output.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <string_view>
#include <thread>

#include "audio_sink.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla::player {
namespace {

constexpr std::string_view k_alsa = "alsa";
constexpr std::size_t k_most_behind = 1 << 14;  // Ticks.
constexpr auto k_look = std::chrono::milliseconds(2);

/// The device that a target names; nothing for a file.
std::optional<std::string> alsa_device(const std::string& target) {
  if (target == k_alsa) return "default";
  if (target.starts_with("alsa:")) return target.substr(k_alsa.size() + 1);
  return std::nullopt;
}

/// Linear up to half, then rounded off to 1.
float rounded_off(double x) {
  constexpr double k_linear = 0.5;
  const double beyond = std::abs(x) - k_linear;
  if (beyond <= 0) return static_cast<float>(x);
  return static_cast<float>(std::copysign(k_linear + (1 - k_linear) * std::tanh(beyond / (1 - k_linear)), x));
}

}  // namespace

bool is_sound_target(const std::string& target) { return alsa_device(target) || target.ends_with(".wav"); }

void require_sound_target(const std::string& target) {
  if (!alsa_device(target)) require_writable(target);
}

struct VibrationOutput::State {
  State(const ContactSurface& surface, double rate_hz, double full_scale)
      : vibration(surface, {.rate_hz = rate_hz, .sample_rate_hz = k_audio_rate_hz}),
        full_scale_m_per_s2(full_scale),
        ring(k_most_behind) {}

  /// Takes the ticks that are new to `sink`; waits for more until the loop has ended.
  void play(const AudioSink& sink) {
    phase = Phase::open;
    std::uint64_t done = 0;
    std::vector<float> samples;
    while (true) {
      const bool last = ended;
      const std::uint64_t ticks = status == nullptr ? 0 : status.load()->ticks.load();
      if (ticks - done > k_most_behind / 2) {
        report.missed_ticks += ticks - done - k_most_behind / 2;
        done = ticks - k_most_behind / 2;
      }
      samples.clear();
      for (; done < ticks; ++done) {
        const RecordRow& row = ring[done % k_most_behind];
        vibration.tick({row.proxy, norm(row.force), row.in_contact}, samples);
      }
      for (float& sample : samples) take(sample);
      if (!samples.empty()) sink(samples);
      if (last) return;
      std::this_thread::sleep_for(k_look);
    }
  }

  void take(float& sample) {
    const double a = static_cast<double>(sample);
    ++report.samples;
    squares += a * a;
    report.peak_m_per_s2 = std::max(report.peak_m_per_s2, std::abs(a));
    report.limited = report.limited || std::abs(a) > full_scale_m_per_s2;
    sample = rounded_off(a / full_scale_m_per_s2);
  }

  Vibration vibration;
  double full_scale_m_per_s2;
  std::vector<RecordRow> ring;
  std::atomic<const LoopStatus*> status{nullptr};
  std::atomic<bool> ended{false};
  enum class Phase { opening, open, over };
  std::atomic<Phase> phase{Phase::opening};
  std::exception_ptr failure;  ///< Of the thread, once it is over.
  VibrationReport report;
  double squares = 0;
  std::jthread playing;
};

VibrationOutput::VibrationOutput(const std::string& target, const ContactSurface& surface, double rate_hz,
                                 double full_scale_m_per_s2)
    : state_(std::make_unique<State>(surface, rate_hz, full_scale_m_per_s2)) {
  State& state = *state_;
  state.report.target = target;
  const std::optional<std::string> device = alsa_device(target);
  state.playing = std::jthread([&state, target, device] {
    const auto play = [&state](const AudioSink& sink) { state.play(sink); };
    try {
      device ? with_alsa_device(*device, play) : with_wav_file(target, play);
    } catch (...) {
      state.failure = std::current_exception();
    }
    state.phase = State::Phase::over;
  });
  // What can't be opened is told before the loop begins.
  while (state.phase == State::Phase::opening) std::this_thread::sleep_for(k_look);
  if (state.phase == State::Phase::over) finish();
}

VibrationOutput::~VibrationOutput() { state_->ended = true; }

void VibrationOutput::follow(LoopOptions& options) {
  options.recent = state_->ring;
  state_->status = options.status;
}

VibrationReport VibrationOutput::finish() {
  state_->ended = true;
  state_->playing.join();
  if (state_->failure) std::rethrow_exception(state_->failure);
  if (state_->report.samples > 0)
    state_->report.rms_m_per_s2 = std::sqrt(state_->squares / static_cast<double>(state_->report.samples));
  return state_->report;
}

}  // namespace papilla::player
