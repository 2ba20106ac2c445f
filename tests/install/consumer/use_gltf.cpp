// SPDX-License-Identifier: MIT
#include <papilla/core/error.hpp>
#include <papilla/io/gltf_reader.hpp>

int main() {
  try {
    papilla::read_gltf("missing.glb");
  } catch (const papilla::IoError&) {
    return 0;
  }
  return 1;
}
