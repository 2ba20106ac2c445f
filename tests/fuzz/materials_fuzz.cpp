// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "materials_mutator.hpp"
#include "papilla/pipeline/assignment.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const auto path = fuzz::write_input("input.json", fuzz::text_of(data, size));
  fuzz::expect_read([&] {
    const Materials file = read_materials(path);
    Part part;
    part.name = "dash left";
    part.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.mesh.triangles = {{0, 1, 2}};
    Scene scene = single_part_scene(std::move(part), "fuzz");
    for (const RuleUse& use : assign_materials(scene, file).uses)
      fuzz::require(use.problem.empty() == (use.surfaces > 0), "a rule takes a surface or says why not");
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_json_text(data, size, max_size, seed, papilla::fuzz::materials_grammar(),
                                         papilla::fuzz::repair_materials);
}
