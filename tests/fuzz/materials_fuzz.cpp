// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "papilla/pipeline/materials.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.json", fuzz::text_of(data, size));
  fuzz::expect_result_or_refusal([&] {
    const Materials file = read_materials(path);
    if (const AssignRule* rule = match_rule(file, "dash left", "#202020", "Leather"); rule != nullptr)
      fuzz::require(rule->material.empty() || file.materials.contains(rule->material), "a rule names a material");
  });
  return 0;
}
