// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace papilla {

/// Lets `write` fill a temporary file in the folder of `path` and renames it to `path` when that
/// succeeded, so that a crash, an exception or a full disk neither leaves half a file nor destroys
/// the old one. The temporary file keeps the extension of `path`, for writers that choose
/// the format by it.
/// @throws IoError when the folder is missing, or the file can't be written, flushed or renamed;
///         whatever `write` throws passes through after the temporary file is removed.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for content that fits into memory.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Removes the temporary files of writes under way; may be called from a signal handler, after which
/// the process must end.
void remove_temporaries() noexcept;

}  // namespace papilla
