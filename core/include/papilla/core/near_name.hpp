// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace papilla {

/// "; did you mean 'scale'?" with the known name that is nearest to a wrong word, or nothing where none is near.
///
/// Near is a name that the word becomes by at most max(2, letters / 3) changes, fewer than it has letters: a letter
/// more, less or another one, two neighbours exchanged (optimal string alignment distance). Upper and lower case are
/// alike. In the word, a shell pattern, '*' and '?' stand for any text and any letter. Failing that, near is a name
/// that contains a word of three letters or more, with at most letters / 5 changes. Of names that are equally near the
/// first one is taken.
///
/// Names of more than 200 bytes are left out. Cost: letters of the word times letters of all names at most.
/// @param most_changes Instead of that limit; where names are few, the nearest one helps even if it is far.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known,
                         std::optional<std::size_t> most_changes = {});

}  // namespace papilla
