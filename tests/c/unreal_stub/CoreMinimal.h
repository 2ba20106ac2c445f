// SPDX-License-Identifier: MIT
// As much of Unreal as examples/unreal/PapillaHaptic.h uses, so that it compiles and runs without.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

using int32 = std::int32_t;
using TCHAR = char16_t;
#define TEXT(quote) u##quote

inline std::string to_utf8(const TCHAR* text) {
  std::string bytes;
  for (; *text != 0; ++text) bytes += static_cast<char>(*text);  // The test's names are ASCII.
  return bytes;
}
inline std::u16string to_utf16(const char* text) {
  const std::string bytes(text);
  return {bytes.begin(), bytes.end()};
}
#define TCHAR_TO_UTF8(text) to_utf8(text).c_str()
#define UTF8_TO_TCHAR(text) to_utf16(text).c_str()

class FString {
 public:
  FString() = default;
  FString(const TCHAR* text) : text_(text) {}
  const TCHAR* operator*() const { return text_.c_str(); }

 private:
  std::u16string text_;
};

struct FVector {
  FVector() = default;
  FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
  double X = 0, Y = 0, Z = 0;
};
