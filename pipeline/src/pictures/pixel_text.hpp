// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/texture/image.hpp"

namespace papilla {

/// Width of a text in pixels at a scale: 3 x 5 dots a character, one dot between them.
int text_width(std::string_view text, int scale);

/// Calls set(x, y) for every pixel of the text, its upper edge at `top`, its middle at `centre`. The font has digits,
/// capital letters (small ones are drawn as capitals) and . + - , ; any other character is a blank.
void draw_text(std::string_view text, int centre, int top, int scale, const std::function<void(int, int)>& set);

/// The picture with a white band below that has a caption under each of its equally wide panels. Letters are as large
/// as the widest caption allows.
ColorImage with_captions(const ColorImage& picture, const std::vector<std::string>& captions);

}  // namespace papilla
