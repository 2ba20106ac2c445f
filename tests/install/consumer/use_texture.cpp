// SPDX-License-Identifier: MIT
#include <papilla/texture/spectral_surface.hpp>

int main() {
  papilla::SpectralSurfaceOptions options;
  options.size = 16;
  return papilla::spectral_surface(options).heights.size() == 256 ? 0 : 1;
}
