// SPDX-License-Identifier: MIT
#include <papilla/core/error.hpp>
#include <papilla/core/vec.hpp>
#include <string>

int main() {
  const std::string version = papilla::version();
  return !version.empty() && papilla::norm(papilla::Vec3{2, 3, 6}) == 7 ? 0 : 1;
}
