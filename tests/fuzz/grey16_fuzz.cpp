// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "papilla/io/decode_grey16.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  fuzz::expect_result_or_refusal([&] {
    const Grey16 grey = decode_grey16(std::as_bytes(std::span(data, size)), "input");
    fuzz::require(grey.width > 0 && grey.height > 0, "a picture has pixels");
    fuzz::require(grey.values.size() == static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height),
                  "a value per pixel");
  });
  return 0;
}
