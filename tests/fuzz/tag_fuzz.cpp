// SPDX-License-Identifier: MIT
#include "fuzz_input.hpp"
#include "papilla/haptic/material_tag.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  const std::string_view text = fuzz::text_of(data, size);
  std::vector<HapticWarning> warnings;
  fuzz::expect_result_or_refusal([&] {
    const MaterialTag tag = parse_material_tag(text, warnings);
    fuzz::require(parse_material_tag(to_json(tag), warnings) == tag, "a tag that is written is read again as it was");
  });
  std::string extras(text);
  fuzz::expect_result_or_refusal([&] { take_material_tag(extras, warnings); });
  return 0;
}
