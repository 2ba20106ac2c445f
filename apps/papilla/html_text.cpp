// SPDX-License-Identifier: GPL-3.0-or-later
#include "html_text.hpp"

#include "papilla/core/one_line.hpp"

namespace papilla::app {

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : shown_lines(text)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

}  // namespace papilla::app
