// SPDX-License-Identifier: MIT
#include "papilla/procedural/ageing.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "syntax.hpp"

namespace papilla {
namespace {

constexpr double k_plain = 0.6;

/// From the lowest layer to the highest.
constexpr std::string_view k_order[] = {"greying",   "erosion", "chipped_paint", "rust_in",     "rust_on", "scratches",
                                        "edge_wear", "polish",  "dirt",          "flow_stains", "grime",   "smears",
                                        "moss",      "wetness", "dust",          "snow"};

struct Strength {
  std::string_view word;
  double value;
};
constexpr Strength k_strengths[] = {{"slightly", 0.3},  {"lightly", 0.3}, {"little", 0.3},   {"bit", 0.3},
                                    {"somewhat", 0.3},  {"barely", 0.15}, {"hardly", 0.15},  {"moderately", 0.45},
                                    {"quite", 0.45},    {"rather", 0.45}, {"very", 0.85},    {"heavily", 0.85},
                                    {"strongly", 0.85}, {"badly", 0.85},  {"extremely", 1},  {"completely", 1},
                                    {"totally", 1},     {"leicht", 0.3},  {"etwas", 0.3},    {"wenig", 0.3},
                                    {"bisschen", 0.3},  {"kaum", 0.15},   {"maessig", 0.45}, {"ziemlich", 0.45},
                                    {"recht", 0.45},    {"sehr", 0.85},   {"stark", 0.85},   {"schwer", 0.85},
                                    {"extrem", 1},      {"voellig", 1},   {"ganz", 1},       {"komplett", 1}};
constexpr std::string_view k_joining[] = {"and", "und", "a", "an", "ein"};

template <class Range>
bool holds(const Range& range, std::string_view word) {
  return std::find(std::begin(range), std::end(range), word) != std::end(range);
}

/// Lower case, umlauts in two letters.
std::string plain_letters(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> umlauts{
      {{"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "ae"}, {"Ö", "oe"}, {"Ü", "ue"}, {"ß", "ss"}}};
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto it = std::find_if(umlauts.begin(), umlauts.end(),
                                 [&](const auto& u) { return text.substr(at).starts_with(u.first); });
    if (it != umlauts.end()) {
      out += it->second;
      at += it->first.size();
      continue;
    }
    const char c = text[at++];
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return out;
}

/// Words and numbers; a comma and its like are words of their own.
std::vector<std::string> tokens_of(std::string_view text) {
  std::vector<std::string> tokens;
  bool open = false;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '=' || c == ':' || c == '_' || c == '-';
    const bool mark = c == ',' || c == ';' || c == '+' || c == '&';
    if (mark) tokens.emplace_back(",");
    if (!blank && !mark) {
      if (!open) tokens.emplace_back();
      tokens.back() += c;
    }
    open = !blank && !mark;
  }
  return tokens;
}

const AgeingWord* known_word(const std::string& word) {
  const auto& words = ageing_words();
  const auto exact = [&](std::string_view w) {
    const auto it = std::find_if(words.begin(), words.end(), [&](const AgeingWord& a) { return a.word == w; });
    return it == words.end() ? nullptr : &*it;
  };
  if (const AgeingWord* found = exact(word)) return found;
  for (const std::string_view ending : {"e", "er", "es", "en", "em"})
    if (word.size() > ending.size() + 2 && word.ends_with(ending))
      if (const AgeingWord* found = exact(std::string_view(word).substr(0, word.size() - ending.size()))) return found;
  return nullptr;
}

std::optional<double> strength_of(const std::string& word) {
  const auto it =
      std::find_if(std::begin(k_strengths), std::end(k_strengths), [&](const Strength& s) { return s.word == word; });
  return it == std::end(k_strengths) ? std::nullopt : std::optional(it->value);
}

/// A number or a percentage, as a share; nothing for other words.
std::optional<double> share_of(const std::string& word) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc()) return std::nullopt;
  if (stop == end) return value;
  return stop + 1 == end && *stop == '%' ? std::optional(value / 100) : std::nullopt;
}

/// Layers by place in k_order; 0: none.
using Strengths = std::array<double, std::size(k_order)>;

void add_word(const AgeingWord& word, double strength, Strengths& strengths) {
  std::string_view rest = word.layers;
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::size_t equals = entry.find('=');
    double share = 1;
    std::from_chars(entry.data() + equals + 1, entry.data() + entry.size(), share);
    const auto place = static_cast<std::size_t>(
        std::find(std::begin(k_order), std::end(k_order), entry.substr(0, equals)) - std::begin(k_order));
    strengths[place] = std::max(strengths[place], share * strength);
  }
}

std::vector<AgeingLayer> layers_of(const Strengths& strengths) {
  std::vector<AgeingLayer> layers;
  for (std::size_t k = 0; k < strengths.size(); ++k)
    if (strengths[k] > 0) layers.push_back({std::string(k_order[k]), strengths[k]});
  return layers;
}

[[noreturn]] void fail(const std::string& reason) { throw InvalidInput("age: " + reason); }

[[noreturn]] void refuse_unknown(const std::string& word) {
  std::vector<std::string_view> known;
  for (const AgeingWord& w : ageing_words()) known.push_back(w.word);
  for (const Strength& s : k_strengths) known.push_back(s.word);
  fail("unknown word " + procedural_detail::in_quotes(word) + did_you_mean(word, known) +
       "; known are rusty, dusty, worn, wet and others (texture --list ageing)");
}

/// Reads a text word by word. A lenient reader leaves what it does not know.
class Reader {
 public:
  explicit Reader(bool lenient) : lenient_(lenient) {}

