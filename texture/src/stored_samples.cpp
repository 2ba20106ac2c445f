// SPDX-License-Identifier: MIT
#include "papilla/texture/stored_samples.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

[[noreturn]] void fail(const std::filesystem::path& folder, int reason) {
  throw IoError((folder.empty() ? "." : folder.string()) +
                ": a temporary file in it: " + std::generic_category().message(reason));
}

/// Moves `count` bytes by pread() or pwrite(), which may move fewer at a time.
template <class Move, class Byte>
void move_all(const std::filesystem::path& folder, Byte* bytes, std::size_t count, off_t at, const Move& move) {
  while (count > 0) {
    const ssize_t moved = move(bytes, count, at);
    if (moved < 0 && errno == EINTR) continue;
    if (moved <= 0) fail(folder, moved < 0 ? errno : EIO);
    bytes += moved;
    at += moved;
    count -= static_cast<std::size_t>(moved);
  }
}

off_t place(int x, int y, int width) { return (static_cast<off_t>(y) * width + x) * static_cast<off_t>(sizeof(float)); }

}  // namespace

void SamplesInMemory::read(int x, int y, int count, float* samples) const {
  const std::size_t begin =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x);
  std::copy_n(samples_.begin() + static_cast<std::ptrdiff_t>(begin), count, samples);
}

void ScaledSamples::read(int x, int y, int count, float* samples) const {
  samples_.read(x, y, count, samples);
  std::transform(samples, samples + count, samples, [this](float sample) {
    return static_cast<float>(scale_ * (static_cast<double>(sample) - origin_) + offset_);
  });
}

SampleFile::SampleFile(int width, int height, const std::filesystem::path& folder)
    : SampleRows(width, height), folder_(folder) {
  file_ = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC | O_EXCL, 0600);
  if (file_ >= 0) return;
  // Some file systems have no files without a name.
  std::string name = (folder / ".papilla-samples-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) fail(folder_, errno);
  ::unlink(name.c_str());
}

SampleFile::~SampleFile() { ::close(file_); }

void SampleFile::read(int x, int y, int count, float* samples) const {
  move_all(folder_, reinterpret_cast<char*>(samples), static_cast<std::size_t>(count) * sizeof(float),
           place(x, y, width()),
           [this](char* to, std::size_t bytes, off_t at) { return ::pread(file_, to, bytes, at); });
}

void SampleFile::write(int y, std::span<const float> samples) {
  move_all(folder_, reinterpret_cast<const char*>(samples.data()), samples.size_bytes(), place(0, y, width()),
           [this](const char* from, std::size_t bytes, off_t at) { return ::pwrite(file_, from, bytes, at); });
}

}  // namespace papilla
