// SPDX-License-Identifier: MIT
#include "json_mutator.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

extern "C" __attribute__((weak)) std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                                              std::size_t max_size);

namespace papilla::fuzz {
namespace {

constexpr int k_deepest = 64;
constexpr std::size_t k_most_slots = 20000;
constexpr double k_bytes_share = 0.02;  ///< Of mutations that may break the text.

/// A value and where it stands.
struct Slot {
  Json* value;
  Json* parent;
  std::string key;  ///< Of an array's element: that of the array.
  std::size_t index = 0;
};

void collect(Json& value, Json* parent, const std::string& key, std::size_t index, int depth,
             std::vector<Slot>& slots) {
  if (depth > k_deepest || slots.size() > k_most_slots) return;
  slots.push_back({&value, parent, key, index});
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], &value, key, i, depth + 1, slots);
  if (value.is_object())
    for (auto& [name, member] : value.items()) collect(member, &value, name, 0, depth + 1, slots);
}

std::vector<Slot> slots_of(Json& json) {
  std::vector<Slot> slots;
  collect(json, nullptr, "", 0, 0, slots);
  return slots;
}

/// Those that `accept` likes.
template <class Accept>
std::vector<Slot> slots_of(Json& json, const Accept& accept) {
  std::vector<Slot> slots = slots_of(json);
  std::erase_if(slots, [&](const Slot& slot) { return !accept(slot); });
  return slots;
}

double finite(double value) {
  constexpr double k_largest = std::numeric_limits<double>::max();
  return std::isnan(value) ? 0 : std::clamp(value, -k_largest, k_largest);
}

double any_number(double old, Random& random) {
  constexpr double k_extremes[] = {5e-324, 1e-300, 1e-30, 1e-9, 1e9, 1e30, 1e300, 4294967296.0, 9007199254740993.0};
  switch (random.below(6)) {
    case 0: return 0;
    case 1: return -old;
    case 2: return old * std::pow(10, random.real(-3, 3));
    case 3: return old + (random.chance(0.5) ? 1 : -1);
    case 4: return (random.chance(0.2) ? -1 : 1) * std::pow(10, random.real(-12, 9));
    default: return (random.chance(0.3) ? -1 : 1) * random.of(k_extremes);
  }
}

double number_in(const JsonGrammar::Range& range, double old, Random& random) {
  const auto [key, low, high] = range;
  switch (random.below(8)) {
    case 0: return low;
    case 1: return high;
    case 2: return std::nextafter(low, random.chance(0.5) ? high : low - 1);
    case 3: return std::nextafter(high, random.chance(0.5) ? low : 2 * high);
    case 4: return any_number(old, random);
    case 5: return low + (high - low) * std::pow(10, random.real(-12, 0));
    default: return random.real(low, high);
  }
}

Json mutated_number(const Slot& slot, const JsonGrammar& grammar, Random& random) {
  const double old = slot.value->get<double>();
  for (const JsonGrammar::Range& range : grammar.ranges)
    if (range.key == slot.key && random.chance(0.9)) {
      const double number = finite(number_in(range, old, random));
      return slot.value->is_number_integer() && std::abs(number) < 1e15 && random.chance(0.8)
                 ? Json(static_cast<std::int64_t>(number))
                 : Json(number);
    }
  if (!slot.value->is_number_integer() || random.chance(0.02)) return finite(any_number(old, random));
  constexpr std::int64_t k_extremes[] = {-1, 255, 256, 65535, 65536, 2147483647, 2147483648, 4294967295, 4294967296};
  const auto whole = slot.value->get<std::int64_t>();
  if (random.chance(0.1)) return random.of(k_extremes);
  switch (random.below(4)) {
    case 0: return whole < std::numeric_limits<std::int64_t>::max() ? whole + 1 : whole;
    case 1: return whole > 0 ? whole - 1 : 0;
    case 2: return static_cast<std::int64_t>(random.below(4));
    default: return static_cast<std::int64_t>(random.below(64));
  }
}

std::string mutated_word(const Slot& slot, const JsonGrammar& grammar, Random& random) {
  for (const JsonGrammar::Words& words : grammar.words)
    if (words.key == slot.key && random.chance(0.9)) return std::string(random.of(words.words));
  constexpr const char* k_odd[] = {"", "\n", "../x", "/dev/null", "a\u202eb", "*", "[", "%", "%0A", "data:,", "0", "é"};
  std::string word = slot.value->get<std::string>();
  switch (random.below(4)) {
    case 0: return random.of(k_odd);
    case 1: return word.substr(0, random.below(word.size()));
    case 2: return word + random.of(k_odd);
    default: break;
  }
  if (!word.empty()) word[random.below(word.size())] = static_cast<char>(' ' + static_cast<int>(random.below(95)));
  return word;
}

