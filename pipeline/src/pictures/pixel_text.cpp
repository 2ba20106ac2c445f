// SPDX-License-Identifier: MIT
#include "pictures/pixel_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace papilla {
namespace {

constexpr int k_columns = 3, k_rows = 5;
using Glyph = std::array<std::uint8_t, k_rows>;  ///< A row in the low three bits.

constexpr std::array<Glyph, 10> k_digits = {{{7, 5, 5, 5, 7},
                                             {2, 6, 2, 2, 7},
                                             {7, 1, 7, 4, 7},
                                             {7, 1, 7, 1, 7},
                                             {5, 5, 7, 1, 1},
                                             {7, 4, 7, 1, 7},
                                             {7, 4, 7, 5, 7},
                                             {7, 1, 2, 2, 2},
                                             {7, 5, 7, 5, 7},
                                             {7, 5, 7, 1, 7}}};
constexpr std::array<Glyph, 26> k_letters = {
    {{2, 5, 7, 5, 5}, {6, 5, 6, 5, 6}, {3, 4, 4, 4, 3}, {6, 5, 5, 5, 6}, {7, 4, 6, 4, 7}, {7, 4, 6, 4, 4},
     {3, 4, 5, 5, 3}, {5, 5, 7, 5, 5}, {7, 2, 2, 2, 7}, {1, 1, 1, 5, 2}, {5, 5, 6, 5, 5}, {4, 4, 4, 4, 7},
     {5, 7, 7, 5, 5}, {5, 7, 7, 7, 5}, {2, 5, 5, 5, 2}, {6, 5, 6, 4, 4}, {2, 5, 5, 6, 3}, {6, 5, 6, 5, 5},
     {3, 4, 2, 1, 6}, {7, 2, 2, 2, 2}, {5, 5, 5, 5, 7}, {5, 5, 5, 5, 2}, {5, 5, 7, 7, 5}, {5, 5, 2, 5, 5},
     {5, 5, 2, 2, 2}, {7, 1, 2, 4, 7}}};

Glyph glyph(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (std::isdigit(byte)) return k_digits[static_cast<std::size_t>(c - '0')];
  if (byte < 128 && std::isalpha(byte)) return k_letters[static_cast<std::size_t>(std::toupper(byte) - 'A')];
  switch (c) {
    case '.': return {0, 0, 0, 0, 2};
    case ',': return {0, 0, 0, 2, 4};
    case '+': return {0, 2, 7, 2, 0};
    case '-': return {0, 0, 7, 0, 0};
    default: return {};
  }
}

}  // namespace

int text_width(std::string_view text, int scale) { return static_cast<int>(text.size()) * (k_columns + 1) * scale; }

void draw_text(std::string_view text, int centre, int top, int scale, const std::function<void(int, int)>& set) {
  int left = centre - text_width(text, scale) / 2;
  for (const char c : text) {
    const Glyph rows = glyph(c);
    for (int y = 0; y < k_rows * scale; ++y)
      for (int x = 0; x < k_columns * scale; ++x)
        if (rows[static_cast<std::size_t>(y / scale)] >> (k_columns - 1 - x / scale) & 1) set(left + x, top + y);
    left += (k_columns + 1) * scale;
  }
}

ColorImage with_captions(const ColorImage& picture, const std::vector<std::string>& captions) {
  constexpr int k_most_scale = 3, k_gap = 3;
  const int width = picture.width / std::max(1, static_cast<int>(captions.size()));
  int scale = k_most_scale;
  for (const std::string& caption : captions)
    while (scale > 1 && text_width(caption, scale) > width) --scale;
  ColorImage result = picture;
  result.height += k_rows * scale + 2 * k_gap * scale;
  result.pixels.resize(3 * static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height), 255);
  for (std::size_t i = 0; i < captions.size(); ++i)
    draw_text(
        captions[i], static_cast<int>(i) * width + width / 2, picture.height + k_gap * scale, scale, [&](int x, int y) {
          if (x < 0 || x >= result.width) return;
          const auto at =
              3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(result.width) + static_cast<std::size_t>(x));
          std::fill_n(&result.pixels[at], 3, static_cast<unsigned char>(0));
        });
  return result;
}

}  // namespace papilla
