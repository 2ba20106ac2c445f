// SPDX-License-Identifier: MIT
#include <cmath>
#include <papilla/study/psychometric.hpp>

int main() {
  const papilla::PsychometricFunction f =
      papilla::most_likely_function({{0.1, 1000, 600}, {0.4, 1000, 900}}, {.most_lapse = 0});
  return std::abs(f.threshold - 0.2) < 1e-6 ? 0 : 1;
}
