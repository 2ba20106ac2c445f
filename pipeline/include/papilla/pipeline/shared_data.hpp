// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace papilla {

/// A folder of the data that is installed with the program: share/papilla/NAME beside the folder of the running
/// program, else the one that was installed with this library.
/// @param hint  what may name another one, for the message; may be empty.
/// @throws IoError naming the places where there is none.
std::filesystem::path find_shared_data(const std::string& name, const std::string& hint = {});

}  // namespace papilla