void change_scalar(Json& json, const JsonGrammar& grammar, Random& random) {
  const auto slots = slots_of(json, [](const Slot& slot) { return slot.value->is_primitive(); });
  if (slots.empty()) return;
  const Slot& slot = random.of(slots);
  if (slot.value->is_boolean())
    *slot.value = !slot.value->get<bool>();
  else if (slot.value->is_number())
    *slot.value = mutated_number(slot, grammar, random);
  else if (slot.value->is_string())
    *slot.value = mutated_word(slot, grammar, random);
}

/// Copies a member of an object in `source` into an object that stands under the same key.
void graft(Json& json, const Json& source, Random& random) {
  const auto is_object = [](const Slot& slot) { return slot.value->is_object(); };
  Json samples = source;
  const auto targets = slots_of(json, is_object), all = slots_of(samples, is_object);
  if (targets.empty()) return;
  const Slot& target = random.of(targets);
  std::vector<const Json*> fitting;
  for (const Slot& slot : all)
    if (slot.key == target.key && !slot.value->empty()) fitting.push_back(slot.value);
  if (fitting.empty()) return;
  const Json& object = *random.of(fitting);
  auto member = object.begin();
  std::advance(member, random.below(object.size()));
  (*target.value)[member.key()] = member.value();
}

void erase_or_repeat(Json& json, Random& random) {
  const auto slots = slots_of(json, [](const Slot& slot) { return slot.parent != nullptr; });
  if (slots.empty()) return;
  const Slot& slot = random.of(slots);
  if (slot.parent->is_array()) {
    const auto place = slot.parent->begin() + static_cast<std::ptrdiff_t>(slot.index);
    if (random.chance(0.5))
      slot.parent->push_back(Json(*slot.value));
    else
      slot.parent->erase(place);
  } else {
    slot.parent->erase(std::string(slot.key));
  }
}

/// Gives a value that of another one; under the same key, or any of the same type.
void copy_or_swap(Json& json, Random& random) {
  auto slots = slots_of(json);
  const Slot target = random.of(slots);
  const bool same_key = random.chance(0.7);
  std::erase_if(slots, [&](const Slot& slot) {
    return slot.value == target.value ||
           (same_key ? slot.key != target.key : slot.value->type() != target.value->type());
  });
  if (slots.empty()) return;
  // A value must not be swapped with one that holds it.
  Json& other = *random.of(slots).value;
  if (random.chance(0.5) && other.is_primitive() && target.value->is_primitive())
    std::swap(other, *target.value);
  else
    *target.value = Json(other);
}

void change_type(Json& json, Random& random) {
  const auto slots = slots_of(json, [](const Slot& slot) { return slot.parent != nullptr; });
  if (slots.empty()) return;
  const Json others[] = {nullptr, true, -1, 0.5, "x", Json::array(), Json::object(), Json::array({1, 2})};
  *random.of(slots).value = random.of(others);
}

}  // namespace

const JsonGrammar& tag_grammar() {
  static const JsonGrammar grammar{
      {{"stiffness", 0, 1e7},
       {"damping", 0, 1e5},
       {"staticFriction", 0, 100},
       {"dynamicFriction", 0, 100},
       {"stribeckVelocity", 1e-9, 1e3},
       {"bits", 1, 64},
       {"size", 1, 65536},
       {"scale", -1, 1},
       {"offset", -1, 1},
       {"rms", 0, 1},
       {"texCoord", 0, 7},
       {"metresPerUV", 1e-9, 1e12},
       {"rotation", -7, 7},
       {"fractalDimension", 2, 3},
       {"rmsHeight", 0, 0.1},
       {"wavelengthRange", 1e-9, 100},
       {"amplitude", 0, 100},
       {"period", -1, 1},
       {"area", 0, 10},
       {"box", -10, 10}},
      {{"name",
        {"heightfield", "orthogonal", "lateral", "lateral-isotropic", "graph-orthogonal", "graph-lateral",
         "textured-normal", "coulomb", "bristle"}},
       {"sign", {"downhill", "literal"}},
       {"outward", {"white", "black"}},
       {"wrap", {"repeat", "clamp", "mirror"}},
       {"quantity", {"stiffness", "static_friction", "dynamic_friction", "damping"}},
       {"channel", {"r", "g"}},
       {"group", {"p1", "p4m", "p6m", "cmm"}}},
      Json::parse(R"({"version":2,"stiffness":900,"damping":0.5,"staticFriction":0.4,"dynamicFriction":0.3,
        "stribeckVelocity":0.02,"frictionModel":{"name":"bristle","stiffness":300},"forceShading":true,
        "height":{"image":"h","sha256":"","bits":16,"channel":"r","size":[8,8],"scale":0.001,"offset":-0.0005,
          "outward":"white","texCoord":0,"uvTransform":{"offset":[0.1,0],"rotation":0.5,"scale":[2,2]},
          "metresPerUV":[0.04,0.04],"wrap":["repeat","clamp"],"rms":0.0001},
        "maps":{"image":"m","sha256":"","bits":8,"size":[8,8],
          "channels":{"r":{"quantity":"stiffness","scale":300,"offset":100},"g":{"quantity":"dynamic_friction","scale":0.4,
            "offset":0.1},"b":{"quantity":"damping","scale":-0.5,"offset":0.5}},
          "texCoord":0,"uvTransform":{"offset":[0.1,0],"rotation":0.5,"scale":[2,2]},"wrap":["repeat","clamp"]},
        "backing":{"stiffness":1800,"depth":0.001},
        "roughness":{"fractalDimension":2.4,"rmsHeight":0.0001,"wavelengthRange":[0.0002,0.02]},
        "forceModel":{"name":"lateral","amplitude":0.02,"sign":"literal"},
        "symmetry":{"group":"pmm","period":[[0.01,0],[0,0.01]]},
        "provenance":{"tool":"papilla","source":"a","plan":"b"},"other":[1]})")};
  return grammar;
}

