// SPDX-License-Identifier: MIT
#include <papilla/io/image_file.hpp>

int main() {
  const papilla::ColorImage black{.width = 2, .height = 1, .pixels = {0, 0, 0, 0, 0, 0}};
  return papilla::encode_png(black).size() > 8 ? 0 : 1;
}
