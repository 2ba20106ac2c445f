// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_suggestion.hpp"
#include "one_material_scene.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "papilla/pipeline/hex_colour.hpp"
#include "papilla/pipeline/material_library.hpp"

namespace papilla {
namespace {

const std::vector<LibraryMaterial>& library() {
  static const std::vector<LibraryMaterial> materials =
      MaterialLibrary(std::filesystem::path(PAPILLA_DATA) / "materials").materials();
  return materials;
}

/// A plan of one part that no rule takes, but for `assigned`.
std::vector<MaterialSuggestion> suggest(const std::string& part, const std::string& material, const std::string& colour,
                                        const std::string& assigned = "", std::size_t most = 3) {
  const Scene scene = test::one_material_scene(part, material, linear_colour(colour));
  PartSurface surface;
  surface.label = part;
  surface.material = assigned;
  return suggest_materials(scene, {surface}, library(), most);
}

/// The folder of the best suggestion.
std::string kind_of(const std::vector<MaterialSuggestion>& suggestions) {
  return suggestions.empty() ? "" : suggestions[0].material.substr(0, suggestions[0].material.find('/'));
}

TEST(MaterialSuggestion, GoesByTheNameOfThePart) {
  EXPECT_EQ(suggest("piano_black_bezel", "", "#ff00ff").at(0).material, "gloss/piano-black");
  EXPECT_EQ(kind_of(suggest("SeatCushion_2", "", "#2b2724")), "leather");
  EXPECT_EQ(kind_of(suggest("floor_carpet", "", "#3c3c40")), "carpet");
  const std::vector<MaterialSuggestion> knob = suggest("knob_left", "", "#f5f6f6");
  EXPECT_NE(knob.at(0).material.find("knurled"), std::string::npos) << knob[0].material;
  EXPECT_EQ(knob[0].reason, "part name 'knob_left' has 'knob'");
}

TEST(MaterialSuggestion, KnowsGermanAndItsCompounds) {
  EXPECT_EQ(kind_of(suggest("Lenkrad_Leder", "", "#1d1b1a")), "leather");
  EXPECT_EQ(kind_of(suggest("Fußmatte vorn", "", "#3c3c40")), "carpet");
  EXPECT_EQ(kind_of(suggest("Korkeinlage", "", "#000000")), "wood");
}

TEST(MaterialSuggestion, TheNameOfAMaterialSaysMoreThanThatOfThePart) {
  const std::vector<MaterialSuggestion> s = suggest("seat_cushion", "Walnut", "#2b2724");
  EXPECT_EQ(s.at(0).material.substr(0, 11), "wood/walnut");
  EXPECT_EQ(s[0].reason, "material 'Walnut' has 'walnut'");
}

TEST(MaterialSuggestion, AmongEqualsTheNearestColourIsFirst) {
  EXPECT_EQ(suggest("seat", "leather", "#6b4a33").at(0).material, "leather/semi-aniline");
  EXPECT_EQ(suggest("seat", "leather", "#8a5a34").at(0).material, "leather/saddle");
}

TEST(MaterialSuggestion, WithoutANameOnlyTheColourIsLeftAndSaysSo) {
  const std::vector<MaterialSuggestion> s = suggest("Body001", "", "#f9d1c2");
  for (const MaterialSuggestion& one : s)
    EXPECT_EQ(one.reason.substr(0, 26), "only its colour #f9d1c2 is") << one.reason;
  EXPECT_EQ(suggest("Body001", "", "#00ff00").size(), 0U) << "nothing is that green";
}

TEST(MaterialSuggestion, WhatHasAMaterialGetsNone) {
  EXPECT_TRUE(suggest("seat", "leather", "#000000", "mine").empty());
  EXPECT_EQ(suggest("seat", "leather", "#000000", "", 1).size(), 1U);
}

}  // namespace
}  // namespace papilla
