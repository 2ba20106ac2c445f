// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "json_mutator.hpp"

namespace papilla::fuzz {

bool is_png(std::string_view bytes);

/// Changes fields of the header and bytes of chunks, repeats and drops chunks; the sums are right again, those of the
/// zlib stream too where it stores its bytes as they are. A file that is cut within a chunk stays cut.
void mutate_png(std::string& bytes, Random& random);

}  // namespace papilla::fuzz
