// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "json_mutator.hpp"
#include "papilla/haptic/material_tag.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const std::string_view text = fuzz::text_of(data, size);
  std::vector<HapticWarning> warnings;
  fuzz::expect_read([&] {
    const MaterialTag tag = parse_material_tag(text, warnings);
    fuzz::require(parse_material_tag(to_json(tag), warnings) == tag, "a tag that is written is read again as it was");
  });
  std::string extras(text);
  fuzz::expect_result_or_refusal([&] { take_material_tag(extras, warnings); });
  for (const HapticWarning& warning : warnings)
    fuzz::require(warning.message.find('\n') == std::string::npos, "a warning is one line");
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return papilla::fuzz::mutate_json_text(data, size, max_size, seed, papilla::fuzz::tag_grammar(),
                                         papilla::fuzz::repair_tag);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second, std::size_t second_size, std::uint8_t* out,
                                                 std::size_t max_size, unsigned seed) {
  using namespace papilla::fuzz;
  return cross_json_texts(text_of(first, first_size), text_of(second, second_size), out, max_size, seed);
}
