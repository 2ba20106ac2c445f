// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include "fuzz_input.hpp"
#include "scene_promises.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.ply", fuzz::text_of(data, size));
  fuzz::expect_result_or_refusal([&] { fuzz::require_promises(read_ply(path)); });
  return 0;
}
