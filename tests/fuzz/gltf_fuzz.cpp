// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "gltf_mutator.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "scene_promises.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.gltf", fuzz::text_of(data, size));
  fuzz::expect_read([&] { fuzz::require_promises(read_gltf(path)); });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_gltf(data, size, max_size, seed);
}
