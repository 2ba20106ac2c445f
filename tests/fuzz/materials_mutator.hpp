// SPDX-License-Identifier: MIT
#pragma once

#include "json_mutator.hpp"

namespace papilla::fuzz {

/// The members of MATERIALS.json.
const JsonGrammar& materials_grammar();

}  // namespace papilla::fuzz
