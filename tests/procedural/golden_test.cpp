// SPDX-License-Identifier: MIT
// Small pictures of every type. PAPILLA_REMAKE_GOLDEN=1 papilla_procedural_tests --gtest_filter='*Golden*' writes them
// anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "papilla/procedural/reference.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

constexpr int k_side = 32;

/// The main channel as a binary PGM.
std::string pgm_of(std::string_view type) {
  const RenderedTexture texture = test::rendered(test::example_of(type), k_side, RecipeLibrary::builtin());
  std::string file = "P5\n32 32\n255\n";
  for (const float v : texture.values[Channel::main])
    file += static_cast<char>(static_cast<unsigned char>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))));
  return file;
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, LooksAsBefore) {
  const auto path = std::filesystem::path(PAPILLA_GOLDEN_DIR) / (GetParam() + ".pgm");
  const std::string now = pgm_of(GetParam());
  if (std::getenv("PAPILLA_REMAKE_GOLDEN")) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << now;
  }
  std::ifstream in(path, std::ios::binary);
  const std::string before{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  ASSERT_EQ(before.size(), now.size()) << path;
  int unlike = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (std::abs(static_cast<unsigned char>(now[i]) - static_cast<unsigned char>(before[i])) > 1) ++unlike;
  // Edges may fall to the other side where a library's sine differs in the last bit.
  EXPECT_LE(unlike, 4);
}

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const TypeInfo& type : texture_types()) names.emplace_back(type.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Types, Golden, testing::ValuesIn(type_names()), [](const auto& type) { return type.param; });

}  // namespace
}  // namespace papilla
