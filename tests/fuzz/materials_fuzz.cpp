// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "materials_mutator.hpp"
#include "papilla/pipeline/materials.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.json", fuzz::text_of(data, size));
  fuzz::expect_read([&] {
    const Materials file = read_materials(path);
    if (const AssignRule* rule = match_rule(file, "dash left", "#202020", "Leather"); rule != nullptr)
      fuzz::require(rule->material.empty() || file.materials.contains(rule->material), "a rule names a material");
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_json_text(data, size, max_size, seed, papilla::fuzz::materials_grammar(),
                                         papilla::fuzz::repair_materials);
}
