// SPDX-License-Identifier: MIT
#include "audio_sink.hpp"

#include <alsa/asoundlib.h>
#include <dlfcn.h>
#include <sndfile.h>

#include <memory>
#include <ostream>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla::player {
namespace {

/// A library that is loaded when it is needed; it stays loaded.
class Library {
 public:
  explicit Library(const char* name) : handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {}
  bool is_there() const noexcept { return handle_ != nullptr; }

  template <typename Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(::dlsym(handle_, name));
  }

 private:
  void* handle_;
};

#define PAPILLA_LOADED(library, name) const auto name = (library).function<decltype(::name)>(#name)

/// libsndfile's files over a stream.
std::ostream& stream_of(void* user) { return *static_cast<std::ostream*>(user); }

sf_count_t length(void* user) {
  std::ostream& out = stream_of(user);
  const auto at = out.tellp();
  out.seekp(0, std::ios::end);
  const auto end = out.tellp();
  out.seekp(at);
  return end;
}

sf_count_t seek(sf_count_t offset, int whence, void* user) {
  const auto from = whence == SEEK_SET ? std::ios::beg : whence == SEEK_CUR ? std::ios::cur : std::ios::end;
  stream_of(user).seekp(offset, from);
  return stream_of(user).tellp();
}

sf_count_t read_nothing(void*, sf_count_t, void*) { return 0; }

sf_count_t write(const void* bytes, sf_count_t count, void* user) {
  try {
    stream_of(user).write(static_cast<const char*>(bytes), count);
    return count;
  } catch (const std::ios_base::failure&) {
    return 0;  // No exception may pass through C; the sink looks at the stream.
  }
}

/// Errors of ALSA are ours to tell.
void keep_quiet(const char*, int, const char*, int, const char*, ...) {}

sf_count_t tell(void* user) { return stream_of(user).tellp(); }

}  // namespace

void with_wav_file(const std::string& file, const std::function<void(const AudioSink&)>& play) {
  const Library library("libsndfile.so.1");
  if (!library.is_there())
    throw IoError(file + ": sound files need libsndfile, which is not installed (Debian: libsndfile1)");
  PAPILLA_LOADED(library, sf_open_virtual);
  PAPILLA_LOADED(library, sf_write_float);
  PAPILLA_LOADED(library, sf_close);
  write_atomically(file, [&](std::ostream& out) {
    SF_VIRTUAL_IO calls{length, seek, read_nothing, write, tell};
    SF_INFO format{};
    format.samplerate = k_audio_rate_hz;
    format.channels = 1;
    format.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    const std::unique_ptr<SNDFILE, decltype(sf_close)> sound(sf_open_virtual(&calls, SFM_WRITE, &format, &out),
                                                             sf_close);
    if (sound == nullptr) throw IoError(file + ": libsndfile can't write it");
    play([&](std::span<const float> samples) {
      const auto count = static_cast<sf_count_t>(samples.size());
      if (sf_write_float(sound.get(), samples.data(), count) != count) out.setstate(std::ios::badbit);
    });
  });
}

void with_alsa_device(const std::string& device, const std::function<void(const AudioSink&)>& play) {
  const Library library("libasound.so.2");
  if (!library.is_there())
    throw DeviceError("alsa:" + device + ": needs libasound, which is not installed (Debian: libasound2)");
  PAPILLA_LOADED(library, snd_pcm_open);
  PAPILLA_LOADED(library, snd_pcm_set_params);
  PAPILLA_LOADED(library, snd_pcm_writei);
  PAPILLA_LOADED(library, snd_pcm_recover);
  PAPILLA_LOADED(library, snd_pcm_drain);
  PAPILLA_LOADED(library, snd_pcm_close);
  PAPILLA_LOADED(library, snd_strerror);
  PAPILLA_LOADED(library, snd_lib_error_set_handler);
  snd_lib_error_set_handler(keep_quiet);
  const auto fail = [&](int code) { throw DeviceError("alsa:" + device + ": " + snd_strerror(code)); };
  snd_pcm_t* opened = nullptr;
  if (const int code = snd_pcm_open(&opened, device.c_str(), SND_PCM_STREAM_PLAYBACK, 0); code < 0) fail(code);
  const std::unique_ptr<snd_pcm_t, decltype(snd_pcm_close)> pcm(opened, snd_pcm_close);
  constexpr unsigned k_latency_us = 20000;
  if (const int code = snd_pcm_set_params(pcm.get(), SND_PCM_FORMAT_FLOAT, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                                          k_audio_rate_hz, 1, k_latency_us);
      code < 0)
    fail(code);
  play([&](std::span<const float> samples) {
    while (!samples.empty()) {
      const snd_pcm_sframes_t written = snd_pcm_writei(pcm.get(), samples.data(), samples.size());
      if (written >= 0)
        samples = samples.subspan(static_cast<std::size_t>(written));
      else if (const int code = snd_pcm_recover(pcm.get(), static_cast<int>(written), 1); code < 0)
        fail(code);
    }
  });
  snd_pcm_drain(pcm.get());
}

}  // namespace papilla::player
