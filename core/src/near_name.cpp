// SPDX-License-Identifier: MIT
#include "papilla/core/near_name.hpp"

#include <algorithm>
#include <utility>

#include "papilla/core/one_line.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_longest = 200;        ///< Bytes of a name that is compared.
constexpr std::size_t k_shortest_inside = 3;  ///< Letters that a name must contain to be found by them.
constexpr std::size_t k_letters_a_change_inside = 5;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Changes that make `name` of the pattern, by optimal string alignment; `limit` when there are as many or more.
std::size_t changes_between(std::string_view pattern, std::string_view name, std::size_t limit) {
  std::vector<std::size_t> before, last(name.size() + 1), row(name.size() + 1);
  for (std::size_t j = 0; j <= name.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= pattern.size(); ++i) {
    before = std::exchange(last, row);
    const char c = lower(pattern[i - 1]);
    if (c == '*') {
      for (std::size_t j = 1; j <= name.size(); ++j) row[j] = std::min(last[j], row[j - 1]);
      continue;
    }
    row[0] = last[0] + 1;
    for (std::size_t j = 1; j <= name.size(); ++j) {
      const char d = lower(name[j - 1]);
      row[j] = std::min({last[j - 1] + (c == d || c == '?' ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      const bool exchanged = i > 1 && j > 1 && c == lower(name[j - 2]) && lower(pattern[i - 2]) == d;
      if (exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    if (*std::min_element(row.begin(), row.end()) >= limit) return limit;
  }
  return std::min(row.back(), limit);
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known,
                         std::optional<std::size_t> most_changes) {
  if (word.size() > k_longest) return "";
  const auto letters = word.size() - static_cast<std::size_t>(std::count(word.begin(), word.end(), '*'));
  std::size_t least = most_changes ? *most_changes + 1 : std::min(letters, std::max<std::size_t>(2, letters / 3) + 1);
  std::string_view best;
  const auto look_for = [&](std::string_view pattern) {
    for (const std::string_view name : known) {
      if (name.empty() || name.size() > k_longest) continue;
      const std::size_t changes = changes_between(pattern, name, least);
      if (changes >= least) continue;
      least = changes;
      best = name;
    }
  };
  look_for(word);
  if (best.empty() && letters >= k_shortest_inside) {
    least = letters / k_letters_a_change_inside + 1;
    look_for("*" + std::string(word) + "*");
  }
  return best.empty() ? "" : "; did you mean '" + shown(best) + "'?";
}

}  // namespace papilla
