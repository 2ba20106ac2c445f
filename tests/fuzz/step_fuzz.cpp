// SPDX-License-Identifier: MIT
#include "cad_syntax.hpp"
#include "fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto file = fuzz::write_input("input.step", fuzz::text_of(data, size));
  fuzz::expect_result_or_refusal([&] { cad::check_step_syntax(file); });
  return 0;
}
