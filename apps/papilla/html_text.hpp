// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace papilla::app {

/// A text in which nothing is markup and nothing changes the order of characters, for elements and quoted attributes of
/// HTML.
std::string html_text(const std::string& text);

}  // namespace papilla::app
