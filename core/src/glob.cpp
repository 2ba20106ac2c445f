// SPDX-License-Identifier: MIT
#include "papilla/core/glob.hpp"

#include <fnmatch.h>

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

}  // namespace

bool matches_glob(const std::string& pattern, const std::string& name) {
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