  void read(std::string_view text) {
    for (const std::string& token : tokens_of(text)) {
      const std::string word = plain_letters(token);
      if (word == "," || holds(k_joining, word))
        leave(word == "," ? "" : token);
      else if (const AgeingWord* ageing = known_word(word))
        begin(*ageing);
      else if (const auto strength = strength_of(word))
        wait(*strength, token);
      else if (const auto share = share_of(word))
        set_share(*share, token);
      else if (lenient_)
        leave(token);
      else
        refuse_unknown(token);
    }
    finish();
    if (waiting_) {
      if (!lenient_) fail(procedural_detail::in_quotes(waiting_word_) + " belongs to no word of ageing");
      leave(waiting_word_);
    }
  }

  Strengths strengths{};
  std::string rest;

 private:
  void begin(const AgeingWord& word) {
    finish();
    open_ = &word, strength_ = waiting_.value_or(k_plain), is_given_ = waiting_.has_value();
    waiting_.reset();
  }
  void finish() {
    if (open_) add_word(*open_, strength_, strengths);
    open_ = nullptr;
  }
  void wait(double strength, const std::string& token) {
    finish();
    if (waiting_ && !lenient_) fail(procedural_detail::in_quotes(waiting_word_) + " belongs to no word of ageing");
    waiting_ = strength, waiting_word_ = token;
  }
  void set_share(double share, const std::string& token) {
    if (!open_ || is_given_) {
      if (lenient_) return leave(token);
      fail("the number " + procedural_detail::in_quotes(token) + " stands behind no word of ageing");
    }
    if (!(share > 0 && share <= 1)) fail("the strength " + procedural_detail::in_quotes(token) + " is not in (0, 1]");
    strength_ = share, is_given_ = true;
  }
  void leave(const std::string& token) {
    if (token.empty()) finish();
    if (!lenient_ || token.empty()) return;
    rest += (rest.empty() ? "" : " ") + token;
  }

  bool lenient_;
  const AgeingWord* open_ = nullptr;
  double strength_ = k_plain;
  bool is_given_ = false;
  std::optional<double> waiting_;
  std::string waiting_word_;
};

}  // namespace

