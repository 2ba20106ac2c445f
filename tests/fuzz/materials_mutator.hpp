// SPDX-License-Identifier: MIT
#pragma once

#include "json_mutator.hpp"

namespace papilla::fuzz {

/// The members of MATERIALS.json.
const JsonGrammar& materials_grammar();

/// Makes of a damaged MATERIALS.json one that read_materials() accepts.
void repair_materials(Json& rules);

}  // namespace papilla::fuzz
