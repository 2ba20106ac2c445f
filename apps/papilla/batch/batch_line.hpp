// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace papilla::app {

/// One command of a batch.
struct BatchLine {
  std::string place;               ///< "lines.jsonl: line 3", or its input.
  std::string id;                  ///< As the manifest has it; may be empty.
  std::vector<std::string> words;  ///< The verb and all that follows it.
  std::optional<double> cost_seconds;

  // Found by check_lines().
  std::vector<std::filesystem::path> inputs, outputs;  ///< Files that its options name.
  bool names_threads = false;                          ///< It says --threads itself.
};

/// Lines of a JSON Lines file. A line is an object with "command", the words of a command line that begins with
/// "papilla", and perhaps "id" and "cost_seconds"; what else it has is for others. Empty lines are none.
/// @throws IoError; InvalidInput naming the file, the line and the reason.
std::vector<BatchLine> manifest_lines(const std::filesystem::path& manifest);

/// "VERB INPUT WORD ..." for every input. In the words {stem} stands for the input's name without extension, {name} for
/// the whole name and {folder} for where it lies, as it was given.
/// @throws UsageError when a word has another name in braces.
std::vector<BatchLine> lines_of_verb(const std::string& verb, std::span<const std::string> inputs,
                                     std::span<const std::string> words);

/// Parses every line as the program will, without doing anything, and finds its files.
/// @throws InvalidInput naming the line that is no command of this program; OverwriteRefused when two lines write one
///         file, or one reads what another writes.
void check_lines(std::span<BatchLine> lines);

/// Whether all files that the line's options name to be written are there, and none is older than one that it reads.
/// False where no option names a file to write.
bool is_up_to_date(const BatchLine& line);

}  // namespace papilla::app
