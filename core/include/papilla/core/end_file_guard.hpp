// SPDX-License-Identifier: MIT
#pragma once

namespace papilla {

/// Lets the guard of file_guard.hpp note and refuse nothing more: for programs in which people open, change and save
/// the same files.
void end_file_guard();

}  // namespace papilla
