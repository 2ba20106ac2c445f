// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/pipeline/grain.hpp"

namespace papilla {

/// What of a grain rests on a choice that a picture does not settle, a sentence each, for people who look at it:
/// - the class, where the share that repeats is within 0.05 of where another class begins (classify());
/// - the lattice, where there is order but none was found;
/// - the depth, where the rule does not say it;
/// - the direction of the light, where it is estimated, and with it bumps and hollows;
/// - the roughness, where it follows no power law;
/// and the grain's warnings. Empty for a recipe without warnings. Cost: O(1).
std::vector<std::string> grain_doubts(const MaterialRule& rule, const Grain& grain);

}  // namespace papilla
