// SPDX-License-Identifier: MIT
#include "papilla/core/glob.hpp"

#include <fnmatch.h>
#include <locale.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace papilla {
namespace {

std::vector<std::string> names_of(const std::string& path) {
  std::vector<std::string> names;
  for (std::size_t begin = 0;;) {
    const std::size_t end = path.find('/', begin);
    names.push_back(path.substr(begin, end - begin));
    if (end == std::string::npos) return names;
    begin = end + 1;
  }
}

/// Makes the thread's characters those of UTF-8, whatever the program's locale.
class Utf8Characters {
 public:
  Utf8Characters() noexcept : before_(utf8() != nullptr ? ::uselocale(utf8()) : nullptr) {}
  ~Utf8Characters() {
    if (before_ != nullptr) ::uselocale(before_);
  }
  Utf8Characters(const Utf8Characters&) = delete;
  Utf8Characters& operator=(const Utf8Characters&) = delete;

 private:
  static locale_t utf8() noexcept {
    static const locale_t locale = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
    return locale;
  }
  locale_t before_;
};

}  // namespace

bool matches_glob(const std::string& pattern, const std::string& name) {
  if (pattern.find('\0') != std::string::npos || name.find('\0') != std::string::npos) return false;
  const Utf8Characters characters;
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

bool matches_path_glob(const std::string& pattern, const std::string& path) {
  const std::vector<std::string> names = names_of(path);
  // fits[n]: the steps of the pattern so far fit the first n names.
  std::vector<std::uint8_t> fits(names.size() + 1, 0);
  fits[0] = 1;
  for (const std::string& step : names_of(pattern)) {
    if (step == "**") {
      for (std::size_t n = 1; n < fits.size(); ++n) fits[n] |= fits[n - 1];
      continue;
    }
    for (std::size_t n = fits.size() - 1; n > 0; --n)
      fits[n] = fits[n - 1] != 0 && matches_glob(step, names[n - 1]) ? 1 : 0;
    fits[0] = 0;
  }
  return fits.back() != 0;
}

}  // namespace papilla
