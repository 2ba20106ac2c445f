// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {

/// A program would write over one of its inputs, or write two outputs to one file (exit code 2).
class OverwriteRefused : public Error {
 public:
  using Error::Error;
};

// Which files of this process are inputs and which outputs. Two paths are one file when they lead to the same device
// and inode, or would once the missing one is made. Devices and pipes are no files here. Off until start_file_guard():
// the users of the library may read and replace as they like. All functions may be called from any thread.

/// Begins to note files. For programs, once, before they open any.
void start_file_guard();

/// An input or output that the command line names, before the work begins.
/// @param name  what names it in messages: the option.
/// @throws OverwriteRefused when it is an output and an input, or two outputs.
void declare_input(const std::filesystem::path& path, const std::string& name);
void declare_output(const std::filesystem::path& path, const std::string& name);

/// A file that is about to be read: read_file() and require_file() call it. What this process has written may be read.
/// @throws OverwriteRefused when it is a declared output that is not written yet.
void note_input(const std::filesystem::path& path);

/// A file that is about to be written: write_atomically() calls it.
/// @throws OverwriteRefused when it is an input, or was written before.
void note_output(const std::filesystem::path& path);

/// Lets a program that builds again and again write its outputs once more.
void forget_written_outputs();

/// Notes and refuses nothing more: for programs in which people open, change and save the same files.
void end_file_guard();

}  // namespace papilla
