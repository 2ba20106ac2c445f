// SPDX-License-Identifier: MIT
#include "papilla/io/animation_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

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
  OIIO::ImageSpec spec(frames.front().width, frames.front().height, 3, OIIO::TypeDesc::UINT8);
  const int rate[2] = {static_cast<int>(std::lround(per_second * 100)), 100};
  spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
  spec.attribute("gif:LoopCount", 0);
  const std::vector<OIIO::ImageSpec> specs(frames.size() + k_held, spec);
  OIIO::Filesystem::IOVecOutput memory;
  const auto out = OIIO::ImageOutput::create(path.string());
  bool good =
      out && out->set_ioproxy(&memory) && out->open(path.string(), static_cast<int>(specs.size()), specs.data());
  for (std::size_t k = 0; good && k < specs.size(); ++k) {
    if (k > 0) good = out->open(path.string(), specs[k], OIIO::ImageOutput::AppendSubimage);
    good = good && out->write_image(OIIO::TypeDesc::UINT8, frames[std::min(k, frames.size() - 1)].pixels.data());
  }
  if (!good || !out->close())
    throw IoError(path.string() + ": cannot be encoded: " + first_line(out ? out->geterror() : OIIO::geterror()));
  write_atomically(path, {reinterpret_cast<const char*>(memory.buffer().data()), memory.buffer().size()});
}

}  // namespace papilla
