// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/pipeline/contact_sheet.hpp"

namespace papilla::app {

/// The sheet as an HTML page: every tile above its name, cut out of the picture, and a table.
std::string sheet_page(const ContactSheet& sheet, const std::string& picture_file);

}  // namespace papilla::app
