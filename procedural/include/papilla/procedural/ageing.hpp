// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// A layer that words of ageing ask for.
struct AgeingLayer {
  std::string recipe;     ///< Name of the built-in recipe.
  double strength = 0.6;  ///< Its age at time 1, in (0, 1].

  /// RECIPE|fixtime=true|time=STRENGTH*globaltime: new at time 0, of its strength at time 1.
  std::string text() const;
};

/// A word, English or German, and the layers that it stands for at full strength, by name.
struct AgeingWord {
  std::string_view word;
  std::string_view layers;  ///< name=share, separated by blanks: "polish=1 edge_wear=.8".
};

/// The words, in alphabetical order of English, then German. Umlauts are written ae, oe, ue, ss.
const std::vector<AgeingWord>& ageing_words();

/// The layers for words such as "very rusty and slightly dusty", "dirty 0.7", "sehr rostig, etwas verstaubt", from the
/// lowest to the highest: what eats into a surface, what wears it, what lies on it, snow last.
///
/// A word stands for its layers at strength 0.6. Before it may stand a word of strength: slightly, leicht, etwas (0.3),
/// quite, ziemlich (0.45), heavily, very, sehr, stark (0.85), completely, voellig (1), and behind it a number of (0, 1]
/// or a percentage instead. Words are separated by and, und, commas. German adjectives may be declined, umlauts written
/// either way; upper and lower case are alike. A layer that two words ask for has the larger strength.
/// @throws InvalidInput naming a word that is unknown, with the nearest that is known; a strength that belongs to no
/// word or is outside of (0, 1]; a text without words.
std::vector<AgeingLayer> ageing_layers(std::string_view words);

/// What of a text is about ageing ("rusty" of "rusty steel door"), and the rest of it. Never throws for unknown words.
struct AgeingInText {
  std::vector<AgeingLayer> layers;
  std::string rest;
};
AgeingInText find_ageing(std::string_view text);

/// multi|textures=[RECIPE],LAYERS.
std::string aged_recipe(std::string_view recipe, const std::vector<AgeingLayer>& layers);

}  // namespace papilla