void mutate_json(Json& json, const JsonGrammar& grammar, Random& random) {
  for (std::size_t left = 1 + random.below(4); left > 0; --left) {
    const std::size_t choice = random.below(100);
    if (choice < 60)
      change_scalar(json, grammar, random);
    else if (choice < 75)
      graft(json, grammar.sample, random);
    else if (choice < 84)
      erase_or_repeat(json, random);
    else if (choice < 98)
      copy_or_swap(json, random);
    else
      change_type(json, random);
  }
}

void repair_tag(Json& tag) {
  if (!tag.is_object()) tag = Json::object();
  tag["version"] = tag.contains("maps") || tag.contains("backing") ? 2 : 1;
  if (!tag.contains("stiffness") && !tag.contains("height")) tag["stiffness"] = 500;
}

void fit_json(Json& value, const Json& sample, const JsonGrammar& grammar, std::string_view key) {
  const bool same = value.type() == sample.type() || (value.is_number() && sample.is_number());
  if (!same || (value.is_array() && value.size() != sample.size())) value = sample;
  if (value.is_object()) {
    std::vector<std::string> unknown;
    for (auto& [name, member] : value.items())
      if (sample.contains(name))
        fit_json(member, sample[name], grammar, name);
      else
        unknown.push_back(name);
    for (const std::string& name : unknown) value.erase(name);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) fit_json(value[i], sample[i], grammar, key);
  } else if (value.is_number()) {
    for (const auto& [name, low, high] : grammar.ranges)
      if (name == key) {
        if (const double number = value.get<double>(); !(number >= low && number <= high))
          value = std::clamp(number, low, high);
        return;
      }
  } else if (value.is_string()) {
    for (const auto& [name, words] : grammar.words)
      if (name == key && std::find(words.begin(), words.end(), value.get<std::string>()) == words.end())
        value = words.front();
  }
}

void cross_json(Json& json, const Json& other, Random& random) {
  if (random.chance(0.5)) return graft(json, other, random);
  Json source = other;
  const auto targets = slots_of(json), all = slots_of(source);
  const Slot& target = random.of(targets);
  std::vector<const Json*> fitting;
  for (const Slot& slot : all)
    if (slot.key == target.key && slot.value->type() == target.value->type()) fitting.push_back(slot.value);
  if (!fitting.empty()) *target.value = *random.of(fitting);
}

std::size_t mutate_json_text(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                             const JsonGrammar& grammar, void (*repair)(Json&)) {
  constexpr double k_repaired_share = 0.9;
  Random random(seed);
  Json json = Json::parse(data, data + size, nullptr, false);
  if (json.is_discarded() || random.chance(k_bytes_share)) return mutate_bytes(data, size, max_size, random);
  mutate_json(json, grammar, random);
  if (repair != nullptr && random.chance(k_repaired_share)) repair(json);
  return store(json.dump(-1, ' ', false, Json::error_handler_t::replace), data, size, max_size);
}

std::size_t cross_json_texts(std::string_view first, std::string_view second, std::uint8_t* out, std::size_t max_size,
                             unsigned seed) {
  Random random(seed);
  Json json = Json::parse(first, nullptr, false);
  const Json other = Json::parse(second, nullptr, false);
  if (json.is_discarded() || other.is_discarded()) return store(first, out, 0, max_size);
  cross_json(json, other, random);
  return store(json.dump(-1, ' ', false, Json::error_handler_t::replace), out, 0, max_size);
}

std::size_t mutate_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size, Random& random) {
  if (LLVMFuzzerMutate != nullptr) return LLVMFuzzerMutate(data, size, max_size);
  if (size > 0) data[random.below(size)] ^= static_cast<std::uint8_t>(1U << random.below(8));
  return size;
}

std::size_t store(std::string_view text, std::uint8_t* data, std::size_t size, std::size_t max_size) {
  if (text.size() > max_size) return size;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace papilla::fuzz
