// SPDX-License-Identifier: MIT
// usage: papilla-guest-plate FILE.glb
#include <fstream>

#include "haptic/tagged_glb.hpp"

int main(int argc, char** argv) {
  using namespace papilla;
  if (argc != 2) return 2;
  const nlohmann::json tag = {{"version", 1}, {"stiffness", 300}};
  std::ofstream(argv[1], std::ios::binary) << testing::plate_glb({{"haptic", tag}}, "");
  return 0;
}
