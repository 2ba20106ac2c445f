// SPDX-License-Identifier: MIT
#include <cmath>

#include "fuzz_input.hpp"
#include "papilla/core/error.hpp"
#include "papilla/procedural/shader.hpp"
#include "papilla/procedural/texture.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace papilla;
  static const RecipeLibrary builtin = RecipeLibrary::builtin();
  constexpr unsigned k_all = (1U << k_channels) - 1;
  const std::string_view text = fuzz::text_of(data, size);
  fuzz::expect_result_or_refusal([&] {
    const ProceduralTexture texture = compile_texture(text, builtin);
    const std::vector<double> x = {-1e300, 0, 0.3, 1, 7}, y = {0.2, 0, 0.9, 1, -4};
    const std::vector<std::uint32_t> places = {5, 0, 1, 3, 4};
    const TextureValues values =
        evaluate_texture(texture, {x, y, {}, {}, {}, {}, {}, {3, 2, true, places}}, k_all, 0.01);
    for (const auto& channel : values.channels)
      for (const float v : channel) fuzz::require(std::isfinite(v), "a value is finite");
  });
  fuzz::expect_result_or_refusal([&] { shader_source(compile_texture(text, builtin)); });
  fuzz::expect_result_or_refusal([&] {
    RecipeLibrary library;
    library.read_text(text, "input", "/nonexistent");
    for (const auto& entry : library.recipes())
      fuzz::expect_result_or_refusal([&] { compile_texture(entry.first, library); });
  });
  return 0;
}
