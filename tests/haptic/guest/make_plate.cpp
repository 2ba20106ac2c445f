// SPDX-License-Identifier: MIT
// usage: papilla-guest-plate FILE.glb [relief]
#include <fstream>

#include "haptic/tagged_glb.hpp"
#include "papilla/haptic/sha256.hpp"

int main(int argc, char** argv) {
  using namespace papilla;
  if (argc != 2 && argc != 3) return 2;
  nlohmann::json tag = {{"version", 1}, {"stiffness", 300}};
  std::string image;
  if (argc == 3) {
    image = testing::sine_png();
    tag["height"] = {{"uri", "data:image/png;base64," + testing::base64(image)},
                     {"sha256", sha256_hex(std::as_bytes(std::span(image.data(), image.size())))},
                     {"scale", 1e-3},
                     {"offset", -1e-3},
                     {"metresPerUV", {0.04, 0.04}}};
  }
  std::ofstream(argv[1], std::ios::binary) << testing::plate_glb({{"haptic", tag}}, image, argc == 3);
  return 0;
}
