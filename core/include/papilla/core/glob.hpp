// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace papilla {

/// Whether a name fits a shell pattern: `*` is any text, `?` any character of UTF-8, `[a-z]` one of those; a
/// backslash takes the character behind it as it is. The pattern covers the whole name. Upper and lower case differ. A
/// name or pattern with a null byte fits nothing. What does not fit as characters may fit byte by byte (glibc).
bool matches_glob(const std::string& pattern, const std::string& name);

/// Whether a path, names joined by '/', fits a pattern of names: in a name as matches_glob(), so that `*` stays within
/// one, and the name `**` is any number of names, none included. "a/**/c" fits "a/c" and "a/b/c".
/// Cost: names of the pattern times names of the path.
bool matches_path_glob(const std::string& pattern, const std::string& path);

}  // namespace papilla