const std::vector<AgeingWord>& ageing_words() {
  static const std::vector<AgeingWord> words = {
      {"aged", "greying=.8 scratches=.5 polish=.6 dirt=.5"},
      {"bleached", "greying=1"},
      {"chipped", "chipped_paint=1"},
      {"corroded", "rust_in=1 rust_on=.5"},
      {"damp", "wetness=.6"},
      {"dirty", "dirt=1"},
      {"dusty", "dust=1"},
      {"eroded", "erosion=1"},
      {"faded", "greying=1"},
      {"flaking", "chipped_paint=1"},
      {"greasy", "grime=.7 smears=.7"},
      {"grey", "greying=1"},
      {"greyed", "greying=1"},
      {"grimy", "grime=1"},
      {"moist", "wetness=.6"},
      {"mossy", "moss=1"},
      {"old", "greying=.8 scratches=.5 polish=.6 dirt=.5"},
      {"overgrown", "moss=1 dirt=.4"},
      {"peeling", "chipped_paint=1"},
      {"pitted", "rust_in=1"},
      {"polished", "polish=1"},
      {"rubbed", "edge_wear=1"},
      {"rusted", "rust_on=1"},
      {"rusty", "rust_on=1"},
      {"scratched", "scratches=1"},
      {"scuffed", "scratches=.6 edge_wear=.8"},
      {"shabby", "greying=.6 scratches=.6 edge_wear=.8 grime=.6"},
      {"smeared", "smears=1"},
      {"smudged", "smears=1"},
      {"snowy", "snow=1"},
      {"soiled", "dirt=1"},
      {"stained", "flow_stains=1 smears=.5"},
      {"streaked", "flow_stains=1"},
      {"streaky", "flow_stains=1"},
      {"used", "scratches=.4 polish=.7"},
      {"weathered", "greying=.7 erosion=.6 dirt=.5"},
      {"wet", "wetness=1"},
      {"worn", "scratches=.3 edge_wear=.8 polish=1"},
      // German.
      {"abblaetternd", "chipped_paint=1"},
      {"abgegriffen", "edge_wear=.6 polish=1"},
      {"abgenutzt", "scratches=.3 edge_wear=.8 polish=1"},
      {"abgeplatzt", "chipped_paint=1"},
      {"abgerieben", "edge_wear=1"},
      {"abgewetzt", "scratches=.6 edge_wear=.8"},
      {"alt", "greying=.8 scratches=.5 polish=.6 dirt=.5"},
      {"ausgeblichen", "greying=1"},
      {"bemoost", "moss=1"},
      {"dreckig", "dirt=1"},
      {"durchgerostet", "rust_in=1 rust_on=.5"},
      {"erodiert", "erosion=1"},
      {"feucht", "wetness=.6"},
      {"fleckig", "smears=1 dirt=.4"},
      {"gealtert", "greying=.8 scratches=.5 polish=.6 dirt=.5"},
      {"gebraucht", "scratches=.4 polish=.7"},
      {"korrodiert", "rust_in=1 rust_on=.5"},
      {"moosig", "moss=1"},
      {"nass", "wetness=1"},
      {"poliert", "polish=1"},
      {"rostig", "rust_on=1"},
      {"schaebig", "greying=.6 scratches=.6 edge_wear=.8 grime=.6"},
      {"schmierig", "grime=.7 smears=.7"},
      {"schmutzig", "dirt=1"},
      {"schneebedeckt", "snow=1"},
      {"speckig", "grime=.6 polish=1"},
      {"staubig", "dust=1"},
      {"streifig", "flow_stains=1"},
      {"verblasst", "greying=1"},
      {"verblichen", "greying=1"},
      {"verdreckt", "dirt=1 grime=.6"},
      {"vergraut", "greying=1"},
      {"verkratzt", "scratches=1"},
      {"vermoost", "moss=1"},
      {"verrostet", "rust_on=1"},
      {"verschmiert", "smears=1"},
      {"verschmutzt", "dirt=1"},
      {"verschneit", "snow=1"},
      {"verstaubt", "dust=1"},
      {"verwittert", "greying=.7 erosion=.6 dirt=.5"},
      {"zerfressen", "rust_in=1"},
      {"zerkratzt", "scratches=1"},
  };
  return words;
}

std::string AgeingLayer::text() const {
  char number[32];
  const auto [end, unused] = std::to_chars(number, number + sizeof number, strength, std::chars_format::fixed, 3);
  return recipe + "|fixtime=true|time=" + std::string(number, end) + "*globaltime";
}

std::vector<AgeingLayer> ageing_layers(std::string_view words) {
  Reader reader(false);
  reader.read(words);
  std::vector<AgeingLayer> layers = layers_of(reader.strengths);
  if (layers.empty()) fail("a word such as rusty, dusty or worn is missing");
  return layers;
}

AgeingInText find_ageing(std::string_view text) {
  Reader reader(true);
  reader.read(text);
  return {layers_of(reader.strengths), std::move(reader.rest)};
}

std::string aged_recipe(std::string_view recipe, const std::vector<AgeingLayer>& layers) {
  std::string out = "multi|textures=[" + std::string(recipe) + "]";
  for (const AgeingLayer& layer : layers) out += ",[" + layer.text() + "]";
  return out;
}

}  // namespace papilla
