// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/file_guard.hpp"

/// Which options name files: every option of both programs whose value is a path is marked by one of these, so that no
/// output is written over an input or another output.
namespace papilla::app {

struct FileOption {
  enum class Use { input, output, folder, perhaps_output } use;
  std::vector<std::string> names;  ///< Of the files that are always written into a folder.
};

inline std::map<const CLI::Option*, FileOption>& file_options() {
  static std::map<const CLI::Option*, FileOption> options;
  return options;
}

/// An option that names files to read. @returns the option.
inline CLI::Option* reads(CLI::Option* option) {
  file_options()[option] = {FileOption::Use::input, {}};
  return option;
}

/// An option that names a file to write; "-" is standard output. @returns the option.
inline CLI::Option* writes(CLI::Option* option) {
  file_options()[option] = {FileOption::Use::output, {}};
  return option;
}

/// An option that names a folder to write into. @returns the option.
inline CLI::Option* writes_into(CLI::Option* option, std::vector<std::string> names = {}) {
  file_options()[option] = {FileOption::Use::folder, std::move(names)};
  return option;
}

/// An option that names a file to write, if it has an extension, or something else: a folder, a device. @returns the
/// option.
inline CLI::Option* writes_if_file(CLI::Option* option) {
  file_options()[option] = {FileOption::Use::perhaps_output, {}};
  return option;
}

/// Whether a value of an option names a file to write.
inline bool names_output(FileOption::Use use, const std::string& value) {
  if (use == FileOption::Use::perhaps_output)
    return std::filesystem::path(value).has_extension() && !std::filesystem::is_directory(value);
  return use == FileOption::Use::output;
}

/// Declares what the command's options name.
/// @throws OverwriteRefused.
inline void declare_files(const CLI::App& command) {
  for (const bool inputs : {true, false})
    for (const CLI::Option* option : command.get_options()) {
      const auto known = file_options().find(option);
      if (known == file_options().end() || (known->second.use == FileOption::Use::input) != inputs) continue;
      for (const std::string& value : option->results()) {
        if (value.empty() || value == "-") continue;
        if (inputs) declare_input(value, option->get_name());
        if (names_output(known->second.use, value)) declare_output(value, option->get_name());
        for (const std::string& name : known->second.names)
          declare_output(std::filesystem::path(value) / name, option->get_name());
      }
    }
}

/// Checks that the files which the command's options name can be written, before the work begins.
/// @throws IoError naming the file and the reason.
inline void require_outputs(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const auto known = file_options().find(option);
    if (known == file_options().end()) continue;
    for (const std::string& value : option->results())
      if (!value.empty() && value != "-" && names_output(known->second.use, value)) require_writable(value);
  }
}

}  // namespace papilla::app
