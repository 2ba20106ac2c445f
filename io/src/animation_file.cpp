// SPDX-License-Identifier: MIT
#include "papilla/io/animation_file.hpp"

#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "picture_codec.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_held = 5;  ///< How often the last picture is repeated.

void check(const fs::path& path, std::span<const ColorImage> frames, double per_second) {
  if (path.extension() != ".gif") throw InvalidInput(path.string() + ": an animation is a .gif file");
  if (frames.empty()) throw InvalidInput("write_animation: there are no pictures");
  if (!(per_second > 0 && per_second <= 50))
    throw InvalidInput("write_animation: pictures a second must be in (0, 50]");
  const ColorImage& first = frames.front();
  for (const ColorImage& frame : frames)
    if (frame.width != first.width || frame.height != first.height || frame.width < 1 || frame.height < 1 ||
        frame.width > 65535 || frame.height > 65535 ||
        frame.pixels.size() != 3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height))
      throw InvalidInput("write_animation: the pictures must have one size, 1 to 65535 a side");
}

}  // namespace

void write_animation(const fs::path& path, std::span<const ColorImage> frames, double per_second) {
  check(path, frames, per_second);
  const std::vector<unsigned char> bytes =
      io_detail::pictures_plugin().encode_animation(path.string(), frames, per_second, k_held);
  write_atomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace papilla
