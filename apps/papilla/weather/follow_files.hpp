// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace papilla::app {

/// Calls `changed` whenever one of the files has another time or size than before, until `stopped` says so. The files
/// are looked at five times a second, which works on every file system; a file that is being replaced counts when it is
/// there again.
/// @param files  asked anew at every look.
void follow_files(const std::function<std::vector<std::filesystem::path>()>& files,
                  const std::function<void()>& changed, const std::function<bool()>& stopped);

}  // namespace papilla::app
