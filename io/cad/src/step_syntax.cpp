// SPDX-License-Identifier: MIT
#include "cad_syntax.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_set>

#include "papilla/core/error.hpp"

namespace papilla::cad {
namespace {

constexpr char k_end = '\0';

class Scanner {
 public:
  Scanner(const std::filesystem::path& path, std::string_view text) : path_(path), text_(text) {}

  void check() {
    while (!at_end()) {
      const std::string word = statement_keyword();
      if (word == "DATA") {
        finish_statement();
        check_data();
      } else if (!at_end()) {
        finish_statement();
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const auto lines = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw InvalidInput(path_.string() + ": STEP file is damaged (line " + std::to_string(lines) + ": " + what + ")");
  }

  bool at_end() {
    skip_blanks();
    return at_ >= text_.size();
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : k_end; }

  void skip_blanks() {
    while (at_ < text_.size()) {
      if (std::isspace(static_cast<unsigned char>(text_[at_])) || text_[at_] == '\0') {
        ++at_;
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t close = text_.find("*/", at_ + 2);
        if (close == std::string_view::npos) fail("a comment is not closed");
        at_ = close + 2;
      } else {
        return;
      }
    }
  }

  std::string statement_keyword() {
    skip_blanks();
    std::string word;
    while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '-' || peek() == '_') word += text_[at_++];
    return word;
  }

  void skip_string() {
    const std::size_t close = text_.find('\'', at_ + 1);
    if (close == std::string_view::npos) fail("a string is not closed");
    at_ = close + 1;
  }

  /// To behind the next ';' outside of strings and comments.
  void finish_statement() {
    int depth = 0;
    for (;; ++at_) {
      skip_blanks();
      while (peek() == '\'') {
        skip_string();
        skip_blanks();
      }
      const char c = peek();
      if (at_ >= text_.size()) fail("the last statement has no end");
      if (c == '(') ++depth;
      if (c == ')' && --depth < 0) fail("a parenthesis is closed that was not opened");
      if (c == '#' && !std::isdigit(static_cast<unsigned char>(at_ + 1 < text_.size() ? text_[at_ + 1] : k_end)))
        fail("# without a number");
      if (c == '=') fail("a second = in one statement");
      if (c != ';') continue;
      if (depth > 0) fail("a parenthesis is not closed");
      ++at_;
      return;
    }
  }

  void check_data() {
    std::unordered_set<std::uint64_t> numbers;
    while (!at_end()) {
      if (peek() != '#') {
        if (statement_keyword() != "ENDSEC") fail("neither #number nor ENDSEC");
        finish_statement();
        return;
      }
      const std::uint64_t number = entity_number();
      if (!numbers.insert(number).second) fail("#" + std::to_string(number) + " is given twice");
      skip_blanks();
      if (peek() != '=') fail("#" + std::to_string(number) + " without =");
      ++at_;
      skip_blanks();
      if (!std::isalpha(static_cast<unsigned char>(peek())) && peek() != '(' && peek() != '!' && peek() != '&')
        fail("#" + std::to_string(number) + " has no type");
      finish_statement();
    }
    fail("a DATA section has no ENDSEC");
  }

  std::uint64_t entity_number() {
    std::uint64_t number = 0;
    const std::size_t start = ++at_;
    // More than 18 digits don't fit any reader's numbers.
    while (std::isdigit(static_cast<unsigned char>(peek())) && at_ - start < 18)
      number = 10 * number + static_cast<std::uint64_t>(text_[at_++] - '0');
    if (at_ == start) fail("# without a number");
    if (number == 0) fail("#0 is no entity number");
    return number;
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

void check_step_syntax(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": can't be opened");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  Scanner(path, text).check();
}

}  // namespace papilla::cad
