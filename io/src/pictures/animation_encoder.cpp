// SPDX-License-Identifier: MIT
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "codecs.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla::io_detail {

std::vector<unsigned char> encode_gif(const std::string& name, std::span<const ColorImage> frames, double per_second,
                                      std::size_t held) {
  OIIO::ImageSpec spec(frames.front().width, frames.front().height, 3, OIIO::TypeDesc::UINT8);
  const int rate[2] = {static_cast<int>(std::lround(per_second * 100)), 100};
  spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
  spec.attribute("gif:LoopCount", 0);
  const std::vector<OIIO::ImageSpec> specs(frames.size() + held, spec);
  OIIO::Filesystem::IOVecOutput memory;
  const auto out = OIIO::ImageOutput::create(name);
  bool good = out && out->set_ioproxy(&memory) && out->open(name, static_cast<int>(specs.size()), specs.data());
  for (std::size_t k = 0; good && k < specs.size(); ++k) {
    if (k > 0) good = out->open(name, specs[k], OIIO::ImageOutput::AppendSubimage);
    good = good && out->write_image(OIIO::TypeDesc::UINT8, frames[std::min(k, frames.size() - 1)].pixels.data());
  }
  if (!good || !out->close())
    throw IoError(name + ": cannot be encoded: " + first_line(out ? out->geterror() : OIIO::geterror()));
  return memory.buffer();
}

}  // namespace papilla::io_detail
