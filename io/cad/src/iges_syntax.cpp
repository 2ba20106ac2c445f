// SPDX-License-Identifier: MIT
#include "cad_syntax.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "papilla/core/error.hpp"

namespace papilla::cad {
namespace {

constexpr std::size_t k_section_column = 72, k_field = 8;

struct Line {
  std::string_view text;
  std::size_t number;  ///< In the file, from 1.
};

/// The integer in a field that blanks may surround; an empty field is 0.
std::optional<long> integer(std::string_view field) {
  const std::size_t first = field.find_first_not_of(' ');
  if (first == std::string_view::npos) return 0;
  field = field.substr(first, field.find_last_not_of(' ') - first + 1);
  if (field.starts_with('+')) field.remove_prefix(1);
  long value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size() ? std::optional(value) : std::nullopt;
}

class Checker {
 public:
  Checker(const std::filesystem::path& path, std::string_view text) : path_(path) { split(text); }

  void check() const {
    check_directory();
    check_parameters();
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InvalidInput(path_.string() + ": IGES file is damaged (line " + std::to_string(line) + ": " + what + ")");
  }

  void split(std::string_view text) {
    std::size_t number = 0, section = 0;
    constexpr std::string_view k_order = "SGDPT";
    while (!text.empty()) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      ++number;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.find_first_not_of(std::string_view(" \0", 2)) == std::string_view::npos) continue;
      if (line.size() <= k_section_column) fail(number, "it has no section letter in column 73");
      const std::size_t letter = k_order.find(line[k_section_column]);
      if (letter == std::string_view::npos || letter < section || letter > section + 1)
        fail(number, "its section letter is out of order");
      section = letter;
      if (line[k_section_column] == 'D') directory_.push_back({line, number});
      if (line[k_section_column] == 'P') parameters_.push_back({line, number});
    }
    if (directory_.empty() || parameters_.empty()) fail(number, "the file has no directory or no parameters");
  }

  long field(const Line& line, std::size_t index) const {
    const auto value = integer(line.text.substr(index * k_field, k_field));
    if (!value) fail(line.number, "field " + std::to_string(index + 1) + " is no number");
    return *value;
  }

  void check_directory() const {
    if (directory_.size() % 2 != 0) fail(directory_.back().number, "the directory has an odd number of lines");
    const auto lines = static_cast<long>(parameters_.size());
    for (std::size_t i = 0; i < directory_.size(); i += 2) {
      const Line &first = directory_[i], &second = directory_[i + 1];
      if (field(first, 0) != field(second, 0)) fail(second.number, "its entity type is not that of the line before");
      const long from = field(first, 1), count = field(second, 3);
      // Type 0 is an entity that was deleted.
      if (field(first, 0) == 0) continue;
      if (from < 1 || count < 0 || from > lines || count > lines - from + 1)
        fail(first.number, "it points outside of the parameter section");
      for (const std::size_t pointer : {2u, 3u, 4u, 5u, 6u, 7u})
        if (const long to = field(first, pointer); std::abs(to) > static_cast<long>(directory_.size()))
          fail(first.number, "field " + std::to_string(pointer + 1) + " points outside of the directory");
    }
  }

  void check_parameters() const {
    for (const Line& line : parameters_) {
      const auto owner = integer(line.text.substr(64, k_field));
      if (!owner || *owner < 1 || *owner > static_cast<long>(directory_.size()) || *owner % 2 == 0)
        fail(line.number, "its pointer back to the directory is wrong");
    }
  }

  const std::filesystem::path& path_;
  std::vector<Line> directory_, parameters_;
};

}  // namespace

void check_iges_syntax(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": can't be opened");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  Checker(path, text).check();
}

}  // namespace papilla::cad
