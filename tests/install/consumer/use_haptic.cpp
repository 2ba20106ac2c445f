// SPDX-License-Identifier: MIT
#include <papilla/haptic/height_field.hpp>

int main() {
  papilla::HeightFieldOptions options;
  options.scale_m = 0.001;
  const papilla::HeightField relief(2, 2, {65535, 65535, 65535, 65535}, options);
  return relief.max_m() == 0.001 ? 0 : 1;
}
