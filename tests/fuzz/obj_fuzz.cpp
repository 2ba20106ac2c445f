// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include "fuzz_input.hpp"
#include "scene_promises.hpp"

/// What follows the first zero byte is the material library input.mtl.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t end = std::min(text.find('\0'), size);
  const auto path = fuzz::write_input("input.obj", text.substr(0, end));
  fuzz::write_input("input.mtl", text.substr(std::min(end + 1, size)));
  fuzz::expect_result_or_refusal([&] { fuzz::require_promises(read_obj(path)); });
  return 0;
}
