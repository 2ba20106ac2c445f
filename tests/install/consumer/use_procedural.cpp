// SPDX-License-Identifier: MIT
#include <papilla/procedural/library.hpp>

int main() {
  papilla::RecipeLibrary library;
  library.add("plain", "brick|scale=.5");
  return library.find("plain") != nullptr && !papilla::RecipeLibrary::builtin().recipes().empty() ? 0 : 1;
}
