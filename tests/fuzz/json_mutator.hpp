// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace papilla::fuzz {

using Json = nlohmann::ordered_json;

/// The choices of one mutation; the same seed gives the same ones.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::size_t below(std::size_t count) { return count == 0 ? 0 : engine_() % count; }  ///< 0 of nothing.
  bool chance(double share) { return real(0, 1) < share; }
  double real(double low, double high) {
    return low + (high - low) * (static_cast<std::uint32_t>(engine_()) / 4294967296.0);
  }
  template <class List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937 engine_;
};

/// What the members of a JSON format may hold, by key; elements of an array have the array's key.
struct JsonGrammar {
  struct Range {
    std::string_view key;
    double low, high;
  };
  struct Words {
    std::string_view key;
    std::vector<std::string_view> words;
  };
  std::vector<Range> ranges;
  std::vector<Words> words;
  Json sample;  ///< A document with every member, from which members are taken.
};

/// The members of `extras.haptic`.
const JsonGrammar& tag_grammar();

/// Gives a tag what it can't be without.
void repair_tag(Json& tag);

/// Changes one to four values or members: numbers to their limits and just beyond, tiny, huge and negative ones; words;
/// members added from the sample, taken away, copied, swapped; rarely a value of another type.
void mutate_json(Json& json, const JsonGrammar& grammar, Random& random);

/// Takes away members that the sample has not, and brings values into its types, the ranges and the words.
void fit_json(Json& value, const Json& sample, const JsonGrammar& grammar, std::string_view key = "");

/// Replaces some value by one that stands under the same key in `other`.
void cross_json(Json& json, const Json& other, Random& random);

/// Bodies of LLVMFuzzerCustomMutator() and LLVMFuzzerCustomCrossOver() for JSON texts. Texts that are no JSON, and some
/// others, are left to libFuzzer's own mutations.
/// @param repair  of most results.
std::size_t mutate_json_text(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                             const JsonGrammar& grammar, void (*repair)(Json&) = nullptr);
std::size_t cross_json_texts(std::string_view first, std::string_view second, std::uint8_t* out, std::size_t max_size,
                             unsigned seed);

/// libFuzzer's own mutations of the bytes; without libFuzzer one bit.
std::size_t mutate_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size, Random& random);

/// Copies a text that fits; else leaves `data` as it is. @returns the size of what `data` holds.
std::size_t store(std::string_view text, std::uint8_t* data, std::size_t size, std::size_t max_size);

}  // namespace papilla::fuzz
