// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace papilla {

/// Whether a new file is on the disk when it gets its name.
enum class Durability {
  synced,   ///< It is, so that a loss of power can't leave a file of that name without content.
  unsynced  ///< The system writes it when it likes: for what can be made again and is read with a sum.
};

/// Lets `write` fill a temporary file in the folder of `path` and renames it to `path` when that
/// succeeded, so that a crash, an exception or a full disk neither leaves half a file nor destroys
/// the old one. A file that is replaced keeps its mode bits, and its owner and group where that is permitted. A
/// symbolic link is followed: its target is replaced and the link stays, except another user's link in a folder that
/// everyone may write to. Devices and pipes are written to as they are.
/// The temporary file has an unpredictable name, is new, and is locked until it is renamed. Temporary files that a
/// killed process of the same user left in the folder are removed by the next process that writes there.
/// The stream throws when the system refuses a byte. Its position can be set, except on devices and pipes.
/// @param bytes  that `write` will write at least, as far as known: when the file system has less space for this user,
///        nothing is begun.
/// @throws IoError naming `path` and the system's reason, or the bytes needed and free; OverwriteRefused as
/// note_output() of file_guard.hpp;
///         whatever `write` throws passes through after the temporary file is removed.
void write_atomically(const std::filesystem::path& path, const std::function<void(std::ostream& out)>& write,
                      std::uintmax_t bytes = 0, Durability durability = Durability::synced);

/// The same for content that fits into memory.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Tells before long work whether `path` can be written: writes a block beside it, which is removed.
/// @throws IoError as write_atomically() would.
void require_writable(const std::filesystem::path& path);

/// Removes the temporary files of writes under way; may be called from a signal handler, after which the process must
/// end. Other threads begin no more writes and wait where what they wrote is gone.
void remove_temporaries() noexcept;

/// Makes a folder, and those above it that are missing. @returns whether it is new.
/// @throws IoError naming it and the system's reason.
bool make_folder(const std::filesystem::path& path);

}  // namespace papilla
